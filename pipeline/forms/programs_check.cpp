// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/programs.h"

namespace tessemu {

template class DomainProgramOn<RegularQuadDomainShader, CheckScalar>;
template class DomainProgramOn<RegularCornersDomainShader, CheckScalar>;
template class HullProgramOn<StencilHullShader<TessellatorDomain::Quad>, CheckScalar>;
template class HullProgramOn<StencilHullShader<TessellatorDomain::Tri>, CheckScalar>;

} // namespace tessemu
