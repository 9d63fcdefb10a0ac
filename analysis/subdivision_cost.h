// What the kernels of subdivision cost: LOOP10 section 3, kernel by kernel.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/divergence.h"
#include "pipeline/commands/command_list.h"

namespace tessemu {

/// A kernel of a step.
struct KernelCost {
    std::string kernel;        ///< "face points"
    std::uint64_t threads = 0; ///< with a point to make
    FlopCount flops;
    std::uint64_t index_fetches = 0;  ///< of all its tables
    std::uint64_t vertex_fetches = 0; ///< of the vertex buffer
    std::uint64_t fetched_bytes = 0;  ///< by both
    LoopTurns gtx480, radeon5870;     ///< in groups of 32 threads, and of 64; no loop: none
};

struct StepCost {
    std::uint32_t faces = 0, edges = 0, vertices = 0; ///< F, E, V of the mesh before it
    std::vector<KernelCost> kernels;                  ///< in their order
};

/// \param statistics  of a list that held add_subdivision()'s commands of these tables
std::vector<StepCost> subdivision_cost(std::span<SubdivisionTables const> tables,
                                       ListStatistics const& statistics);

} // namespace tessemu
