// Input assembler: index and vertex buffers into primitives and shader inputs (rules R27 to R40).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/formats.h"

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace tessemu {

enum class PrimitiveTopology : std::uint8_t {
    PointList,
    LineList,
    LineStrip,
    TriangleList,
    TriangleStrip,
    LineListAdj,
    LineStripAdj,
    TriangleListAdj,
    TriangleStripAdj,
    PatchList
};

/// Vertices that a primitive of the topology brings to a geometry shader: 1, 2, 3, 4 with line
/// adjacency, 6 with triangle adjacency; of a patch list `control_points`.
int vertices_per_primitive(PrimitiveTopology topology, int control_points);

/// Indices of a draw: none (vertices 0, 1, 2, ...), 16 or 32 bits. The all-ones index is a cut,
/// see IndexCut.
using IndexBuffer =
    std::variant<std::monostate, std::span<std::uint16_t const>, std::span<std::uint32_t const>>;

inline constexpr std::size_t kMaxVertexBuffers = 32, kMaxInputElements = 32; // R38
inline constexpr std::uint32_t kMaxVertexStride = 2048;
inline constexpr std::uint32_t kAllIndices = 0xffffffffu;
/// A draw may ask for so many indices more than its buffer holds: they take memory.
inline constexpr std::size_t kMostPastIndices = std::size_t(1) << 24;

/// A slot. Vertex i lies at offset + stride * i, in wrapping 32-bit arithmetic (R32).
struct VertexBuffer {
    std::span<std::byte const> bytes; ///< empty: nothing is bound (R35)
    std::uint32_t stride = 0, offset = 0;
};

/// An element of the input layout: fills `components` scalars of the vertex shader's input record.
struct InputElement {
    Format format = Format::R32G32B32_FLOAT;
    int components = 3; ///< registers that the shader reads, 1 to 4
    std::uint32_t slot = 0, offset = 0;
    bool per_instance = false;
    std::uint32_t step_rate = 1; ///< instances per step of per-instance data; 0 never steps (R33)
};

/// Draws the primitives of a stream-output buffer: as many as it was filled with (R40).
struct DrawAuto {
    std::uint32_t filled_bytes = 0;
};

/// Topologies that the all-ones index cuts: every one, as the specification has it (R31), or strips
/// only, as drivers do. It is a vertex's index like any other in those that it does not cut.
enum class IndexCut : std::uint8_t { EveryTopology, StripsOnly };

/// One draw.
struct DrawCall {
    PrimitiveTopology topology = PrimitiveTopology::PatchList;
    int control_points = 4; ///< of a patch, 1 to 32

    std::vector<VertexBuffer> vertex_buffers = {};
    std::vector<InputElement> layout = {};
    IndexBuffer indices = {};
    IndexCut index_cut = IndexCut::EveryTopology;
    std::uint32_t start_index = 0;
    /// The default takes all that there are; of more than there are, the rest are 0, up to
    /// kMostPastIndices of them.
    std::uint32_t index_count = kAllIndices;
    std::int32_t base_vertex = 0;                     ///< added to each index (R32)
    std::uint32_t vertex_count = 0, start_vertex = 0; ///< of a draw without indices
    std::uint32_t instance_count = 1, start_instance = 0;

    /// One buffer of `floats_per_vertex` floats a vertex, read as they are.
    void set_vertices(std::span<float const> vertices, int floats_per_vertex);
    /// Scalars that the layout gives a vertex shader.
    int vertex_floats() const;
    /// Bytes that a vertex is fetched from.
    std::size_t vertex_bytes() const;
    /// vertex_count from a buffer that stream output filled (R40).
    void set_auto(DrawAuto const& filled);
};

/// Checks limits and alignment (R37, R38). Throws LimitError or Error.
void check_draw_call(DrawCall const& call);

/// Primitives of one instance. Partial ones at a cut or at the end are dropped (R29) and not
/// counted (I-23). Vertices have dense ids here; id_of_index tells what index each stands for.
struct AssembledPrimitives {
    std::vector<std::uint32_t> storage, stream_storage;
    std::span<std::uint32_t const> vertices; ///< vertex ids, primitive after primitive
    std::span<std::uint32_t const> stream;   ///< vertex ids as the assembler met them, without
                                             ///< repeating a strip's shared ones (R156)
    std::uint32_t vertices_per_primitive = 3;
    std::uint32_t vertex_id_limit = 0;      ///< 1 + the largest id
    std::vector<std::uint32_t> index_of_id; ///< empty: ids are the indices themselves
    std::size_t index_bytes = 0;            ///< of one index; 0 without an index buffer
    std::uint64_t indices_read = 0;

    std::size_t primitives() const { return vertices.size() / vertices_per_primitive; }
    std::uint32_t index(std::uint32_t id) const
    {
        return index_of_id.empty() ? id : index_of_id[id];
    }
};

/// Copies indices only where a cut, a strip or 16-bit indices ask for it.
AssembledPrimitives assemble_primitives(DrawCall const& call);

/// Reads a vertex: `out` gets the layout's scalars, in order.
///
/// \param index     the index value, or the vertex's number in a draw without indices (R34)
/// \param instance  counted from 0
/// Out of bounds: 0 in the components that the format has, defaults in the others (R35).
void fetch_vertex(DrawCall const& call, std::uint32_t index, std::uint32_t instance, float* out);

} // namespace tessemu
