// Rasterizer of one screen tile, for every state: points, lines, triangles, 1 to 8 samples.
//
// Coverage is exact: edge functions in 64-bit integers on 16.8 coordinates, top-left rule for areas
// (R101 to R103), the diamond rule for lines (R106). Interpolation weights are exact integers times
// the reciprocal of the area or length (I-15), so a pixel's values do not depend on the way it was
// reached. Fragments queue up in submission order, are shaded in dense groups and merged in order.
// Triangles in the common state take a faster way to the same bits (emu/triangle_stream.h).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/output_merger.h"
#include "emu/pixel_shader.h"
#include "emu/primitive_assembly.h"

namespace tessemu {

inline constexpr int kTileShift = 7, kTileSize = 1 << kTileShift;

/// The tiles of a target that a draw can reach.
struct TileGrid {
    int x = 0, y = 0, columns = 0, rows = 0; ///< the first one's column and row, and how many

    /// \param reached  pixels
    static TileGrid of(Rect const& reached)
    {
        if (reached.empty()) return {};
        TileGrid g{reached.left >> kTileShift, reached.top >> kTileShift, 0, 0};
        g.columns = ((reached.right - 1) >> kTileShift) + 1 - g.x;
        g.rows = ((reached.bottom - 1) >> kTileShift) + 1 - g.y;
        return g;
    }
    std::size_t size() const { return std::size_t(columns) * std::size_t(rows); }
    /// Of the tile in that column and row of the target.
    int number(int column, int row) const { return (row - y) * columns + (column - x); }
};

/// What rasterizing counted.
struct RasterCounters {
    StageCounters pixel;
    std::uint64_t covered_samples = 0; ///< after the sample mask, before the tests
    std::uint64_t passed_samples = 0;  ///< R165

    RasterCounters& operator+=(RasterCounters const& o)
    {
        pixel += o.pixel;
        covered_samples += o.covered_samples;
        passed_samples += o.passed_samples;
        return *this;
    }
};

/// Pixels that a primitive can touch.
Rect primitive_bounds(AssembledVertices const& vertices, AssembledPrimitive const& primitive,
                      int samples, bool multisample_lines);

/// Targets of a draw, drawn into tile by tile.
struct RasterSetup {
    RasterTarget const& target;
    std::vector<Rect> bounds;        ///< per viewport: viewport, scissor and target (R98)
    PixelShader const& pixel_shader; ///< none: depth and stencil only
    PixelShaderCost pixel_cost;
    OutputLayout layout; ///< of the vertices
    StageBuffers const& buffers;
    bool inclusive_edges = false; ///< see DrawMistakes
};

/// Draws primitives into one tile. Make one per tile and wave; feed primitives in order; flush() at
/// the end.
class TileRasterizer {
public:
    TileRasterizer(RasterSetup const& setup, Rect tile, RasterCounters& counters);

    void draw(AssembledVertices const& vertices, AssembledPrimitive const& primitive);
    void flush();

private:
    static constexpr std::size_t kQueue = 256, kGroup = 16;
    static constexpr std::size_t kRow = kQueue + kGroup;
    template <int kEdges> struct Area;
    struct Weights;
    struct Pixel;
    using Floats = std::vector<float>;

    template <int kEdges>
    void draw_area(Area<kEdges> const& area, Weights const& weights, Rect pixels);
    void draw_line(Weights const& weights, AssembledVertices const& vertices,
                   AssembledPrimitive const& p, Rect pixels);
    void draw_quad(Weights const& weights, int x, int y, std::uint32_t const (&covered)[4]);
    void push(Weights const& weights, int x, int y, int sample, std::uint32_t covered,
              std::uint32_t passed, bool live);
    void shade_and_merge();

    RasterSetup const& setup_;
    Rect tile_;
    RasterCounters& counters_;
    OutputMerger merger_;
    PixelShaderInfo info_;
    std::span<SampleOffset const> pattern_;
    std::uint32_t sample_mask_;
    bool early_, quads_;

    std::size_t queued_ = 0;
    std::int32_t pixel_x_[kRow], pixel_y_[kRow], primitive_id_[kRow], front_face_[kRow],
        sample_index_[kRow], covered_[kRow], passed_[kRow], live_[kRow], discard_[kRow],
        out_coverage_[kRow], viewport_[kRow];
    float position_[4][kRow], depth_[kRow];
    Floats sample_z_, attributes_, color_;
    std::vector<float const*> attribute_rows_;
    std::vector<float*> color_rows_;
};

} // namespace tessemu
