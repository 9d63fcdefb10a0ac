// SPDX-License-Identifier: Apache-2.0
#include "emu/lanes.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace tessemu {
namespace {

std::uint32_t bits(float x)
{
    return std::bit_cast<std::uint32_t>(x);
}

// Any float, special values often.
rc::Gen<float> any_float()
{
    return rc::gen::map(rc::gen::pair(rc::gen::inRange(0, 4), rc::gen::arbitrary<std::uint32_t>()),
                        [](auto const& p) {
                            float const special[] = {0.0f,    -0.0f,    1.0f,      -1.0f, 1e-40f,
                                                     -1e-40f, INFINITY, -INFINITY, NAN,   0.5f};
                            return p.first == 0 ? special[p.second % 10]
                                                : std::bit_cast<float>(p.second);
                        });
}

bool same(float a, float b)
{
    return bits(a) == bits(b) || (std::isnan(a) && std::isnan(b));
}

template <class L> class LanesOf : public testing::Test {
};
using Widths = testing::Types<Lanes<4>, Lanes<8>, Lanes<16>>;
TYPED_TEST_SUITE(LanesOf, Widths);

TYPED_TEST(LanesOf, EveryOperationEqualsTheScalarBitForBit)
{
    using L = TypeParam;
    bool const ok = rc::check([] {
        constexpr int N = lanes_of<L>;
        float a[N], b[N], c[N];
        L x, y, z;
        for (int i = 0; i < N; ++i) {
            x.raw[i] = a[i] = *any_float();
            y.raw[i] = b[i] = *any_float();
            z.raw[i] = c[i] = *any_float();
        }
        L const sum = x + y, difference = x - y, product = x * y, quotient = x / y, negative = -x;
        L const root = sqrt(x), low = floor(x), magnitude = abs(x), least = min(x, y),
                most = max(x, y);
        L const fused = mad(x, y, z), chosen = select(x < y, x, y);
        auto const less = (x < y).bits();
        for (int i = 0; i < N; ++i) {
            RC_ASSERT(same(sum.raw[i], a[i] + b[i]));
            RC_ASSERT(same(difference.raw[i], a[i] - b[i]));
            RC_ASSERT(same(product.raw[i], a[i] * b[i]));
            RC_ASSERT(same(quotient.raw[i], a[i] / b[i]));
            RC_ASSERT(same(negative.raw[i], -a[i]));
            RC_ASSERT(same(root.raw[i], tessemu::sqrt(a[i])));
            RC_ASSERT(same(low.raw[i], tessemu::floor(a[i])));
            RC_ASSERT(same(magnitude.raw[i], std::fabs(a[i])));
            RC_ASSERT(same(least.raw[i], tessemu::min(a[i], b[i])));
            RC_ASSERT(same(most.raw[i], tessemu::max(a[i], b[i])));
            RC_ASSERT(same(fused.raw[i], tessemu::mad(a[i], b[i], c[i])));
            RC_ASSERT(same(chosen.raw[i], a[i] < b[i] ? a[i] : b[i]));
            RC_ASSERT(((less >> i) & 1) == std::uint32_t(a[i] < b[i]));
        }
    });
    EXPECT_TRUE(ok);
}

TYPED_TEST(LanesOf, AConstantKeepsTheSignOfZero)
{
    TypeParam const z(-0.0f);
    EXPECT_EQ(bits(z.raw[0]), 0x80000000u);
    EXPECT_EQ(bits(TypeParam(0.0f).raw[0]), 0u);
}

TYPED_TEST(LanesOf, MaskBitsAreLanesInOrder)
{
    constexpr int N = lanes_of<TypeParam>;
    for (int n = 0; n <= N; ++n) EXPECT_EQ(Mask<N>::first(n).bits(), (1u << n) - 1);
    EXPECT_TRUE(any(Mask<N>::first(1)));
    EXPECT_FALSE(any(Mask<N>::first(0)));
    EXPECT_TRUE(all(Mask<N>::first(N)));
    EXPECT_FALSE(all(Mask<N>::first(N - 1)));
}

TYPED_TEST(LanesOf, IntegersWrap)
{
    IntLanes<lanes_of<TypeParam>> const big(0x7fffffff);
    EXPECT_EQ((big + big).raw[0], -2);
    EXPECT_EQ((big * big).raw[0], 1);
    EXPECT_EQ((big << IntLanes<lanes_of<TypeParam>>(1)).raw[0], -2);
}

// Rules R12, R18 and the choice I-5.
TEST(MinMax, LoseNanAndOrderSignedZeros)
{
    EXPECT_EQ(tessemu::min(1.0f, NAN), 1.0f);
    EXPECT_EQ(tessemu::min(NAN, 1.0f), 1.0f);
    EXPECT_EQ(tessemu::max(1.0f, NAN), 1.0f);
    EXPECT_EQ(tessemu::max(NAN, 1.0f), 1.0f);
    EXPECT_EQ(bits(tessemu::min(0.0f, -0.0f)), 0x80000000u);
    EXPECT_EQ(bits(tessemu::min(-0.0f, 0.0f)), 0x80000000u);
    EXPECT_EQ(bits(tessemu::max(0.0f, -0.0f)), 0u);
    EXPECT_EQ(bits(tessemu::max(-0.0f, 0.0f)), 0u);
    DenormalMode const flush(DenormalMode::Flush);
    volatile float tiny = 1e-40f;
    EXPECT_EQ(bits(tessemu::max(tiny, -1.0f)), 0u);
}

// The fallback for processors without the instruction, against the instruction.
RC_GTEST_PROP(FusedMultiplyAdd, ExactFallbackEqualsTheInstruction, ())
{
    float const a = *any_float(), b = *any_float();
    float const close = -a * b; // cancellation is where double rounding would show
    float const c = *rc::gen::oneOf(any_float(), rc::gen::just(close),
                                    rc::gen::just(std::nextafter(close, 1.0f)));
    float const exact = fused_multiply_add_exact(a, b, c);
#ifdef __FMA__
    RC_ASSERT(same(exact, __builtin_fmaf(a, b, c)));
#else
    RC_ASSERT(same(exact, std::fma(a, b, c)));
#endif
}

// A tie that double rounding gets wrong: the sum's low part decides it.
TEST(FusedMultiplyAdd, RoundsOnce)
{
    float const a = 1.0f + 0x1p-23f, b = 1.0f + 0x1p-23f, c = 0x1p-60f;
    EXPECT_EQ(fused_multiply_add_exact(a, b, c), std::fma(a, b, c));
    float const d = 0x1.000002p0f, e = 0x1p-24f;
    EXPECT_EQ(fused_multiply_add_exact(d, e, 1.0f), std::fma(d, e, 1.0f));
}

} // namespace
} // namespace tessemu
