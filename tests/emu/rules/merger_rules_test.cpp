// Rules R120 to R140: interpolation, pixel shader, depth, stencil, blending.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/output_merger.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace tessemu::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class T> struct AllModes {
    T constant, linear, flat, rest;
    static constexpr std::array<Interpolation, 4> kInterpolation{
        Interpolation::Constant, Interpolation::Linear, Interpolation::LinearNoperspective,
        Interpolation::LinearCentroid};
    static constexpr auto signature()
    {
        return std::tuple{&AllModes::constant, &AllModes::linear, &AllModes::flat, &AllModes::rest};
    }
};
struct ShowModes {
    template <class T> using Input = AllModes<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, AllModes<T> const& in) const
    {
        return {in.constant, in.linear, in.flat, in.rest};
    }
};

TEST(Interpolation, R120ModesAreConstantPerspectiveAndScreenLinear)
{
    Scene s(32, 32);
    s.use(ShowModes{});
    s.add(0, 0, 0.5f, 1, {5, 0, 0, 0}).add(64, 0, 0.5f, 4, {6, 1, 1, 1});
    s.add(0, 64, 0.5f, 1, {7, 0, 0, 0});
    s.draw();
    auto const p = s.color.load(15, 0);
    double const t = 15.5 / 64, u = 0.5 / 64;
    EXPECT_EQ(p[0], 5.0f);
    // Weights are exact here: multiples of 2^-28. So is the sum of 1/w; its reciprocal and that
    // times the weight round.
    EXPECT_EQ(double(p[2]), t);
    double const perspective = (t / 4) / ((1 - t - u) + t / 4 + u);
    EXPECT_NEAR(p[1], perspective, 2.0001 * 0x1p-24 * perspective);
    EXPECT_EQ(p[3], p[1]); // one sample: centroid is the centre
    // I-15: constant attributes pass bits, a NaN with payload too; an integer target shows them.
    Scene bits(16, 16, 1, Format::R32G32B32A32_UINT);
    bits.use(ShowModes{});
    float const odd = std::bit_cast<float>(0x7fc12345u);
    bits.add_full(0.5f, {odd, 0, 0, 0});
    bits.draw();
    EXPECT_EQ(std::bit_cast<std::uint32_t>(bits.at(1, 1)), 0x7fc12345u);
}

struct Derivatives {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        T const f = p.position.x * p.position.x + p.position.y * p.position.y * T(8);
        return {ddx(f), ddy(f), ddx_fine(f), ddy_fine(f)};
    }
};

TEST(PixelShader, R123R129I14DerivativesAreDifferencesInsideTheQuad)
{
    Scene s;
    s.use(Derivatives{});
    s.add_full();
    s.draw();
    auto const f = [](float x, float y) { return x * x + y * y * 8; };
    for (int y : {4, 5})
        for (int x : {6, 7}) {
            auto const p = s.color.load(x, y);
            EXPECT_EQ(p[0], f(7.5f, 4.5f) - f(6.5f, 4.5f)); // the top row
            EXPECT_EQ(p[1], f(6.5f, 5.5f) - f(6.5f, 4.5f)); // the left column
            float const fy = float(y) + 0.5f, fx = float(x) + 0.5f;
            EXPECT_EQ(p[2], f(7.5f, fy) - f(6.5f, fy));
            EXPECT_EQ(p[3], f(fx, 5.5f) - f(fx, 4.5f));
        }
}

TEST(PixelShader, R123R163HelperPixelsRunForTheirQuadAndCountNowhere)
{
    Scene s;
    s.use(Derivatives{});
    s.add(4.2f, 4.2f).add(4.8f, 4.2f).add(4.5f, 4.8f); // one pixel
    DrawStatistics const& n = s.draw();
    EXPECT_EQ(n.pipeline.PSInvocations, 1u);
    EXPECT_EQ(s.at(4, 4), 5.5f * 5.5f - 4.5f * 4.5f);
    EXPECT_EQ(s.at(5, 4), 0.0f);
    for (StageStatistics const& stage : n.stages)
        if (stage.stage == "pixel_shader") {
            EXPECT_EQ(stage.flops.mul, 3u);
        }
}

struct DepthOut {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        float4<T> color;
        T depth;
    };
    template <class T> Out<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        return {in.value, in.value.y};
    }
};
struct EarlyDepthOut : DepthOut {
    static constexpr bool kForceEarlyDepthStencil = true;
};

TEST(PixelShader, R124R131R135WrittenDepthReplacesZAndIsClamped)
{
    for (auto [written, stored] : {std::pair{0.25f, 0.25f},
                                   {7.0f, 1.0f},
                                   {-3.0f, 0.0f},
                                   {kNan, 0.0f},
                                   {std::numeric_limits<float>::max(), 1.0f}}) {
        Scene s;
        s.use(DepthOut{});
        s.target.depth_stencil.depth_func = Comparison::LessEqual;
        s.add_full(0.5f, {1, written, 0, 0});
        DrawStatistics const& n = s.draw();
        EXPECT_EQ(s.depth.depth(3, 3), stored);
        EXPECT_EQ(n.pipeline.PSInvocations, 256u); // R163: all of them
    }
    Scene early; // R131: the written depth is ignored
    early.use(EarlyDepthOut{});
    early.add_full(0.5f, {1, 0.25f, 0, 0});
    early.draw();
    EXPECT_EQ(early.depth.depth(3, 3), 0.5f);
}

struct DepthBack {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        float4<T> color;
        T depth;
    };
    template <class T> Out<T> operator()(PixelInput<T> const& p, SceneValue<T> const& in) const
    {
        return {in.value, p.position.z};
    }
};

TEST(PixelShader, R122WritingZBackEqualsNotWritingIt)
{
    for (Format f : {Format::D16_UNORM, Format::D24_UNORM_S8_UINT, Format::D32_FLOAT}) {
        Scene a(16, 16, 1, Format::R32G32B32A32_FLOAT, f),
            b(16, 16, 1, Format::R32G32B32A32_FLOAT, f);
        b.use(DepthBack{});
        for (Scene* s : {&a, &b}) {
            s->add(0, 0, 0.1f).add(40, 3, 0.9f, 3).add(2, 50, 0.4f, 2);
            s->add(16, 16, 0.9f).add(0, 16, 0.1f).add(16, 0, 0.5f);
            s->draw();
        }
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                ASSERT_EQ(a.depth.codes()[a.depth.index(x, y)],
                          b.depth.codes()[b.depth.index(x, y)]);
                ASSERT_EQ(a.color.load(x, y), b.color.load(x, y));
            }
    }
}

struct Discard {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        float4<T> color;
        mask_of<T> discard;
    };
    template <class T> Out<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        // Uses its derivative after it is dead.
        T const x = ddx(p.position.x) + p.position.y * T(0);
        return {{x, x, x, x}, p.position.x < T(8)};
    }
};

TEST(PixelShader, R125R165DiscardLeavesNoTrace)
{
    Scene s;
    s.use(Discard{});
    s.add_full();
    DrawStatistics const& n = s.draw();
    EXPECT_EQ(s.covered(), 8 * 16);
    EXPECT_EQ(s.depth.depth(3, 3), 1.0f);
    EXPECT_EQ(s.depth.depth(9, 3), 0.5f);
    EXPECT_EQ(n.samples_passed, 8u * 16);
    EXPECT_EQ(n.pipeline.PSInvocations, 256u);
}

struct TwoColors {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        std::array<float4<T>, 2> color;
    };
    template <class T> Out<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        return {{in.value, float4<T>(T(0.5), T(0.25), T(0.125), T(1))}};
    }
};

TEST(OutputMerger, R126R137UndeclaredTargetsStayAndEightAreAllowed)
{
    Scene s;
    ColorTarget second(16, 16), third(16, 16);
    second.clear({1, 1, 1, 1}, ThreadPool(1));
    third.clear({1, 1, 1, 1}, ThreadPool(1));
    s.target.color = {&s.color, &second, &third};
    s.use(TwoColors{});
    s.add_full(0.5f, {3, 4, 5, 6});
    s.draw();
    EXPECT_EQ(s.at(2, 2), 3.0f);
    EXPECT_EQ(second.load(2, 2)[1], float_from_unorm(unorm_from_float(0.25f, 8), 8));
    EXPECT_EQ(third.load(2, 2)[0], 1.0f);
    s.target.color.resize(9, nullptr);
    EXPECT_THROW(s.draw(), LimitError);
}

// 0/0, its negative, infinity less infinity, and what the attribute brings.
struct MakeNans {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        T const zero = in.value.x, nan = zero / zero, inf = T(1) / zero;
        return {nan, T(-nan), T(inf - inf), in.value.w};
    }
};

TEST(OutputMerger, I4FloatTargetsHoldOneNan)
{
    for (bool general : {false, true})
        for (Format format : {Format::R32G32B32A32_FLOAT, Format::R16G16B16A16_FLOAT}) {
            Scene s(8, 8, 1, format);
            s.use(MakeNans{});
            s.target.blend.target[0].enable = general; // takes the draw off the streaming path
            s.add_full(0.5f, {0, 0, 0, std::bit_cast<float>(0x7fa12345u)});
            s.draw();
            std::byte const* const texel = s.color.texel(3, 4);
            for (int k = 0; k < 4; ++k) {
                std::uint32_t bits = 0;
                std::size_t const width = format == Format::R32G32B32A32_FLOAT ? 4 : 2;
                std::memcpy(&bits, texel + std::size_t(k) * width, width);
                EXPECT_EQ(bits, width == 4 ? 0x7fc00000u : 0x7e00u) << k << general;
            }
        }
}

TEST(OutputMerger, R6WithoutTargetsStatisticsAndOcclusionStillRun)
{
    Scene s;
    s.target.color.clear();
    s.target.depth = nullptr;
    s.add_full();
    DrawStatistics const& n = s.draw();
    EXPECT_EQ(n.pipeline.PSInvocations, 256u);
    EXPECT_EQ(n.samples_passed, 256u);
    Scene depth_only; // no pixel shader: depth is tested and written
    depth_only.desc.pixel_shader = nullptr;
    depth_only.add_full();
    EXPECT_EQ(depth_only.draw().pipeline.PSInvocations, 0u);
    EXPECT_EQ(depth_only.depth.depth(1, 1), 0.5f);
    EXPECT_EQ(depth_only.statistics.samples_passed, 256u);
}

TEST(OutputMerger, R5WithoutPixelShaderDepthAndStencilRasterizationIsOff)
{
    Scene s;
    s.desc.pixel_shader = nullptr;
    s.target.depth_stencil.depth_enable = false;
    s.add_full();
    EXPECT_EQ(s.draw().pipeline.CInvocations, 0u);
    s.target.depth_stencil.stencil_enable = true;
    EXPECT_EQ(s.draw().pipeline.CInvocations, 1u);
}

TEST(DepthTest, R130WithoutDepthNothingIsTestedOrWritten)
{
    Scene s;
    s.target.depth_stencil.depth_enable = false;
    s.clear({}, 0);
    s.add_full();
    s.draw();
    EXPECT_EQ(s.covered(), 256);
    EXPECT_EQ(s.depth.depth(1, 1), 0.0f);
}

TEST(DepthTest, R133ComparesNewWithStored)
{
    struct {
        Comparison func;
        bool less, equal, greater;
    } const table[] = {
        {Comparison::Never, false, false, false},      {Comparison::Less, true, false, false},
        {Comparison::Equal, false, true, false},       {Comparison::LessEqual, true, true, false},
        {Comparison::Greater, false, false, true},     {Comparison::NotEqual, true, false, true},
        {Comparison::GreaterEqual, false, true, true}, {Comparison::Always, true, true, true}};
    for (auto const& row : table)
        for (auto [z, pass] :
             {std::pair{0.25f, row.less}, {0.5f, row.equal}, {0.75f, row.greater}}) {
            Scene s;
            s.target.depth_stencil.depth_func = row.func;
            s.clear({}, 0.5f);
            s.add_full(z);
            s.draw();
            EXPECT_EQ(s.covered(), pass ? 256 : 0) << int(row.func) << " " << z;
            EXPECT_EQ(s.depth.depth(2, 2), pass ? z : 0.5f);
        }
}

TEST(DepthTest, R133StencilOperationsAndMasksFollowTheFace)
{
    EXPECT_EQ(apply(StencilOp::IncrSat, 255, 0), 255);
    EXPECT_EQ(apply(StencilOp::Incr, 255, 0), 0);
    EXPECT_EQ(apply(StencilOp::DecrSat, 0, 0), 0);
    EXPECT_EQ(apply(StencilOp::Decr, 0, 0), 255);
    EXPECT_EQ(apply(StencilOp::Invert, 0x0f, 0), 0xf0);
    EXPECT_EQ(apply(StencilOp::Replace, 1, 9), 9);
    EXPECT_EQ(apply(StencilOp::Zero, 7, 9), 0);
    EXPECT_EQ(apply(StencilOp::Keep, 7, 9), 7);
    auto const stencil = [](Comparison func, float z, bool counter_clockwise,
                            std::uint8_t write_mask) {
        Scene s(16, 16, 1, Format::R32G32B32A32_FLOAT, Format::D24_UNORM_S8_UINT);
        s.clear({}, 0.5f, 0x33);
        auto& d = s.target.depth_stencil;
        d.stencil_enable = true;
        d.stencil_ref = 0xf3;
        d.stencil_read_mask = 0x0f;
        d.stencil_write_mask = write_mask;
        d.front = {StencilOp::Zero, StencilOp::Invert, StencilOp::Replace, func};
        d.back = {StencilOp::Keep, StencilOp::Keep, StencilOp::Incr, Comparison::Always};
        s.target.rasterizer.front_counter_clockwise = counter_clockwise;
        s.add_full(z);
        s.draw();
        return std::pair(int(s.depth.stencil()[s.depth.index(3, 3)]), s.covered());
    };
    using P = std::pair<int, int>;
    EXPECT_EQ(stencil(Comparison::Equal, 0.25f, false, 0xff), (P{0xf3, 256})); // 3 = 3: replaced
    EXPECT_EQ(stencil(Comparison::Less, 0.25f, false, 0xff), (P{0, 0}));
    EXPECT_EQ(stencil(Comparison::Equal, 0.75f, false, 0xff), (P{0xcc, 0})); // depth fails
    EXPECT_EQ(stencil(Comparison::Equal, 0.25f, false, 0xc0), (P{0xf3, 256}));
    EXPECT_EQ(stencil(Comparison::Less, 0.25f, false, 0xf0), (P{0x03, 0}));
    EXPECT_EQ(stencil(Comparison::Never, 0.25f, true, 0xff), (P{0x34, 256})); // the back face's
}

TEST(DepthTest, R134DepthIsRoundedToItsFormatAndComparedThere)
{
    for (auto [format, bits] :
         {std::pair{Format::D16_UNORM, 16}, {Format::D24_UNORM_S8_UINT, 24}}) {
        Scene s(16, 16, 1, Format::R32G32B32A32_FLOAT, format);
        float const z = 0.3333333f;
        s.add_full(z);
        s.draw();
        EXPECT_EQ(s.depth.codes()[s.depth.index(2, 2)], unorm_from_float(z, bits));
        if (bits == 16) { // a smaller z of the same code is not LESS
            s.clear();
            s.add_full(std::nextafter(z, 0.0f));
            EXPECT_EQ(s.draw().samples_passed, 256u);
        }
    }
    Scene f;
    f.add_full(0.3333333f);
    f.draw();
    EXPECT_EQ(f.depth.depth(2, 2), 0.3333333f);
}

TEST(Blending, R136R137I20OperationsFactorsAndClamps)
{
    using A = std::array<float, 4>;
    A const s{0.5f, 0.25f, 2.0f, 0.5f}, d{0.25f, 0.5f, 1.0f, 0.75f}, s1{0.1f, 0.2f, 0.3f, 0.4f},
        f{0.9f, 0.8f, 0.7f, 0.6f};
    auto const run = [&](Blend src, Blend dest, BlendOp op, FormatType type) {
        RenderTargetBlend b{true, src, dest, op, src, dest, op, 0xf};
        return blend(b, f, type, s, s1, d);
    };
    EXPECT_EQ(run(Blend::One, Blend::One, BlendOp::Add, FormatType::Float),
              (A{0.75f, 0.75f, 3.0f, 1.25f}));
    EXPECT_EQ(run(Blend::One, Blend::One, BlendOp::Add, FormatType::Unorm),
              (A{0.75f, 0.75f, 1.0f, 1.0f}));
    EXPECT_EQ(run(Blend::SrcAlpha, Blend::InvSrcAlpha, BlendOp::Add, FormatType::Float),
              (A{0.375f, 0.375f, 1.5f, 0.625f}));
    EXPECT_EQ(run(Blend::One, Blend::One, BlendOp::Subtract, FormatType::Unorm),
              (A{0.25f, 0.0f, 0.0f, 0.0f}));
    EXPECT_EQ(run(Blend::One, Blend::One, BlendOp::RevSubtract, FormatType::Float),
              (A{-0.25f, 0.25f, -1.0f, 0.25f}));
    EXPECT_EQ(run(Blend::Zero, Blend::Zero, BlendOp::Min, FormatType::Float),
              (A{0.25f, 0.25f, 1.0f, 0.5f})); // factors do not matter
    EXPECT_EQ(run(Blend::Zero, Blend::Zero, BlendOp::Max, FormatType::Float),
              (A{0.5f, 0.5f, 2.0f, 0.75f}));
    EXPECT_EQ(run(Blend::SrcAlphaSat, Blend::Zero, BlendOp::Add, FormatType::Float),
              (A{0.125f, 0.0625f, 0.5f, 0.5f})); // min(1 - 0.75, 0.5), alpha 1
    EXPECT_EQ(run(Blend::BlendFactor, Blend::Zero, BlendOp::Add, FormatType::Float)[1],
              0.25f * 0.8f);
    EXPECT_EQ(run(Blend::InvBlendFactor, Blend::Zero, BlendOp::Add, FormatType::Float)[1],
              0.25f * (1 - 0.8f));
    EXPECT_EQ(run(Blend::Src1Color, Blend::Zero, BlendOp::Add, FormatType::Float)[2], 2.0f * 0.3f);
    EXPECT_EQ(run(Blend::InvSrc1Alpha, Blend::Zero, BlendOp::Add, FormatType::Float)[0],
              0.5f * (1 - 0.4f));
    EXPECT_EQ(run(Blend::DestColor, Blend::DestAlpha, BlendOp::Add, FormatType::Float)[0],
              0.5f * 0.25f + 0.25f * 0.75f);
    // Float targets: NaN propagates even with weight 0.
    RenderTargetBlend zero{true,        Blend::Zero, Blend::One,   BlendOp::Add,
                           Blend::Zero, Blend::One,  BlendOp::Add, 0xf};
    EXPECT_TRUE(std::isnan(blend(zero, f, FormatType::Float, {kNan, 0, 0, 0}, s1, d)[0]));
    EXPECT_EQ(blend(zero, f, FormatType::Unorm, {kNan, 0, 0, 0}, s1, d)[0], 0.25f);
}

TEST(Blending, R137OneEntryHoldsForAllTargetsUnlessIndependent)
{
    for (bool independent : {false, true}) {
        Scene s;
        ColorTarget second(16, 16);
        s.clear({1, 1, 1, 1});
        second.clear({1, 1, 1, 1}, ThreadPool(1));
        s.target.color = {&s.color, &second};
        s.use(TwoColors{});
        s.target.blend.independent_blend = independent;
        s.target.blend.target[0].enable = true;
        s.target.blend.target[0].dest = Blend::One;
        s.add_full(0.5f, {1, 1, 1, 1});
        s.draw();
        EXPECT_EQ(s.at(1, 1), 2.0f);
        EXPECT_EQ(second.load(1, 1)[0], independent ? float_from_unorm(128, 8) : 1.0f);
    }
}

TEST(Blending, R138MasksStopWritesOnlyAndSrgbBlendsInLinearSpace)
{
    Scene s(16, 16, 1, Format::R8G8B8A8_UNORM_SRGB);
    s.clear({0.25f, 0.25f, 0.25f, 0.5f});
    s.target.blend.target[0] = {true,        Blend::DestAlpha, Blend::One,   BlendOp::Add,
                                Blend::Zero, Blend::Zero,      BlendOp::Add, 0b0101};
    s.add_full(0.5f, {0.5f, 0.5f, 0.5f, 1});
    float const before = s.at(1, 1, 1), alpha = s.at(1, 1, 3);
    s.draw();
    float const stored = linear_from_srgb8(srgb8_from_linear(0.25f));
    std::uint8_t const expected = srgb8_from_linear(0.5f * alpha + stored);
    EXPECT_EQ(std::uint8_t(s.color.texel(1, 1)[0]), expected);
    EXPECT_EQ(s.at(1, 1, 1), before);
    EXPECT_EQ(s.at(1, 1, 3), alpha); // read, though masked
}

TEST(DepthTest, R139ReadOnlyViewsAreTestedAndNotWritten)
{
    Scene s(16, 16, 1, Format::R32G32B32A32_FLOAT, Format::D24_UNORM_S8_UINT);
    s.target.depth_read_only = s.target.stencil_read_only = true;
    s.target.depth_stencil.stencil_enable = true;
    s.target.depth_stencil.front.pass = StencilOp::Incr;
    s.target.depth_stencil.back.pass = StencilOp::Incr;
    s.add_full();
    s.draw();
    EXPECT_EQ(s.covered(), 256);
    EXPECT_EQ(s.depth.depth(1, 1), 1.0f);
    EXPECT_EQ(s.depth.stencil()[0], 0);
    s.target.depth_read_only = false;
    s.target.depth_stencil.depth_write = false; // R139: the state too
    s.draw();
    EXPECT_EQ(s.depth.depth(1, 1), 1.0f);
}

TEST(Clear, R140CoversTheWholeViewWhateverTheScissor)
{
    Scene s(20, 20, 2);
    s.clear({0.5f, 0, 0, 0}, 0.25f);
    EXPECT_EQ(s.covered(), 20 * 20 * 2);
    EXPECT_EQ(s.depth.depth(19, 19, 1), 0.25f);
}

} // namespace
} // namespace tessemu::test
