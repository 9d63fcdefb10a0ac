// What displacement is tested on: texture coordinates that tear at every edge, and noise.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/displacement.h"

namespace tessemu::test {

/// A chart of its own for every face, at a random place in the texture: every edge is a seam.
inline void add_charts(ControlMesh& mesh)
{
    std::uint32_t state = 7;
    auto const random = [&] {
        return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
    };
    mesh.face_coordinates.clear();
    mesh.coordinates.clear();
    for (std::size_t i = 0; i < mesh.face_vertices.size(); ++i) {
        mesh.face_coordinates.push_back(std::uint32_t(i));
        float const u = 3 * random() - 1;
        mesh.coordinates.emplace_back(u, 3 * random() - 1);
    }
}

/// The larger, the oftener a coordinate's last bit shows.
inline HeightImage noise(int size)
{
    HeightImage image{{}, size, size};
    std::uint32_t state = 3;
    for (int i = 0; i < size * size; ++i)
        image.heights.push_back(float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f);
    return image;
}

} // namespace tessemu::test
