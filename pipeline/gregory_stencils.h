// Stencils of the Gregory scheme: every control point as a weighted sum of the patch's inputs
// (LOOP09 sections 3.3, 3.4, 4.3, 4.6; sheet sections 2, 4, 9).
//
// Weights are made per vertex ring and do not depend on where a ring is entered: contributions to
// one input are sorted before they are added. So two patches that share a control point give it
// weights with equal bits.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/connectivity.h"

#include <vector>

namespace tessemu {

/// Free choices of the scheme; 1 is the paper's.
struct GregoryParameters {
    double lambda_scale = 1;     ///< multiplies lambda(n), the length of interior tangents
    double r_scale = 1;          ///< multiplies r, the transversal vectors of the face points
    bool smooth_corners = false; ///< BoundaryRule::EdgeOnly: a boundary vertex with one face is not
                                 ///< interpolated
};

/// Rows of a patch's stencil: control points (p, e+, e-, f+ and, unless regular, f-, each corner by
/// corner), then 4 rows an edge (transversal field E_0..E_3 from corner k to k+1), then for each
/// corner pairs of tangents, a pair for each edge at which the vertex's ring may begin (boundary:
/// one pair).
struct GregoryStencils {
    int inputs = 0;
    int control_points = 0;
    int corner_row[4] = {};                ///< first tangent row of each corner
    std::vector<std::vector<double>> rows; ///< [row][input]
};

/// \param regular  16 control points: f- equals f+ and is left out
GregoryStencils make_gregory_stencils(Neighbourhood const& patch, bool regular,
                                      GregoryParameters const& parameters);

} // namespace tessemu
