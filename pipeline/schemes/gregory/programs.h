// Programs of Gregory patches: compiled once, for the fast machine in programs_fast.cpp and for the
// checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/programs.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/gregory/corner_domain_shaders.h"
#include "shaders_cpp/gregory/corner_hull_shader.h"
#include "shaders_cpp/gregory/ring_vertex_shader.h"

namespace tessemu {

/// Of both forms.
std::vector<SchemeParameter> gregory_parameters();

extern template class DomainProgramOn<GregoryQuadDomainShader, FastScalar>;
extern template class DomainProgramOn<GregoryTriangleDomainShader, FastScalar>;
extern template class DomainProgramOn<GregoryQuadCornersDomainShader, FastScalar>;
extern template class DomainProgramOn<GregoryTriangleCornersDomainShader, FastScalar>;
extern template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 4>, FastScalar>;
extern template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 5>, FastScalar>;
extern template class HullProgramOn<CornerHullShader<TessellatorDomain::Tri, 5>, FastScalar>;
extern template class VertexProgramOn<RingVertexShader<>, FastScalar>;

extern template class DomainProgramOn<GregoryQuadDomainShader, CheckScalar>;
extern template class DomainProgramOn<GregoryTriangleDomainShader, CheckScalar>;
extern template class DomainProgramOn<GregoryQuadCornersDomainShader, CheckScalar>;
extern template class DomainProgramOn<GregoryTriangleCornersDomainShader, CheckScalar>;
extern template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 4>, CheckScalar>;
extern template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 5>, CheckScalar>;
extern template class HullProgramOn<CornerHullShader<TessellatorDomain::Tri, 5>, CheckScalar>;
extern template class VertexProgramOn<RingVertexShader<>, CheckScalar>;

} // namespace tessemu
