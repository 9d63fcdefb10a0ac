// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/programs.h"

namespace tessemu {

template class DomainProgramOn<RegularQuadDomainShader, FastScalar>;
template class DomainProgramOn<RegularCornersDomainShader, FastScalar>;
template class HullProgramOn<StencilHullShader<TessellatorDomain::Quad>, FastScalar>;
template class HullProgramOn<StencilHullShader<TessellatorDomain::Tri>, FastScalar>;

} // namespace tessemu
