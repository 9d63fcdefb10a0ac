// gregory-stencil: LOOP09's Gregory patches with stencils by connectivity type (section 4.3).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/technique.h"

namespace tessemu {

std::unique_ptr<Technique> make_gregory_stencil_technique();

} // namespace tessemu
