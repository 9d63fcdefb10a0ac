// Ink on a figure's paper: captions and shapes with smooth edges.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/encoded_picture.h"

#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>

namespace tessemu {

inline constexpr float kInk[4] = {0.15f, 0.16f, 0.2f, 1}, kPaper[4] = {1, 1, 1, 1};
inline constexpr char kFont[] = "DejaVuSans";

inline OIIO::ImageBuf blank_paper(int width, int height)
{
    OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 4, OIIO::TypeDesc::FLOAT));
    OIIO::ImageBufAlgo::fill(image, kPaper);
    return image;
}

/// A line of text, its middle at height y. Throws WriteError on a computer without the font.
inline void write_text(OIIO::ImageBuf& image, int x, int y, std::string const& line,
                       OIIO::ImageBufAlgo::TextAlignX align, int size = 15)
{
    if (!OIIO::ImageBufAlgo::render_text(image, x, y, line, size, kFont, kInk, align,
                                         OIIO::ImageBufAlgo::TextAlignY::Center))
        throw WriteError("captions need the font DejaVu Sans (fonts-dejavu-core): " +
                         image.geterror());
}

/// A shape within a clip, its edge smooth over a pixel.
/// \param distance  (x, y) in pixels: from the shape's edge, negative inside
template <class Distance>
void paint(OIIO::ImageBuf& image, OIIO::ROI const& clip, float const (&color)[4],
           Distance const& distance)
{
    for (int y = clip.ybegin; y < clip.yend; ++y)
        for (int x = clip.xbegin; x < clip.xend; ++x) {
            auto const covered = float(std::clamp(0.5 - distance(x + 0.5, y + 0.5), 0.0, 1.0));
            if (covered == 0) continue;
            float pixel[4];
            image.getpixel(x, y, pixel);
            for (int c = 0; c < 4; ++c) pixel[c] += covered * (color[c] - pixel[c]);
            image.setpixel(x, y, pixel);
        }
}

inline void write_image(OIIO::ImageBuf const& image, OutputFile& out)
{
    write_encoded(out, image.spec().width, image.spec().height,
                  [&](OIIO::ImageOutput& file) { return image.write(&file); });
}

} // namespace tessemu
