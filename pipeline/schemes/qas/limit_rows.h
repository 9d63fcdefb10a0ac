// What the limit surface at a mesh's vertices and the middles of its edges is made of.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/gradient_rows.h"

namespace tessemu {

/// Of each point that a step of Loop's makes of a mesh of triangles (PointNumbers), on the limit
/// surface. \cost  linear in the mesh
GradientRows loop_limit_rows(Topology const& topology);

} // namespace tessemu
