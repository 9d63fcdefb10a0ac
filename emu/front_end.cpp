// SPDX-License-Identifier: Apache-2.0
#include "emu/front_end.h"

#include <cstring>

namespace tessemu {

namespace {

constexpr std::size_t kPadding = 16; // whole groups of lanes are written

std::size_t padded(std::size_t n)
{
    return (n + kPadding - 1) / kPadding * kPadding;
}

std::shared_ptr<DomainPoints const> turned_over(DomainPoints const& pattern)
{
    auto out = std::make_shared<DomainPoints>(pattern);
    for (std::size_t i = 0; i + 2 < out->patch.indices.size(); i += 3)
        std::swap(out->patch.indices[i + 1], out->patch.indices[i + 2]);
    std::swap(out->corner[1], out->corner[2]);
    return out;
}

} // namespace

FrontEnd::FrontEnd(GraphicsPipelineDesc const& desc, DrawCall const& call,
                   DrawMistakes const& mistakes)
    : d_(desc),
      call_(call),
      mistakes_(mistakes),
      hs_buffers_(desc.hull_shader.resources()),
      ds_buffers_(desc.domain_resources()),
      gs_buffers_(desc.geometry_shader.resources())
{
}

OutputLayout FrontEnd::output() const
{
    if (d_.geometry_shader) return d_.geometry_shader->output();
    if (d_.domain_shader) return d_.domain_output();
    return d_.vertex_shader->output();
}

bool FrontEnd::makes_triangles() const
{
    if (d_.geometry_shader)
        return d_.geometry_shader->output_topology() == GeometryOutput::TriangleStrip;
    if (d_.hull_shader)
        return d_.output_primitive == OutputPrimitive::TriangleCw ||
               d_.output_primitive == OutputPrimitive::TriangleCcw;
    int const n = vertices_per_primitive(call_.topology, call_.control_points);
    return call_.topology != PrimitiveTopology::PatchList && (n == 3 || n == 6);
}

void FrontEnd::start(FrontEndChunk& c, std::size_t first, std::size_t count)
{
    c.first = first;
    c.count = count;
    c.counters = FrontEndCounters{};
    c.primitives.clear();
    c.gs_primitive_id.clear(); // another draw's geometry shader may have left some
    c.gs_viewport.clear();
}

void FrontEnd::run(FrontEndChunk& c, TessellatorCache& cache, AssembledPrimitives const& primitives,
                   float const* shaded_vertices, std::size_t first, std::size_t count) const
{
    start(c, first, count);
    if (d_.hull_shader) {
        hull_and_tessellate(c, cache, primitives, shaded_vertices);
        shade_patches(c);
    } else {
        gather(c, primitives, shaded_vertices);
    }
    if (d_.geometry_shader) run_geometry_shader(c);
}

void FrontEnd::hull_and_tessellate(FrontEndChunk& c, TessellatorCache& cache,
                                   AssembledPrimitives const& primitives,
                                   float const* shaded_vertices) const
{
    HullShader const& hs = d_.hull_shader;
    c.control_points.resize(c.count * std::size_t(hs.patch_floats()));
    c.patch_constants.resize(c.count * std::size_t(hs.constant_floats()));
    c.factors.resize(c.count);
    auto const n = std::size_t(call_.control_points);
    hs.run(HullBatch{primitives.vertices.subspan(c.first * n, c.count * n), shaded_vertices,
                     call_.control_points, std::uint32_t(c.first), c.count, c.control_points.data(),
                     c.patch_constants.data(), c.factors.data()},
           c.counters.hull, hs_buffers_);
    if (float const most = hs->max_tess_factor(); most < kMaxTessFactor)
        for (TessFactors& factors : c.factors)
            for (float& f : factors)
                if (f > most) f = most, ++c.counters.factors_above_max;
    c.patterns.resize(c.count);
    for (std::size_t p = 0; p < c.count; ++p) {
        auto const id = std::int64_t(c.first + p);
        if (id == mistakes_.other_factor)
            c.factors[p][0] += c.factors[p][0] > kMaxTessFactor - 2 ? -2.0f : 2.0f;
        bool const like_last =
            p > 0 && id - 1 != mistakes_.reversed_winding &&
            std::memcmp(&c.factors[p], &c.factors[p - 1], sizeof(TessFactors)) == 0;
        c.patterns[p] = like_last ? c.patterns[p - 1] : cache.find(c.factors[p]);
        if (id == mistakes_.reversed_winding) c.patterns[p] = turned_over(*c.patterns[p]);
        c.counters.tessellated_points += c.patterns[p]->patch.points();
        c.counters.tessellated_indices += c.patterns[p]->patch.indices.size();
    }
}

void FrontEnd::run_domain_shader(FrontEndChunk& c, std::size_t p) const
{
    HullShader const& hs = d_.hull_shader;
    DomainPoints const& d = *c.patterns[p];
    d_.domain_shader.run(
        DomainBatch{c.control_points.data() + p * std::size_t(hs.patch_floats()),
                    hs.control_points(),
                    c.patch_constants.data() + p * std::size_t(hs.constant_floats()),
                    hs.patch_constants(), std::int32_t(c.first + p), d.u.data(), d.v.data(),
                    d.patch.points(), c.shaded.data() + c.first_point[p], c.stride,
                    d_.domain_epilog ? &d_.domain_epilog : nullptr, &c.factors[p]},
        c.counters.domain);
}

void FrontEnd::shade_patches(FrontEndChunk& c) const
{
    c.first_point.resize(c.count);
    std::size_t points = 0;
    for (std::size_t p = 0; p < c.count; ++p) {
        c.first_point[p] = points;
        points += padded(c.patterns[p]->patch.points());
    }
    c.stride = points;
    c.shaded.resize(points * std::size_t(d_.domain_output().floats));
    StageScope const scope(c.counters.domain, ds_buffers_, d_.domain_shader.sites());
    for (std::size_t p = 0; p < c.count; ++p) run_domain_shader(c, p);
}

void FrontEnd::shade_patch_alone(FrontEndChunk& c, std::size_t p) const
{
    c.first_point.assign(c.count, 0);
    // An odd number of cache lines from row to row, so that rows do not share sets of the cache.
    c.stride = padded(c.patterns[p]->patch.points()) | kPadding;
    std::size_t const floats = c.stride * std::size_t(d_.domain_output().floats);
    if (c.shaded.size() < floats) c.shaded.resize(floats);
    StageScope const scope(c.counters.domain, ds_buffers_, d_.domain_shader.sites());
    run_domain_shader(c, p);
}

// Without tessellation: the vertex shader's outputs, all vertices of each primitive.
void FrontEnd::gather(FrontEndChunk& c, AssembledPrimitives const& primitives,
                      float const* shaded_vertices) const
{
    auto const out = std::size_t(d_.vertex_shader->output_floats());
    std::size_t const n = primitives.vertices_per_primitive;
    c.stride = padded(n * c.count);
    c.shaded.assign(c.stride * out, 0.0f);
    for (std::size_t i = 0; i < n * c.count; ++i) {
        float const* const v = shaded_vertices + primitives.vertices[n * c.first + i] * out;
        for (std::size_t k = 0; k < out; ++k) c.shaded[k * c.stride + i] = v[k];
    }
}

void FrontEnd::run_geometry_shader(FrontEndChunk& c) const
{
    GeometryShader const& gs = d_.geometry_shader;
    std::vector<std::uint32_t> index;
    std::vector<std::int32_t> ids;
    for_each_input_primitive(c, [&](std::uint32_t const* v, int n, std::int32_t id) {
        index.insert(index.end(), v, v + n);
        ids.push_back(id);
    });
    c.gs.vertices.clear();
    c.gs.primitives.clear();
    gs.run(GeometryBatch{c.shaded.data(), c.stride, index, ids}, c.gs, c.counters.geometry,
           gs_buffers_);
    c.counters.geometry_primitives = c.gs.primitives.size();

    // The rasterized stream's vertices take the place of the stage's inputs.
    int const stream = d_.stream_output ? d_.stream_output->rasterized_stream : 0;
    auto const n = std::size_t(gs->vertices_per_output()),
               floats = std::size_t(gs->output().floats);
    c.gs_primitive_id.clear();
    c.gs_viewport.clear();
    std::vector<std::size_t> source;
    for (std::size_t p = 0; p < c.gs.primitives.size(); ++p) {
        auto const& primitive = c.gs.primitives[p];
        if (primitive.stream != stream) continue;
        source.push_back(p);
        c.gs_primitive_id.push_back(primitive.primitive_id);
        // Out of range acts as 0 (R99).
        bool const in =
            primitive.viewport_index >= 0 && primitive.viewport_index < std::int32_t(kMaxViewports);
        c.gs_viewport.insert(c.gs_viewport.end(), n,
                             std::uint8_t(in ? primitive.viewport_index : 0));
    }
    c.stride = padded(n * source.size());
    c.gs_viewport.resize(c.stride);
    c.shaded.assign(c.stride * floats, 0.0f);
    for (std::size_t p = 0; p < source.size(); ++p)
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < floats; ++k)
                c.shaded[k * c.stride + p * n + i] =
                    c.gs.vertices[(source[p] * n + i) * floats + k];
}

void FrontEnd::stream_out(FrontEndChunk const& c, StreamOutput& out) const
{
    if (d_.geometry_shader) {
        auto const n = std::size_t(d_.geometry_shader->vertices_per_output());
        auto const floats = std::size_t(d_.geometry_shader->output().floats);
        for (std::size_t p = 0; p < c.gs.primitives.size(); ++p)
            out.write(c.gs.primitives[p].stream, int(n), [&](int i, int k) {
                return c.gs.vertices[(p * n + std::size_t(i)) * floats + std::size_t(k)];
            });
        return;
    }
    for_each_input_primitive(c, [&](std::uint32_t const* v, int n, std::int32_t) {
        out.write(0, n, [&](int i, int k) { return c.shaded[std::size_t(k) * c.stride + v[i]]; });
    });
}

} // namespace tessemu
