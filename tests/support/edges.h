// What both patches at a shared edge computed, side by side.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/frame.h"

namespace tessemu::test {

struct EdgeComparison {
    std::size_t shared_points = 0; ///< edge points (corners included) seen by two patches or more
    std::size_t shared_edge_coordinates = 0, differing_edge_coordinates = 0; ///< without corners
    std::size_t lonely_points = 0; ///< on an edge of two patches, of which one alone has the point
    std::size_t differing_positions = 0, differing_normals = 0; ///< points with any other bit
    std::string first_difference;
};

/// Replaces a pass's domain shader; returns the program to use, or nothing to keep it.
using ReplaceDomainShader = std::function<std::shared_ptr<DomainProgram const>(DrawPass const&)>;

/// Draws the patches and compares positions and normals at equal edge parameters, bit for bit.
EdgeComparison compare_edges(ControlMesh const& mesh, PatchMesh const& patches,
                             FrameSettings const& settings, ThreadPool const& threads,
                             ReplaceDomainShader const& replace = {});

} // namespace tessemu::test
