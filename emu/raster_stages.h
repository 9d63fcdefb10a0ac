// The raster side of a draw, and the memory that its chunks live in.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/front_end.h"
#include "emu/rasterizer.h"
#include "emu/triangle_stream.h"

#include <mutex>
#include <optional>

namespace tessemu {

// A chunk and its primitives, or its shaded fragments, by tile.
struct DrawMemory::Parts {
    struct Chunk : FrontEndChunk {
        FragmentBins fragments;
        std::uint64_t fragment_count = 0;
        std::vector<std::uint32_t> bin_start, bin_primitives; // by tile, in submission order
        std::vector<std::pair<std::uint32_t, std::uint32_t>> bin_entries;
    };
    std::vector<Chunk> wave;
    std::vector<float> shaded_vertices;

    // What a thread owns while it works on a chunk.
    struct Worker {
        FrontEndChunk chunk; // of a chunk that streams
        TriangleStream stream;
        std::optional<TessellatorCache> patterns;
        TessellatorState state;
        std::uint64_t draw = 0; // that the stream is bound to
    };
    std::unique_ptr<Worker> take(TessellatorState const& state)
    {
        std::unique_ptr<Worker> w;
        {
            std::scoped_lock const lock(mutex);
            if (!idle.empty()) {
                w = std::move(idle.back());
                idle.pop_back();
            }
        }
        if (!w) w = std::make_unique<Worker>();
        if (!w->patterns || w->state != state) {
            w->patterns.emplace(state);
            w->state = state;
        }
        return w;
    }
    void give(std::unique_ptr<Worker> w)
    {
        std::scoped_lock const lock(mutex);
        idle.push_back(std::move(w));
    }
    std::mutex mutex;
    std::vector<std::unique_ptr<Worker>> idle;
    std::uint64_t draws = 0;
};

using Chunk = DrawMemory::Parts::Chunk;

/// The raster side of a draw: targets and what of them may be written; a chunk becomes primitives
/// or fragments by tile, on any thread; a wave of chunks is drawn tile by tile.
class RasterStages {
public:
    // \param triangles  whether nothing but triangles will reach the rasterizer
    RasterStages(RasterTarget const& target, GraphicsPipelineDesc const& desc, OutputLayout layout,
                 bool triangles, DrawMistakes const& mistakes);
    RasterStages(RasterStages const&) = delete;
    RasterStages& operator=(RasterStages const&) = delete;

    bool streams() const { return streams_; }

    // Assembles a chunk and sorts its primitives into tiles.
    void assemble(FrontEnd const& stages, Chunk& c) const;

    // Turns primitives into shaded fragments by tile. Only they and the counts stay in `slot`.
    void stream(FrontEnd const& stages, AssembledPrimitives const& primitives,
                float const* shaded_vertices, std::size_t first, std::size_t count, Chunk& slot,
                DrawMemory::Parts& memory);

    void rasterize(std::span<Chunk> wave, ThreadPool const& threads);

    // The depth test of a wave's fragments. Returns how many there were.
    std::uint64_t merge(std::span<Chunk> wave, ThreadPool const& threads);

    StageBuffers const& buffers() const { return buffers_; }
    RasterTarget const& target() const { return target_; }

    RasterCounters counters;

private:
    // A geometry shader may choose any of 16; those not set are all zeros (R97, R99).
    static RasterTarget with_all_viewports(RasterTarget t, GraphicsPipelineDesc const& desc);

    Rect extent() const;

    // Lists of primitives by tile, each in submission order (a counting sort).
    void bin(Chunk& c) const;

    RasterTarget target_;
    StageBuffers buffers_;
    RasterSetup setup_;
    PrimitiveAssembler assembler_;
    TileGrid tiles_;
    bool streams_ = false;
};

} // namespace tessemu
