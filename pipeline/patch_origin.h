// Patches and the faces they come from.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace tessemu {

/// Where a patch comes from: its domain's corner 0 is corner `rotation` of the face.
struct PatchOrigin {
    std::uint32_t face = 0;
    std::uint8_t rotation = 0, sides = 4;
};

/// A domain point in its face: quad, u from corner 0 to 1 and v from corner 0 to 3; triangle,
/// weights of corners 0 and 1. Exact for 16-bit fractions.
struct FacePoint {
    float u, v;
};
FacePoint domain_to_face(PatchOrigin const& origin, float u, float v);

} // namespace tessemu
