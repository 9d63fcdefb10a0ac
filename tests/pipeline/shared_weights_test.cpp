// By exhaustion over the rings of an interior vertex, valences 3 to 12, every pattern of triangles
// and quads: the weights of what belongs to the vertex have equal bits whichever of its patches
// they are made for, that is wherever the ring is entered and however the inputs are numbered.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/vertex_stencils.h"

#include <gtest/gtest.h>

#include <numeric>

namespace tessemu {
namespace {

// The ring entered at face `start`, input i numbered number[i]: 0 the vertex, 1 + j the far end of
// edge j, 1 + n + j the diagonal of face j.
CornerNeighbourhood ring(int n, unsigned pattern, int start, std::vector<int> const& number)
{
    CornerNeighbourhood c;
    for (int k = 0; k < n; ++k) {
        int const j = (start + k) % n, next = (j + 1) % n;
        auto const at = [&](int i) { return number[std::size_t(i)]; };
        if (pattern >> j & 1)
            c.faces.push_back({3, {at(0), at(1 + j), at(1 + next), 0}});
        else
            c.faces.push_back({4, {at(0), at(1 + j), at(1 + n + j), at(1 + next)}});
    }
    return c;
}

TEST(SharedWeights, DoNotDependOnThePatchForEveryRingUpToValenceTwelve)
{
    std::size_t rings = 0;
    for (int n = 3; n <= 12; ++n) {
        int const inputs = 1 + 2 * n;
        std::vector<int> plain(static_cast<std::size_t>(inputs)), turned = plain;
        std::iota(plain.begin(), plain.end(), 0);
        for (unsigned pattern = 0; pattern < 1u << n; ++pattern) {
            CornerNeighbourhood const first = ring(n, pattern, 0, plain);
            VertexStencils const reference(first, inputs, false);
            int const edge = int(pattern % unsigned(n)); // all of them, over the patterns
            StencilRow const p = reference.p(), q = reference.q(edge), r = reference.r(edge);
            // Entries of the ring: all for small valences, a few for large ones.
            int const step = n <= 8 ? 1 : 3;
            for (int start = 1; start < n; start += step) {
                for (int i = 0; i < inputs; ++i)
                    turned[std::size_t(i)] = (i * (inputs - 1) + start) % inputs;
                CornerNeighbourhood const other = ring(n, pattern, start, turned);
                VertexStencils const s(other, inputs, false);
                int const j = (edge - start + n) % n;
                StencilRow const p2 = s.p(), q2 = s.q(j), r2 = s.r(j);
                for (std::size_t i = 0; i < std::size_t(inputs); ++i) {
                    auto const k = std::size_t(turned[i]);
                    ASSERT_EQ(p[i], p2[k]) << n << " " << pattern << " " << start;
                    ASSERT_EQ(q[i], q2[k]) << n << " " << pattern << " " << start;
                    ASSERT_EQ(r[i], r2[k]) << n << " " << pattern << " " << start;
                }
                ++rings;
            }
        }
    }
    EXPECT_GT(rings, 20000u);
}

} // namespace
} // namespace tessemu
