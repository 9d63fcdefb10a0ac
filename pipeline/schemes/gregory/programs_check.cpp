// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/gregory/programs.h"

namespace tessemu {

template class DomainProgramOn<GregoryQuadDomainShader, CheckScalar>;
template class DomainProgramOn<GregoryTriangleDomainShader, CheckScalar>;
template class DomainProgramOn<GregoryQuadCornersDomainShader, CheckScalar>;
template class DomainProgramOn<GregoryTriangleCornersDomainShader, CheckScalar>;
template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 4>, CheckScalar>;
template class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 5>, CheckScalar>;
template class HullProgramOn<CornerHullShader<TessellatorDomain::Tri, 5>, CheckScalar>;
template class VertexProgramOn<RingVertexShader<>, CheckScalar>;

} // namespace tessemu
