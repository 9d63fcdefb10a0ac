// The two passes of a frame: a quad a patch rasterized into a target of positions, and one of
// normals, whose texels are the tessellated vertices (BOLZ03 2 and 3).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/command_list.h"
#include "pipeline/schemes/bolz/grid.h"
#include "pipeline/schemes/bolz/table_patches.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace tessemu {

/// Where the patches of a frame are tessellated: cells of one target, level after level.
struct Cells {
    struct Cell {
        int x, y;
    };
    std::vector<Cell> of_patch;
    int width = 0, height = 0;

    /// Throws LimitError where they need more texels down than a target has.
    explicit Cells(std::vector<GridLevels> const& levels);

    /// Texels along a side of a patch of 2^level segments.
    static int side(int level) { return (1 << level) + 1; }
};

/// What the two passes of a frame read, patch by patch.
struct Passes {
    TablePatches const& tables;
    Machine machine;
    std::vector<GridLevels> levels;
    Cells cells;
    std::span<float const> constants; ///< [control point][4]
    ColorTarget positions, normals;
    std::array<VertexShader, kTableSteps + 1> quads; ///< by level

    Passes(TablePatches const& t, Machine const& m, std::vector<GridLevels> l);
};

/// Adds both, a draw a patch, whose pixel shaders sum in `order`, that of the tables' textures. The
/// draws keep `frame`.
void add_passes(CommandList& list, std::shared_ptr<Passes> const& frame, TableOrder order);

} // namespace tessemu
