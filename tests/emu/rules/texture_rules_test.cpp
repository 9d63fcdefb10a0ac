// Rules R141 to R150: buffers and texture sampling, against the formulas in double.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/texture.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cstring>

namespace tessemu::test {
namespace {

using T = Lanes<8>;

// A texture whose red is x, green y, blue the level, alpha the slice.
std::vector<float> numbered(int width, int height, int levels, int slices)
{
    std::vector<float> t;
    for (int s = 0; s < slices; ++s)
        for (int l = 0; l < levels; ++l)
            for (int y = 0; y < std::max(1, height >> l); ++y)
                for (int x = 0; x < std::max(1, width >> l); ++x)
                    t.insert(t.end(), {float(x), float(y), float(l), float(s)});
    return t;
}
float2<T> at(float u, float v)
{
    return {T(u), T(v)};
}

TEST(Buffers, R141R142R143I26OutOfRangeAndUnboundReadsGiveZero)
{
    std::vector<float> const values{1, 2, 3};
    Buffer<float> const b(values, 0, "b");
    IntLanes<8> index(0);
    for (int i = 0; i < 8; ++i) index.raw[i] = i - 2;
    auto const r = load<T>(b, index);
    float const expected[8] = {0, 0, 1, 2, 3, 0, 0, 0};
    for (int i = 0; i < 8; ++i) EXPECT_EQ(r.raw[i], expected[i]);
    EXPECT_EQ(load<float>(Buffer<float>(), 0), 0.0f);
    ConstantBuffer<float> const constants(values);
    EXPECT_EQ(load<T>(constants, 2).raw[7], 3.0f);
    EXPECT_EQ(load<T>(constants, 3).raw[7], 0.0f);
    EXPECT_EQ(load<float>(constants, -1), 0.0f);
    EXPECT_EQ(load<float>(ConstantBuffer<float>(), 0), 0.0f);
    // Bits pass untouched.
    std::vector<std::uint32_t> const words{0x7f800001u};
    EXPECT_EQ(load<float>(Buffer<std::uint32_t>(words, 0, "w"), 0), std::int32_t(0x7f800001u));
}

TEST(Texture, R142LoadOutOfRangeInAnyIndexGivesZero)
{
    std::vector<float> const t = numbered(4, 4, 3, 2);
    Texture2D const texture(t, 4, 4, 0, "t", 3, 2);
    auto const red = [&](int x, int y, int level, int slice) {
        return load<T>(texture, IntLanes<8>(x), IntLanes<8>(y), level, slice).x.raw[0];
    };
    EXPECT_EQ(red(3, 0, 0, 1), 3.0f);
    EXPECT_EQ(load<T>(texture, IntLanes<8>(1), IntLanes<8>(1), 1, 1).w.raw[3], 1.0f);
    for (auto [x, y, l, s] : {std::array{4, 0, 0, 0},
                              {0, -1, 0, 0},
                              {0, 0, 3, 0},
                              {0, 0, 0, 2},
                              {0, 0, -1, 0},
                              {2, 0, 1, 0}})
        EXPECT_EQ(load<T>(texture, IntLanes<8>(x), IntLanes<8>(y), l, s).w.raw[0] + red(x, y, l, s),
                  0.0f);
    EXPECT_EQ((load<T>(Texture2D(), IntLanes<8>(0), IntLanes<8>(0)).x.raw[0]), 0.0f);
}

// Components as decode() has them, which the tables of formats are held to; per lane as one by one.
TEST(Texture, R36R142MissingComponentsHaveTheirDefaultInAndOutOfRange)
{
    int const width = 5, height = 3, pitch = 7;
    std::uint32_t state = 1;
    for (std::size_t f = 0; f < kFormats; ++f) {
        auto const format = Format(f);
        FormatInfo const& of = info(format);
        std::vector<std::byte> bytes(std::size_t(pitch * height) * of.bytes);
        for (std::byte& b : bytes) b = std::byte((state = state * 1664525u + 1013904223u) >> 24);
        Texture2D const texture(bytes, format, width, height, pitch, 0, "t");
        EXPECT_EQ(texture.info().element_bytes, of.bytes);
        IntLanes<8> x(0), y(0);
        for (int turn = 0; turn < 4; ++turn) {
            for (int l = 0; l < 8; ++l)
                x.raw[l] = (turn * 8 + l) % 9 - 2, y.raw[l] = (turn * 8 + l) / 9 - 0;
            auto const lanes = load<T>(texture, x, y);
            for (int l = 0; l < 8; ++l) {
                int const i = x.raw[l], j = y.raw[l];
                bool const in = i >= 0 && i < width && j >= 0 && j < height;
                std::array<float, 4> texel{0, 0, 0, 0};
                if (in)
                    texel = decode(format, bytes.data() + std::size_t(j * pitch + i) * of.bytes);
                else if (of.components < 4)
                    texel[3] = of.type == FormatType::Uint || of.type == FormatType::Sint
                                   ? std::bit_cast<float>(1u)
                                   : 1.0f;
                float4<float> const one = load<float>(texture, i, j);
                float const got[2][4] = {
                    {lanes.x.raw[l], lanes.y.raw[l], lanes.z.raw[l], lanes.w.raw[l]},
                    {one.x, one.y, one.z, one.w}};
                for (auto const& g : got)
                    ASSERT_EQ(std::memcmp(g, texel.data(), sizeof g), 0)
                        << of.name << " at " << i << ", " << j;
            }
        }
        EXPECT_EQ(load<float>(texture, 0, 0, 1).x, 0.0f); // it has one level
    }
    // Nothing bound: 0 everywhere, the fourth too.
    EXPECT_EQ((load<T>(Texture2D(), IntLanes<8>(0), IntLanes<8>(0)).w.raw[0]), 0.0f);
    EXPECT_EQ(load<float>(Texture2D(), 0, 0).w, 0.0f);
}

RC_GTEST_PROP(Texture, R145R146PointAndLinearFollowTheirFormulas, ())
{
    int const w = *rc::gen::inRange(1, 9), h = *rc::gen::inRange(1, 9);
    std::vector<float> texels;
    for (int i = 0; i < w * h * 4; ++i) texels.push_back(float(*rc::gen::inRange(-1000, 1000)));
    Texture2D const texture(texels, w, h, 0, "t");
    Sampler s;
    auto const mode = [] {
        return *rc::gen::element(AddressMode::Wrap, AddressMode::Mirror, AddressMode::Clamp,
                                 AddressMode::Border, AddressMode::MirrorOnce);
    };
    s.address_u = mode(), s.address_v = mode();
    s.border = {7, 8, 9, 10};
    s.mag = s.min = *rc::gen::element(Filter::Point, Filter::Linear);
    float const u = float(*rc::gen::inRange(-40000, 40000)) / 8192,
                v = float(*rc::gen::inRange(-40000, 40000)) / 8192;
    auto const wrapped = [](AddressMode m, int i, int n) {
        switch (m) {
        case AddressMode::Wrap:
            while (i < 0) i += n;
            return i % n;
        case AddressMode::Mirror:
            while (i < 0) i += 2 * n;
            i %= 2 * n;
            return i < n ? i : 2 * n - 1 - i;
        case AddressMode::Clamp:
            return std::clamp(i, 0, n - 1);
        case AddressMode::MirrorOnce:
            return std::min(i < 0 ? -1 - i : i, n - 1);
        default:
            return i < 0 || i >= n ? -1 : i;
        }
    };
    auto const texel = [&](int i, int j, int k) -> double {
        i = wrapped(s.address_u, i, w), j = wrapped(s.address_v, j, h);
        return i < 0 || j < 0 ? double(s.border[std::size_t(k)])
                              : double(texels[std::size_t(4 * (j * w + i) + k)]);
    };
    auto const got = sample_level(texture, s, at(u, v), T(0.0f));
    float const result[4] = {got.x.raw[5], got.y.raw[5], got.z.raw[5], got.w.raw[5]};
    auto const fixed = [](double x) { return int(std::nearbyint(x * 256)); };
    for (int k = 0; k < 4; ++k) {
        if (s.mag == Filter::Point) {
            RC_ASSERT(double(result[k]) ==
                      texel(fixed(double(u * float(w))) >> 8, fixed(double(v * float(h))) >> 8, k));
            continue;
        }
        int const x = fixed(double(u * float(w) - 0.5f)), y = fixed(double(v * float(h) - 0.5f));
        double const fx = (x & 255) / 256.0, fy = (y & 255) / 256.0;
        int const i = x >> 8, j = y >> 8;
        double const a = texel(i, j, k) * (1 - fx) + texel(i + 1, j, k) * fx,
                     b = texel(i, j + 1, k) * (1 - fx) + texel(i + 1, j + 1, k) * fx;
        double const low = std::min({texel(i, j, k), fx ? texel(i + 1, j, k) : texel(i, j, k),
                                     fy ? texel(i, j + 1, k) : texel(i, j, k),
                                     fx && fy ? texel(i + 1, j + 1, k) : texel(i, j, k)}),
                     high = std::max({texel(i, j, k), fx ? texel(i + 1, j, k) : texel(i, j, k),
                                      fy ? texel(i, j + 1, k) : texel(i, j, k),
                                      fx && fy ? texel(i + 1, j + 1, k) : texel(i, j, k)});
        // Six roundings of values up to 2000.
        RC_ASSERT(std::fabs(double(result[k]) - (a * (1 - fy) + b * fy)) <= 6 * 2000 * 0x1p-24);
        RC_ASSERT(double(result[k]) >= low && double(result[k]) <= high); // R147
    }
}

TEST(Texture, R147I21AConstantTextureGivesTheConstantAndWeightZeroIgnoresNan)
{
    std::vector<float> texels(5 * 3 * 4, 0.1f);
    Texture2D const texture(texels, 5, 3, 0, "t");
    for (float u = -1; u < 2; u += 0.0371f)
        ASSERT_EQ(sample_level(texture, Sampler{}, at(u, 0.37f), T(0.0f)).x.raw[0], 0.1f);
    std::vector<float> nan{1, 1, 1, 1, NAN, NAN, NAN, NAN};
    Texture2D const two(nan, 2, 1, 0, "n");
    EXPECT_EQ(sample_level(two, Sampler{}, at(0.25f, 0.5f), T(0.0f)).x.raw[0], 1.0f);
}

TEST(Texture, R148LodIsTheLogarithmOfTheLongerDerivativeAndIsClampedAfterTheBias)
{
    for (double x : {1.0, 2.0, 3.0, 0.1, 1e-20, 1e20, 1.4142135})
        EXPECT_EQ(log2_fixed8(x), std::int32_t(std::floor(std::log2(x) * 256))) << x;
    std::vector<float> const t = numbered(16, 16, 5, 1);
    Texture2D const texture(t, 16, 16, 0, "t", 5);
    Sampler s;
    s.min = s.mag = Filter::Point;
    auto const level = [&](float texels_x, float texels_y, float bias = 0) {
        float2<T> const dx(T(texels_x / 16), T(0.0f)), dy(T(0.0f), T(texels_y / 16));
        return sample_grad(texture, s, at(0.5f, 0.5f), dx, dy, T(bias)).z.raw[2];
    };
    EXPECT_EQ(level(4, 1), 2.0f);
    EXPECT_EQ(level(1, 8), 3.0f);
    EXPECT_EQ(level(4, 4, 1), 3.0f);
    EXPECT_EQ(level(0.25f, 0.25f), 0.0f);
    s.lod_bias = -1;
    EXPECT_EQ(level(4, 4), 1.0f);
    s.max_lod = 0.5f;
    EXPECT_EQ(level(16, 16), 0.5f);
    s.min_lod = 2, s.max_lod = 3; // magnification is decided after the clamp
    s.mag = Filter::Linear;
    EXPECT_EQ(level(0.1f, 0.1f), 2.0f);
}

TEST(Texture, R149MipPointRoundsAndMipLinearBlendsEightBits)
{
    std::vector<float> const t = numbered(16, 16, 5, 1);
    Texture2D const texture(t, 16, 16, 0, "t", 5);
    Sampler s;
    auto const level = [&](float lod) {
        return sample_level(texture, s, at(0.5f, 0.5f), T(lod)).z.raw[0];
    };
    EXPECT_EQ(level(1.25f), 1.25f);
    EXPECT_EQ(level(1.0f + 1 / 512.0f), 1.0f); // a tie to even in 1/256
    EXPECT_EQ(level(9), 4.0f);
    s.mip = Filter::Point;
    EXPECT_EQ(level(1.49f), 1.0f);
    EXPECT_EQ(level(1.5f), 2.0f);
    EXPECT_EQ(level(100), 4.0f);
}

TEST(Texture, R150UnboundGivesZeroAndSlicesRoundAndClamp)
{
    EXPECT_EQ(sample_level(Texture2D(), Sampler{}, at(0.5f, 0.5f), T(0.0f)).w.raw[0], 0.0f);
    std::vector<float> const t = numbered(2, 2, 1, 4);
    Texture2D const texture(t, 2, 2, 0, "t", 1, 4);
    auto const slice = [&](float i) {
        return sample_level(texture, Sampler{}, at(0.5f, 0.5f), T(0.0f), T(i)).w.raw[0];
    };
    EXPECT_EQ(slice(1.4f), 1.0f);
    EXPECT_EQ(slice(1.5f), 2.0f);
    EXPECT_EQ(slice(2.5f), 2.0f); // to even
    EXPECT_EQ(slice(-9), 0.0f);
    EXPECT_EQ(slice(99), 3.0f);
}

TEST(Texture, GatherAndComparisonSeeTheBilinearTexels)
{
    std::vector<float> const t = numbered(4, 4, 1, 1);
    Texture2D const texture(t, 4, 4, 0, "t");
    auto const g = gather(texture, Sampler{}, at(0.5f, 0.5f), 0);
    EXPECT_EQ(g.x.raw[0], 1.0f); // left bottom, right bottom, right top, left top
    EXPECT_EQ(g.y.raw[0], 2.0f);
    EXPECT_EQ(g.w.raw[0], 1.0f);
    EXPECT_EQ(gather(texture, Sampler{}, at(0.5f, 0.5f), 1).x.raw[0], 2.0f);
    Sampler s;
    s.comparison = Comparison::LessEqual;
    EXPECT_EQ(sample_cmp_level_zero(texture, s, at(0.5f, 0.5f), T(1.5f)).raw[0], 0.5f);
}

// R127: implicit derivatives in the pixel shader; a texture of 4x4 on 16x16 pixels is level -2,
// magnified; one of 64x64 is level 2.
struct Textured {
    template <class U> using Input = SceneValue<U>;
    Texture2D texture;
    Sampler sampler;
    std::vector<ResourceInfo> resources() const { return {texture.info()}; }
    template <class U> float4<U> operator()(PixelInput<U> const&, SceneValue<U> const& in) const
    {
        return sample(texture, sampler, float2<U>(in.value.x, in.value.y));
    }
};

TEST(Texture, R127R148ImplicitDerivativesChooseTheLevelAndTexelsAreCounted)
{
    for (auto [size, levels, level] : {std::array{4, 3, 0}, {64, 7, 2}}) {
        std::vector<float> const t = numbered(size, size, levels, 1);
        Textured shader;
        shader.texture = Texture2D(t, size, size, 3, "picture", levels);
        Scene s;
        s.use(shader);
        s.add(0, 0, 0.5f, 1, {0, 0, 0, 0}).add(32, 0, 0.5f, 1, {2, 0, 0, 0});
        s.add(0, 32, 0.5f, 1, {0, 2, 0, 0});
        DrawStatistics const& n = s.draw();
        EXPECT_EQ(s.at(5, 7, 2), float(level));
        for (StageStatistics const& stage : n.stages)
            if (stage.stage == "pixel_shader") {
                ASSERT_EQ(stage.fetches.size(), 1u);
                EXPECT_EQ(stage.fetches[0].resource, "picture");
                EXPECT_GE(stage.fetches[0].count, 256u);
                EXPECT_LE(stage.fetches[0].count, 4 * 256u);
            }
    }
}

TEST(Texture, G17MipLevelsAreMeans)
{
    auto const [texels, levels] = make_mip_levels(numbered(4, 2, 1, 1), 4, 2);
    EXPECT_EQ(levels, 3);
    EXPECT_EQ(texels.size(), 4u * (8 + 2 + 1));
    EXPECT_EQ(texels[4 * 8], 0.5f);
    EXPECT_EQ(texels[4 * 9], 2.5f);
    EXPECT_EQ(texels[4 * 10], 1.5f);
}

} // namespace
} // namespace tessemu::test
