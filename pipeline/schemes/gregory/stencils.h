// Stencils of Gregory patches: LOOP09 sections 3.3, 3.4, 4.6 as weights on a patch's inputs.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/patch_stencils.h"

namespace tessemu {

/// Free choices of the scheme; 1 is the paper's.
struct GregoryParameters {
    double lambda_scale = 1;     ///< multiplies lambda(n), the length of interior tangents
    double r_scale = 1;          ///< multiplies r, the transversal vectors of the face points
    bool smooth_corners = false; ///< BoundaryRule::EdgeOnly: a boundary vertex with one face is not
                                 ///< interpolated
};

/// Control points p, e+, e-, f+ and, unless regular, f-, each corner by corner
/// (docs/math/loop09.md, 2).
///
/// \param regular  16 control points: f- equals f+ and is left out
PatchStencils make_gregory_stencils(Neighbourhood const& patch, bool regular,
                                    GregoryParameters const& parameters);

} // namespace tessemu
