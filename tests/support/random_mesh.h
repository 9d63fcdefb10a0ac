// Control meshes that tests make: random ones for tests at scale, and some with larger faces.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/mesh.h"

namespace tessemu::test {

/// An oriented manifold of quads and triangles: closed or open, valences from 3 to about 12,
/// coordinates scaled by a power of two over nine binades. `seed` decides everything.
ControlMesh random_mesh(std::uint32_t seed);

/// Some pairs of neighbouring faces joined: triangles and quads to faces of 4 to 6 sides and more.
/// The mesh stays a manifold without vertices of two faces inside.
ControlMesh join_faces(ControlMesh const& mesh, std::uint32_t seed);

/// Tags of every kind at random: sharpness below, at and above whole steps, and infinite; any boundary
/// rule and crease method, triangles smoothed or not.
ControlMesh with_random_tags(ControlMesh mesh, std::uint32_t seed);

/// A prism over a polygon of n sides: closed, two faces of n sides and n quads; the bottom is face
/// 0.
ControlMesh prism(int n);

} // namespace tessemu::test
