// Stencils that belong to a vertex: limit position, tangents, edge points and inner points of the
// faces around it, as weights on the vertices of those faces (LOOP09 sections 3.3, 3.4, 4.6;
// docs/math/loop09.md, 2, 4 and 5).
//
// Weights do not depend on where a ring is entered: contributions to one input are sorted before
// they are added. So two patches that share a control point give it weights with equal bits.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/connectivity.h"

#include <utility>
#include <vector>

namespace tessemu {

/// Weights by input of the patch.
using StencilRow = std::vector<double>;

StencilRow operator+(StencilRow a, StencilRow const& b);
StencilRow operator-(StencilRow a, StencilRow const& b);
StencilRow operator*(double s, StencilRow a);

/// A vertex and its ring, by the letters of docs/math/loop09.md; n faces, edges 0 to n-1
/// (boundary: 0 to n).
class VertexStencils {
public:
    /// \param corner          must outlive the object
    /// \param inputs          of the patch whose local numbers the corner uses
    /// \param smooth_corners  BoundaryRule::EdgeOnly: a boundary vertex with one face is not
    ///                        interpolated
    VertexStencils(CornerNeighbourhood const& corner, int inputs, bool smooth_corners);

    bool boundary() const { return c_.boundary; }
    int faces() const { return n_; }
    /// Places where the ring may begin.
    int rings() const { return c_.boundary ? 1 : n_; }
    /// The patch is the face between edge plus() and edge minus() (docs/math/loop09.md, 1).
    int plus() const { return c_.position; }
    int minus() const { return c_.boundary ? c_.position + 1 : 1; }
    bool is_boundary_edge(int j) const { return c_.boundary && (j == 0 || j == n_); }

    /// The cosine that the edge conditions know the vertex by.
    double C() const;
    /// Limit position.
    StencilRow p() const;
    /// Limit tangent along edge j (LOOP09 3.3; boundary: 4.6). Interior: `sine` turns it by a
    /// quarter.
    StencilRow q(int j, bool sine = false) const;
    /// r_j, the transversal vector of edge j (LOOP09 3.4).
    StencilRow r(int j, double scale = 1) const;
    /// Inner control point of a bicubic on face j, next to the vertex (docs/math/loop09.md, 5).
    StencilRow inner(int j) const;
    /// The mean of the inner points on both sides of edge j: the edge point of such bicubics.
    StencilRow inner_mean(int j) const;
    /// (2 v + d_j) / 3: the control point of a boundary edge.
    StencilRow third(int j) const;

    /// Two tangents, the surface normal's direction their cross product, for a ring that starts
    /// at s.
    std::pair<StencilRow, StencilRow> tangents(int s) const;

private:
    class Sum;
    int v() const { return c_.vertex(); }
    int d(int j) const { return c_.edge_to(j); }
    StencilRow boundary_across() const;

    CornerNeighbourhood const& c_;
    int n_;
    std::size_t inputs_;
    bool smooth_corners_;
    StencilRow a_, b_; // boundary: tangents along and across
};

} // namespace tessemu
