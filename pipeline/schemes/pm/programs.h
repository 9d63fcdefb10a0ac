// Programs of Pm-patches: compiled once, for the fast machine in programs_fast.cpp and for the
// checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/programs.h"
#include "shaders_cpp/pm/pm_patch.h"
#include "shaders_cpp/pm/pm_vertex_shader.h"

namespace tessemu {

extern template class DomainProgramOn<PmQuadDomainShader, FastScalar>;
extern template class DomainProgramOn<PmTriangleDomainShader, FastScalar>;
extern template class HullProgramOn<PmRegularHullShader<>, FastScalar>;
extern template class HullProgramOn<PmHullShader<TessellatorDomain::Quad>, FastScalar>;
extern template class HullProgramOn<PmHullShader<TessellatorDomain::Tri>, FastScalar>;
extern template class VertexProgramOn<PmVertexShader<>, FastScalar>;

extern template class DomainProgramOn<PmQuadDomainShader, CheckScalar>;
extern template class DomainProgramOn<PmTriangleDomainShader, CheckScalar>;
extern template class HullProgramOn<PmRegularHullShader<>, CheckScalar>;
extern template class HullProgramOn<PmHullShader<TessellatorDomain::Quad>, CheckScalar>;
extern template class HullProgramOn<PmHullShader<TessellatorDomain::Tri>, CheckScalar>;
extern template class VertexProgramOn<PmVertexShader<>, CheckScalar>;

} // namespace tessemu
