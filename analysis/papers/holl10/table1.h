// HOLL10's table I: output triangles and frames a second of tables and substitutes on a GeForce GTX
// 295, predicted from counters.
//
// Two numbers of the GPU are fitted to SM's twelve cells, see timed_cell.h, and each of these is
// also predicted with itself left out. The substitutes' cells are predicted from the same fit and
// change nothing in it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/holl10/items.h"
#include "io/gpu_model.h"

namespace tessemu {

/// Levels of SM's rows; the substitutes have the last.
inline constexpr int kHoll10Levels[] = {2, 4, 5};
inline constexpr double kHoll10Printed[std::size(kHoll10Levels)][std::size(kHoll10Models)] = {
    {641, 495, 334, 291}, {312, 176, 85, 76}, {103, 50, 24, 21}}; // SM, frames a second

/// The table, and the GPU with the fitted numbers in place.
struct Holl10Table {
    PaperTable table;
    GpuModel gpu;
};
/// \param meshes  in the order of kHoll10Models
Holl10Table reproduce_holl10_table1(std::vector<ControlMesh> const& meshes, GpuModel const& gpu,
                                    Machine const& machine, ThreadPool const& threads,
                                    PaperProgress const& progress);

} // namespace tessemu
