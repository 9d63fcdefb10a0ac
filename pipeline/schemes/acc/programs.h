// Programs of ACC patches: compiled once, for the fast machine in programs_fast.cpp and for the
// checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/programs.h"
#include "shaders_cpp/acc/acc_hull_shader.h"

namespace tessemu {

extern template class DomainProgramOn<AccQuadDomainShader, FastScalar>;
extern template class HullProgramOn<AccHullShader<>, FastScalar>;

extern template class DomainProgramOn<AccQuadDomainShader, CheckScalar>;
extern template class HullProgramOn<AccHullShader<>, CheckScalar>;

} // namespace tessemu
