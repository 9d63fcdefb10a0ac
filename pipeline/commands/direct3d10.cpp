// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/direct3d10.h"

#include "pipeline/commands/refinement_pattern.h"

#include <algorithm>
#include <numeric>

namespace tessemu {

namespace {

// Of the second draw's vertex shader: behind the epilog's.
constexpr int kPointSlot = kBufferSlots - 2, kConstantSlot = kBufferSlots - 1;

// The control-point and fork phases as a geometry shader that appends a point for each control
// point to stream 0, for each patch constant to stream 1.
class HullGeometryProgram final : public GeometryProgram {
public:
    HullGeometryProgram(HullShader hull, int input_control_points)
        : hull_(std::move(hull)),
          inputs_(input_control_points)
    {
    }
    PrimitiveTopology input_topology() const override { return PrimitiveTopology::PatchList; }
    int input_vertices() const override { return inputs_; }
    GeometryOutput output_topology() const override { return GeometryOutput::PointList; }
    int max_vertices() const override { return hull_.control_points() + hull_.patch_constants(); }
    int instances() const override { return 1; }
    int input_floats() const override { return hull_->input_floats(); }
    int input_fetch_floats() const override { return hull_->input_fetch_floats(); }
    OutputLayout output() const override
    {
        return {std::max(hull_->control_point_floats(), hull_->patch_constant_floats()), 0, 0};
    }
    std::vector<ResourceInfo> resources(ShaderBinding const&) const override
    {
        return hull_.resources();
    }

    void run(ShaderBinding const&, GeometryBatch const& b, GeometryResult& result,
             StageCounters& counters, StageBuffers const& buffers) const override
    {
        auto const n = std::size_t(inputs_), in = std::size_t(hull_->input_floats());
        auto const point = std::size_t(hull_->control_point_floats()),
                   constant = std::size_t(hull_->patch_constant_floats());
        auto const points = std::size_t(hull_.control_points()),
                   constants = std::size_t(hull_.patch_constants());
        auto const out = std::size_t(output().floats);
        std::vector<float> vertices(n * in), control(points * point),
            registers(constants * constant);
        std::vector<std::uint32_t> ids(n);
        std::iota(ids.begin(), ids.end(), 0u);
        StageCounters own;
        for (std::size_t p = 0; p < b.primitive_ids.size(); ++p) {
            for (std::size_t k = 0; k < n; ++k)
                for (std::size_t c = 0; c < in; ++c)
                    vertices[k * in + c] = b.inputs[c * b.stride + b.index[p * n + k]];
            TessFactors unused;
            hull_.run(HullBatch{ids, vertices.data(), inputs_, std::uint32_t(b.primitive_ids[p]), 1,
                                control.data(), registers.data(), &unused},
                      own, buffers);
            auto const append = [&](std::vector<float> const& from, std::size_t count,
                                    std::size_t floats, std::uint8_t stream) {
                for (std::size_t i = 0; i < count; ++i) {
                    result.vertices.insert(result.vertices.end(), from.data() + i * floats,
                                           from.data() + (i + 1) * floats);
                    result.vertices.resize(result.vertices.size() + out - floats);
                    result.primitives.push_back({b.primitive_ids[p], 0, stream});
                }
            };
            append(control, points, point, 0);
            append(registers, constants, constant, 1);
        }
        // Reads of its own outputs and constants stay in registers.
        own.output_fetches = own.output_touched = own.constant_fetches = own.constant_touched = 0;
        counters += own;
    }

private:
    HullShader hull_;
    int inputs_;
};

// What the first draw streams out.
struct Streamed {
    std::vector<float> points, constants; ///< patch after patch
    std::vector<float> pattern;           ///< [vertex][2]: u, v
};

// A domain shader as a vertex shader: the vertex brings u and v, the instance the patch.
class DomainVertexProgram final : public VertexProgram {
public:
    /// \param pipeline  whose hull shader wrote what its domain shader reads
    DomainVertexProgram(GraphicsPipelineDesc const& pipeline,
                        std::shared_ptr<Streamed const> streamed)
        : pipeline_(pipeline),
          fetch_floats_(pipeline.hull_shader->control_point_fetch_floats()),
          streamed_(std::move(streamed))
    {
    }
    int input_floats() const override { return 2; }
    OutputLayout output() const override { return pipeline_.domain_output(); }
    std::vector<ResourceInfo> resources(ShaderBinding const&) const override
    {
        std::vector<ResourceInfo> all = pipeline_.domain_resources();
        auto const add = [&](char const* name, int slot, std::size_t floats, int record) {
            all.push_back({name, ResourceKind::Buffer, slot, floats / std::size_t(record),
                           std::size_t(record) * sizeof(float)});
        };
        add("control_points", kPointSlot, streamed_->points.size(), fetch_floats_);
        if (pipeline_.hull_shader.patch_constants())
            add("patch_constants", kConstantSlot, streamed_->constants.size(),
                pipeline_.domain_shader->patch_constant_floats());
        return all;
    }

    void run(ShaderBinding const&, VertexBatch const& batch, float* outputs,
             StageCounters& counters, StageBuffers const& buffers) const override
    {
        DomainShader const& domain = pipeline_.domain_shader;
        HullShader const& hull = pipeline_.hull_shader;
        StageScope const scope(counters, buffers, domain.sites());
        std::size_t const n = batch.ids.size(), stride = (n + 15) / 16 * 16;
        auto const floats = std::size_t(output().floats);
        std::vector<float> u(stride), v(stride), shaded(stride * floats);
        for (std::size_t i = 0; i < n; ++i) {
            float at[2];
            fetch_vertex(batch.call, batch.primitives.index(batch.ids[i]), batch.instance, at);
            u[i] = at[0];
            v[i] = at[1];
        }
        std::size_t const patch = batch.instance;
        auto const points = std::size_t(hull.patch_floats()),
                   constants = std::size_t(hull.patch_constants());
        StageCounters own;
        domain.run(
            DomainBatch{streamed_->points.data() + patch * points, hull.control_points(),
                        streamed_->constants.data() + patch * std::size_t(hull.constant_floats()),
                        hull.patch_constants(), std::int32_t(patch), u.data(), v.data(), n,
                        shaded.data(), stride,
                        pipeline_.domain_epilog ? &pipeline_.domain_epilog : nullptr},
            own);
        count(kPointSlot, patch * points / std::size_t(fetch_floats_), own.input_fetches,
              own.input_touched);
        count(kConstantSlot, patch * constants, own.constant_fetches, own.constant_touched);
        counters.invocations += n;
        counters.input_fetches += n;
        if (!outputs) return;
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < floats; ++k)
                outputs[batch.ids[i] * floats + k] = shaded[k * stride + i];
    }

private:
    // The domain program tells how many records it read, not which: the first ones stand for them.
    static void count(int slot, std::size_t first, std::uint64_t fetches, std::uint64_t touched)
    {
        FetchSlot* const s = detail::bound_slot(slot);
        if (!s) return;
        s->count += fetches;
        for (std::size_t i = 0; s->touched && i < touched; ++i) s->touched->mark(first + i);
    }

    GraphicsPipelineDesc pipeline_;
    int fetch_floats_;
    std::shared_ptr<Streamed const> streamed_;
};

std::shared_ptr<DomainPoints const> refinement_pattern(TessellatorDomain domain,
                                                       SurfaceSettings const& settings)
{
    if (settings.pattern == RefinementPattern::Uniform)
        return uniform_pattern(domain, uniform_segments(settings.tess_factor));
    TessFactors factors;
    factors.fill(settings.tess_factor);
    TessellatorCache cache(
        TessellatorState{domain, settings.partitioning, OutputPrimitive::TriangleCw});
    return cache.find(factors);
}

// A draw of patches as two.
void add_instanced(CommandList& list, Draw show, SurfaceSettings const& settings)
{
    GraphicsPipelineDesc const d = show.pipeline;
    HullShader const& hull = d.hull_shader;
    if (d.domain_shader->reads_tess_factors())
        throw Error("the Direct3D 10 path has no tess factors for a domain shader that reads them");
    std::size_t const patches = show.patches.size();
    auto const streamed = std::make_shared<Streamed>();
    streamed->points.resize(patches * std::size_t(hull.patch_floats()));
    streamed->constants.resize(patches * std::size_t(hull.constant_floats()));
    list.memory.push_back(streamed);

    Draw fill;
    fill.name = show.name + ": control points";
    fill.call = show.call;
    fill.pipeline.vertex_shader = d.vertex_shader;
    fill.pipeline.geometry_shader = {
        std::make_shared<HullGeometryProgram>(hull, d.input_control_points)};
    fill.pipeline.input_control_points = d.input_control_points;
    StreamOutputDesc out;
    out.rasterized_stream = -1;
    for (int at = 0, n = hull->control_point_floats(); at < n; at += 4)
        out.entries.push_back({0, std::int16_t(at), std::uint8_t(std::min(4, n - at)), 0});
    fill.stream_output.push_back({std::as_writable_bytes(std::span(streamed->points)), 0});
    if (hull.patch_constants()) {
        out.entries.push_back({1, 0, std::uint8_t(hull->patch_constant_floats()), 1});
        fill.stream_output.push_back({std::as_writable_bytes(std::span(streamed->constants)), 0});
    }
    fill.pipeline.stream_output = out;
    list.commands.emplace_back(std::move(fill));

    show.grid = refinement_pattern(d.domain_shader->domain(), settings);
    std::size_t const points = show.grid->patch.points();
    for (std::size_t i = 0; i < points; ++i)
        streamed->pattern.insert(streamed->pattern.end(), {show.grid->u[i], show.grid->v[i]});
    show.pipeline = {};
    show.pipeline.vertex_shader = {std::make_shared<DomainVertexProgram>(d, streamed)};
    show.pipeline.pixel_shader = d.pixel_shader;
    show.call = {};
    show.call.topology = PrimitiveTopology::TriangleList;
    show.call.set_vertices(streamed->pattern, 2);
    show.call.indices = std::span<std::uint32_t const>(show.grid->patch.indices);
    show.call.instance_count = std::uint32_t(patches);
    list.commands.emplace_back(std::move(show));
}

} // namespace

CommandList instanced(CommandList list, SurfaceSettings const& settings)
{
    if (settings.adaptive_rule.kind != TessFactorRule::Kind::Uniform)
        throw Error("the Direct3D 10 path refines every patch alike: it takes no adaptive factors");
    CommandList out;
    out.memory = std::move(list.memory);
    for (Command& c : list.commands) {
        Draw* const d = std::get_if<Draw>(&c);
        if (d && d->shows_surface() && d->pipeline.hull_shader)
            add_instanced(out, std::move(*d), settings);
        else
            out.commands.push_back(std::move(c));
    }
    return out;
}

} // namespace tessemu
