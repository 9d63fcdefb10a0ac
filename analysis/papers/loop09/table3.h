// LOOP09's table 3 beside our own figures: error of ACC, Pm and Gregory patches against the
// Catmull-Clark limit surface.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/compare.h"
#include "analysis/papers/paper.h"

namespace tessemu {

/// The control meshes of the table, by the paper's names.
inline constexpr std::string_view kLoop09Table3Models[] = {"monsterfrog", "bigguy"};

/// \param meshes  in the order of kLoop09Table3Models. \cost six comparisons, see
/// compare_with_limit
PaperTable reproduce_loop09_table3(std::vector<ControlMesh> const& meshes, int level,
                                   Machine const& machine, ThreadPool const& threads,
                                   PaperProgress const& progress);

} // namespace tessemu
