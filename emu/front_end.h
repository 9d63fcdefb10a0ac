// The geometry side of a draw: a chunk of primitives from control points to assembled primitives.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_pipeline.h"
#include "emu/primitive_assembly.h"

namespace tessemu {

struct FrontEndCounters {
    StageCounters hull, domain, geometry;
    AssemblyCounters assembly;
    std::uint64_t tessellated_points = 0, tessellated_indices = 0, factors_above_max = 0;
    std::uint64_t geometry_primitives = 0; ///< that the geometry shader emitted
};

/// A few primitives on their way. Memory is reused from wave to wave.
struct FrontEndChunk {
    std::size_t first = 0, count = 0; ///< input primitives
    // Tessellation.
    std::vector<float> control_points, patch_constants;
    std::vector<TessFactors> factors;
    std::vector<std::shared_ptr<DomainPoints const>> patterns;
    std::vector<std::size_t> first_point; ///< of each patch, padded
    // The last geometry stage's vertices, component k of vertex i at [k * stride + i].
    std::vector<float> shaded;
    std::size_t stride = 0;
    GeometryResult gs;
    std::vector<std::int32_t> gs_primitive_id; ///< of rasterized primitives
    std::vector<std::uint8_t> gs_viewport;     ///< of rasterized vertices
    // Ready for the rasterizer.
    AssembledVertices assembled;
    std::vector<AssembledPrimitive> primitives;

    FrontEndCounters counters;
};

/// Runs hull shader, tessellator, domain shader and geometry shader over chunks, on any thread.
class FrontEnd {
public:
    FrontEnd(GraphicsPipelineDesc const& desc, DrawCall const& call, DrawMistakes const& mistakes);

    /// \param cache  of no other thread at the time
    void run(FrontEndChunk& chunk, TessellatorCache& cache, AssembledPrimitives const& primitives,
             float const* shaded_vertices, std::size_t first, std::size_t count) const;

    /// The same for tessellated patches without a geometry shader, one patch at a time:
    /// patch(p) finds the points of patch p alone in chunk.shaded, so that they stay in the cache.
    template <class Patch>
    void run_by_patch(FrontEndChunk& chunk, TessellatorCache& cache,
                      AssembledPrimitives const& primitives, float const* shaded_vertices,
                      std::size_t first, std::size_t count, Patch&& patch) const
    {
        start(chunk, first, count);
        hull_and_tessellate(chunk, cache, primitives, shaded_vertices);
        for (std::size_t p = 0; p < count; ++p) {
            shade_patch_alone(chunk, p);
            patch(p);
        }
    }

    /// work(v, n, primitive_id, viewport) for each primitive of n vertices that goes to the
    /// rasterizer, in order; v are columns of chunk.shaded.
    template <class Work> void for_each_primitive(FrontEndChunk const& c, Work&& work) const
    {
        if (d_.geometry_shader) {
            auto const n = std::uint32_t(d_.geometry_shader->vertices_per_output());
            for (std::uint32_t p = 0; p < c.gs_primitive_id.size(); ++p) {
                std::uint32_t const v[3] = {n * p, n * p + 1, n * p + 2};
                work(v, int(n), c.gs_primitive_id[p], c.gs_viewport[n * p]);
            }
            return;
        }
        for_each_input_primitive(c, [&](std::uint32_t const* v, int n, std::int32_t id) {
            work(v, n, id, std::uint8_t(0));
        });
    }

    /// Writes the chunk's primitives to stream output. Call in submission order.
    void stream_out(FrontEndChunk const& chunk, StreamOutput& out) const;

    OutputLayout output() const;
    bool tessellates() const { return bool(d_.hull_shader); }
    /// Of the patterns that the draw needs; any where it does not tessellate.
    TessellatorState tessellator_state() const
    {
        if (!tessellates()) return {};
        return {d_.hull_shader->domain(), d_.partitioning, d_.output_primitive};
    }
    /// True if nothing but triangles reaches the rasterizer.
    bool makes_triangles() const;
    StageBuffers const& hull_buffers() const { return hs_buffers_; }
    StageBuffers const& domain_buffers() const { return ds_buffers_; }
    StageBuffers const& geometry_buffers() const { return gs_buffers_; }

private:
    // What reaches the geometry shader, or the rasterizer where there is none.
    template <class Work> void for_each_input_primitive(FrontEndChunk const& c, Work&& work) const
    {
        if (!d_.hull_shader) {
            auto const per =
                std::uint32_t(vertices_per_primitive(call_.topology, call_.control_points));
            bool const adjacency = !d_.geometry_shader && is_adjacency(call_.topology);
            for (std::uint32_t p = 0; p < c.count; ++p) {
                std::uint32_t v[32];
                int n = int(per);
                for (std::uint32_t k = 0; k < per; ++k) v[k] = per * p + k;
                if (adjacency && per == 4) v[0] = 4 * p + 1, v[1] = 4 * p + 2, n = 2; // R28
                if (adjacency && per == 6) v[1] = 6 * p + 2, v[2] = 6 * p + 4, n = 3;
                work(static_cast<std::uint32_t const*>(v), n, std::int32_t(c.first + p));
            }
            return;
        }
        int const n = d_.output_primitive == OutputPrimitive::Point  ? 1
                      : d_.output_primitive == OutputPrimitive::Line ? 2
                                                                     : 3;
        for (std::size_t p = 0; p < c.count; ++p) {
            auto const base = std::uint32_t(c.first_point[p]);
            TessellatedPatch const& patch = c.patterns[p]->patch;
            auto const id = std::int32_t(c.first + p);
            if (n == 1) {
                for (std::uint32_t i = 0; i < patch.points(); ++i) {
                    std::uint32_t const v[1] = {base + i};
                    work(static_cast<std::uint32_t const*>(v), 1, id);
                }
                continue;
            }
            for (std::size_t i = 0; i < patch.indices.size(); i += std::size_t(n)) {
                std::uint32_t v[3] = {};
                for (int k = 0; k < n; ++k) v[k] = base + patch.indices[i + std::size_t(k)];
                work(static_cast<std::uint32_t const*>(v), n, id);
            }
        }
    }
    static bool is_adjacency(PrimitiveTopology t)
    {
        return t >= PrimitiveTopology::LineListAdj && t <= PrimitiveTopology::TriangleStripAdj;
    }

    static void start(FrontEndChunk& c, std::size_t first, std::size_t count);
    void hull_and_tessellate(FrontEndChunk& c, TessellatorCache& cache,
                             AssembledPrimitives const& primitives,
                             float const* shaded_vertices) const;
    void shade_patches(FrontEndChunk& c) const;
    void shade_patch_alone(FrontEndChunk& c, std::size_t p) const;
    void run_domain_shader(FrontEndChunk& c, std::size_t p) const;
    void gather(FrontEndChunk& c, AssembledPrimitives const& primitives,
                float const* shaded_vertices) const;
    void run_geometry_shader(FrontEndChunk& c) const;

    GraphicsPipelineDesc const& d_;
    DrawCall const& call_;
    DrawMistakes mistakes_;
    StageBuffers hs_buffers_, ds_buffers_, gs_buffers_;
};

} // namespace tessemu
