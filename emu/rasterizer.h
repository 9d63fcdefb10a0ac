// Rasterizer and output merger of one screen tile: coverage, depth test, shading, colour.
//
// Coverage is exact: edge functions in 64-bit integers on 16.8 coordinates, top-left rule (R101 to
// R103). Barycentric weights are the exact edge values times the reciprocal of the area (I-15), so
// a pixel's values do not depend on the way it was reached. Depth is tested early (LESS, 32-bit
// float); surviving fragments queue up in submission order and are shaded in dense groups.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/pixel_shader.h"
#include "emu/primitive_assembly.h"

namespace tessemu {

inline constexpr int kTileSize = 64;

/// Draws triangles into one tile of a target. Make one per tile and wave; feed triangles in order;
/// flush() at the end.
class TileRasterizer {
public:
    /// \param bounds  the pixels of this tile that may be written
    TileRasterizer(RenderTarget& target, Rect bounds, Viewport const& viewport,
                   PixelProgram const* pixel_shader, StageBuffers const& buffers,
                   StageCounters& counters);

    void draw(AssembledVertices const& vertices, AssembledTriangle const& triangle);
    void flush();

    std::uint64_t covered_samples() const { return covered_; }
    std::uint64_t depth_passes() const { return passes_; }

private:
    static constexpr std::size_t kQueue = 256, kGroup = 16;
    static constexpr int kMaxAttributes = 28;

    RenderTarget& target_;
    Rect bounds_;
    float min_depth_, max_depth_;
    PixelProgram const* pixel_shader_;
    StageBuffers const& buffers_;
    StageCounters& counters_;
    int attributes_;
    std::uint64_t covered_ = 0, passes_ = 0;

    std::size_t queued_ = 0;
    std::int32_t pixel_x_[kQueue + kGroup], pixel_y_[kQueue + kGroup];
    float position_[4][kQueue + kGroup];
    float color_[4][kQueue + kGroup];
    std::int32_t primitive_id_[kQueue + kGroup], front_face_[kQueue + kGroup];
    std::vector<float> attribute_storage_;
    std::vector<float const*> attribute_rows_;
};

} // namespace tessemu
