// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/acc/programs.h"

namespace tessemu {

template class DomainProgramOn<AccQuadDomainShader, CheckScalar>;
template class HullProgramOn<AccHullShader<>, CheckScalar>;

} // namespace tessemu
