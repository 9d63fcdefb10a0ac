// The coverage view against exact integers, before any depth test.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/sanitized.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

namespace tessemu::test {
namespace {

struct Corner {
    std::int64_t x, y; // 1/256 pixel
};

// Rules R102 and R104 in 64-bit integers.
bool covers(Corner a, Corner b, Corner c, std::int64_t x, std::int64_t y)
{
    std::int64_t const area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0) return false;
    if (area < 0) std::swap(b, c);
    Corner const v[4] = {a, b, c, a};
    for (int i = 0; i < 3; ++i) {
        std::int64_t const dx = v[i + 1].x - v[i].x, dy = v[i + 1].y - v[i].y;
        std::int64_t const e = dx * (y - v[i].y) - dy * (x - v[i].x);
        if (e < 0 || (e == 0 && !(dy < 0 || (dy == 0 && dx > 0)))) return false;
    }
    return true;
}

class Random {
public:
    std::int64_t below(std::int64_t n)
    {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return std::int64_t((state_ >> 33) % std::uint64_t(n));
    }

private:
    std::uint64_t state_ = 20261124;
};

// Pairs of triangles on opposite sides of a shared edge, a cell of 16x16 pixels each.
TEST(Coverage, AMillionPairsOnASharedEdgeEqualTheOracleSampleBySample)
{
    constexpr int kCell = 16, kCells = 32, kSize = kCell * kCells;
    constexpr int kDraws = (test::kSlow ? 50000 : 1000000) / (kCells * kCells) + 1;
    Random random;
    std::uint64_t wrong = 0, twice = 0, covered = 0;
    Scene s(kSize, kSize);
    s.desc.pixel_shader = nullptr;
    CoverageCounts counts(kSize, kSize);
    s.target.coverage = &counts;
    for (int d = 0; d < kDraws; ++d) {
        std::vector<Corner> corners;
        s.vertices.clear();
        for (int cell = 0; cell < kCells * kCells; ++cell) {
            std::int64_t const ox = cell % kCells * kCell * 256, oy = cell / kCells * kCell * 256;
            // Coarse places make edges through sample points common.
            std::int64_t const step = random.below(3) ? (random.below(2) ? 128 : 64) : 1;
            auto const corner = [&] {
                std::int64_t const n = kCell * 256 / step + 1;
                return Corner{ox + random.below(n) * step, oy + random.below(n) * step};
            };
            Corner const a = corner(), b = corner();
            auto const side = [&](Corner c) {
                return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
            };
            Corner c = corner(), e = corner();
            for (int tries = 0; tries < 20 && side(c) <= 0; ++tries) c = corner();
            for (int tries = 0; tries < 20 && side(e) >= 0; ++tries) e = corner();
            if (side(c) <= 0) c = a; // no room on that side: nothing to see
            if (side(e) >= 0) e = a;
            bool const turned = random.below(2);
            std::array<Corner, 6> const pair{a, b, c, turned ? a : b, turned ? b : a, e};
            for (Corner v : pair) {
                corners.push_back(v);
                s.add(float(v.x) / 256, float(v.y) / 256);
            }
        }
        std::fill(counts.count.begin(), counts.count.end(), 0u);
        s.draw();
        for (int y = 0; y < kSize; ++y)
            for (int x = 0; x < kSize; ++x) {
                auto const cell = std::size_t(y / kCell * kCells + x / kCell);
                Corner const* const v = corners.data() + 6 * cell;
                std::int64_t const cx = x * 256 + 128, cy = y * 256 + 128;
                unsigned const expected = unsigned(covers(v[0], v[1], v[2], cx, cy)) +
                                          unsigned(covers(v[3], v[4], v[5], cx, cy));
                std::uint32_t const n = counts.at(x, y, 0);
                wrong += n != expected;
                twice += n > 1;
                covered += n;
            }
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_EQ(twice, 0u);
    EXPECT_GT(covered, kDraws * 10240u); // ten samples a cell: most have two triangles in them
}

TEST(Coverage, TwoTrianglesOnOneEdgeCoverThirtySixPixelsOnceInBothOrientations)
{
    float const p[4][2] = {{0.5f, 0.49993896484375f},
                           {0.5f, 6.5f},
                           {6.50006103515625f, 0.49993896484375f},
                           {6.50006103515625f, 6.5f}};
    for (auto second : {std::array{3, 2, 1}, {3, 1, 2}}) {
        Scene s(8, 8);
        CoverageCounts counts(8, 8);
        s.target.coverage = &counts;
        for (int i : {0, 1, 2}) s.add(p[i][0], p[i][1]);
        for (int i : second) s.add(p[i][0], p[i][1]);
        s.draw();
        std::uint32_t all = 0;
        for (std::uint32_t n : counts.count) {
            EXPECT_LE(n, 1u);
            all += n;
        }
        EXPECT_EQ(all, 36u);
    }
}

} // namespace
} // namespace tessemu::test
