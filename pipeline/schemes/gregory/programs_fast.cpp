// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/gregory/programs.h"

namespace tessemu {

template class DomainProgramOn<GregoryQuadDomainShader, FastScalar>;
template class DomainProgramOn<GregoryTriangleDomainShader, FastScalar>;
template class DomainProgramOn<GregoryQuadCornersDomainShader, FastScalar>;
template class DomainProgramOn<GregoryTriangleCornersDomainShader, FastScalar>;
template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 4>, FastScalar>;
template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 5>, FastScalar>;
template class HullProgramOn<CornerHullShader<TessellatorDomain::Tri, 5>, FastScalar>;
template class VertexProgramOn<RingVertexShader<>, FastScalar>;

} // namespace tessemu
