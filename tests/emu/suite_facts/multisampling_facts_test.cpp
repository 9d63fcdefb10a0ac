// Facts S45 to S51 of other suites: sample patterns, masks, sample frequency, resolve, alpha to
// coverage.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/quad_scene.h"

namespace tessemu::test {
namespace {

// A pixel of a target, resolved.
std::uint32_t resolved(Scene const& s, int x, int y)
{
    ColorTarget one(s.width, s.height, s.color.format());
    resolve(s.color, one);
    return word(one, x, y);
}

TEST(Multisampling, S45FourSamplesLieInTheStandardPattern)
{
    std::pair<int, int> const sixteenths[] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(sample_pattern(4)[i].x, sixteenths[i].first);
        EXPECT_EQ(sample_pattern(4)[i].y, sixteenths[i].second);
    }
}

// The attribute as the colour, and a coverage (oMask) of the shader's own.
struct Masked {
    int mask;
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        float4<T> color;
        int_of<T> coverage;
    };
    template <class T> Out<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        return {in.value, int_of<T>(mask)};
    }
};

TEST(Multisampling, S46TheShadersMaskAndTheStatesMeet)
{
    for (auto [mask, ours, suite] :
         {std::tuple{~0u, 0x80808080u, 0x7f7f7f7fu}, {0xbu, 0x40404040u, 0x3f3f3f3fu}}) {
        Scene s(8, 8, 4, Format::R8G8B8A8_UNORM);
        s.use(Masked{5});
        s.target.blend.sample_mask = mask;
        set_quad(s);
        s.draw();
        // 2 samples of 4 are 127.5 codes, 1 is 63.75: rounded to nearest, half up.
        EXPECT_EQ(resolved(s, 3, 3), ours);
        EXPECT_TRUE(near_word(ours, suite, 1));
    }
}

// Red, green, blue, black by SV_SampleIndex.
struct ColorBySample {
    static constexpr bool kSampleFrequency = true;
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        T const index(p.sample_index);
        auto const is = [&](float i) { return select(index == T(i), T(1), T(0)); };
        return {is(0), is(1), is(2), T(1)};
    }
};

TEST(Multisampling, S47AShaderThatReadsTheSampleIndexRunsForEachSample)
{
    Scene s(32, 32, 4, Format::R8G8B8A8_UNORM);
    set_quad(s);
    // The 32 pixels on the diagonal have samples in both triangles; the suite: 1,024 to 1,056.
    EXPECT_EQ(s.draw().pipeline.PSInvocations, 1024u + 32);
    s.clear({}, 1);
    s.use(ColorBySample{});
    EXPECT_EQ(s.draw().pipeline.PSInvocations, 4096u);
    EXPECT_EQ(resolved(s, 5, 9), 0xff404040u); // a quarter is 63.75 codes
}

struct ShowCoverage {
    static constexpr bool kSampleFrequency = true;
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {T(p.coverage), T(1), T(1), T(1)};
    }
};

TEST(Multisampling, S48G18CoverageAtSampleFrequencyIsThePixels)
{
    Scene s(2, 2, 4);
    s.use(ShowCoverage{});
    set_quad(s);
    EXPECT_EQ(s.draw().pipeline.PSInvocations, 16u);
    for (int k = 0; k < 4; ++k) EXPECT_EQ(s.at(1, 0, 0, k), 15.0f);
    // A sliver that holds sample 2 of pixel (0,0), (2,10)/16, and sample 0 of (0,1), (6,18)/16.
    Scene sliver(2, 2, 4);
    sliver.use(ShowCoverage{});
    sliver.add(1 / 16.0f, 8 / 16.0f).add(8 / 16.0f, 19 / 16.0f).add(6 / 16.0f, 20 / 16.0f);
    EXPECT_EQ(sliver.draw().pipeline.PSInvocations, 2u);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
            for (int k = 0; k < 4; ++k) {
                float const expected = x == 0 && y == 0 && k == 2   ? 4.0f
                                       : x == 0 && y == 1 && k == 0 ? 1.0f
                                                                    : 0.0f;
                EXPECT_EQ(sliver.at(x, y, 0, k), expected) << x << y << k;
            }
}

TEST(Multisampling, S49ResolveIsTheMeanInLinearSpace)
{
    struct {
        std::array<float, 4> color;
        Format format;
        std::uint32_t ours, suite;
    } const table[] = {
        {{0, 1, 0, 1}, Format::R8G8B8A8_UNORM, 0xff80ff80, 0xff80ff80},
        {{0, 1, 0, 1}, Format::R8G8B8A8_UNORM_SRGB, 0xffbcffbc, 0xffbcffbc},
        // Red and green are 159.5 and 191.5 codes, and a rounding less in float.
        {{0.25f, 0.5f, 0.75f, 1}, Format::R8G8B8A8_UNORM, 0xffdfbf9f, 0xffdfc0a0},
        {{0.25f, 0.5f, 0.75f, 1}, Format::R8G8B8A8_UNORM_SRGB, 0xfff1e1cf, 0xfff1e1cf}};
    for (auto const& row : table) {
        Scene s(8, 8, 4, row.format);
        s.clear({1, 1, 1, 1});
        s.target.blend.sample_mask = 3;
        set_quad(s, row.color);
        s.draw();
        for (int k = 0; k < 4; ++k) EXPECT_EQ(word(s.color, 2, 2, k) == ~0u, k >= 2);
        EXPECT_EQ(resolved(s, 2, 2), row.ours);
        EXPECT_TRUE(near_word(row.ours, row.suite, 2));
    }
}

TEST(Multisampling, S50AlphaBecomesCoverageUnlessTheShaderHasItsOwn)
{
    for (float alpha : {0.0f, 0.5f, 1.0f}) {
        Scene s(4, 4, 4);
        s.target.blend.alpha_to_coverage = true;
        set_quad(s, {1, 1, 1, alpha});
        s.draw();
        // The suite: none, 1 to 3, all.
        EXPECT_EQ(s.covered(), 16 * int(4 * alpha)) << alpha;
        for (int mask : {0, 2, 9, 0xd, 0xf}) {
            s.clear();
            s.use(Masked{mask});
            s.draw();
            for (int k = 0; k < 4; ++k) EXPECT_EQ(s.at(2, 1, 0, k), float(mask >> k & 1)) << mask;
        }
    }
}

// Three colours, of which the first is opaque in the upper left quarter of 8 pixels alone.
struct OpaqueCorner {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        std::array<float4<T>, 3> color;
    };
    template <class T> Out<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        auto const corner = (p.position.x < T(4)) & (p.position.y < T(4));
        return {{float4<T>(T(0), T(1), T(0), select(corner, T(1), T(0))),
                 float4<T>(T(0), T(0), T(1), T(0.75)), float4<T>(T(0), T(1), T(0), T(0.5))}};
    }
};

TEST(Multisampling, S51G11TheFirstColorsAlphaCoversAllTargets)
{
    for (int samples : {1, 4})
        for (Format first : {Format::R8G8B8A8_UNORM, Format::R11G11B10_FLOAT}) {
            Scene s(8, 8, samples, first);
            ColorTarget second(8, 8, Format::R8G8B8A8_UNORM, samples),
                third(8, 8, Format::R8G8B8A8_UNORM, samples);
            for (ColorTarget* t : {&s.color, &second, &third}) t->clear({}, ThreadPool(1));
            s.target.color = {&s.color, &second, &third};
            s.use(OpaqueCorner{});
            s.target.blend.alpha_to_coverage = true;
            set_quad(s);
            s.draw();
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 8; ++x)
                    for (int k = 0; k < samples; ++k) {
                        bool const in = x < 4 && y < 4;
                        // Green of 11 bits: 15 is the exponent of 1.
                        std::uint32_t const green =
                            first == Format::R8G8B8A8_UNORM ? 0xff00ff00u : 15u << 6 << 11;
                        ASSERT_EQ(word(s.color, x, y, k), in ? green : 0u) << x << y << k;
                        ASSERT_EQ(word(second, x, y, k), in ? 0xbfff0000u : 0u) << x << y << k;
                        ASSERT_EQ(word(third, x, y, k), in ? 0x8000ff00u : 0u) << x << y << k;
                    }
        }
}

} // namespace
} // namespace tessemu::test
