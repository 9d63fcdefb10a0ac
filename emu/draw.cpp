// One draw: the stages run in waves of primitives, spread over threads.
//
// Geometry work is spread over chunks of primitives, raster work over screen tiles; a chunk's lists
// are replayed in submission order, so results do not depend on the schedule (R1, R2).
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/geometry.h"
#include "emu/rasterizer.h"
#include "emu/triangle_stream.h"

#include <cmath>

namespace tessemu {

// A chunk and its primitives, or its shaded fragments, by tile.
struct DrawMemory::Parts {
    struct Chunk : GeometryChunk {
        FragmentBins fragments;
        std::uint64_t fragment_count = 0;
        std::vector<std::uint32_t> bin_start, bin_primitives; // by tile, in submission order
        std::vector<std::pair<std::uint32_t, std::uint32_t>> bin_entries;
    };
    std::vector<Chunk> wave;
    std::vector<float> shaded_vertices;
    std::mutex idle_mutex;
    std::vector<std::unique_ptr<GeometryChunk>> idle; // of threads that stream
};

DrawMemory::DrawMemory() : parts_(std::make_unique<Parts>()) {}
DrawMemory::~DrawMemory() = default;
DrawMemory::DrawMemory(DrawMemory&&) noexcept = default;
DrawMemory& DrawMemory::operator=(DrawMemory&&) noexcept = default;

namespace {

using Chunk = DrawMemory::Parts::Chunk;

constexpr std::size_t kPatchesPerChunk = 8;
constexpr std::size_t kPrimitivesPerChunk = 512; // of a draw without tessellation
constexpr std::size_t kChunksPerWave = 128;
// A draw that streams keeps fragments only: waves grow until they hold about so many.
constexpr std::uint64_t kFragmentsPerWave = std::uint64_t(1) << 21;
constexpr std::size_t kMostChunksPerWave = 4096;

// Targets, and what of them may be written.
class Raster {
public:
    // `triangles`: nothing else reaches the rasterizer.
    Raster(RasterTarget const& target, GraphicsPipelineDesc const& desc, OutputLayout layout,
           bool triangles)
        : target_(with_all_viewports(target, desc)),
          buffers_(desc.pixel_shader ? desc.pixel_shader->resources()
                                     : std::vector<ResourceInfo>{}),
          setup_{target_, {}, desc.pixel_shader.get(), layout, buffers_},
          assembler_(target_,
                     desc.pixel_shader
                         ? std::span<Interpolation const>(desc.pixel_shader->info().interpolation)
                         : std::span<Interpolation const>(),
                     layout)
    {
        Rect const all = extent();
        for (std::size_t i = 0; i < target_.viewports.size(); ++i) {
            Viewport const& v = target_.viewports[i];
            // Implicit scissor: sums first, then floor (R98).
            Rect r =
                all.intersect({int(std::floor(v.x)), int(std::floor(v.y)),
                               int(std::floor(v.x + v.width)), int(std::floor(v.y + v.height))});
            if (target_.rasterizer.scissor_enable)
                r = r.intersect(i < target_.scissors.size() ? target_.scissors[i] : Rect{});
            setup_.bounds.push_back(r);
        }
        tiles_x = (all.right + kTileSize - 1) >> kTileShift;
        tiles_y = (all.bottom + kTileSize - 1) >> kTileShift;
        streams_ = TriangleStream::supports(setup_, triangles);
    }
    Raster(Raster const&) = delete;
    Raster& operator=(Raster const&) = delete;

    bool streams() const { return streams_; }

    // Assembles a chunk and sorts its primitives into tiles.
    void assemble(GeometryStages const& stages, Chunk& c) const
    {
        assembler_.project(c.shaded.data(), c.stride, c.stride, c.gs_viewport, c.assembled);
        stages.for_each_primitive(c, [&](std::uint32_t const* v, int n, std::int32_t id,
                                         std::uint8_t viewport) {
            assembler_.assemble(c.assembled, v, n, id, viewport, c.counters.assembly, c.primitives);
        });
        bin(c);
    }

    // Turns primitives into shaded fragments by tile. Only they and the counts stay in `slot`.
    void stream(GeometryStages const& stages, AssembledPrimitives const& primitives,
                float const* shaded_vertices, std::size_t first, std::size_t count, Chunk& slot,
                DrawMemory::Parts& memory)
    {
        Worker w = take_worker(memory);
        GeometryChunk& c = *w.chunk;
        w.stream->begin(c.assembled, slot.fragments);
        if (stages.tessellates()) {
            stages.run_by_patch(c, primitives, shaded_vertices, first, count, [&](std::size_t p) {
                std::size_t const points = (c.patterns[p]->patch.points() + 15) / 16 * 16;
                assembler_.project(c.shaded.data(), c.stride, points, {}, c.assembled);
                w.stream->add_patch(*c.patterns[p], std::int32_t(first + p), c.counters.assembly);
            });
        } else {
            stages.run(c, primitives, shaded_vertices, first, count);
            assembler_.project(c.shaded.data(), c.stride, c.stride, {}, c.assembled);
            stages.for_each_primitive(
                c, [&](std::uint32_t const* v, int, std::int32_t id, std::uint8_t) {
                    w.stream->add_triangle(v, id, c.counters.assembly);
                });
        }
        w.stream->end();
        slot.first = first;
        slot.count = count;
        slot.counters = c.counters;
        slot.fragment_count = w.stream->fragments();
        std::scoped_lock const lock(memory.idle_mutex);
        memory.idle.push_back(std::move(w.chunk));
        idle_.push_back(std::move(w.stream));
    }

    void rasterize(std::span<Chunk> wave, ThreadPool const& threads)
    {
        auto const tiles = std::size_t(tiles_x * tiles_y);
        std::vector<std::size_t> busy;
        for (std::size_t t = 0; t < tiles; ++t)
            for (Chunk const& c : wave)
                if (c.bin_start[t] != c.bin_start[t + 1]) {
                    busy.push_back(t);
                    break;
                }
        std::vector<RasterCounters> tile_counters(busy.size());
        threads.parallel_for(busy.size(), [&](std::size_t i) {
            std::size_t const t = busy[i];
            int const x = int(t) % tiles_x << kTileShift, y = int(t) / tiles_x << kTileShift;
            DenormalMode const flush(DenormalMode::Flush);
            TileRasterizer raster(setup_, {x, y, x + kTileSize, y + kTileSize}, tile_counters[i]);
            for (Chunk const& c : wave)
                for (std::uint32_t k = c.bin_start[t]; k < c.bin_start[t + 1]; ++k)
                    raster.draw(c.assembled, c.primitives[c.bin_primitives[k]]);
            raster.flush();
        });
        for (RasterCounters const& c : tile_counters) counters += c;
    }

    // The depth test of a wave's fragments. Returns how many there were.
    std::uint64_t merge(std::span<Chunk> wave, ThreadPool const& threads)
    {
        std::vector<std::uint64_t> passed(std::size_t(tiles_x * tiles_y));
        threads.parallel_for(passed.size(), [&](std::size_t t) {
            for (std::size_t i = 0; i < wave.size(); ++i) {
                if (i + 1 < wave.size()) wave[i + 1].fragments.prefetch(t);
                if (!wave[i].fragments.empty(t))
                    passed[t] += merge_fragments(target_, wave[i].fragments, t);
            }
        });
        std::uint64_t all = 0;
        for (std::uint64_t n : passed) all += n;
        counters.passed_samples += all;
        counters.pixel.invocations += all; // shading is pure: what fails might never have run
        counters.pixel.flops += setup_.pixel_shader->info().flops * all;
        std::uint64_t fragments = 0;
        for (Chunk const& c : wave) fragments += c.fragment_count;
        counters.covered_samples += fragments;
        return fragments;
    }

    StageBuffers const& buffers() const { return buffers_; }
    RasterTarget const& target() const { return target_; }

    RasterCounters counters;

private:
    // A geometry shader may choose any of 16; those not set are all zeros (R97, R99).
    static RasterTarget with_all_viewports(RasterTarget t, GraphicsPipelineDesc const& desc)
    {
        t.viewports.resize(desc.geometry_shader ? kMaxViewports
                                                : std::max<std::size_t>(1, t.viewports.size()));
        return t;
    }

    Rect extent() const
    {
        for (ColorTarget const* c : target_.color)
            if (c) return {0, 0, c->width(), c->height()};
        if (target_.depth) return {0, 0, target_.depth->width(), target_.depth->height()};
        if (target_.coverage) return {0, 0, target_.coverage->width, target_.coverage->height};
        Viewport const& v = target_.viewports[0]; // nothing bound (R6)
        auto const size = [](float to) {
            return std::clamp(int(std::floor(to)), 0, ColorTarget::kMaxSize);
        };
        return {0, 0, size(v.x + v.width), size(v.y + v.height)};
    }

    struct Worker {
        std::unique_ptr<GeometryChunk> chunk;
        std::unique_ptr<TriangleStream> stream;
    };
    Worker take_worker(DrawMemory::Parts& memory)
    {
        Worker w;
        {
            std::scoped_lock const lock(memory.idle_mutex);
            if (!memory.idle.empty()) {
                w.chunk = std::move(memory.idle.back());
                memory.idle.pop_back();
            }
            if (!idle_.empty()) {
                w.stream = std::move(idle_.back());
                idle_.pop_back();
            }
        }
        if (!w.chunk) w.chunk = std::make_unique<GeometryChunk>();
        if (!w.stream)
            w.stream = std::make_unique<TriangleStream>(setup_, assembler_, tiles_x, tiles_y);
        return w;
    }

    // Lists of primitives by tile, each in submission order (a counting sort).
    void bin(Chunk& c) const
    {
        auto const tiles = std::size_t(tiles_x * tiles_y);
        int const samples = target_.samples();
        bool const wide = target_.rasterizer.multisample_enable;
        c.bin_entries.clear();
        for (std::uint32_t i = 0; i < c.primitives.size(); ++i) {
            AssembledPrimitive const& p = c.primitives[i];
            Rect const r = primitive_bounds(c.assembled, p, samples, wide)
                               .intersect(setup_.bounds[p.viewport]);
            if (r.empty()) continue;
            for (int ty = r.top >> kTileShift; ty <= (r.bottom - 1) >> kTileShift; ++ty)
                for (int tx = r.left >> kTileShift; tx <= (r.right - 1) >> kTileShift; ++tx)
                    c.bin_entries.emplace_back(std::uint32_t(ty * tiles_x + tx), i);
        }
        c.bin_start.assign(tiles + 1, 0);
        for (auto const& [tile, primitive] : c.bin_entries) ++c.bin_start[tile + 1];
        for (std::size_t t = 0; t < tiles; ++t) c.bin_start[t + 1] += c.bin_start[t];
        c.bin_primitives.resize(c.bin_entries.size());
        std::vector<std::uint32_t> at(c.bin_start.begin(), c.bin_start.end() - 1);
        for (auto const& [tile, primitive] : c.bin_entries)
            c.bin_primitives[at[tile]++] = primitive;
    }

    RasterTarget target_;
    StageBuffers buffers_;
    RasterSetup setup_;
    PrimitiveAssembler assembler_;
    int tiles_x = 0, tiles_y = 0;
    bool streams_ = false;
    std::vector<std::unique_ptr<TriangleStream>> idle_; // of threads between chunks
};

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
          stages_(d_, call),
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
                      geometry_.input_touched, std::size_t(gs.input_floats()) * sizeof(float));
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
        std::size_t const constant_bytes = std::size_t(hs.patch_constant_floats()) * sizeof(float);
        StageStatistics& h = add_stage("hull_shader", hull_.invocations, hull_);
        add_fetch(h, "input_control_points", ResourceKind::ControlPoint, hull_.input_fetches,
                  hull_.input_touched, std::size_t(hs.input_floats()) * sizeof(float));
        if (hull_.output_fetches)
            add_fetch(h, "output_control_points", ResourceKind::ControlPoint, hull_.output_fetches,
                      hull_.output_touched, point_bytes);
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
                  domain_.input_touched, point_bytes);
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
    std::optional<Raster> raster_;
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
