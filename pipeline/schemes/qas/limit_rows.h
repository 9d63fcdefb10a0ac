// What the limit surface at a mesh's vertices and the middles of its edges is made of.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/refined_step.h"

namespace tessemu {

/// Rows of weights over a mesh's vertices, of each point that a step makes (PointNumbers).
struct LimitRows {
    std::vector<std::uint32_t> first{0}; ///< [point + 1]
    std::vector<std::uint32_t> vertices; ///< of each term
    std::vector<double> weights;         ///< [term][3]: limit position and two tangents
};

/// After a step of Loop's, of a mesh of triangles. \cost  linear in the mesh
LimitRows loop_limit_rows(Topology const& topology);

} // namespace tessemu
