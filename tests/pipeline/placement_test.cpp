// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/placement.h"

#include "emu/error.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace tessemu {
namespace {

using Points = std::vector<glm::dvec3>;

// A box of 1 x 2 x 2, whose diagonal is 3, moved and scaled.
Points box(glm::dvec3 center, double scale = 1)
{
    glm::dvec3 const half(0.5, 1, 1);
    return {(center - half) * scale, (center + half) * scale};
}

TEST(Placement, AMeshNearTheOriginAndOfUsualSizeStandsAsInItsFile)
{
    for (double x : {0.0, 1.0, 24.0}) // 8 diagonals and no more
        EXPECT_TRUE(Placement(box({x, 0, 0})).is_identity()) << x;
    for (int k : {-20, -21, 18}) // diagonals of 2^-20 times 3, 3/2; the most below 2^20
        EXPECT_TRUE(Placement(box({0, 0, 0}, std::ldexp(1.0, k))).is_identity()) << k;
    EXPECT_FALSE(Placement(box({24.5, 0, 0})).is_identity());
    EXPECT_FALSE(Placement(box({0, 0, 0}, std::ldexp(1.0, -22))).is_identity());
    EXPECT_FALSE(Placement(box({0, 0, 0}, std::ldexp(1.0, 19))).is_identity());
}

TEST(Placement, MovesByMultiplesOfAPowerOfTwoThatIsAtLeastTheDiagonal)
{
    Placement const p(box({1001, -7, 0.5}));
    EXPECT_TRUE(p.is_moved());
    glm::dvec3 const shift = p.to_file(glm::dvec3(0));
    EXPECT_EQ(shift, glm::dvec3(1000, -8, 0)); // multiples of 4
    EXPECT_EQ(p.length_from_file(5), 5);
}

// So a mesh and the same mesh times 2^40 are one in the program.
TEST(Placement, FilesThatDifferBy2To40GiveTheSameMesh)
{
    for (double size : {1e-5, 0.7, 3.0, 1e5})
        for (double x : {0.1, 700.3})
            for (int k : {-200, -80, -40, 40, 80, 200}) {
                Points const at_home = box({x, 2, 3}, size),
                             away = box({x, 2, 3}, std::ldexp(size, k));
                Placement const home(at_home), p(away);
                for (std::size_t i = 0; i < 2; ++i) {
                    EXPECT_EQ(p.from_file(away[i]), home.from_file(at_home[i])) << size << " " << k;
                    EXPECT_EQ(p.length_from_file(std::ldexp(1.0, k)), 1);
                }
            }
}

RC_GTEST_PROP(Placement, MovesAndScalesPointsExactly, ())
{
    auto const number = [] { return double(*rc::gen::inRange<std::int64_t>(-(1 << 22), 1 << 22)); };
    auto const far = [] {
        return double(
            *rc::gen::inRange<std::int64_t>(-(std::int64_t(1) << 50), std::int64_t(1) << 50));
    };
    double const scale = std::ldexp(1.0, *rc::gen::inRange(-100, 100));
    glm::dvec3 const offset(far(), far(), far());
    Points points;
    for (int i = 0; i < 4; ++i)
        points.push_back((offset + glm::dvec3(number(), number(), number())) * scale);
    RC_PRE(points[0] != points[1]);
    Placement const p(points);
    for (glm::dvec3 const& x : points) {
        glm::dvec3 const own((x - p.to_file(glm::dvec3(0))) * p.length_from_file(1));
        RC_ASSERT(p.to_file(own) == x);
        RC_ASSERT(p.from_file(x) == glm::vec3(own));
    }
}

TEST(Placement, LeavesAnAxisWhoseValuesAreNearTheOrigin)
{
    Placement const p(Points{{10000, 0.3, -0.7}, {10000.5, 1.9, -0.7}});
    EXPECT_EQ(p.to_file(glm::dvec3(0)), glm::dvec3(10000, 0, 0));
    EXPECT_EQ(p.from_file({10000, 0.3, 0}).y, 0.3f);
}

// The error of a difference is a double too, by Knuth's TwoSum.
TEST(Placement, SubtractsTheShiftFromAnyDoublesExactly)
{
    std::mt19937_64 bits(1);
    auto const number = [&](int exponent) { // below 2^exponent, of 53 bits
        return std::ldexp(double(std::int64_t(bits()) >> 10), exponent - 53);
    };
    int moved = 0;
    for (int n = 0; n < 20000; ++n) {
        glm::dvec3 center;
        for (int k = 0; k < 3; ++k) center[k] = number(int(bits() % 16));
        Points points(3, center);
        for (glm::dvec3& p : points)
            for (int k = 0; k < 3; ++k) p[k] += number(int(bits() % 8) - 6);
        Placement const placement(points);
        glm::dvec3 const shift = placement.to_file(glm::dvec3(0));
        for (glm::dvec3 const& p : points)
            for (int k = 0; k < 3; ++k) {
                double const d = p[k] - shift[k], b = p[k] - d, a = d + b;
                ASSERT_EQ((p[k] - a) + (b - shift[k]), 0) << p[k] << " - " << shift[k];
                moved += shift[k] != 0;
            }
    }
    EXPECT_GT(moved, 20000);
}

TEST(Placement, RefusesAMeshWithoutExtentOrBeyondAllNumbers)
{
    EXPECT_THROW(Placement(Points{}), Error);
    EXPECT_THROW(Placement(Points{{1, 2, 3}, {1, 2, 3}}), Error);
    EXPECT_THROW(Placement(box({0, 0, 0}, 1e-101)), Error);
    EXPECT_THROW(Placement(box({0, 0, 0}, 1e100)), Error);
    EXPECT_THROW(Placement(box({0, 0, 0}, 1e200)), Error);
}

} // namespace
} // namespace tessemu
