// Samples of a patch's tables, and the cells between them.
//
//     triangle: row after row of v, u + v <= 1        quad: row after row of v
//     i + j (N + 1) - j (j - 1) / 2                   i + j (N + 1)
//
// at u = i/N, v = j/N in the tessellator's domain: a triangle's corners 0, 1, 2 are (1,0), (0,1),
// (0,0), a quad's 0 to 3 (0,0), (1,0), (1,1), (0,1).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace tessemu {

struct TableGrid {
    int sides;
    int segments; ///< N along a side

    int index(int i, int j) const
    {
        return i + j * (segments + 1) - (sides == 3 ? j * (j - 1) / 2 : 0);
    }
    int samples() const
    {
        return (segments + 1) * (sides == 3 ? segments + 2 : 2 * segments + 2) / 2;
    }
    /// (i, j) of corner k.
    std::array<int, 2> corner(int k) const
    {
        int const n = segments;
        if (sides == 3)
            return k == 0 ? std::array{n, 0} : k == 1 ? std::array{0, n} : std::array{0, 0};
        return {k == 1 || k == 2 ? n : 0, k >= 2 ? n : 0};
    }
    /// The sample at t = 0 to N from corner k on the way to corner k + 1.
    int on_side(int k, int t) const
    {
        auto const [ai, aj] = corner(k % sides);
        auto const [bi, bj] = corner((k + 1) % sides);
        return index(ai + (bi - ai) / segments * t, aj + (bj - aj) / segments * t);
    }
};

} // namespace tessemu
