// SPDX-License-Identifier: Apache-2.0
#include "emu/input_assembler.h"

#include "emu/error.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <numeric>

namespace tessemu {

namespace {

// A run of vertices between cuts becomes primitives.
void assemble_run(PrimitiveTopology topology, std::uint32_t per_primitive,
                  std::span<std::uint32_t const> run, AssembledPrimitives& out)
{
    std::size_t const n = run.size();
    auto& v = out.storage;
    auto const used = [&](std::size_t count) {
        out.stream_storage.insert(out.stream_storage.end(), run.begin(),
                                  run.begin() + std::ptrdiff_t(count));
    };
    switch (topology) {
    case PrimitiveTopology::LineStrip:
        if (n < 2) return;
        for (std::size_t i = 0; i + 1 < n; ++i) v.insert(v.end(), {run[i], run[i + 1]});
        return used(n);
    case PrimitiveTopology::TriangleStrip: // R28: the winding stays
        if (n < 3) return;
        for (std::size_t i = 0; i + 2 < n; ++i)
            if (i % 2 == 0)
                v.insert(v.end(), {run[i], run[i + 1], run[i + 2]});
            else
                v.insert(v.end(), {run[i], run[i + 2], run[i + 1]});
        return used(n);
    case PrimitiveTopology::LineStripAdj:
        if (n < 4) return;
        for (std::size_t i = 0; i + 3 < n; ++i)
            v.insert(v.end(), {run[i], run[i + 1], run[i + 2], run[i + 3]});
        return used(n);
    case PrimitiveTopology::TriangleStripAdj: {
        // Triangle i has corners 2i, 2i+2, 2i+4. Its neighbours lie across the edges that it shares
        // with triangles i-1 and i+1 and across the strip's rim.
        if (n < 6) return;
        std::size_t const triangles = (n - 4) / 2;
        for (std::size_t i = 0; i < triangles; ++i) {
            bool const first = i == 0, last = i + 1 == triangles;
            std::uint32_t const a = run[2 * i], b = run[2 * i + 2], c = run[2 * i + 4];
            std::uint32_t const before = run[first ? 1 : 2 * i - 2];
            std::uint32_t const after = run[last ? 2 * i + 5 : 2 * i + 6];
            std::uint32_t const rim = run[2 * i + 3];
            if (i % 2 == 0)
                v.insert(v.end(), {a, before, b, after, c, rim});
            else
                v.insert(v.end(), {a, rim, c, after, b, before});
        }
        return used(4 + 2 * triangles);
    }
    default: {
        std::size_t const whole = n / per_primitive * per_primitive;
        v.insert(v.end(), run.begin(), run.begin() + std::ptrdiff_t(whole));
    }
    }
}

bool is_strip(PrimitiveTopology t)
{
    return t == PrimitiveTopology::LineStrip || t == PrimitiveTopology::TriangleStrip ||
           t == PrimitiveTopology::LineStripAdj || t == PrimitiveTopology::TriangleStripAdj;
}

template <class Index>
void assemble_indexed(std::span<Index const> indices, DrawCall const& call,
                      AssembledPrimitives& out)
{
    constexpr Index kCut = std::numeric_limits<Index>::max();
    bool const cuts = call.index_cut == IndexCut::EveryTopology || is_strip(call.topology);
    indices = indices.subspan(std::min<std::size_t>(call.start_index, indices.size()));
    indices = indices.first(std::min<std::size_t>(call.index_count, indices.size()));
    // Past the buffer's end, or without one, an index is 0.
    std::size_t const past_end =
        call.index_count == kAllIndices ? 0 : call.index_count - indices.size();
    if (past_end > kMostPastIndices)
        throw LimitError("indices past the index buffer's end", past_end, kMostPastIndices);
    out.index_bytes = sizeof(Index);
    out.indices_read = indices.size();
    if constexpr (sizeof(Index) == 4) {
        std::size_t const n = out.vertices_per_primitive;
        if (!is_strip(call.topology) && past_end == 0 &&
            (!cuts || std::find(indices.begin(), indices.end(), kCut) == indices.end())) {
            out.vertices = indices.first(indices.size() / n * n);
            return;
        }
    }
    std::vector<std::uint32_t> run;
    auto const finish = [&] {
        assemble_run(call.topology, out.vertices_per_primitive, run, out);
        run.clear();
    };
    for (Index i : indices) {
        if (cuts && i == kCut)
            finish();
        else
            run.push_back(i);
    }
    run.insert(run.end(), past_end, 0u);
    finish();
}

// Vertex results lie in a table by id: wild indices get dense ids.
void make_ids_dense(AssembledPrimitives& p)
{
    p.index_of_id.assign(p.vertices.begin(), p.vertices.end());
    std::sort(p.index_of_id.begin(), p.index_of_id.end());
    p.index_of_id.erase(std::unique(p.index_of_id.begin(), p.index_of_id.end()),
                        p.index_of_id.end());
    auto const dense = [&](std::span<std::uint32_t const> from) {
        std::vector<std::uint32_t> ids;
        for (std::uint32_t v : from)
            ids.push_back(
                std::uint32_t(std::lower_bound(p.index_of_id.begin(), p.index_of_id.end(), v) -
                              p.index_of_id.begin()));
        return ids;
    };
    bool const same = p.stream.data() == p.vertices.data();
    std::vector<std::uint32_t> primitives = dense(p.vertices), stream;
    if (!same) stream = dense(p.stream);
    p.storage = std::move(primitives);
    p.stream_storage = std::move(stream);
    p.vertices = p.storage;
    p.stream = same ? p.vertices : std::span<std::uint32_t const>(p.stream_storage);
    p.vertex_id_limit = std::uint32_t(p.index_of_id.size());
}

} // namespace

int vertices_per_primitive(PrimitiveTopology t, int control_points)
{
    switch (t) {
    case PrimitiveTopology::PointList:
        return 1;
    case PrimitiveTopology::LineList:
    case PrimitiveTopology::LineStrip:
        return 2;
    case PrimitiveTopology::TriangleList:
    case PrimitiveTopology::TriangleStrip:
        return 3;
    case PrimitiveTopology::LineListAdj:
    case PrimitiveTopology::LineStripAdj:
        return 4;
    case PrimitiveTopology::TriangleListAdj:
    case PrimitiveTopology::TriangleStripAdj:
        return 6;
    default:
        return control_points;
    }
}

void DrawCall::set_vertices(std::span<float const> vertices, int floats_per_vertex)
{
    vertex_buffers = {{std::as_bytes(vertices), std::uint32_t(floats_per_vertex) * 4, 0}};
    layout.clear();
    constexpr Format kFloats[] = {Format::R32_FLOAT, Format::R32G32_FLOAT, Format::R32G32B32_FLOAT,
                                  Format::R32G32B32A32_FLOAT};
    for (int k = 0; k < floats_per_vertex; k += 4) {
        int const n = std::min(4, floats_per_vertex - k);
        layout.push_back({kFloats[n - 1], n, 0, std::uint32_t(k) * 4, false, 1});
    }
}

int DrawCall::vertex_floats() const
{
    int n = 0;
    for (InputElement const& e : layout) n += e.components;
    return n;
}

std::size_t DrawCall::vertex_bytes() const
{
    std::size_t n = 0;
    for (InputElement const& e : layout) n += info(e.format).bytes;
    return n;
}

void DrawCall::set_auto(DrawAuto const& filled)
{
    indices = {};
    VertexBuffer const b = vertex_buffers.empty() ? VertexBuffer{} : vertex_buffers[0];
    vertex_count = b.stride == 0 || filled.filled_bytes <= b.offset
                       ? 0
                       : (filled.filled_bytes - b.offset) / b.stride;
}

void check_draw_call(DrawCall const& call)
{
    auto const limit = [](char const* thing, std::size_t value, std::size_t most) {
        if (value > most) throw LimitError(thing, value, most);
    };
    limit("vertex buffers", call.vertex_buffers.size(), kMaxVertexBuffers);
    limit("input elements", call.layout.size(), kMaxInputElements);
    for (VertexBuffer const& b : call.vertex_buffers)
        limit("vertex stride in bytes", b.stride, kMaxVertexStride);
    for (InputElement const& e : call.layout) {
        limit("vertex buffer slot", e.slot, kMaxVertexBuffers - 1);
        FormatInfo const& f = info(e.format);
        if (!can_be_vertex_element(f.type))
            throw Error(std::string(f.name) + " is not a vertex format");
        if (e.components < 1 || e.components > 4)
            throw Error("components of an input element is " + std::to_string(e.components) +
                        ", it must be 1 to 4");
        std::uint32_t const align = std::min(4u, std::bit_ceil(std::uint32_t(f.bytes)));
        if (e.offset % align)
            throw Error("offset of an input element is " + std::to_string(e.offset) + ", " +
                        std::string(f.name) + " needs a multiple of " + std::to_string(align) +
                        " (R37)");
    }
}

AssembledPrimitives assemble_primitives(DrawCall const& call)
{
    AssembledPrimitives out;
    out.vertices_per_primitive =
        std::uint32_t(vertices_per_primitive(call.topology, call.control_points));
    if (auto const* i16 = std::get_if<std::span<std::uint16_t const>>(&call.indices)) {
        assemble_indexed(*i16, call, out);
    } else if (auto const* i32 = std::get_if<std::span<std::uint32_t const>>(&call.indices)) {
        assemble_indexed(*i32, call, out);
    } else {
        std::vector<std::uint32_t> run(call.vertex_count);
        std::iota(run.begin(), run.end(), 0u);
        assemble_run(call.topology, out.vertices_per_primitive, run, out);
    }
    if (out.vertices.empty()) out.vertices = out.storage;
    out.stream =
        is_strip(call.topology) ? std::span<std::uint32_t const>(out.stream_storage) : out.vertices;
    if (!out.vertices.empty()) {
        std::uint32_t const most = *std::max_element(out.vertices.begin(), out.vertices.end());
        if (most >= 4 * out.vertices.size() + (1u << 20))
            make_ids_dense(out);
        else
            out.vertex_id_limit = most + 1;
    }
    return out;
}

void fetch_vertex(DrawCall const& call, std::uint32_t index, std::uint32_t instance, float* out)
{
    bool const indexed = !std::holds_alternative<std::monostate>(call.indices);
    std::uint32_t const vertex =
        index + (indexed ? std::uint32_t(call.base_vertex) : call.start_vertex);
    for (InputElement const& e : call.layout) {
        VertexBuffer const bound =
            e.slot < call.vertex_buffers.size() ? call.vertex_buffers[e.slot] : VertexBuffer{};
        auto const n = std::size_t(e.components);
        if (bound.bytes.empty()) { // R35: no defaults either
            std::fill_n(out, n, 0.0f);
            out += n;
            continue;
        }
        std::uint32_t const step =
            e.per_instance ? call.start_instance + (e.step_rate ? instance / e.step_rate : 0)
                           : vertex;
        std::uint32_t const address = bound.offset + bound.stride * step + e.offset;
        FormatInfo const& f = info(e.format);
        static constexpr std::byte kZeros[16]{};
        bool const inside =
            address <= bound.bytes.size() && bound.bytes.size() - address >= f.bytes;
        std::byte const* const at = inside ? bound.bytes.data() + address : kZeros;
        if (f.type == FormatType::Float && f.bytes == 4 * f.components && n <= f.components) {
            std::memcpy(out, at, 4 * n);
        } else {
            std::array<float, 4> const v = decode(e.format, at);
            std::copy_n(v.begin(), n, out);
        }
        out += n;
    }
}

} // namespace tessemu
