// Input assembler: index and vertex buffers into primitives.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <variant>
#include <vector>

namespace tessemu {

enum class PrimitiveTopology { TriangleList, PatchList };

/// Indices of a draw: none (vertices 0, 1, 2, ...), 16 or 32 bits. The all-ones index cuts (R31).
using IndexBuffer =
    std::variant<std::monostate, std::span<std::uint16_t const>, std::span<std::uint32_t const>>;

/// One draw. Attributes of a vertex lie one after the other, `vertex_floats` of them.
struct DrawCall {
    PrimitiveTopology topology = PrimitiveTopology::PatchList;
    int control_points = 4; ///< of a patch, 1 to 32
    std::span<float const> vertices;
    int vertex_floats = 3;
    IndexBuffer indices;
    std::uint32_t vertex_count = 0; ///< of a draw without indices
    std::int32_t base_vertex = 0;   ///< added to each index (R32)
};

/// Complete primitives; partial ones at a cut or at the end are dropped (R29) and not counted
/// (I-23).
struct AssembledPrimitives {
    std::vector<std::uint32_t> storage;
    std::span<std::uint32_t const> vertices; ///< vertex ids, primitive after primitive
    std::uint32_t vertices_per_primitive = 3;
    std::uint32_t vertex_id_limit = 0; ///< 1 + the largest id
    std::size_t index_bytes = 0;       ///< of one index; 0 without an index buffer

    std::size_t primitives() const { return vertices.size() / vertices_per_primitive; }
};

/// Copies indices only where a cut, a base vertex or 16-bit indices ask for it.
AssembledPrimitives assemble_primitives(DrawCall const& call);

} // namespace tessemu
