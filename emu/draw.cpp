// One draw: the stages run in waves of primitives, spread over threads.
//
// Geometry work is spread over chunks of primitives, raster work over screen tiles; a chunk's lists
// are replayed in submission order, so results do not depend on the schedule (R1, R2).
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/draw_report.h"
#include "emu/raster_stages.h"

namespace tessemu {

DrawMemory::DrawMemory() : parts_(std::make_unique<Parts>()) {}
DrawMemory::~DrawMemory() = default;
DrawMemory::DrawMemory(DrawMemory&&) noexcept = default;
DrawMemory& DrawMemory::operator=(DrawMemory&&) noexcept = default;

namespace {

constexpr std::size_t kPatchesPerChunk = 8, kPatchesPerCountedChunk = 32;
constexpr std::size_t kPrimitivesPerChunk = 512; // of a draw without tessellation
constexpr std::size_t kChunksPerWave = 128;
// A draw that streams keeps fragments only: waves grow or shrink until they hold about so many. After
// each the depth target hides what comes behind it, so waves are as small as threads allow.
constexpr std::uint64_t kFragmentsPerWave = std::uint64_t(1) << 17;
constexpr std::size_t kFewestChunksPerWave = 16, kChunksPerThread = 8, kMostChunksPerWave = 4096;
// Where patches have few fragments, chunks grow before waves have more than so many: each costs a
// set of counters and a list for each tile.
constexpr std::size_t kManyChunks = 128, kMostPatchesPerChunk = 128;

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
          vs_buffers_(d_.vertex_shader.resources()),
          memory_(options.memory ? *options.memory : own_memory_),
          shaded_vertices_(memory_.parts().shaded_vertices)
    {
        ++memory_.parts().draws;
        if (rasterization_is_on(d_, target))
            raster_.emplace(*target, d_, stages_.output(), stages_.makes_triangles(),
                            options.mistakes);
        if (d_.stream_output) stream_output_.emplace(*d_.stream_output, options.stream_output);
    }

    DrawStatistics run()
    {
        primitives_ = assemble_primitives(call_);
        for (std::uint32_t i = 0; i < call_.instance_count; ++i) run_instance(i);
        report_draw({d_, call_, primitives_, stages_, vs_buffers_, raster_ ? &*raster_ : nullptr,
                     stream_output_ ? &*stream_output_ : nullptr, counters_},
                    stats_);
        return std::move(stats_);
    }

private:
    void run_instance(std::uint32_t instance)
    {
        std::size_t const all = primitives_.primitives();
        stats_.pipeline.IAPrimitives += all;
        stats_.pipeline.IAVertices += primitives_.stream.size();
        run_vertex_shader(instance);
        std::vector<Chunk>& wave = memory_.parts().wave;
        bool const streams = raster_ && raster_->streams() && !visit_ && !stream_output_;
        bool const counts_only =
            !raster_ && !visit_ && !stream_output_ && stages_.tessellates() && !d_.geometry_shader;
        std::size_t per_wave = streams ? fewest_chunks() : kChunksPerWave;
        std::size_t per_chunk = counts_only      ? kPatchesPerCountedChunk
                                : d_.hull_shader ? kPatchesPerChunk
                                                 : kPrimitivesPerChunk;
        for (std::size_t first = 0; first < all;) {
            std::size_t const n = std::min(per_wave, (all - first + per_chunk - 1) / per_chunk);
            if (wave.size() < n) wave.resize(n);
            threads_.parallel_for(n, [&](std::size_t i) {
                DenormalMode const flush(DenormalMode::Flush); // fixed function between the stages
                std::size_t const p = first + i * per_chunk;
                std::size_t const count = std::min(per_chunk, all - p);
                float const* const vertices = shaded_vertices_.data();
                if (streams)
                    return raster_->stream(stages_, primitives_, vertices, p, count, wave[i],
                                           memory_.parts());
                auto worker = memory_.parts().take(stages_.tessellator_state());
                if (counts_only) { // nobody looks at the points
                    stages_.run_by_patch(worker->chunk, *worker->patterns, primitives_, vertices, p,
                                         count, [](std::size_t) {});
                    wave[i].counters = worker->chunk.counters;
                } else {
                    stages_.run(wave[i], *worker->patterns, primitives_, vertices, p, count);
                }
                memory_.parts().give(std::move(worker));
                if (raster_) raster_->assemble(stages_, wave[i]);
            });
            for (std::size_t i = 0; i < n; ++i) finish_geometry(wave[i]);
            std::span<Chunk> const done = std::span(wave).first(n);
            first = std::min(first + n * per_chunk, all);
            if (streams) {
                per_wave = next_wave(n, raster_->merge(done, threads_));
                for (; d_.hull_shader && per_wave > kManyChunks && per_chunk < kMostPatchesPerChunk;
                     per_chunk *= 2)
                    per_wave = (per_wave + 1) / 2;
            } else if (raster_) {
                raster_->rasterize(done, threads_);
            }
            if (options_.progress) options_.progress(first, all);
        }
    }

    std::size_t fewest_chunks() const
    {
        return std::max(kFewestChunksPerWave, kChunksPerThread * std::size_t(threads_.threads()));
    }
    std::size_t next_wave(std::size_t chunks, std::uint64_t fragments) const
    {
        std::uint64_t const fit =
            chunks * kFragmentsPerWave / std::max<std::uint64_t>(1, fragments);
        std::size_t const most = std::min(4 * chunks + kChunksPerWave, kMostChunksPerWave);
        return std::size_t(std::clamp<std::uint64_t>(fit, std::min(fewest_chunks(), most), most));
    }

    // The cache decides which vertices run, and run again after a miss. They run in blocks; a
    // repeated run gives the same bits, so only the first one writes and threads never share a
    // place. Where lanes do not bend control flow and nothing is fetched, each run costs the same:
    // repeated ones are counted only.
    void run_vertex_shader(std::uint32_t instance)
    {
        VertexShader const& vs = d_.vertex_shader;
        std::uint32_t const limit = primitives_.vertex_id_limit;
        shaded_vertices_.resize(std::size_t(limit) * std::size_t(vs->output_floats()));
        VertexCache cache(options_.vertex_cache, limit);
        std::vector<char> shaded(limit, 0);
        constexpr std::size_t kBlock = 1 << 16, kPiece = 1 << 9;
        StageCounters all;

        auto const run = [&](std::span<std::uint32_t const> ids, float* outputs) {
            std::size_t const pieces = (ids.size() + kPiece - 1) / kPiece;
            std::vector<StageCounters> counters(pieces);
            threads_.parallel_for(pieces, [&](std::size_t i) {
                std::size_t const n = std::min(kPiece, ids.size() - i * kPiece);
                vs.run(VertexBatch{ids.subspan(i * kPiece, n), call_, primitives_, instance},
                       outputs, counters[i], vs_buffers_);
            });
            for (StageCounters const& c : counters) all += c;
        };
        std::span<std::uint32_t const> const stream = primitives_.stream;
        std::vector<std::uint32_t> fresh(std::min(kBlock, stream.size())), repeated(fresh.size());
        for (std::size_t first = 0; first < stream.size(); first += kBlock) {
            std::size_t fresh_ones = 0, repeated_ones = 0;
            for (std::uint32_t v : stream.subspan(first, std::min(kBlock, stream.size() - first))) {
                bool const miss = !cache.access(v), again = shaded[v];
                fresh[fresh_ones] = repeated[repeated_ones] = v;
                fresh_ones += miss & !again;
                repeated_ones += miss & again;
                shaded[v] = 1;
            }
            all.input_touched += fresh_ones;
            run(std::span(fresh).first(fresh_ones), shaded_vertices_.data());
            if (all.features == 0 && repeated_ones > 0) {
                all.flops += all.flops / all.invocations * repeated_ones;
                all.invocations += repeated_ones;
                all.input_fetches += repeated_ones;
            } else {
                run(std::span(repeated).first(repeated_ones), nullptr);
            }
        }
        counters_.vertex += all;
        stats_.pipeline.VSInvocations = counters_.vertex.invocations;
    }

    void finish_geometry(Chunk& c)
    {
        FrontEndCounters const& g = c.counters;
        counters_.hull += g.hull;
        counters_.domain += g.domain;
        counters_.geometry += g.geometry;
        counters_.tessellated_points += g.tessellated_points;
        counters_.tessellated_indices += g.tessellated_indices;
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

    GraphicsPipelineDesc const& d_;
    DrawCall const& call_;
    PatchVisitor const& visit_;
    ThreadPool const& threads_;
    DrawOptions const& options_;
    FrontEnd stages_;
    StageBuffers vs_buffers_;
    std::optional<RasterStages> raster_;
    std::optional<StreamOutput> stream_output_;

    AssembledPrimitives primitives_;
    DrawMemory own_memory_;
    DrawMemory& memory_;
    std::vector<float>& shaded_vertices_;
    DrawCounters counters_;
    DrawStatistics stats_;
};

} // namespace

DrawStatistics draw(GraphicsPipeline const& pipeline, DrawCall const& call,
                    RasterTarget const* raster, PatchVisitor const& visit,
                    ThreadPool const& threads, DrawOptions const& options)
{
    check_draw(pipeline.desc(), call, raster, options.stream_output.size());
    return Drawing(pipeline, call, raster, visit, threads, options).run();
}

} // namespace tessemu
