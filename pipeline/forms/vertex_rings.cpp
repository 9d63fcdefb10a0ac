// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/vertex_rings.h"

#include "pipeline/mesh/limit_constants.h"

#include <algorithm>
#include <cassert>

namespace tessemu {

VertexRings::VertexRings(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    constexpr std::uint32_t kNone = RingTextures::kNone;
    constexpr auto kWidth = std::size_t(RingTextures::kTextureWidth);
    std::size_t const vertices = mesh.positions.size();
    rings.reserve(2 * vertices);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        auto const ring = topology.ring(v);
        bool const boundary = !ring.empty() && topology.is_boundary(v);
        assert(ring.size() <= 0xffff);
        rings.push_back(std::uint32_t(entries.size() / 2));
        rings.push_back(std::uint32_t(ring.size()) | (boundary ? 0x10000u : 0u));
        for (HalfEdge h : ring) {
            bool const quad = mesh.face(topology.face_of(h)).size() == 4;
            entries.push_back(topology.vertex_of(topology.next(h)));
            entries.push_back(quad ? topology.vertex_of(topology.next(topology.next(h))) : kNone);
        }
        if (boundary) {
            entries.push_back(topology.vertex_of(topology.previous(ring.back())));
            entries.push_back(kNone);
        }
    }
    height = int((vertices + kWidth - 1) / kWidth);
    positions.resize(std::size_t(height) * kWidth * 4);
    for (std::size_t v = 0; v < vertices; ++v)
        for (int k = 0; k < 3; ++k) positions[4 * v + std::size_t(k)] = mesh.positions[v][k];
}

std::array<std::uint32_t, 4> window_edges(Topology const& topology, HalfEdge corner)
{
    std::uint32_t const v = topology.vertex_of(corner), plus = topology.ring_index(corner);
    auto const faces = std::uint32_t(topology.ring(v).size());
    if (!topology.is_boundary(v)) {
        std::uint32_t const minus = (plus + 1) % faces;
        return {(plus + faces - 1) % faces, plus, minus, (minus + 1) % faces};
    }
    return {plus > 0 ? plus - 1 : CornerWindow::kNone, plus, plus + 1,
            plus + 1 < faces ? plus + 2 : CornerWindow::kNone};
}

std::uint32_t corner_offsets(Topology const& topology, HalfEdge corner)
{
    std::uint32_t const v = topology.vertex_of(corner);
    auto const faces = std::uint32_t(topology.ring(v).size());
    bool const boundary = topology.is_boundary(v);
    std::uint32_t const plus = topology.ring_index(corner);
    std::uint32_t const minus = boundary ? plus + 1 : (plus + 1) % faces;
    std::uint32_t const row = faces + (boundary ? std::uint32_t(RingRows::kBoundary) : 0);
    return plus | minus << 8 | row << 16;
}

std::array<double, 2> ring_angles(int faces, bool boundary)
{
    if (!boundary) return {cos_pi(2, faces), sin_pi(2, faces)};
    return {faces > 1 ? cos_pi(1, faces) : 0, 0};
}

std::vector<double> make_ring_angles()
{
    std::vector<double> out(2 * RingRows::kCount);
    auto const set = [&](int row, std::array<double, 2> const& of) {
        out[std::size_t(2 * row)] = of[0], out[std::size_t(2 * row + 1)] = of[1];
    };
    for (int n = 2; n <= RingLayout::kEdges; ++n) set(n, ring_angles(n, false));
    for (int k = 2; k < RingLayout::kEdges; ++k) set(RingRows::kBoundary + k, ring_angles(k, true));
    return out;
}

} // namespace tessemu
