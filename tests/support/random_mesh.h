// Random control meshes for tests at scale.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh.h"

namespace tessemu::test {

/// An oriented manifold of quads and triangles: closed or open, valences from 3 to about 12,
/// coordinates scaled by a power of two over nine binades. `seed` decides everything.
ControlMesh random_mesh(std::uint32_t seed);

} // namespace tessemu::test
