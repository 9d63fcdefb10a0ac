// Stencils of ACC patches (Loop and Schaefer 2008) as weights on a patch's inputs.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/patch_stencils.h"

namespace tessemu {

/// Control points of a quad p, e+, e-, inner and, unless regular, the corner's tangents t+, t-,
/// each corner by corner; constants: the corners' cosines / 3 (docs/math/loop09.md, 5).
PatchStencils make_acc_stencils(Neighbourhood const& patch, bool regular, bool smooth_corners);

} // namespace tessemu
