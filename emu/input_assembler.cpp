// SPDX-License-Identifier: Apache-2.0
#include "emu/input_assembler.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tessemu {

namespace {

template <class Index>
void assemble_indexed(std::span<Index const> indices, DrawCall const& call,
                      AssembledPrimitives& out)
{
    constexpr Index kCut = std::numeric_limits<Index>::max();
    out.index_bytes = sizeof(Index);
    std::size_t const n = out.vertices_per_primitive;
    bool const plain =
        call.base_vertex == 0 && std::find(indices.begin(), indices.end(), kCut) == indices.end();
    if constexpr (sizeof(Index) == 4) {
        if (plain) {
            out.vertices = indices.first(indices.size() / n * n);
            return;
        }
    }
    std::size_t pending = 0; // vertices of the primitive that is being gathered
    for (Index i : indices) {
        if (i == kCut) {
            out.storage.resize(out.storage.size() - pending);
            pending = 0;
            continue;
        }
        out.storage.push_back(std::uint32_t(i) + std::uint32_t(call.base_vertex));
        pending = (pending + 1) % n;
    }
    out.storage.resize(out.storage.size() - pending);
    out.vertices = out.storage;
}

} // namespace

AssembledPrimitives assemble_primitives(DrawCall const& call)
{
    AssembledPrimitives out;
    out.vertices_per_primitive =
        call.topology == PrimitiveTopology::TriangleList ? 3u : std::uint32_t(call.control_points);
    if (auto const* i16 = std::get_if<std::span<std::uint16_t const>>(&call.indices)) {
        assemble_indexed(*i16, call, out);
    } else if (auto const* i32 = std::get_if<std::span<std::uint32_t const>>(&call.indices)) {
        assemble_indexed(*i32, call, out);
    } else {
        std::uint32_t const n = out.vertices_per_primitive;
        out.storage.resize(call.vertex_count / n * n);
        std::iota(out.storage.begin(), out.storage.end(), 0u);
        out.vertices = out.storage;
    }
    if (!out.vertices.empty())
        out.vertex_id_limit = *std::max_element(out.vertices.begin(), out.vertices.end()) + 1;
    return out;
}

} // namespace tessemu
