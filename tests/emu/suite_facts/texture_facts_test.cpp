// Facts S59 to S66 of other suites: levels, slices, loads, gathers, comparisons, derivatives.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/texture.h"
#include "tests/emu/suite_facts/quad_scene.h"

#include <limits>

namespace tessemu::test {
namespace {

using T = Lanes<8>;

// A texture whose every texel holds its level and its slice.
struct Levels {
    std::vector<float> texels;
    Texture2D texture;
    Levels(int size, int levels, int slices)
    {
        for (int s = 0; s < slices; ++s)
            for (int l = 0; l < levels; ++l)
                for (int i = 0; i < std::max(1, size >> l) * std::max(1, size >> l); ++i)
                    texels.insert(texels.end(), {float(l), float(s), 1, 1});
        texture = Texture2D(texels, size, size, 0, "levels", levels, slices);
    }
};

Sampler point_sampler()
{
    Sampler s;
    s.min = s.mag = s.mip = Filter::Point;
    return s;
}
float2<T> centre()
{
    return {T(0.5f), T(0.5f)};
}

// Pixels of a 640x480 target in [0,1], as the coordinate; one value of bias.
struct SampleByPixel {
    Texture2D texture;
    Sampler sampler;
    float bias;
    std::vector<ResourceInfo> resources() const { return {texture.info()}; }
    template <class U> using Input = SceneValue<U>;
    template <class U> float4<U> operator()(PixelInput<U> const& p, SceneValue<U> const&) const
    {
        float2<U> const uv(p.position.x / U(640), p.position.y / U(480));
        return sample(texture, sampler, uv, U(bias));
    }
};

TEST(Texture, S59TheBiasMovesTheLevelOfTheLongerDerivative)
{
    Levels const t(4, 3, 1);
    // 4 texels over 480 rows: log2(1/120) is -6.907, so 8.5 of bias pass 1.5.
    auto const level = [&](float bias, float max_lod) {
        Scene s(8, 8); // a corner of the suite's target
        SampleByPixel shader{t.texture, point_sampler(), bias};
        shader.sampler.max_lod = max_lod;
        s.use(shader);
        set_quad(s);
        s.draw();
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) EXPECT_EQ(s.at(x, y), s.at(0, 0));
        return s.at(0, 0);
    };
    float const most = std::numeric_limits<float>::max();
    EXPECT_EQ(level(0, most), 0.0f);
    EXPECT_EQ(level(8, most), 1.0f);
    EXPECT_EQ(level(8.4f, most), 1.0f);
    EXPECT_EQ(level(8.5f, most), 2.0f);
    EXPECT_EQ(level(9, most), 2.0f);
    for (float max_lod : {2.0f, 1.0f, 0.0f}) EXPECT_EQ(level(9, max_lod), max_lod);
}

TEST(Texture, S60LevelsAreRoundedBlendedBiasedAndClamped)
{
    Levels const t(4, 3, 1);
    Sampler s = point_sampler();
    auto const level = [&](float lod) {
        return sample_level(t.texture, s, centre(), T(lod)).x.raw[3];
    };
    for (auto [lod, expected] : {std::pair{0.0f, 0.0f},
                                 {0.4f, 0.0f},
                                 {0.6f, 1.0f},
                                 {1.4f, 1.0f},
                                 {1.6f, 2.0f},
                                 {4.0f, 2.0f}})
        EXPECT_EQ(level(lod), expected) << lod;
    s.mip = Filter::Linear;
    EXPECT_EQ(level(1.5f), 1.5f);
    s.mip = Filter::Point;
    s.lod_bias = 2;
    EXPECT_EQ(level(-2), 0.0f);
    EXPECT_EQ(level(-1), 1.0f);
    s.lod_bias = 0;
    s.min_lod = s.max_lod = 2;
    for (float lod : {-9.0f, 0.0f, 1.0f, 2.0f, 9.0f}) EXPECT_EQ(level(lod), 2.0f) << lod;
}

TEST(Texture, S61SlicesAreRoundedToEvenAndClamped)
{
    Levels const t(2, 1, 3);
    for (auto [slice, expected] : {std::pair{-9.0f, 0.0f},
                                   {0.0f, 0.0f},
                                   {0.4f, 0.0f},
                                   {0.5f, 0.0f},
                                   {1.0f, 1.0f},
                                   {1.4f, 1.0f},
                                   {2.0f, 2.0f},
                                   {2.1f, 2.0f},
                                   {3.0f, 2.0f},
                                   {9.0f, 2.0f}})
        EXPECT_EQ(sample_level(t.texture, Sampler{}, centre(), T(0.0f), T(slice)).y.raw[0],
                  expected)
            << slice;
}

// What Direct3D samples with where no sampler is bound.
TEST(Texture, S62MissingLevelsAndTexturesAreZeroAndTheDefaultSamplerServes)
{
    Levels const t(4, 3, 1);
    for (int level : {0, 1, 2, 3, 7, -1})
        EXPECT_EQ(load<T>(t.texture, IntLanes<8>(0), IntLanes<8>(0), level).z.raw[1],
                  level >= 0 && level < 3 ? 1.0f : 0.0f)
            << level;
    EXPECT_EQ(load<T>(Texture2D(), IntLanes<8>(0), IntLanes<8>(0)).w.raw[1], 0.0f);
    EXPECT_EQ(sample_level(Texture2D(), Sampler{}, centre(), T(0.0f)).w.raw[1], 0.0f);
    Sampler const none;
    for (Filter f : {none.min, none.mag, none.mip}) EXPECT_EQ(f, Filter::Linear);
    for (AddressMode m : {none.address_u, none.address_v}) EXPECT_EQ(m, AddressMode::Clamp);
    EXPECT_EQ(none.border, (std::array<float, 4>{1, 1, 1, 1}));
    EXPECT_EQ(none.comparison, Comparison::Never);
    EXPECT_EQ(none.lod_bias, 0.0f);
    EXPECT_EQ(none.max_lod, std::numeric_limits<float>::max());
    EXPECT_EQ(none.min_lod, -none.max_lod);
    EXPECT_EQ(sample_level(t.texture, none, centre(), T(1.25f)).x.raw[0], 1.25f);
    EXPECT_EQ(sample_cmp_level_zero(t.texture, none, centre(), T(0.0f)).raw[0], 0.0f);
}

TEST(Texture, S63SrgbTexelsAreDecoded)
{
    // Grey codes and the UNORM codes that they are shown as; the suite allows one.
    struct {
        std::uint8_t srgb, unorm;
    } const table[] = {{0x00, 0x00}, {0x10, 0x01}, {0x20, 0x04}, {0x30, 0x08}, {0x7f, 0x36},
                       {0x80, 0x37}, {0x90, 0x47}, {0xa0, 0x5a}, {0xff, 0xff}};
    for (auto const& row : table) {
        std::byte const texel[4] = {std::byte(row.srgb), std::byte(row.srgb), std::byte(row.srgb),
                                    std::byte(0x40)};
        auto const loaded = decode(Format::R8G8B8A8_UNORM_SRGB, texel);
        Texture2D const t(loaded, 1, 1, 0, "texel");
        auto const c = sample_level(t, Sampler{}, centre(), T(0.0f));
        EXPECT_NEAR(int(unorm_from_float(c.x.raw[0], 8)), row.unorm, 1) << int(row.srgb);
        EXPECT_EQ(c.y.raw[0], c.x.raw[0]);
        EXPECT_EQ(c.z.raw[0], c.x.raw[0]);
        EXPECT_EQ(unorm_from_float(c.w.raw[0], 8), 0x40u); // alpha is linear
    }
}

TEST(Texture, S64GatherTakesTheFourTexelsAroundRedAndGreen)
{
    // 0 to 9, then 0.5 to 5.5; green is 100 above.
    std::vector<float> red;
    for (int i = 0; i < 10; ++i) red.push_back(float(i));
    for (int i = 0; i < 6; ++i) red.push_back(float(i) + 0.5f);
    std::vector<float> texels;
    for (float r : red) texels.insert(texels.end(), {r, r + 100, 0, 1});
    Texture2D const t(texels, 4, 4, 0, "numbers");
    auto const at = [&](int x, int y) {
        return red[std::size_t(4 * std::min(y, 3) + std::min(x, 3))];
    };
    for (int component : {0, 1})
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                float2<T> const uv(T((float(x) + 0.5f) / 4), T((float(y) + 0.5f) / 4));
                auto const g = gather(t, point_sampler(), uv, component);
                float const up = component ? 100.0f : 0.0f;
                EXPECT_EQ(g.x.raw[2], up + at(x, y + 1)) << x << y;
                EXPECT_EQ(g.y.raw[2], up + at(x + 1, y + 1)) << x << y;
                EXPECT_EQ(g.z.raw[2], up + at(x + 1, y)) << x << y;
                EXPECT_EQ(g.w.raw[2], up + at(x, y)) << x << y;
            }
    auto const corner = gather(t, point_sampler(), float2<T>(T(0.125f), T(0.125f)));
    EXPECT_EQ(corner.x.raw[0], 4.0f);
    EXPECT_EQ(corner.y.raw[0], 5.0f);
    EXPECT_EQ(corner.z.raw[0], 1.0f);
    EXPECT_EQ(corner.w.raw[0], 0.0f);
    auto const last = gather(t, point_sampler(), float2<T>(T(0.875f), T(0.875f)));
    for (float v : {last.x.raw[0], last.y.raw[0], last.z.raw[0], last.w.raw[0]}) EXPECT_EQ(v, 5.5f);
}

TEST(Texture, S65AComparisonPutsTheReferenceBeforeTheTexel)
{
    Sampler s = point_sampler();
    s.comparison = Comparison::Greater;
    for (float depth : {0.0f, 1.0f, 0.5f, 0.6f, 0.4f, 0.1f}) {
        std::vector<float> const texel{depth, 0, 0, 1};
        Texture2D const t(texel, 1, 1, 0, "depth");
        for (float reference : {0.0f, 0.5f, 1.0f})
            EXPECT_EQ(sample_cmp_level_zero(t, s, centre(), T(reference)).raw[0],
                      reference > depth ? 1.0f : 0.0f)
                << depth << " " << reference;
    }
}

struct RowDerivatives {
    bool fine;
    template <class U> using Input = SceneValue<U>;
    template <class U> float4<U> operator()(PixelInput<U> const&, SceneValue<U> const& in) const
    {
        auto const shown = [&](U const& v) {
            U const d = fine ? ddy_fine(v) : ddy(v);
            return U(d * U(240) + U(0.5f));
        };
        return {shown(in.value.x), shown(in.value.y), shown(in.value.z), shown(in.value.w)};
    }
};

TEST(PixelShader, S66ARampOverTheRowsHasADerivativeDownTheRows)
{
    // Green falls from 1 to 0 over 480 rows, blue grows, red and alpha stay: -1/2, 1/2 and 0 times
    // 1/240, each half up of 0.5; a rounding of 0.5 may not reach 127.5 codes.
    for (bool fine : {true, false}) {
        Scene s(640, 480, 1, Format::R8G8B8A8_UNORM);
        s.use(RowDerivatives{fine});
        std::array<float, 4> const top{0, 1, 0, 1}, bottom{0, 0, 1, 1};
        set_corners(s, {bottom, top, bottom, top});
        s.draw();
        for (auto [x, y] : {std::pair{190, 160}, {255, 240}, {320, 190}, {639, 479}})
            EXPECT_TRUE(near_word(word(s.color, x, y), 0x7fff007f, 1)) << x << "," << y;
    }
}

TEST(Texture, G17LevelsAreMeansInFloatAndATextureTellsItsSize)
{
    // Sums row by row, then the quarter: of four codes the mean is no code, and stays.
    std::vector<float> texels;
    for (int code : {10, 11, 13, 255}) {
        float const v = float_from_unorm(std::uint32_t(code), 8);
        texels.insert(texels.end(), {v, 1, 0, 0.5f});
    }
    auto const [all, levels] = make_mip_levels(texels, 2, 2);
    ASSERT_EQ(levels, 2);
    float const mean = (((texels[0] + texels[4]) + texels[8]) + texels[12]) * 0.25f;
    EXPECT_EQ(all[16], mean);
    EXPECT_EQ(unorm_from_float(mean, 8), 72u); // 72.25 codes
    EXPECT_EQ(all[17], 1.0f);
    EXPECT_EQ(all[19], 0.5f);
    // GetDimensions: the size of a level, the levels, the slices; sampleinfo: a pattern's samples.
    Levels const t(8, 4, 3);
    for (int l = 0; l < 4; ++l) {
        EXPECT_EQ(t.texture.width(l), 8 >> l);
        EXPECT_EQ(t.texture.height(l), 8 >> l);
    }
    EXPECT_EQ(t.texture.levels(), 4);
    EXPECT_EQ(t.texture.slices(), 3);
    EXPECT_FALSE(Texture2D().bound());
    for (int n : {1, 2, 4, 8}) EXPECT_EQ(sample_pattern(n).size(), std::size_t(n));
}

} // namespace
} // namespace tessemu::test
