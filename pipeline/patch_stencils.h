// Stencils of a patch: every control point as a weighted sum of the patch's inputs (LOOP09 4.3),
// for the Gregory scheme and for ACC.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/vertex_stencils.h"

namespace tessemu {

/// Rows of a patch's stencil: control points, then 4 rows an edge (transversal field E_0..E_3 from
/// corner k to k+1), then for each corner pairs of tangents, a pair for each edge at which the
/// vertex's ring may begin (boundary: one pair).
struct PatchStencils {
    int inputs = 0;
    int control_points = 0; ///< rows that are control points
    int corner_row[4] = {}; ///< first tangent row of each corner
    std::vector<StencilRow> rows;
    std::vector<double> constants; ///< what else a scheme's hull shader knows of the type
};

/// Free choices of the Gregory scheme; 1 is the paper's.
struct GregoryParameters {
    double lambda_scale = 1;     ///< multiplies lambda(n), the length of interior tangents
    double r_scale = 1;          ///< multiplies r, the transversal vectors of the face points
    bool smooth_corners = false; ///< BoundaryRule::EdgeOnly: a boundary vertex with one face is not
                                 ///< interpolated
};

/// Control points p, e+, e-, f+ and, unless regular, f-, each corner by corner (sheet section 2).
///
/// \param regular  16 control points: f- equals f+ and is left out
PatchStencils make_gregory_stencils(Neighbourhood const& patch, bool regular,
                                    GregoryParameters const& parameters);

/// Control points of a quad p, e+, e-, inner and, unless regular, the corner's tangents t+, t-,
/// each corner by corner; constants: the corners' cosines / 3 (sheet section 5).
PatchStencils make_acc_stencils(Neighbourhood const& patch, bool regular, bool smooth_corners);

} // namespace tessemu
