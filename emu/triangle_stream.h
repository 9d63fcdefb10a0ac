// Triangles in the common state, many at a time, to the bits that emu/rasterizer.h gives one by
// one.
//
// The common state: solid triangles, one sample, depth LESS or LESS_EQUAL in 32-bit float, one
// colour target that is overwritten, a pixel shader of straight-line arithmetic. Such a shader has
// no side effect and the same cost everywhere, so fragments may be shaded before their depth test;
// what counts is what passes. And depth can but fall: a fragment that fails against what its pixel
// held at any time of the draw fails in order too, and need not be shaded (R163, I-16). It counts as
// covered.
//
// On the geometry side: set-up, rejection and coverage of small triangles with lanes over triangles,
// of larger ones with lanes over pixels; fragments dropped that lie behind what earlier waves left,
// attributes fetched once a triangle that is left, fragments shaded in dense groups and sorted into
// tiles. On the raster side, tile by tile: the depth test in submission order.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/triangle_coverage.h"

namespace tessemu {

/// What a thread needs to turn a chunk's triangles into fragments; reused from chunk to chunk.
class TriangleStream {
public:
    /// True if draws in this state may take this way.
    /// \param triangles  whether nothing else reaches the rasterizer
    static bool supports(RasterSetup const& setup, bool triangles);

    /// Starts a draw, whose `setup` and `assembler` must outlive it. Memory serves draw after draw.
    void bind(RasterSetup const& setup, PrimitiveAssembler const& assembler, TileGrid const& tiles);

    /// Starts a chunk whose fragments go to `bins`.
    void begin(AssembledVertices& vertices, FragmentBins& bins);
    /// All triangles of a tessellated patch, whose points are the vertices.
    void add_patch(DomainPoints const& pattern, std::int32_t primitive_id,
                   AssemblyCounters& counters);
    /// One triangle of any kind.
    void add_triangle(std::uint32_t const* v, std::int32_t primitive_id, AssemblyCounters& counters)
    {
        single_.add(*vertices_, v, primitive_id, counters);
    }
    void end() { shading_.shade(); }

    /// Fragments of the chunk that ended.
    std::uint64_t fragments() const { return covered_.fragments() + single_.fragments(); }

private:
    RasterSetup const* setup_ = nullptr;
    AssembledVertices* vertices_ = nullptr;
    FragmentShading shading_;
    SingleTriangles single_{shading_};
    CoveredPixels covered_{shading_};
    TriangleCoverage coverage_{covered_, single_};
};

} // namespace tessemu
