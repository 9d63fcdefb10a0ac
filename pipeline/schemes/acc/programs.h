// Programs of ACC patches: compiled once, for the fast machine in programs_fast.cpp and for the
// checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/programs.h"
#include "shaders_cpp/acc/acc_hull_shader.h"

namespace tessemu {

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_ACC_PROGRAMS(instantiate, T)                                                       \
    instantiate class DomainProgramOn<AccQuadDomainShader, T>;                                     \
    instantiate class HullProgramOn<AccHullShader<SummedRows<4>>, T>;                              \
    instantiate class HullProgramOn<AccHullShader<GatheredRows<4>>, T>;

TESSEMU_ACC_PROGRAMS(extern template, FastScalar)
TESSEMU_ACC_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
