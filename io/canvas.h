// Figures are drawn on a canvas: pictures, captions and shapes with smooth edges.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/image_writer.h"
#include "io/picture_library.h"

#include <algorithm>
#include <array>

namespace tessemu {

inline constexpr float kInk[4] = {0.15f, 0.16f, 0.2f, 1}, kPaper[4] = {1, 1, 1, 1};

/// White paper.
class Canvas {
public:
    using Align = PictureLibrary::Align;

    Canvas(int width, int height);

    int width() const { return width_; }
    int height() const { return height_; }
    /// On the canvas.
    float* pixel(int x, int y)
    {
        return pixels_.data() + 4 * (std::size_t(y) * std::size_t(width_) + std::size_t(x));
    }
    float const* pixel(int x, int y) const { return const_cast<Canvas*>(this)->pixel(x, y); }
    void set(int x, int y, float const* rgba)
    {
        if (x >= 0 && x < width_ && y >= 0 && y < height_) std::copy_n(rgba, 4, pixel(x, y));
    }

    /// A line of text, its middle at height y. Throws WriteError on a computer without the font
    /// DejaVu Sans.
    void text(int x, int y, std::string const& line, Align align, int size = 15);
    static int text_width(std::string const& line, int size);
    /// The same from bottom to top, its middle at (x, y), in a strip of `strip` pixels.
    void upright_text(int x, int y, std::string const& line, int size, int strip);

    /// A shape within a clip, its edge smooth over a pixel.
    /// \param distance  (x, y) in pixels: from the shape's edge, negative inside
    template <class Distance>
    void paint(Rect const& clip, float const (&color)[4], Distance const& distance)
    {
        for (int y = std::max(clip.top, 0); y < std::min(clip.bottom, height_); ++y)
            for (int x = std::max(clip.left, 0); x < std::min(clip.right, width_); ++x) {
                auto const covered = float(std::clamp(0.5 - distance(x + 0.5, y + 0.5), 0.0, 1.0));
                if (covered == 0) continue;
                float* const p = pixel(x, y);
                for (int c = 0; c < 4; ++c) p[c] += covered * (color[c] - p[c]);
            }
    }

    /// As .png or .exr; the caller commits.
    void write(OutputFile& out) const;

private:
    int width_, height_;
    std::vector<float> pixels_;
};

} // namespace tessemu
