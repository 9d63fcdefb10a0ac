// Stencils of a patch: every control point as a weighted sum of the patch's inputs (LOOP09 4.3).
// What rows there are is the form's; a scheme says which control points.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "pipeline/forms/vertex_stencils.h"

#include <array>

namespace tessemu {

/// Rows of a patch's stencil: control points, then 4 rows an edge (its transversal field, E_0 and
/// E_1 as corner k has them, E_2 and E_3 as corner k+1 has them), then for each corner pairs of
/// tangents whose cross product is the normal there: a pair for each edge at which the vertex's
/// ring may begin, because patches of one type share these rows though their corners' rings begin
/// at different edges, and the normal's bits must be the vertex's own (boundary: one pair). A patch
/// with more inputs than a hull shader has shares no rows of tangents: its form makes the pair that
/// it needs.
struct PatchStencils {
    int inputs = 0;
    int control_points = 0; ///< rows that are control points
    int corner_row[4] = {}; ///< first tangent row of each corner
    std::vector<StencilRow> rows;
    bool dense = false;            ///< zero weights are multiplied too
    std::vector<double> constants; ///< what else a scheme's hull shader knows of the type

    void add(std::vector<StencilRow> const& more)
    {
        rows.insert(rows.end(), more.begin(), more.end());
    }
};

/// The patch's corners. `patch` must outlive them.
std::vector<VertexStencils> corners_of(Neighbourhood const& patch, bool smooth_corners);

/// Appends the rows of the edges and the corners.
///
/// \param across, transversal  (vertex, j): the two vectors at an end of an inner edge; half of the
///                             difference of the inward fields of its two patches
/// \param own                  (k): a boundary edge's inward field, four rows
template <class Across, class Transversal, class Own>
void add_boundary_rows(PatchStencils& out, std::vector<VertexStencils> const& corner,
                       Across const& across, Transversal const& transversal, Own const& own)
{
    auto const sides = corner.size();
    for (std::size_t k = 0; k < sides; ++k) {
        std::size_t const next = (k + 1) % sides;
        int const ja = corner[k].plus(), jb = corner[next].minus();
        if (corner[k].is_boundary_edge(ja) && corner[next].is_boundary_edge(jb)) {
            std::array<StencilRow, 4> const field = own(k);
            // The hull shader turns the second half's signs round.
            out.add({field[0], field[1], -1.0 * field[2], -1.0 * field[3]});
        } else {
            StencilRow const a = across(corner[k], ja), b = transversal(corner[k], ja),
                             c = transversal(corner[next], jb), d = across(corner[next], jb);
            out.add({a, b, c, d});
        }
    }
    for (std::size_t i = 0; i < sides; ++i) {
        out.corner_row[i] = int(out.rows.size());
        if (out.inputs > kMaxControlPoints) continue;
        for (int s = 0; s < corner[i].rings(); ++s) {
            auto const [a, b] = corner[i].tangents(s);
            out.add({a, b});
        }
    }
}

} // namespace tessemu
