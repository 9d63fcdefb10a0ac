// Programs of Pm-patches: compiled once, for the fast machine in programs_fast.cpp and for the
// checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/programs.h"
#include "shaders_cpp/pm/pm_patch.h"
#include "shaders_cpp/pm/pm_vertex_shader.h"

namespace tessemu {

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_PM_PROGRAMS(instantiate, T)                                                        \
    instantiate class DomainProgramOn<PmQuadDomainShader, T>;                                      \
    instantiate class DomainProgramOn<PmTriangleDomainShader, T>;                                  \
    instantiate class HullProgramOn<PmRegularHullShader<>, T>;                                     \
    instantiate class HullProgramOn<PmHullShader<TessellatorDomain::Quad>, T>;                     \
    instantiate class HullProgramOn<PmHullShader<TessellatorDomain::Tri>, T>;                      \
    instantiate class VertexProgramOn<PmVertexShader<>, T>;

TESSEMU_PM_PROGRAMS(extern template, FastScalar)
TESSEMU_PM_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
