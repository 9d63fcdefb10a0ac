// LOOP10's table 1: the time of the subdivision step on two GPUs, predicted from counters.
//
// Two numbers are fitted to the table, for both GPUs together: what a frame with subdivision takes
// more whatever it subdivides, and what each dispatch takes more (least squares of the relative
// errors). Everything else is counted by the emulated dispatches or comes from the GPUs'
// descriptions. Each cell is also predicted with itself left out of the fit.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/cost.h"
#include "analysis/papers/paper.h"
#include "pipeline/commands/command_list.h"

namespace tessemu {

/// Subdivision's dispatches of a frame.
struct SubdivisionTime {
    std::uint64_t dispatches = 0;
    double seconds = 0;     ///< counted, without what a dispatch costs whatever it does
    std::string bound;      ///< of the dispatch that takes longest
    std::string bound_name; ///< "edge points, step 1"
};
/// \param commands  of a frame; those of subdivision are told by their names
SubdivisionTime subdivision_time(GpuModel const& gpu,
                                 std::vector<CommandStatistics> const& commands);

struct SubdivisionFit {
    double frame = 0, dispatch = 0; ///< seconds
};
struct SubdivisionTable {
    PaperTable table;
    SubdivisionFit fit;
};

/// \param meshes  in the order of kLoop10Models
/// \param gpus    Radeon HD 5870, GeForce GTX 480
SubdivisionTable reproduce_loop10_table1(std::vector<ControlMesh> const& meshes,
                                         std::vector<GpuModel> const& gpus, Machine const& machine,
                                         ThreadPool const& threads, PaperProgress const& progress);

} // namespace tessemu
