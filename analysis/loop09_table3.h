// LOOP09's table 3 beside our own figures: error of ACC, Pm and Gregory patches against the
// Catmull-Clark limit surface.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/compare.h"

#include <string>

namespace tessemu {

/// A cell: what the paper prints, and ours.
struct PaperCell {
    std::string row, column;
    double paper, ours;
};

struct PaperTable {
    std::string title;
    std::vector<PaperCell> cells;
    std::vector<std::string> remarks; ///< what the paper leaves open, and how we read it
};

/// The control meshes of the table, by the paper's names.
inline constexpr std::string_view kLoop09Table3Models[] = {"monsterfrog", "bigguy"};

/// \param meshes  in the order of kLoop09Table3Models. \cost six comparisons, see
/// compare_with_limit
PaperTable reproduce_loop09_table3(std::vector<ControlMesh> const& meshes, int level,
                                   Machine const& machine, ThreadPool const& threads,
                                   std::function<void(std::size_t, std::size_t)> const& progress);

} // namespace tessemu
