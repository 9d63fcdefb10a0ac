// What test suites draw: a quad over the whole clip square, and colours as words.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <cstring>

namespace tessemu::test {

/// A vertex in clip space.
inline void add_clip(Scene& s, std::array<float, 4> position,
                     std::array<float, 4> value = {1, 1, 1, 1})
{
    s.vertices.insert(s.vertices.end(), position.begin(), position.end());
    s.vertices.insert(s.vertices.end(), value.begin(), value.end());
}

/// The strip (-1,-1) (-1,1) (1,-1) (1,1), clockwise on the screen, at z with w = 1, as the scene's
/// only vertices, a value for each corner.
inline void set_corners(Scene& s, std::array<std::array<float, 4>, 4> const& values, float z = 0)
{
    s.call.topology = PrimitiveTopology::TriangleStrip;
    s.vertices.clear();
    for (std::size_t i = 0; i < 4; ++i)
        add_clip(s, {i < 2 ? -1.0f : 1.0f, i % 2 ? 1.0f : -1.0f, z, 1}, values[i]);
}
/// The same with one value.
inline void set_quad(Scene& s, std::array<float, 4> const& value = {1, 1, 1, 1}, float z = 0)
{
    set_corners(s, {value, value, value, value}, z);
}

/// A pixel of four bytes as the word that holds it: 0xAABBGGRR of R8G8B8A8.
inline std::uint32_t word(ColorTarget const& target, int x, int y, int s = 0)
{
    std::uint32_t w;
    std::memcpy(&w, target.texel(x, y, s), 4);
    return w;
}

/// Whether each of a word's four bytes is within so many codes of another's.
inline testing::AssertionResult near_word(std::uint32_t ours, std::uint32_t theirs, int codes)
{
    for (int shift = 0; shift < 32; shift += 8)
        if (std::abs(int(ours >> shift & 255) - int(theirs >> shift & 255)) > codes)
            return testing::AssertionFailure()
                   << std::hex << ours << " is not within " << codes << " codes of " << theirs;
    return testing::AssertionSuccess();
}

/// Rows y0 to y1 - 1 of columns x0 to x1 - 1 are drawn (red is not 0), and nothing else.
inline testing::AssertionResult only_drawn(Scene const& s, Rect r)
{
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x) {
            bool const in = x >= r.left && x < r.right && y >= r.top && y < r.bottom;
            if ((s.at(x, y) != 0) != in)
                return testing::AssertionFailure()
                       << "pixel " << x << "," << y << (in ? " is not drawn" : " is drawn");
        }
    return testing::AssertionSuccess();
}

} // namespace tessemu::test
