// One draw: the stages run in waves of patches, spread over threads.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"
#include "emu/rasterizer.h"

#include <cmath>
#include <mutex>
#include <thread>

namespace tessemu {

namespace {

constexpr std::size_t kPatchesPerChunk = 8;
constexpr std::size_t kTrianglesPerChunk = 512; // of a draw without tessellation
constexpr std::size_t kChunksPerWave = 64;
constexpr std::size_t kPadding = 16; // whole groups of lanes are written

std::size_t padded(std::size_t n)
{
    return (n + kPadding - 1) / kPadding * kPadding;
}

// The work of one chunk: a few patches from control points to binned triangles.
struct Chunk {
    std::vector<float> control_points, patch_constants;
    std::vector<TessFactors> factors;
    std::vector<std::shared_ptr<DomainPoints const>> patterns;
    std::vector<std::size_t> first_point; // of each patch, padded
    std::vector<float> shaded;
    std::size_t stride = 0;
    AssembledVertices assembled;
    std::vector<AssembledTriangle> triangles;
    std::vector<std::uint32_t> bin_start, bin_triangles; // by tile, in submission order
    std::vector<std::pair<std::uint32_t, std::uint32_t>> bin_entries;
    StageCounters hull, domain;
    AssemblyCounters assembly;
    std::uint64_t tessellated_points = 0, tessellated_indices = 0;
};

class Drawing {
public:
    Drawing(GraphicsPipeline const& pipeline, DrawCall const& call, RasterTarget const* raster,
            PatchVisitor const& visit, ThreadPool const& threads, DrawOptions const& options)
        : d_(pipeline.desc()),
          call_(call),
          raster_(raster),
          visit_(visit),
          threads_(threads),
          options_(options),
          vs_buffers_(d_.vertex_shader->resources()),
          hs_buffers_(d_.hull_shader ? d_.hull_shader->resources() : std::vector<ResourceInfo>{}),
          ds_buffers_(d_.domain_shader ? d_.domain_shader->resources()
                                       : std::vector<ResourceInfo>{}),
          ps_buffers_(d_.pixel_shader ? d_.pixel_shader->resources() : std::vector<ResourceInfo>{})
    {
        if (!raster_) return;
        Viewport const& v = raster_->viewport;
        // Implicit scissor: sums first, then floor (R98).
        Rect const implied{int(std::floor(v.x)), int(std::floor(v.y)),
                           int(std::floor(v.x + v.width)), int(std::floor(v.y + v.height))};
        bounds_ =
            Rect{0, 0, raster_->target->width(), raster_->target->height()}.intersect(implied);
        if (raster_->rasterizer.scissor_enable)
            bounds_ = bounds_.intersect(raster_->rasterizer.scissor);
        tiles_x_ = (raster_->target->width() + kTileSize - 1) / kTileSize;
        tiles_y_ = (raster_->target->height() + kTileSize - 1) / kTileSize;
    }

    DrawStatistics run()
    {
        primitives_ = assemble_primitives(call_);
        stats_.pipeline.IAPrimitives = primitives_.primitives();
        stats_.pipeline.IAVertices = primitives_.vertices.size();
        run_vertex_shader();

        std::size_t const per_chunk = d_.hull_shader ? kPatchesPerChunk : kTrianglesPerChunk;
        std::size_t const chunks = (primitives_.primitives() + per_chunk - 1) / per_chunk;
        std::vector<Chunk> wave(std::min(chunks, kChunksPerWave));
        for (std::size_t first = 0; first < chunks; first += kChunksPerWave) {
            std::size_t const n = std::min(kChunksPerWave, chunks - first);
            threads_.parallel_for(n, [&](std::size_t i) {
                std::size_t const p = (first + i) * per_chunk;
                run_geometry(wave[i], p, std::min(per_chunk, primitives_.primitives() - p));
            });
            for (std::size_t i = 0; i < n; ++i) finish_geometry(wave[i], (first + i) * per_chunk);
            if (raster_) rasterize(std::span(wave).first(n));
            if (options_.progress)
                options_.progress(std::min((first + n) * per_chunk, primitives_.primitives()),
                                  primitives_.primitives());
        }
        report();
        return std::move(stats_);
    }

private:
    // The cache decides which vertices run, and run again after a miss. They run in blocks; a
    // repeated run gives the same bits, so only the first one writes and threads never share a
    // place.
    void run_vertex_shader()
    {
        VertexProgram const& vs = *d_.vertex_shader;
        std::uint32_t const limit = primitives_.vertex_id_limit;
        shaded_vertices_.resize(std::size_t(limit) * std::size_t(vs.output_floats()));
        VertexCache cache(options_.vertex_cache, limit);
        std::vector<char> shaded(limit, 0);
        constexpr std::size_t kBlock = 1 << 16, kPiece = 1 << 11;
        std::vector<std::uint32_t> fresh, repeated;

        auto const run = [&](std::vector<std::uint32_t>& ids, float* outputs) {
            std::size_t const pieces = (ids.size() + kPiece - 1) / kPiece;
            std::vector<StageCounters> counters(pieces);
            threads_.parallel_for(pieces, [&](std::size_t i) {
                std::size_t const n = std::min(kPiece, ids.size() - i * kPiece);
                vs.run(std::span(ids).subspan(i * kPiece, n), call_.vertices, outputs, counters[i],
                       vs_buffers_);
            });
            for (StageCounters const& c : counters) vertex_ += c;
            ids.clear();
        };
        auto const flush = [&] {
            vertex_.input_touched += fresh.size();
            run(fresh, shaded_vertices_.data());
            run(repeated, nullptr);
        };
        for (std::uint32_t v : primitives_.vertices) {
            if (cache.access(v)) continue;
            (shaded[v] ? repeated : fresh).push_back(v);
            shaded[v] = 1;
            if (fresh.size() + repeated.size() == kBlock) flush();
        }
        flush();
        stats_.pipeline.VSInvocations = vertex_.invocations;
    }

    void run_geometry(Chunk& c, std::size_t first, std::size_t count) const
    {
        DenormalMode const flush(DenormalMode::Flush); // fixed function between the stages
        c.hull = c.domain = StageCounters{};
        c.assembly = AssemblyCounters{};
        c.triangles.clear();
        if (d_.hull_shader)
            shade_patches(c, first, count);
        else
            gather_triangles(c, first, count);
        if (!raster_) return;

        int const components = d_.domain_shader ? d_.domain_shader->output_floats()
                                                : d_.vertex_shader->output_floats();
        project_vertices(raster_->viewport, c.shaded.data(), c.stride, c.stride, components,
                         c.assembled);
        auto const assemble = [&](std::uint32_t a, std::uint32_t b, std::uint32_t e,
                                  std::size_t id) {
            assemble_triangle(raster_->rasterizer, raster_->viewport, c.assembled, a, b, e,
                              std::int32_t(id), c.assembly, c.triangles);
        };
        if (!d_.hull_shader) {
            for (std::uint32_t t = 0; t < count; ++t)
                assemble(3 * t, 3 * t + 1, 3 * t + 2, first + t);
        } else if (d_.output_primitive != OutputPrimitive::Point) {
            for (std::size_t p = 0; p < count; ++p) {
                auto const base = std::uint32_t(c.first_point[p]);
                auto const& index = c.patterns[p]->patch.indices;
                for (std::size_t i = 0; i + 2 < index.size(); i += 3)
                    assemble(base + index[i], base + index[i + 1], base + index[i + 2], first + p);
            }
        }
        bin(c);
    }

    void shade_patches(Chunk& c, std::size_t first, std::size_t count) const
    {
        HullProgram const& hs = *d_.hull_shader;
        DomainProgram const& ds = *d_.domain_shader;
        std::size_t const point_floats =
            std::size_t(hs.control_points() * hs.control_point_floats());
        std::size_t const constant_floats =
            std::size_t(hs.patch_constants() * hs.patch_constant_floats());
        c.control_points.resize(count * point_floats);
        c.patch_constants.resize(count * constant_floats);
        c.factors.resize(count);
        auto const n = std::size_t(call_.control_points);
        hs.run({primitives_.vertices.subspan(first * n, count * n), shaded_vertices_.data(),
                call_.control_points, std::uint32_t(first), count, c.control_points.data(),
                c.patch_constants.data(), c.factors.data()},
               c.hull, hs_buffers_);

        c.patterns.resize(count);
        c.first_point.resize(count);
        std::size_t points = 0;
        c.tessellated_points = c.tessellated_indices = 0;
        TessellatorCache& cache = tessellator_cache();
        for (std::size_t p = 0; p < count; ++p) {
            c.patterns[p] = cache.find(c.factors[p]);
            c.first_point[p] = points;
            points += padded(c.patterns[p]->patch.points());
            c.tessellated_points += c.patterns[p]->patch.points();
            c.tessellated_indices += c.patterns[p]->patch.indices.size();
        }
        c.stride = points;
        c.shaded.resize(points * std::size_t(ds.output_floats()));
        StageScope const scope(c.domain, ds_buffers_, ds.seed());
        for (std::size_t p = 0; p < count; ++p) {
            DomainPoints const& d = *c.patterns[p];
            ds.run({c.control_points.data() + p * point_floats,
                    c.patch_constants.data() + p * constant_floats, std::int32_t(first + p),
                    d.u.data(), d.v.data(), d.patch.points(), c.shaded.data() + c.first_point[p],
                    c.stride},
                   hs.patch_constants(), c.domain);
        }
    }

    // Without tessellation: the vertex shader's outputs, three vertices a triangle.
    void gather_triangles(Chunk& c, std::size_t first, std::size_t count) const
    {
        auto const out = std::size_t(d_.vertex_shader->output_floats());
        c.stride = padded(3 * count);
        c.shaded.assign(c.stride * out, 0.0f);
        for (std::size_t i = 0; i < 3 * count; ++i) {
            float const* const v =
                shaded_vertices_.data() + primitives_.vertices[3 * first + i] * out;
            for (std::size_t k = 0; k < out; ++k) c.shaded[k * c.stride + i] = v[k];
        }
    }

    // Lists of triangles by tile, each in submission order (a counting sort of (tile, triangle)).
    void bin(Chunk& c) const
    {
        auto const tiles = std::size_t(tiles_x_ * tiles_y_);
        c.bin_entries.clear();
        for (std::uint32_t i = 0; i < c.triangles.size(); ++i) {
            std::uint32_t const* v = c.triangles[i].v;
            auto const& X = c.assembled.x;
            auto const& Y = c.assembled.y;
            Rect const pixels =
                pixel_bounds({X[v[0]], X[v[1]], X[v[2]]}, {Y[v[0]], Y[v[1]], Y[v[2]]})
                    .intersect(bounds_);
            if (pixels.empty()) continue;
            for (int ty = pixels.top / kTileSize; ty <= (pixels.bottom - 1) / kTileSize; ++ty)
                for (int tx = pixels.left / kTileSize; tx <= (pixels.right - 1) / kTileSize; ++tx)
                    c.bin_entries.emplace_back(std::uint32_t(ty * tiles_x_ + tx), i);
        }
        c.bin_start.assign(tiles + 1, 0);
        for (auto const& [tile, triangle] : c.bin_entries) ++c.bin_start[tile + 1];
        for (std::size_t t = 0; t < tiles; ++t) c.bin_start[t + 1] += c.bin_start[t];
        c.bin_triangles.resize(c.bin_entries.size());
        std::vector<std::uint32_t> at(c.bin_start.begin(), c.bin_start.end() - 1);
        for (auto const& [tile, triangle] : c.bin_entries) c.bin_triangles[at[tile]++] = triangle;
    }

    void finish_geometry(Chunk& c, std::size_t first)
    {
        hull_ += c.hull;
        domain_ += c.domain;
        tessellated_points_ += c.tessellated_points;
        tessellated_indices_ += c.tessellated_indices;
        stats_.pipeline.CInvocations += c.assembly.clip_invocations;
        stats_.pipeline.CPrimitives += c.assembly.clip_primitives;
        if (!visit_ || !d_.hull_shader) return;
        for (std::size_t p = 0; p < c.hull.invocations; ++p)
            visit_({std::uint32_t(first + p), c.patterns[p].get(),
                    c.shaded.data() + c.first_point[p], c.stride});
    }

    void rasterize(std::span<Chunk> wave)
    {
        auto const tiles = std::size_t(tiles_x_ * tiles_y_);
        std::vector<std::size_t> busy;
        for (std::size_t t = 0; t < tiles; ++t)
            for (Chunk const& c : wave)
                if (c.bin_start[t] != c.bin_start[t + 1]) {
                    busy.push_back(t);
                    break;
                }
        struct TileCounters {
            StageCounters pixel;
            std::uint64_t covered = 0, passes = 0;
        };
        std::vector<TileCounters> counters(busy.size());
        threads_.parallel_for(busy.size(), [&](std::size_t i) {
            std::size_t const t = busy[i];
            int const x = int(t) % tiles_x_ * kTileSize, y = int(t) / tiles_x_ * kTileSize;
            Rect const tile = bounds_.intersect({x, y, x + kTileSize, y + kTileSize});
            DenormalMode const flush(DenormalMode::Flush);
            TileRasterizer raster(*raster_->target, tile, raster_->viewport, d_.pixel_shader.get(),
                                  ps_buffers_, counters[i].pixel);
            for (Chunk const& c : wave)
                for (std::uint32_t k = c.bin_start[t]; k < c.bin_start[t + 1]; ++k)
                    raster.draw(c.assembled, c.triangles[c.bin_triangles[k]]);
            raster.flush();
            counters[i].covered = raster.covered_samples();
            counters[i].passes = raster.depth_passes();
        });
        for (TileCounters const& c : counters) {
            pixel_ += c.pixel;
            covered_samples_ += c.covered;
            depth_passes_ += c.passes;
        }
    }

    TessellatorCache& tessellator_cache() const
    {
        std::scoped_lock const lock(cache_mutex_);
        auto& slot = caches_[std::this_thread::get_id()];
        if (!slot)
            slot = std::make_unique<TessellatorCache>(
                TessellatorState{d_.hull_shader->domain(), d_.partitioning, d_.output_primitive});
        return *slot;
    }

    void report()
    {
        PipelineStatistics& p = stats_.pipeline;
        auto const add = [&](char const* name, std::uint64_t invocations,
                             StageCounters const& c) -> StageStatistics& {
            stats_.stages.push_back({name, invocations, c.flops, {}, 0});
            return stats_.stages.back();
        };
        auto const fetch = [](StageStatistics& s, char const* name, ResourceKind kind,
                              std::uint64_t n, std::uint64_t unique, std::size_t bytes) {
            s.fetches.push_back({name, kind, n, n * bytes, unique * bytes});
        };

        StageStatistics& ia = add("input_assembler", p.IAPrimitives, {});
        if (primitives_.index_bytes)
            fetch(ia, "indices", ResourceKind::Index, p.IAVertices, p.IAVertices,
                  primitives_.index_bytes);

        VertexProgram const& vs = *d_.vertex_shader;
        StageStatistics& v = add("vertex_shader", vertex_.invocations, vertex_);
        fetch(v, "vertices", ResourceKind::Vertex, vertex_.input_fetches, vertex_.input_touched,
              std::size_t(vs.input_floats()) * sizeof(float));
        vs_buffers_.report(vertex_, v);
        v.output_bytes = vertex_.invocations * std::uint64_t(vs.output_floats()) * sizeof(float);

        if (d_.hull_shader) {
            HullProgram const& hs = *d_.hull_shader;
            DomainProgram const& ds = *d_.domain_shader;
            p.HSInvocations = hull_.invocations;
            p.HSControlPointInvocations = hull_.invocations * std::uint64_t(hs.control_points());
            p.HSPatchConstantInvocations =
                hull_.invocations * std::uint64_t(hs.patch_constants() + 1);
            std::size_t const point_bytes = std::size_t(hs.control_point_floats()) * sizeof(float);
            std::size_t const constant_bytes =
                std::size_t(hs.patch_constant_floats()) * sizeof(float);
            StageStatistics& h = add("hull_shader", hull_.invocations, hull_);
            fetch(h, "input_control_points", ResourceKind::ControlPoint, hull_.input_fetches,
                  hull_.input_touched, std::size_t(hs.input_floats()) * sizeof(float));
            if (hull_.output_fetches)
                fetch(h, "output_control_points", ResourceKind::ControlPoint, hull_.output_fetches,
                      hull_.output_touched, point_bytes);
            if (hull_.constant_fetches)
                fetch(h, "patch_constants", ResourceKind::PatchConstant, hull_.constant_fetches,
                      hull_.constant_touched, constant_bytes);
            hs_buffers_.report(hull_, h);
            h.output_bytes =
                hull_.invocations * (std::uint64_t(hs.control_points()) * point_bytes +
                                     std::uint64_t(hs.patch_constants()) * constant_bytes +
                                     std::uint64_t(tess_factor_count(hs.domain())) * sizeof(float));

            StageStatistics& t = add("tessellator", hull_.invocations, {});
            t.output_bytes = tessellated_points_ * 2 * sizeof(float) +
                             tessellated_indices_ * sizeof(std::uint32_t);

            p.DSInvocations = domain_.invocations;
            StageStatistics& s = add("domain_shader", domain_.invocations, domain_);
            fetch(s, "control_points", ResourceKind::ControlPoint, domain_.input_fetches,
                  domain_.input_touched, point_bytes);
            fetch(s, "patch_constants", ResourceKind::PatchConstant, domain_.constant_fetches,
                  domain_.constant_touched, constant_bytes);
            ds_buffers_.report(domain_, s);
            s.output_bytes =
                domain_.invocations * std::uint64_t(ds.output_floats()) * sizeof(float);
        }
        if (!raster_) return;
        StageStatistics& r = add("rasterizer", p.CPrimitives, {});
        r.output_bytes = covered_samples_ * sizeof(float);
        p.PSInvocations = pixel_.invocations;
        StageStatistics& ps = add("pixel_shader", pixel_.invocations, pixel_);
        ps_buffers_.report(pixel_, ps);
        ps.output_bytes = pixel_.invocations * 4 * sizeof(float);
        std::uint64_t const color_bytes = ps.output_bytes;
        StageStatistics& om = add("output_merger", covered_samples_, {});
        om.output_bytes = depth_passes_ * sizeof(float) + color_bytes;
    }

    GraphicsPipelineDesc const& d_;
    DrawCall const& call_;
    RasterTarget const* raster_;
    PatchVisitor const& visit_;
    ThreadPool const& threads_;
    DrawOptions const& options_;
    StageBuffers vs_buffers_, hs_buffers_, ds_buffers_, ps_buffers_;
    Rect bounds_;
    int tiles_x_ = 0, tiles_y_ = 0;

    AssembledPrimitives primitives_;
    std::vector<float> shaded_vertices_;
    StageCounters vertex_, hull_, domain_, pixel_;
    std::uint64_t tessellated_points_ = 0, tessellated_indices_ = 0;
    std::uint64_t covered_samples_ = 0, depth_passes_ = 0;
    DrawStatistics stats_;
    mutable std::mutex cache_mutex_;
    mutable std::unordered_map<std::thread::id, std::unique_ptr<TessellatorCache>> caches_;
};

} // namespace

DrawStatistics draw(GraphicsPipeline const& pipeline, DrawCall const& call,
                    RasterTarget const* raster, PatchVisitor const& visit,
                    ThreadPool const& threads, DrawOptions const& options)
{
    GraphicsPipelineDesc const& d = pipeline.desc();
    if (call.vertex_floats != d.vertex_shader->input_floats())
        throw Error("the vertex buffer's record is not the vertex shader's input");
    bool const patches = call.topology == PrimitiveTopology::PatchList;
    if (patches != (d.hull_shader != nullptr))
        throw Error("patch lists need a hull shader and triangle lists must not have one (R3, R4)");
    if (patches && call.control_points != d.input_control_points)
        throw Error("the draw has " + std::to_string(call.control_points) +
                    " control points per patch, the pipeline was created for " +
                    std::to_string(d.input_control_points));
    return Drawing(pipeline, call, raster, visit, threads, options).run();
}

} // namespace tessemu
