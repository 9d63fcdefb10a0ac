// One-rings of a mesh as the textures that a two-stage vertex shader reads (LOOP09 4.1, figure 7).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"
#include "shaders_cpp/two_stage_form/ring_window.h"

#include <array>

namespace tessemu {

/// Memory behind RingTextures.
struct VertexRings {
    std::vector<std::uint32_t> rings, entries;
    std::vector<float> positions; ///< four floats a texel
    int height = 0;               ///< rows of the position texture

    /// Rings of up to 65,535 faces. Vertices without faces get an empty one.
    explicit VertexRings(Topology const& topology);
};

/// What a hull shader knows of a corner of a face (figure 8): the ring edges of e+ and e- and the
/// row of its vertex in the ring tables, as CornerTables::offsets has it.
std::uint32_t corner_offsets(Topology const& topology, HalfEdge corner);

/// CornerWindow::kEdges of a corner of a face.
std::array<std::uint32_t, 4> window_edges(Topology const& topology, HalfEdge corner);

/// A row of CornerTables::angles.
std::array<double, 2> ring_angles(int faces, bool boundary);
/// CornerTables::angles: each row's cosine, cos(2pi/n), boundary cos(pi/k), a corner 0; and
/// sin(2pi/n).
std::vector<double> make_ring_angles();

} // namespace tessemu
