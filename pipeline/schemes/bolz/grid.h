// Grids of a patch's vertices with the triangles between them: regular strips inside, and along
// edges that have fewer segments than the inside strips that zip both together (BOLZ03 2.1, 3).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_points.h"

namespace tessemu {

/// Segments of a patch and of its edges, as powers of two.
struct GridLevels {
    std::uint8_t inside = 0;
    std::array<std::uint8_t, 4> edges{}; ///< from corner k to corner k+1; at most `inside`

    bool is_regular() const
    {
        return edges == std::array<std::uint8_t, 4>{inside, inside, inside, inside};
    }
    friend auto operator<=>(GridLevels const&, GridLevels const&) = default;
};

/// A grid's points in the order of the vertices: row after row, and of a regular grid all of them;
/// otherwise those of an edge that it does not use are left out.
struct PatchGrid {
    DomainPoints points;
    /// [point]: x + (y << 8), in segments of the inside; empty: of a regular grid.
    std::vector<std::uint32_t> places;
};

/// Triangles run counter-clockwise in (u, v).
PatchGrid make_patch_grid(GridLevels const& levels);

} // namespace tessemu
