// LOOP09's tables 1 and 2: times of ACC, Pm and Gregory patches, predicted from counters.
//
// Two numbers of the GPU are fitted to a table, the overhead of a frame and the rate of fetches
// (least squares of the relative errors; of table 2 nearly); everything else is counted by the
// emulated pipeline or comes from the GPU's description. Each cell is also predicted with itself
// left out of the fit.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/cost.h"
#include "analysis/papers/paper.h"

namespace tessemu {

/// A table, and the GPU with the fitted numbers in place.
struct TimingTable {
    PaperTable table;
    GpuModel gpu;
};

/// Table 1: irregular quads on a grid of N x N on an emulator. The paper's mesh is not to be had.
///
/// \param mesh     closed quads; its irregular faces stand for the paper's 508
/// \param gpu      fetch rate and overhead are fitted anew
TimingTable reproduce_loop09_table1(ControlMesh const& mesh, GpuModel gpu, Machine const& machine,
                                    ThreadPool const& threads, PaperProgress const& progress);

/// The control meshes of table 2, by the paper's names.
inline constexpr std::string_view kLoop09Table2Models[] = {"monsterfrog", "bigguy"};

/// Table 2: frames a second of the Direct3D 10 implementation on a GeForce GTX 260.
///
/// \param meshes  in the order of kLoop09Table2Models
TimingTable reproduce_loop09_table2(std::vector<ControlMesh> const& meshes, GpuModel gpu,
                                    Machine const& machine, ThreadPool const& threads,
                                    PaperProgress const& progress);

} // namespace tessemu
