// Fixed-function state of a draw: viewport, scissor, rasterizer, render target.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessemu {

struct Viewport {
    float x = 0, y = 0, width = 0, height = 0, min_depth = 0, max_depth = 1;
};

/// Pixels left <= x < right, top <= y < bottom.
struct Rect {
    int left = 0, top = 0, right = 0, bottom = 0;

    Rect intersect(Rect const& o) const
    {
        return {std::max(left, o.left), std::max(top, o.top), std::min(right, o.right),
                std::min(bottom, o.bottom)};
    }
    bool empty() const { return left >= right || top >= bottom; }
};

enum class CullMode { None, Front, Back };

struct RasterizerState {
    CullMode cull = CullMode::Back;
    bool front_counter_clockwise = false; ///< R104: otherwise clockwise on the target is front
    bool scissor_enable = false;
    Rect scissor;
};

/// Colour (four 32-bit floats) and depth (32-bit float), rows from the top, cleared to
/// `clear_color` and 1.
class RenderTarget {
public:
    /// Throws LimitError outside 1 to 16384 pixels an axis (R112 asks for 2^15 addressable; D3D11's
    /// textures end at 2^14).
    RenderTarget(int width, int height, std::array<float, 4> clear_color = {0, 0, 0, 0});

    static constexpr int kMaxSize = 16384;
    /// Rows are padded so that a group of pixels never crosses into the next row.
    static constexpr int kPadding = 16;

    int width() const { return width_; }
    int height() const { return height_; }
    std::size_t pitch() const { return pitch_; } ///< pixels from row to row
    float* depth_row(int y) { return depth_.data() + std::size_t(y) * pitch_; }
    float const* depth_row(int y) const { return depth_.data() + std::size_t(y) * pitch_; }
    std::array<float, 4>* color_row(int y) { return color_.data() + std::size_t(y) * pitch_; }
    std::array<float, 4> const* color_row(int y) const
    {
        return color_.data() + std::size_t(y) * pitch_;
    }

private:
    int width_, height_;
    std::size_t pitch_;
    std::vector<float> depth_;
    std::vector<std::array<float, 4>> color_;
};

} // namespace tessemu
