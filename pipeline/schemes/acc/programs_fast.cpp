// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/acc/programs.h"

namespace tessemu {

template class DomainProgramOn<AccQuadDomainShader, FastScalar>;
template class HullProgramOn<AccHullShader<>, FastScalar>;

} // namespace tessemu
