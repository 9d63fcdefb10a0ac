// One Catmull-Clark step: splits every n-gon into n quads.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"

#include <glm/vec3.hpp>

namespace tessemu {

/// F = mean of the face, E = (a + b + F + F')/4, V = (n-2)/n V + mean(d)/n + mean(F)/n (LOOP10
/// section 3; docs/math/subdivision.md, 1.1); boundary: midpoints and (1,6,1)/8, a vertex with one
/// face stays unless the boundary rule is EdgeOnly. Tags are carried along, creases to the new
/// edges, but do not shape the step: creases and corners become one less sharp (10 and above stay:
/// infinite), holes' quads are holes.
///
/// \returns vertex points, then edge points in order of first meeting, then face points; quads face
///          by face, each starting at its old vertex. Sums run in double and are rounded once.
ControlMesh catmull_clark_step(Topology const& topology);

/// The positions of the step alone, not rounded.
///
/// \param x  positions in place of the mesh's own
std::vector<glm::dvec3> catmull_clark_points(Topology const& topology,
                                             std::span<glm::dvec3 const> x);

} // namespace tessemu
