// Conversions against the formulas of the specification, in double or exhaustively.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/formats.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace tessemu {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

TEST(Formats, R10AndR22HalvesAndUnormsDecodeExactly)
{
    for (std::uint32_t h = 0; h < 0x7c00; ++h) {
        int const exponent = int(h >> 10), mantissa = int(h & 0x3ff);
        double const expected = exponent ? std::ldexp(1024 + mantissa, exponent - 25)
                                         : std::ldexp(mantissa, -24); // denormals are kept
        ASSERT_EQ(float_from_half(std::uint16_t(h)), float(expected)) << h;
        ASSERT_EQ(half_from_float(float(expected)), h);
    }
    EXPECT_EQ(float_from_half(0x7c00), kInf);
    EXPECT_TRUE(std::isnan(float_from_half(0x7e00)));
    for (std::uint32_t i = 0; i < 256; ++i)
        ASSERT_EQ(float_from_unorm(i, 8), float(double(i) / 255));
}

TEST(Formats, R20NarrowFloatsRoundTowardZero)
{
    EXPECT_EQ(float_from_half(half_from_float(65520.0f)), 65504.0f); // the rule's example
    EXPECT_EQ(float_from_half(half_from_float(1e9f)), 65504.0f);
    EXPECT_EQ(half_from_float(kInf), 0x7c00);
    EXPECT_EQ(half_from_float(-kInf), 0xfc00);
    EXPECT_TRUE(std::isnan(float_from_half(half_from_float(kNan))));
    EXPECT_EQ(float_from_half(half_from_float(std::nextafter(1.0f, 0.0f))), 1 - 0x1p-11f);
    EXPECT_EQ(half_from_float(-0.0f), 0x8000);
    std::byte e[4];
    encode(Format::R11G11B10_FLOAT, {1.0f, -3.0f, 1e9f, 0}, e);
    auto const v = decode(Format::R11G11B10_FLOAT, e);
    EXPECT_EQ(v[0], 1.0f);
    EXPECT_EQ(v[1], 0.0f);
    EXPECT_EQ(v[2], 64512.0f); // the largest finite with 5 bits of mantissa
    EXPECT_EQ(v[3], 1.0f);
}

// About every step from code to code, and over all floats in strides.
TEST(Formats, R21LanesRoundToTheSameCode)
{
    constexpr int N = kRasterLanes;
    std::vector<float> all{kNan, kInf, -kInf, -0.0f, -1.0f, 1e-40f, -1e-40f, 2.0f};
    for (int k = 0; k <= 256; ++k) {
        auto const middle = std::bit_cast<std::uint32_t>(std::max(0.0f, float((k - 0.5) / 255)));
        for (std::uint32_t i = 0; i < 64; ++i) {
            all.push_back(std::bit_cast<float>(middle + i));
            if (middle >= i) all.push_back(std::bit_cast<float>(middle - i));
        }
    }
    for (std::uint64_t i = 0; i < std::uint64_t(1) << 32; i += 4099)
        all.push_back(std::bit_cast<float>(std::uint32_t(i)));
    all.resize((all.size() + N - 1) / N * N);
    for (std::size_t i = 0; i < all.size(); i += N) {
        IntLanes<N> const codes = unorm8_from_float(Lanes<N>::load(all.data() + i));
        for (std::size_t l = 0; l < N; ++l)
            ASSERT_EQ(std::uint32_t(codes.raw[l]), unorm_from_float(all[i + l], 8)) << all[i + l];
    }
}

TEST(Formats, R21I8UnormAndSnormReachEveryCodeAndNeverDecrease)
{
    std::uint32_t last = 0;
    for (int i = 0; i <= 255 * 64; ++i) {
        float const c = float(i) / (255 * 64);
        std::uint32_t const code = unorm_from_float(c, 8);
        ASSERT_EQ(code, std::uint32_t(double(c) * 255 + 0.5));
        ASSERT_TRUE(code == last || code == last + 1);
        last = code;
    }
    EXPECT_EQ(last, 255u);
    // Just below a tie: float arithmetic would round up.
    EXPECT_EQ(unorm_from_float(std::nextafter(0.5f / 255, 0.0f), 8), 0u);
    EXPECT_EQ(unorm_from_float(kNan, 8), 0u);
    EXPECT_EQ(unorm_from_float(kInf, 8), 255u);
    EXPECT_EQ(unorm_from_float(-1, 8), 0u);
    for (int i = -127; i <= 127; ++i) ASSERT_EQ(snorm_from_float(float_from_snorm(i, 8), 8), i);
    EXPECT_EQ(float_from_snorm(-128, 8), -1.0f);
    EXPECT_EQ(float_from_snorm(-127, 8), -1.0f);
    EXPECT_EQ(snorm_from_float(kNan, 8), 0);
}

TEST(Formats, R23SrgbFollowsTheCurve)
{
    for (int i = 0; i < 256; ++i) {
        double const c = i / 255.0;
        double const linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
        // pow and the fifth root each err by less than 2 ulp of double; a float rounding follows.
        ASSERT_NEAR(linear_from_srgb8(std::uint8_t(i)), linear, linear * 0x1p-24 + 1e-15) << i;
        ASSERT_EQ(srgb8_from_linear(linear_from_srgb8(std::uint8_t(i))), i);
    }
    for (int i = 0; i <= 20000; ++i) {
        double const c = i / 20000.0;
        double const ideal =
            255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
        // 0.6 units: half of rounding, and what the two thresholds of the curve disagree by.
        ASSERT_NEAR(srgb8_from_linear(float(c)), ideal, 0.6) << c;
    }
    EXPECT_EQ(srgb8_from_linear(kNan), 0);
    EXPECT_EQ(linear_from_srgb8(255), 1.0f);
    EXPECT_EQ(linear_from_srgb8(0), 0.0f);
}

TEST(Formats, R24FixedPointRoundsTiesToEven)
{
    EXPECT_EQ(fixed_from_float(std::bit_cast<float>(0xc5fffd0cu), 16, 8), -2097058);
    EXPECT_EQ(fixed_from_float(0.5f / 256, 16, 8), 0);
    EXPECT_EQ(fixed_from_float(1.5f / 256, 16, 8), 2);
    EXPECT_EQ(fixed_from_float(1e9f, 16, 8), (1 << 23) - 1);
    EXPECT_EQ(fixed_from_float(-1e9f, 16, 8), -(1 << 23));
    EXPECT_EQ(fixed_from_float(kNan, 16, 8), 0);
}

TEST(Formats, R25FixedPointOf24BitsIsExactInFloat)
{
    for (std::int32_t i : {1, -1, 0x7fffff, -0x800000, 12345})
        EXPECT_EQ(fixed_from_float(float(i) / 256, 16, 8), i);
}

TEST(Formats, R19AndR26IntegersTruncateAndClamp)
{
    EXPECT_EQ(int_from_float(-1.9f), -1);
    EXPECT_EQ(int_from_float(3e9f), std::numeric_limits<std::int32_t>::max());
    EXPECT_EQ(int_from_float(-3e9f), std::numeric_limits<std::int32_t>::min());
    EXPECT_EQ(int_from_float(kNan), 0);
    EXPECT_EQ(uint_from_float(-5), 0u);
    EXPECT_EQ(uint_from_float(1e10f), 0xffffffffu);
    EXPECT_EQ(uint_from_float(kNan), 0u);

    std::byte e[8];
    auto const bits = [](std::int32_t i) { return std::bit_cast<float>(i); };
    encode(Format::R16G16B16A16_SINT, {bits(70000), bits(-70000), bits(-5), bits(5)}, e);
    auto const s = decode(Format::R16G16B16A16_SINT, e);
    EXPECT_EQ(std::bit_cast<std::int32_t>(s[0]), 32767);
    EXPECT_EQ(std::bit_cast<std::int32_t>(s[1]), -32768);
    EXPECT_EQ(std::bit_cast<std::int32_t>(s[2]), -5); // sign extended
    encode(Format::R8G8B8A8_UINT, {bits(300), bits(255), bits(7), bits(0)}, e);
    auto const u = decode(Format::R8G8B8A8_UINT, e);
    EXPECT_EQ(std::bit_cast<std::int32_t>(u[0]), 255);
    EXPECT_EQ(std::bit_cast<std::int32_t>(u[2]), 7);
}

TEST(Formats, F6ComponentsLieWhereTheNameSaysFromTheLowestBitOn)
{
    auto const word = [](Format f, std::array<float, 4> const& v, unsigned mask = 0xf,
                         std::uint32_t before = 0xffffffffu) {
        encode(f, v, reinterpret_cast<std::byte*>(&before), mask);
        return before;
    };
    std::array<float, 4> const v{1.0f / 255, 2.0f / 255, 3.0f / 255, 4.0f / 255};
    EXPECT_EQ(word(Format::R8G8B8A8_UNORM, v), 0x04030201u);
    EXPECT_EQ(word(Format::B8G8R8A8_UNORM, v), 0x04010203u);
    EXPECT_EQ(word(Format::B8G8R8X8_UNORM, v), 0x00010203u);
    EXPECT_EQ(word(Format::R8G8_UNORM, v), 0xffff0201u); // two bytes of the four
    EXPECT_EQ(word(Format::R8_UNORM, v), 0xffffff01u);
    EXPECT_EQ(word(Format::R8G8_SNORM, {-1, 1, 0, 0}), 0xffff7f81u);
    EXPECT_EQ(word(Format::R16G16_SNORM, {-1, 1, 0, 0}), 0x7fff8001u);
    EXPECT_EQ(word(Format::R16_FLOAT, {-2, 0, 0, 0}), 0xffffc000u);
    EXPECT_EQ(word(Format::R10G10B10A2_UNORM, {0.25f, 0.5f, 1, 2.0f / 3}),
              256u | 512u << 10 | 1023u << 20 | 2u << 30);
    auto const bits = [](std::uint32_t i) { return std::bit_cast<float>(i); };
    EXPECT_EQ(word(Format::R10G10B10A2_UINT, {bits(1), bits(1024), bits(1022), bits(4)}),
              1u | 1023u << 10 | 1022u << 20 | 3u << 30);
    // sRGB in the first three registers, wherever they lie.
    std::uint32_t const half = srgb8_from_linear(0.5f);
    EXPECT_EQ(word(Format::B8G8R8A8_UNORM_SRGB, {0, 0.5f, 1, 0.5f}), 128u << 24 | half << 8 | 255u);
    // A mask keeps the bits of the other components.
    EXPECT_EQ(word(Format::B8G8R8A8_UNORM, v, 1, 0xaabbccddu), 0xaa01ccddu);
    EXPECT_EQ(word(Format::R10G10B10A2_UNORM, {0, 0, 0, 0}, 10), 0x3ff003ffu);
    EXPECT_EQ(word(Format::R11G11B10_FLOAT, {0, 0, 0, 0}, 4), 0x003fffffu);
    EXPECT_EQ(word(Format::R32_FLOAT, v, 14), 0xffffffffu);
}

TEST(Formats, EveryFormatGivesBackWhatItHolds)
{
    for (std::size_t f = 0; f < kFormats; ++f) {
        auto const format = Format(f);
        if (info(format).type == FormatType::Depth) continue;
        std::byte first[16] = {}, second[16] = {};
        encode(format, {0.25f, 0.75f, 1, 0}, first);
        encode(format, decode(format, first), second);
        EXPECT_TRUE(std::equal(first, first + info(format).bytes, second)) << info(format).name;
    }
}

} // namespace
} // namespace tessemu
