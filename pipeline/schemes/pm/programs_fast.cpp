// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/pm/programs.h"

namespace tessemu {

template class DomainProgramOn<PmQuadDomainShader, FastScalar>;
template class DomainProgramOn<PmTriangleDomainShader, FastScalar>;
template class HullProgramOn<PmRegularHullShader<>, FastScalar>;
template class HullProgramOn<PmHullShader<TessellatorDomain::Quad>, FastScalar>;
template class HullProgramOn<PmHullShader<TessellatorDomain::Tri>, FastScalar>;
template class VertexProgramOn<PmVertexShader<>, FastScalar>;

} // namespace tessemu
