// One-rings of a mesh as the textures that a two-stage vertex shader reads (LOOP09 4.1, figure 7).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/topology.h"
#include "shaders_cpp/gregory/ring_vertex_shader.h"

namespace tessemu {

/// Memory behind RingTextures.
struct VertexRings {
    std::vector<std::uint32_t> rings, entries;
    std::vector<float> positions; ///< four floats a texel
    int height = 0;               ///< rows of the position texture

    /// Throws LimitError for a vertex with more edges than the vertex shader's output registers
    /// hold. Vertices without faces get an empty ring.
    explicit VertexRings(Topology const& topology);
};

/// What a hull shader knows of a corner of a face (figure 8): the ring edges of e+ and e- and the
/// row of its vertex in the ring tables, as SectorTables::offsets has it.
std::uint32_t corner_offsets(Topology const& topology, HalfEdge corner);

/// RingConstants with the paper's lambda(n) times `lambda_scale`; double, to be rounded once.
std::vector<double> make_ring_constants(double lambda_scale);
/// SectorTables::angles: each row's cosine, cos(2pi/n), boundary cos(pi/k), a corner 0; and
/// sin(2pi/n).
std::vector<double> make_ring_angles();

} // namespace tessemu
