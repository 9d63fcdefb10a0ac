// What the patches at a shared edge computed, side by side.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/frame.h"

namespace tessemu::test {

struct EdgeComparison {
    std::size_t shared_points = 0; ///< edge points (corners included) seen by two patches or more
    std::size_t shared_edge_coordinates = 0, differing_edge_coordinates = 0; ///< without corners
    std::size_t lonely_points = 0; ///< inside the edges of two patches, of which one alone has it
    std::size_t differing_positions = 0, differing_normals = 0; ///< points with any other bit
    std::string first_difference;
};

/// Replaces the domain shader of a draw of the surface; returns none to keep it.
using ReplaceDomainShader = std::function<DomainShader(Draw const&)>;

/// Runs the patches and compares positions and normals at equal points of the file's mesh, bit for
/// bit.
EdgeComparison compare_edges(PatchMesh const& patches, FrameSettings const& settings,
                             ThreadPool const& threads, ReplaceDomainShader const& replace = {});

/// Machines of every contraction: none, all, mixed with the seeds 1 to `seeds`; under a sanitizer
/// at most with 1 and 2.
std::vector<Machine> contraction_policies(std::uint64_t seeds = 10);

/// Which of n cases a policy meets where their product would be long: none and all every one, each
/// seed of mixed one, all in turn.
bool meets_case(Machine const& policy, std::size_t i, std::size_t n);

} // namespace tessemu::test
