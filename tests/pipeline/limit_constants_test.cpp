// Cosines of fractions of pi, and LOOP09's constants by valence.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/limit_constants.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tessemu {
namespace {

TEST(CosPi, IsTheCosineToTwoUlp)
{
    for (int b = 1; b <= 64; ++b)
        for (int a = -2 * b; a <= 4 * b; ++a) {
            // Range reduction in long double keeps the comparison itself exact enough.
            double const expected = double(std::cos(acosl(-1.0L) * a / b));
            EXPECT_NEAR(cos_pi(a, b), expected, 2 * 0x1p-53) << a << "/" << b;
            EXPECT_EQ(cos_pi(a, b), cos_pi(-a, b));
            EXPECT_EQ(cos_pi(a, b), cos_pi(a + 2 * b, b));
            EXPECT_NEAR(sin_pi(a, b), double(std::sin(acosl(-1.0L) * a / b)), 2 * 0x1p-53);
        }
    EXPECT_EQ(cos_pi(1, 2), 0.0);
    EXPECT_EQ(cos_pi(1, 3), 0.5);
    EXPECT_EQ(cos_pi(2, 3), -0.5);
    EXPECT_EQ(cos_pi(1, 1), -1.0);
}

// The table of docs/math/loop09.md, 1.
TEST(Loop09, LambdaAndSigmaAreThePagesValues)
{
    struct {
        int n;
        double lambda, sigma;
    } const rows[] = {{3, .410097051, .485071250}, {4, .5, .471404521},
                      {5, .549988355, .463514246}, {6, .579682326, .458831468},
                      {7, .598510283, .455878072}, {8, .611116527, .453910359},
                      {9, .619939221, .452538622}, {12, .634796412, .450239800}};
    for (auto const& r : rows) {
        EXPECT_NEAR(loop09_lambda(r.n), r.lambda, 5e-10) << r.n;
        EXPECT_NEAR(loop09_sigma(r.n), r.sigma, 5e-10) << r.n;
    }
}

} // namespace
} // namespace tessemu
