// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/pm/programs.h"

namespace tessemu {

template class DomainProgramOn<PmQuadDomainShader, CheckScalar>;
template class DomainProgramOn<PmTriangleDomainShader, CheckScalar>;
template class HullProgramOn<PmRegularHullShader<>, CheckScalar>;
template class HullProgramOn<PmHullShader<TessellatorDomain::Quad>, CheckScalar>;
template class HullProgramOn<PmHullShader<TessellatorDomain::Tri>, CheckScalar>;
template class VertexProgramOn<PmVertexShader<>, CheckScalar>;

} // namespace tessemu
