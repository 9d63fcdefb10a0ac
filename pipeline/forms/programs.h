// Programs that schemes of one form share: compiled once, for the fast machine in programs_fast.cpp
// and for the checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/stencil_form/stencil_hull_shader.h"
#include "shaders_cpp/two_stage_form/by_corners.h"

namespace tessemu {

extern template class DomainProgramOn<RegularQuadDomainShader, FastScalar>;
extern template class DomainProgramOn<RegularCornersDomainShader, FastScalar>;
extern template class HullProgramOn<StencilHullShader<TessellatorDomain::Quad>, FastScalar>;
extern template class HullProgramOn<StencilHullShader<TessellatorDomain::Tri>, FastScalar>;

extern template class DomainProgramOn<RegularQuadDomainShader, CheckScalar>;
extern template class DomainProgramOn<RegularCornersDomainShader, CheckScalar>;
extern template class HullProgramOn<StencilHullShader<TessellatorDomain::Quad>, CheckScalar>;
extern template class HullProgramOn<StencilHullShader<TessellatorDomain::Tri>, CheckScalar>;

} // namespace tessemu
