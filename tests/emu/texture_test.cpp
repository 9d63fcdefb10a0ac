// Textures of any format, views of what was drawn, and texels by the point that they hold.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/texture.h"

#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <set>

namespace tessemu::test {
namespace {

std::vector<float> numbers(std::size_t n)
{
    std::vector<float> v;
    for (std::size_t i = 0; i < n; ++i) v.push_back(float(i) + 0.5f);
    return v;
}

TEST(TexelFetch, ReadsTheTexelThatHoldsThePoint)
{
    int const width = 5, height = 4;
    std::vector<float> const values = numbers(width * height);
    Texture2D const texture(std::as_bytes(std::span(values)), Format::R32_FLOAT, width, height,
                            width, 0, "t");
    auto const at = [&](float x, float y) {
        float const one = fetch_texel<float>(texture, {x, y}).x;
        using L = Lanes<8>;
        EXPECT_EQ(fetch_texel<L>(texture, {L(x), L(y)}).x.raw[5], one) << x << ", " << y;
        EXPECT_EQ(fetch_texel<double>(texture, {x, y}).x, double(one));
        return one;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (float part : {0.0f, 0.5f, 0.99999f})
                EXPECT_EQ(at(float(x) + part, float(y) + part), values[std::size_t(y * width + x)]);
    float const infinity = std::numeric_limits<float>::infinity();
    for (float outside : {-1e-9f, -0.5f, -1.0f, -70000.0f, -3e9f, 3e9f, infinity, -infinity}) {
        EXPECT_EQ(at(outside, 1), 0.0f) << outside;
        EXPECT_EQ(at(1, outside), 0.0f) << outside;
    }
    EXPECT_EQ(at(5, 0), 0.0f);
    EXPECT_EQ(at(0, 4), 0.0f);
    EXPECT_EQ(at(-0.0f, 0), values[0]);
    EXPECT_EQ(at(std::nanf(""), 2), values[10]); // R19: a conversion makes 0 of NaN
}

TEST(TexelFetch, OfFourFloatsReadsWhatLoadReads)
{
    std::vector<float> const values = numbers(4 * 6);
    Texture2D const texture(values, 3, 2, 0, "t");
    using L = Lanes<4>;
    L x(0.0f), y(1.5f);
    for (int l = 0; l < 4; ++l) x.raw[l] = float(l) + 0.25f;
    auto const r = fetch_texel<L>(texture, {x, y});
    for (int l = 0; l < 4; ++l) {
        float4<float> const one = load<float>(texture, l, 1);
        EXPECT_EQ(r.x.raw[l], one.x);
        EXPECT_EQ(r.y.raw[l], one.y);
        EXPECT_EQ(r.z.raw[l], one.z);
        EXPECT_EQ(r.w.raw[l], one.w);
        EXPECT_EQ(one.x, l < 3 ? values[std::size_t(4 * (3 + l))] : 0.0f);
    }
}

// The texel under each pixel's centre; and, in the second half of the picture, another.
struct Fetching {
    template <class T> using Input = SceneValue<T>;
    Texture2D texture;
    std::vector<ResourceInfo> resources() const { return {texture.info()}; }
    template <class T> float4<T> operator()(PixelInput<T> const& pixel, SceneValue<T> const&) const
    {
        return fetch_texel<T>(texture, float2<T>(pixel.position.x, pixel.position.y));
    }
};

TEST(TexelFetch, CountsOneFetchOfTheFormatsBytesAndNoOperation)
{
    // 16 x 16 pixels over a texture of 9 x 16: each pixel fetches, 9 x 16 texels are there.
    for (auto [format, bytes] : {std::pair{Format::R32_FLOAT, 4},
                                 {Format::R16G16_UNORM, 4},
                                 {Format::R8_UNORM, 1},
                                 {Format::R32G32B32A32_FLOAT, 16}}) {
        std::vector<std::byte> const texels(std::size_t(12 * 16 * bytes));
        for (bool checking : {false, true}) {
            Fetching shader;
            shader.texture = Texture2D(texels, format, 9, 16, 12, 5, "table");
            Scene s;
            s.desc.pixel_shader =
                bind_pixel_shader(shader, {kNativeLanes, Contraction::None, 0, checking});
            DrawStatistics const& n = s.add_full().draw();
            for (StageStatistics const& stage : n.stages)
                if (stage.stage == "pixel_shader") {
                    EXPECT_EQ(stage.flops, FlopCount{});
                    ASSERT_EQ(stage.fetches.size(), 1u);
                    EXPECT_EQ(stage.fetches[0], (FetchStatistics{"table", ResourceKind::Texture,
                                                                 256, std::uint64_t(256 * bytes),
                                                                 std::uint64_t(9 * 16 * bytes)}));
                }
            EXPECT_EQ(s.at(8, 8, 3), bytes == 16 ? 0.0f : 1.0f);
        }
    }
}

TEST(TextureOfATarget, ShowsWhatWasDrawnInTheTargetsOwnFormat)
{
    for (Format format : {Format::R32_FLOAT, Format::R32G32B32A32_FLOAT, Format::R8G8B8A8_UNORM,
                          Format::R16G16_FLOAT, Format::B8G8R8A8_UNORM_SRGB}) {
        ColorTarget target(37, 5, format);
        float const shift = 0.125f;
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 37; ++x)
                encode(format, {float(x) / 64 + shift, float(y) / 8, 0.5f, 0.25f},
                       target.texel(x, y));
        Texture2D const texture = texture_of(target, 3, "drawn");
        EXPECT_EQ(texture.info().name, "drawn");
        EXPECT_EQ(texture.info().element_bytes, info(format).bytes);
        EXPECT_EQ(texture.slot(), 3);
        using L = Lanes<8>;
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 37; ++x) {
                std::array<float, 4> const is = target.load(x, y);
                float4<L> const t = load<L>(texture, IntLanes<8>(x), IntLanes<8>(y));
                EXPECT_EQ((std::array{t.x.raw[1], t.y.raw[1], t.z.raw[1], t.w.raw[1]}), is);
                Sampler point;
                point.min = point.mag = point.mip = Filter::Point;
                float2<float> const uv((float(x) + 0.5f) / 37, (float(y) + 0.5f) / 5);
                EXPECT_EQ(sample_level(texture, point, uv, 0.0f).x, is[0]);
            }
        EXPECT_EQ(load<float>(texture, 37, 0).x, 0.0f);
        // It is a view: what is drawn later shows.
        encode(format, {1, 1, 1, 1}, target.texel(36, 4));
        EXPECT_EQ(load<float>(texture, 36, 4).x, 1.0f);
    }
}

TEST(TextureOfATarget, RefusesSeveralSamplesAPixel)
{
    ColorTarget const target(4, 4, Format::R32_FLOAT, 4);
    try {
        texture_of(target, 0, "drawn");
        FAIL();
    } catch (Error const& e) {
        EXPECT_EQ(std::string(e.what()), "the target 'drawn' has 4 samples a pixel, a texture has "
                                         "1: resolve it first");
    }
}

} // namespace
} // namespace tessemu::test
