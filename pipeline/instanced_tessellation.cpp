// SPDX-License-Identifier: Apache-2.0
#include "pipeline/instanced_tessellation.h"

#include <algorithm>
#include <numeric>

namespace tessemu {

namespace {

constexpr int kPointSlot = 3, kConstantSlot = 4; // of the second draw's vertex shader

// The control-point and fork phases as a geometry shader that appends a point for each control
// point to stream 0, for each patch constant to stream 1.
class HullGeometryProgram final : public GeometryProgram {
public:
    HullGeometryProgram(std::shared_ptr<HullProgram const> hull, int input_control_points)
        : hull_(std::move(hull)),
          inputs_(input_control_points)
    {
    }
    PrimitiveTopology input_topology() const override { return PrimitiveTopology::PatchList; }
    int input_vertices() const override { return inputs_; }
    GeometryOutput output_topology() const override { return GeometryOutput::PointList; }
    int max_vertices() const override { return hull_->control_points() + hull_->patch_constants(); }
    int instances() const override { return 1; }
    int input_floats() const override { return hull_->input_floats(); }
    int input_fetch_floats() const override { return hull_->input_fetch_floats(); }
    OutputLayout output() const override
    {
        return {std::max(hull_->control_point_floats(), hull_->patch_constant_floats()), 0, 0};
    }
    std::vector<ResourceInfo> resources() const override { return hull_->resources(); }

    void run(GeometryBatch const& b, GeometryResult& result, StageCounters& counters,
             StageBuffers const& buffers) const override
    {
        auto const n = std::size_t(inputs_), in = std::size_t(hull_->input_floats());
        auto const point = std::size_t(hull_->control_point_floats()),
                   constant = std::size_t(hull_->patch_constant_floats());
        auto const points = std::size_t(hull_->control_points()),
                   constants = std::size_t(hull_->patch_constants());
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
            hull_->run({ids, vertices.data(), inputs_, std::uint32_t(b.primitive_ids[p]), 1,
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
    std::shared_ptr<HullProgram const> hull_;
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
    /// \param hull  whose outputs the domain shader reads
    DomainVertexProgram(std::shared_ptr<DomainProgram const> domain, HullProgram const& hull,
                        std::shared_ptr<Streamed const> streamed)
        : domain_(std::move(domain)),
          patch_constants_(hull.patch_constants()),
          fetch_floats_(hull.control_point_fetch_floats()),
          streamed_(std::move(streamed))
    {
        for (ResourceInfo const& r : domain_->resources())
            if (r.slot == kPointSlot || r.slot == kConstantSlot)
                throw Error("slot " + std::to_string(r.slot) + " is taken by " + r.name +
                            ": an instanced patch needs it for its control points");
    }
    int input_floats() const override { return 2; }
    OutputLayout output() const override { return domain_->output(); }
    std::vector<ResourceInfo> resources() const override
    {
        std::vector<ResourceInfo> all = domain_->resources();
        auto const add = [&](char const* name, int slot, std::size_t floats, int record) {
            all.push_back({name, ResourceKind::Buffer, slot, floats / std::size_t(record),
                           std::size_t(record) * sizeof(float)});
        };
        add("control_points", kPointSlot, streamed_->points.size(), fetch_floats_);
        if (patch_constants_)
            add("patch_constants", kConstantSlot, streamed_->constants.size(),
                domain_->patch_constant_floats());
        return all;
    }

    void run(VertexBatch const& batch, float* outputs, StageCounters& counters,
             StageBuffers const& buffers) const override
    {
        StageScope const scope(counters, buffers, domain_->sites());
        std::size_t const n = batch.ids.size(), stride = (n + 15) / 16 * 16;
        auto const floats = std::size_t(domain_->output_floats());
        std::vector<float> u(stride), v(stride), shaded(stride * floats);
        for (std::size_t i = 0; i < n; ++i) {
            float at[2];
            fetch_vertex(batch.call, batch.primitives.index(batch.ids[i]), batch.instance, at);
            u[i] = at[0];
            v[i] = at[1];
        }
        std::size_t const patch = batch.instance;
        std::size_t const points =
            std::size_t(domain_->control_points() * domain_->control_point_floats());
        auto const constants = std::size_t(patch_constants_);
        StageCounters own;
        domain_->run({streamed_->points.data() + patch * points,
                      streamed_->constants.data() +
                          patch * constants * std::size_t(domain_->patch_constant_floats()),
                      std::int32_t(patch), u.data(), v.data(), n, shaded.data(), stride},
                     patch_constants_, own);
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
        FetchSlot& s = execution.buffers[slot];
        s.count += fetches;
        if (!s.touched) return;
        for (std::size_t i = 0; i < touched; ++i) s.touched->mark(first + i);
    }

    std::shared_ptr<DomainProgram const> domain_;
    int patch_constants_, fetch_floats_;
    std::shared_ptr<Streamed const> streamed_;
};

std::shared_ptr<DomainPoints const> refinement_pattern(TessellatorDomain domain,
                                                       PassSettings const& settings)
{
    TessFactors factors;
    factors.fill(settings.tess_factor);
    TessellatorCache cache(
        TessellatorState{domain, settings.partitioning, OutputPrimitive::TriangleCw});
    return cache.find(factors);
}

} // namespace

DrawPass instanced(DrawPass pass, PassSettings const& settings)
{
    if (settings.adaptive.kind != TessFactorRule::Kind::Uniform)
        throw Error("the Direct3D 10 path refines every patch alike: it takes no adaptive factors");
    GraphicsPipelineDesc const& d = pass.pipeline.desc();
    HullProgram const& hull = *d.hull_shader;
    DomainProgram const& domain = *d.domain_shader;
    std::size_t const patches = pass.patches.size();
    auto const streamed = std::make_shared<Streamed>();
    streamed->points.resize(patches * std::size_t(hull.control_points()) *
                            std::size_t(hull.control_point_floats()));
    streamed->constants.resize(patches * std::size_t(hull.patch_constants()) *
                               std::size_t(hull.patch_constant_floats()));

    GraphicsPipelineDesc first;
    first.vertex_shader = d.vertex_shader;
    first.geometry_shader =
        std::make_shared<HullGeometryProgram>(d.hull_shader, d.input_control_points);
    first.input_control_points = d.input_control_points;
    StreamOutputDesc out;
    out.rasterized_stream = -1;
    for (int at = 0; at < hull.control_point_floats(); at += 4)
        out.entries.push_back(
            {0, std::int16_t(at), std::uint8_t(std::min(4, hull.control_point_floats() - at)), 0});
    if (hull.patch_constants())
        out.entries.push_back({1, 0, std::uint8_t(hull.patch_constant_floats()), 1});
    first.stream_output = out;
    auto const before = std::move(pass.prepare);
    auto const call = std::make_shared<DrawCall>(pass.call);
    auto const pipeline = std::make_shared<GraphicsPipeline>(std::move(first));
    pass.prepare = [before, call, pipeline, streamed](ThreadPool const& threads,
                                                      VertexCacheModel const& cache) {
        DrawStatistics s;
        if (before) s += before(threads, cache);
        StreamOutputBuffer buffers[2] = {
            {std::as_writable_bytes(std::span(streamed->points)), 0},
            {std::as_writable_bytes(std::span(streamed->constants)), 0}};
        DrawOptions options;
        options.vertex_cache = cache;
        options.stream_output = buffers;
        s += draw(*pipeline, *call, nullptr, {}, threads, options);
        return s;
    };

    pass.pattern = refinement_pattern(domain.domain(), settings);
    std::size_t const points = pass.pattern->patch.points();
    for (std::size_t i = 0; i < points; ++i)
        streamed->pattern.insert(streamed->pattern.end(), {pass.pattern->u[i], pass.pattern->v[i]});
    GraphicsPipelineDesc second;
    second.vertex_shader = std::make_shared<DomainVertexProgram>(d.domain_shader, hull, streamed);
    second.pixel_shader = d.pixel_shader;
    pass.call = {};
    pass.call.topology = PrimitiveTopology::TriangleList;
    pass.call.set_vertices(streamed->pattern, 2);
    pass.call.indices = std::span<std::uint32_t const>(pass.pattern->patch.indices);
    pass.call.instance_count = std::uint32_t(patches);
    pass.pipeline = GraphicsPipeline(std::move(second));
    pass.memory.push_back(streamed);
    return pass;
}

} // namespace tessemu
