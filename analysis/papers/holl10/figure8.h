// HOLL10's figure 8: what a triangle costs by the level that it is made at, from counters on a
// GeForce GTX 295; and the share that the initial pass has of a frame.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/holl10/items.h"

namespace tessemu {

/// \param meshes  in the order of kHoll10Models
/// \param gpu     with the numbers that table I fits
PaperPlots reproduce_holl10_figure8(std::vector<ControlMesh> const& meshes, GpuModel const& gpu,
                                    Machine const& machine, ThreadPool const& threads,
                                    PaperProgress const& progress);

} // namespace tessemu
