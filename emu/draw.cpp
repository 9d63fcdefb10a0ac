// One draw: the stages run in waves of primitives, spread over threads.
//
// Geometry work is spread over chunks of primitives, raster work over screen tiles; a chunk's lists
// are replayed in submission order, so results do not depend on the schedule (R1, R2).
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/raster_stages.h"

namespace tessemu {

DrawMemory::DrawMemory() : parts_(std::make_unique<Parts>()) {}
DrawMemory::~DrawMemory() = default;
DrawMemory::DrawMemory(DrawMemory&&) noexcept = default;
DrawMemory& DrawMemory::operator=(DrawMemory&&) noexcept = default;

namespace {

constexpr std::size_t kPatchesPerChunk = 8;
constexpr std::size_t kPrimitivesPerChunk = 512; // of a draw without tessellation
constexpr std::size_t kChunksPerWave = 128;
// A draw that streams keeps fragments only: waves grow until they hold about so many.
constexpr std::uint64_t kFragmentsPerWave = std::uint64_t(1) << 21;
constexpr std::size_t kMostChunksPerWave = 4096;

// R5.
bool rasterization_is_on(GraphicsPipelineDesc const& d, RasterTarget const* t)
{
    if (!t || (d.stream_output && d.stream_output->rasterized_stream < 0)) return false;
    return d.pixel_shader || t->depth_stencil.depth_enable || t->depth_stencil.stencil_enable;
}

class Drawing {
public:
    Drawing(GraphicsPipeline const& pipeline, DrawCall const& call, RasterTarget const* target,
            PatchVisitor const& visit, ThreadPool const& threads, DrawOptions const& options)
        : d_(pipeline.desc()),
          call_(call),
          visit_(visit),
          threads_(threads),
          options_(options),
          stages_(d_, call, options.mistakes),
          vs_buffers_(d_.vertex_shader->resources()),
          memory_(options.memory ? *options.memory : own_memory_),
          shaded_vertices_(memory_.parts().shaded_vertices)
    {
        if (rasterization_is_on(d_, target))
            raster_.emplace(*target, d_, stages_.output(), stages_.makes_triangles());
        if (d_.stream_output) stream_output_.emplace(*d_.stream_output, options.stream_output);
    }

    DrawStatistics run()
    {
        primitives_ = assemble_primitives(call_);
        for (std::uint32_t i = 0; i < call_.instance_count; ++i) run_instance(i);
        report();
        return std::move(stats_);
    }

private:
    void run_instance(std::uint32_t instance)
    {
        std::size_t const all = primitives_.primitives();
        stats_.pipeline.IAPrimitives += all;
        stats_.pipeline.IAVertices += primitives_.stream.size();
        run_vertex_shader(instance);
        std::size_t const per_chunk = d_.hull_shader ? kPatchesPerChunk : kPrimitivesPerChunk;
        std::size_t const chunks = (all + per_chunk - 1) / per_chunk;
        std::vector<Chunk>& wave = memory_.parts().wave;
        bool const streams = raster_ && raster_->streams() && !visit_ && !stream_output_;
        bool const counts_only =
            !raster_ && !visit_ && !stream_output_ && stages_.tessellates() && !d_.geometry_shader;
        std::size_t per_wave = kChunksPerWave;
        for (std::size_t first = 0; first < chunks;) {
            std::size_t const n = std::min(per_wave, chunks - first);
            if (wave.size() < n) wave.resize(n);
            threads_.parallel_for(n, [&](std::size_t i) {
                DenormalMode const flush(DenormalMode::Flush); // fixed function between the stages
                std::size_t const p = (first + i) * per_chunk;
                std::size_t const count = std::min(per_chunk, all - p);
                float const* const vertices = shaded_vertices_.data();
                if (streams)
                    return raster_->stream(stages_, primitives_, vertices, p, count, wave[i],
                                           memory_.parts());
                if (counts_only) // nobody looks at the points
                    return stages_.run_by_patch(wave[i], primitives_, vertices, p, count,
                                                [](std::size_t) {});
                stages_.run(wave[i], primitives_, vertices, p, count);
                if (raster_) raster_->assemble(stages_, wave[i]);
            });
            for (std::size_t i = 0; i < n; ++i) finish_geometry(wave[i]);
            std::span<Chunk> const done = std::span(wave).first(n);
            if (streams)
                per_wave = next_wave(n, raster_->merge(done, threads_));
            else if (raster_)
                raster_->rasterize(done, threads_);
            first += n;
            if (options_.progress) options_.progress(std::min(first * per_chunk, all), all);
        }
    }

    static std::size_t next_wave(std::size_t chunks, std::uint64_t fragments)
    {
        std::uint64_t const fit =
            chunks * kFragmentsPerWave / std::max<std::uint64_t>(1, fragments);
        return std::size_t(std::clamp<std::uint64_t>(
            fit, kChunksPerWave, std::min(4 * chunks + kChunksPerWave, kMostChunksPerWave)));
    }

    // The cache decides which vertices run, and run again after a miss. They run in blocks; a
    // repeated run gives the same bits, so only the first one writes and threads never share a
    // place.
    void run_vertex_shader(std::uint32_t instance)
    {
        VertexProgram const& vs = *d_.vertex_shader;
        std::uint32_t const limit = primitives_.vertex_id_limit;
        shaded_vertices_.resize(std::size_t(limit) * std::size_t(vs.output_floats()));
        VertexCache cache(options_.vertex_cache, limit);
        std::vector<char> shaded(limit, 0);
        constexpr std::size_t kBlock = 1 << 16, kPiece = 1 << 9;
        std::vector<std::uint32_t> fresh, repeated;

        auto const run = [&](std::vector<std::uint32_t>& ids, float* outputs) {
            std::size_t const pieces = (ids.size() + kPiece - 1) / kPiece;
            std::vector<StageCounters> counters(pieces);
            threads_.parallel_for(pieces, [&](std::size_t i) {
                std::size_t const n = std::min(kPiece, ids.size() - i * kPiece);
                vs.run({std::span(ids).subspan(i * kPiece, n), call_, primitives_, instance},
                       outputs, counters[i], vs_buffers_);
            });
            for (StageCounters const& c : counters) vertex_ += c;
            ids.clear();
        };
        auto const flush = [&] {
            vertex_.input_touched += fresh.size();
            run(fresh, shaded_vertices_.data());
            run(repeated, nullptr);
        };
        for (std::uint32_t v : primitives_.stream) {
            if (cache.access(v)) continue;
            (shaded[v] ? repeated : fresh).push_back(v);
            shaded[v] = 1;
            if (fresh.size() + repeated.size() == kBlock) flush();
        }
        flush();
        stats_.pipeline.VSInvocations = vertex_.invocations;
    }

    void finish_geometry(Chunk& c)
    {
        GeometryCounters const& g = c.counters;
        hull_ += g.hull;
        domain_ += g.domain;
        geometry_ += g.geometry;
        tessellated_points_ += g.tessellated_points;
        tessellated_indices_ += g.tessellated_indices;
        stats_.tess_factors_above_max += g.factors_above_max;
        stats_.pipeline.CInvocations += g.assembly.clip_invocations;
        stats_.pipeline.CPrimitives += g.assembly.clip_primitives;
        stats_.pipeline.GSPrimitives += g.geometry_primitives;
        if (stream_output_) stages_.stream_out(c, *stream_output_);
        if (!visit_ || !d_.hull_shader) return;
        for (std::size_t p = 0; p < c.count; ++p)
            visit_({std::uint32_t(c.first + p), c.patterns[p].get(),
                    c.shaded.data() + c.first_point[p], c.stride});
    }

    StageStatistics& add_stage(char const* name, std::uint64_t invocations, StageCounters const& c)
    {
        stats_.stages.push_back({name, invocations, c.flops, {}, 0});
        return stats_.stages.back();
    }
    static void add_fetch(StageStatistics& s, char const* name, ResourceKind kind, std::uint64_t n,
                          std::uint64_t unique, std::size_t bytes)
    {
        s.fetches.push_back({name, kind, n, n * bytes, unique * bytes});
    }

    void report()
    {
        PipelineStatistics& p = stats_.pipeline;
        StageStatistics& ia = add_stage("input_assembler", p.IAPrimitives, {});
        if (primitives_.index_bytes) {
            std::uint64_t const read = primitives_.indices_read * call_.instance_count;
            add_fetch(ia, "indices", ResourceKind::Index, read, primitives_.indices_read,
                      primitives_.index_bytes);
        }
        VertexProgram const& vs = *d_.vertex_shader;
        StageStatistics& v = add_stage("vertex_shader", vertex_.invocations, vertex_);
        add_fetch(v, "vertices", ResourceKind::Vertex, vertex_.input_fetches, vertex_.input_touched,
                  call_.vertex_bytes());
        vs_buffers_.report(vertex_, v);
        v.output_bytes = vertex_.invocations * std::uint64_t(vs.output_floats()) * sizeof(float);
        if (d_.hull_shader) report_tessellation();
        if (d_.geometry_shader) {
            GeometryProgram const& gs = *d_.geometry_shader;
            p.GSInvocations = geometry_.invocations;
            StageStatistics& g = add_stage("geometry_shader", geometry_.invocations, geometry_);
            add_fetch(g, "vertices", ResourceKind::Vertex, geometry_.input_fetches,
                      geometry_.input_touched,
                      std::size_t(gs.input_fetch_floats()) * sizeof(float));
            stages_.geometry_buffers().report(geometry_, g);
            g.output_bytes = p.GSPrimitives * std::uint64_t(gs.vertices_per_output()) *
                             std::uint64_t(gs.output().floats) * sizeof(float);
        }
        if (stream_output_) {
            stats_.stream_output = stream_output_->statistics();
            std::uint64_t written = 0;
            for (auto const& s : stats_.stream_output) written += s.NumPrimitivesWritten;
            add_stage("stream_output", written, {}).output_bytes = stream_output_->bytes_written();
        }
        if (raster_) report_raster();
    }

    void report_tessellation()
    {
        PipelineStatistics& p = stats_.pipeline;
        HullProgram const& hs = *d_.hull_shader;
        DomainProgram const& ds = *d_.domain_shader;
        p.HSInvocations = hull_.invocations;
        p.HSControlPointInvocations = hull_.invocations * std::uint64_t(hs.control_points());
        p.HSPatchConstantInvocations = hull_.invocations * std::uint64_t(hs.patch_constants() + 1);
        std::size_t const point_bytes = std::size_t(hs.control_point_floats()) * sizeof(float);
        std::size_t const fetch_bytes =
            std::size_t(hs.control_point_fetch_floats()) * sizeof(float);
        std::size_t const constant_bytes = std::size_t(hs.patch_constant_floats()) * sizeof(float);
        StageStatistics& h = add_stage("hull_shader", hull_.invocations, hull_);
        add_fetch(h, "input_control_points", ResourceKind::ControlPoint, hull_.input_fetches,
                  hull_.input_touched, std::size_t(hs.input_fetch_floats()) * sizeof(float));
        if (hull_.output_fetches)
            add_fetch(h, "output_control_points", ResourceKind::ControlPoint, hull_.output_fetches,
                      hull_.output_touched, fetch_bytes);
        if (hull_.constant_fetches)
            add_fetch(h, "patch_constants", ResourceKind::PatchConstant, hull_.constant_fetches,
                      hull_.constant_touched, constant_bytes);
        stages_.hull_buffers().report(hull_, h);
        h.output_bytes =
            hull_.invocations * (std::uint64_t(hs.control_points()) * point_bytes +
                                 std::uint64_t(hs.patch_constants()) * constant_bytes +
                                 std::uint64_t(tess_factor_count(hs.domain())) * sizeof(float));

        StageStatistics& t = add_stage("tessellator", hull_.invocations, {});
        t.output_bytes =
            tessellated_points_ * 2 * sizeof(float) + tessellated_indices_ * sizeof(std::uint32_t);

        p.DSInvocations = domain_.invocations;
        StageStatistics& s = add_stage("domain_shader", domain_.invocations, domain_);
        add_fetch(s, "control_points", ResourceKind::ControlPoint, domain_.input_fetches,
                  domain_.input_touched, fetch_bytes);
        add_fetch(s, "patch_constants", ResourceKind::PatchConstant, domain_.constant_fetches,
                  domain_.constant_touched, constant_bytes);
        stages_.domain_buffers().report(domain_, s);
        s.output_bytes = domain_.invocations * std::uint64_t(ds.output_floats()) * sizeof(float);
    }

    void report_raster()
    {
        PipelineStatistics& p = stats_.pipeline;
        RasterCounters const& c = raster_->counters;
        stats_.samples_passed = c.passed_samples;
        add_stage("rasterizer", p.CPrimitives, {}).output_bytes = c.covered_samples * sizeof(float);
        p.PSInvocations = c.pixel.invocations;
        StageStatistics& ps = add_stage("pixel_shader", c.pixel.invocations, c.pixel);
        raster_->buffers().report(c.pixel, ps);
        int const colors = d_.pixel_shader ? d_.pixel_shader->info().color_targets : 0;
        ps.output_bytes = c.pixel.invocations * std::uint64_t(colors) * 4 * sizeof(float);
        std::uint64_t texel_bytes = raster_->target().depth ? sizeof(float) : 0;
        for (std::size_t i = 0; i < raster_->target().color.size() && int(i) < colors; ++i)
            if (ColorTarget const* t = raster_->target().color[i]) texel_bytes += t->texel_bytes();
        add_stage("output_merger", c.covered_samples, {}).output_bytes =
            c.passed_samples * texel_bytes;
    }

    GraphicsPipelineDesc const& d_;
    DrawCall const& call_;
    PatchVisitor const& visit_;
    ThreadPool const& threads_;
    DrawOptions const& options_;
    GeometryStages stages_;
    StageBuffers vs_buffers_;
    std::optional<RasterStages> raster_;
    std::optional<StreamOutput> stream_output_;

    AssembledPrimitives primitives_;
    DrawMemory own_memory_;
    DrawMemory& memory_;
    std::vector<float>& shaded_vertices_;
    StageCounters vertex_, hull_, domain_, geometry_;
    std::uint64_t tessellated_points_ = 0, tessellated_indices_ = 0;
    DrawStatistics stats_;
};

// What a draw needs of its pipeline and targets.
void check_draw(GraphicsPipelineDesc const& d, DrawCall const& call, RasterTarget const* target,
                DrawOptions const& options)
{
    check_draw_call(call);
    if (call.vertex_floats() != d.vertex_shader->input_floats())
        throw Error("the input layout gives " + std::to_string(call.vertex_floats()) +
                    " scalars, the vertex shader reads " +
                    std::to_string(d.vertex_shader->input_floats()));
    bool const patches = call.topology == PrimitiveTopology::PatchList;
    if (d.hull_shader && !patches) throw Error("a hull shader needs a patch list (R3)");
    if (patches && (call.control_points < 1 || call.control_points > kMaxControlPoints))
        throw LimitError("control points per patch", std::uint64_t(call.control_points),
                         kMaxControlPoints);
    if (patches && !d.hull_shader && !d.geometry_shader && rasterization_is_on(d, target))
        throw Error("a patch list cannot be rasterized without hull and domain shader (R4)");
    if (d.hull_shader && call.control_points != d.input_control_points)
        throw Error("the draw has " + std::to_string(call.control_points) +
                    " control points per patch, the pipeline was created for " +
                    std::to_string(d.input_control_points));
    if (d.geometry_shader && !d.hull_shader &&
        vertices_per_primitive(call.topology, call.control_points) !=
            d.geometry_shader->input_vertices())
        throw Error("the topology has " +
                    std::to_string(vertices_per_primitive(call.topology, call.control_points)) +
                    " vertices per primitive, the geometry shader takes " +
                    std::to_string(d.geometry_shader->input_vertices()));
    if (options.stream_output.size() > kMaxStreamOutputBuffers)
        throw LimitError("stream output buffers", options.stream_output.size(),
                         kMaxStreamOutputBuffers);
    if (!target) return;
    auto const limit = [](char const* thing, std::size_t value, std::size_t most) {
        if (value > most) throw LimitError(thing, value, most);
    };
    limit("render targets", target->color.size(), kMaxRenderTargets);
    limit("viewports", target->viewports.size(), kMaxViewports);
    limit("scissor rectangles", target->scissors.size(), kMaxViewports);
    for (Viewport const& v : target->viewports) {
        bool const depth = 0 <= v.min_depth && v.min_depth <= v.max_depth && v.max_depth <= 1;
        auto const inside = [](float p) { return p >= -32768 && p <= 32767; };
        if (!depth || v.width < 0 || v.height < 0 || !inside(v.x) || !inside(v.y) ||
            !inside(v.x + v.width) || !inside(v.y + v.height))
            throw Error("a viewport must lie within -32768 to 32767 and its depths within 0 to 1 "
                        "(R97)");
    }
    int width = 0, height = 0, samples = 0;
    auto const same = [&](int w, int h, int s) {
        if (samples == 0) width = w, height = h, samples = s;
        if (w != width || h != height || s != samples)
            throw Error("targets differ in size or samples: " + std::to_string(w) + "x" +
                        std::to_string(h) + "x" + std::to_string(s) + " beside " +
                        std::to_string(width) + "x" + std::to_string(height) + "x" +
                        std::to_string(samples));
    };
    for (ColorTarget const* c : target->color)
        if (c) same(c->width(), c->height(), c->samples());
    if (target->depth)
        same(target->depth->width(), target->depth->height(), target->depth->samples());
    if (target->coverage)
        same(target->coverage->width, target->coverage->height, target->coverage->samples);
}

} // namespace

DrawStatistics draw(GraphicsPipeline const& pipeline, DrawCall const& call,
                    RasterTarget const* raster, PatchVisitor const& visit,
                    ThreadPool const& threads, DrawOptions const& options)
{
    check_draw(pipeline.desc(), call, raster, options);
    return Drawing(pipeline, call, raster, visit, threads, options).run();
}

} // namespace tessemu
