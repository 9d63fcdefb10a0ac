// SPDX-License-Identifier: Apache-2.0
#include "emu/lane_memory.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

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

// Where the compiler knows an operand there is another way to the same bits.
template <class L, std::uint32_t kBits> void expect_same_with_constant(L a)
{
    float const c = std::bit_cast<float>(kBits);
    L const least = min(a, L(c)), most = max(a, L(c)), least2 = min(L(c), a), most2 = max(L(c), a);
    for (int i = 0; i < lanes_of<L>; ++i) {
        float const x = a.raw[i];
        EXPECT_TRUE(same(least.raw[i], tessemu::min(x, c))) << x << " " << c;
        EXPECT_TRUE(same(most.raw[i], tessemu::max(x, c))) << x << " " << c;
        EXPECT_TRUE(same(least2.raw[i], tessemu::min(c, x))) << x << " " << c;
        EXPECT_TRUE(same(most2.raw[i], tessemu::max(c, x))) << x << " " << c;
    }
}
TYPED_TEST(LanesOf, MinAndMaxWithAConstantEqualTheScalarBitForBit)
{
    using L = TypeParam;
    for (DenormalMode::Kind mode : {DenormalMode::Keep, DenormalMode::Flush}) {
        DenormalMode const set(mode);
        for (float x : {0.0f, -0.0f, 1.0f, -1.0f, 2.0f, 0.5f, 1e-40f, -1e-40f, 0x1p-126f, INFINITY,
                        -INFINITY, float(NAN), std::bit_cast<float>(0x7fa00000u)}) {
            L a;
            for (int i = 0; i < lanes_of<L>; ++i) a.raw[i] = i % 2 ? x : 0.25f;
            expect_same_with_constant<L, 0x00000000>(a); // 0
            expect_same_with_constant<L, 0x80000000>(a); // -0
            expect_same_with_constant<L, 0x3f800000>(a); // 1
            expect_same_with_constant<L, 0x3f7fffff>(a);
            expect_same_with_constant<L, 0xbf800000>(a); // -1
            expect_same_with_constant<L, 0x00800000>(a); // 2^-126
            expect_same_with_constant<L, 0x00000001>(a); // a denormal
            expect_same_with_constant<L, 0x7f800000>(a); // infinity
            expect_same_with_constant<L, 0x7fc00000>(a); // NaN
        }
    }
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

TYPED_TEST(LanesOf, NegativeLanesAreBitsInOrder)
{
    constexpr int N = lanes_of<TypeParam>;
    for (int n = 0; n < N; ++n) {
        IntLanes<N> v(0x7fffffff);
        v.raw[n] = n % 2 ? -1 : std::numeric_limits<std::int32_t>::min();
        EXPECT_EQ(v.negative(), 1u << n);
    }
    EXPECT_EQ(IntLanes<N>(0).negative(), 0u);
}

TYPED_TEST(LanesOf, PairsAndWordsAreWhereTheyLie)
{
    constexpr int N = lanes_of<TypeParam>;
    std::vector<float> memory(100);
    std::vector<std::uint16_t> words(100);
    for (std::size_t i = 0; i < memory.size(); ++i)
        memory[i] = float(i) + 0.5f, words[i] = std::uint16_t(65535 - i);
    IntLanes<N> index;
    for (int l = 0; l < N; ++l) index.raw[l] = (l / 2 * 37) % 99 + l % 2;
    Lanes<N> const pairs = load_pairs<N>(memory.data(), index);
    IntLanes<N> const numbers = load_words<N>(words.data() + 5);
    for (int l = 0; l < N; ++l) {
        EXPECT_EQ(pairs.raw[l], memory[std::size_t(index.raw[l])]);
        EXPECT_EQ(numbers.raw[l], 65530 - l);
    }
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
