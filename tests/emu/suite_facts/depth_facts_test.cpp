// Facts S37 to S44 of other suites: depth bias, written depth, early tests, stencil.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/quad_scene.h"

#include <bit>

namespace tessemu::test {
namespace {

constexpr Format kDepthFormats[] = {Format::D16_UNORM, Format::D24_UNORM_S8_UINT,
                                    Format::D32_FLOAT};

// Codes of a UNORM depth format above 0; 0 of a float one.
double top_code(Format f)
{
    return f == Format::D16_UNORM ? 65535 : f == Format::D24_UNORM_S8_UINT ? 16777215 : 0;
}

double clamped(double bias, double clamp)
{
    return clamp > 0 ? std::min(clamp, bias) : clamp < 0 ? std::max(clamp, bias) : bias;
}

double ulps_between(float a, float b)
{
    return std::fabs(double(std::bit_cast<std::int32_t>(a)) -
                     double(std::bit_cast<std::int32_t>(b)));
}

TEST(DepthBias, S37AConstantCountsInStepsOfTheFormat)
{
    std::vector<std::int32_t> biases{50, 100, 200, 500, -100, 1000, -1000, 10000, -10000};
    for (int b = 1; b <= 10; ++b) biases.insert(biases.end(), {b, -b});
    for (Format format : kDepthFormats) {
        Scene s(4, 4, 1, Format::R32G32B32A32_FLOAT, format);
        s.threads = 1;
        s.target.depth_stencil.depth_func = Comparison::Always;
        double const top = top_code(format);
        for (auto [z, exponent] : {std::pair{0.125f, -3}, {0.25f, -2}, {0.5f, -1}, {1.0f, 0}})
            for (float clamp : {0.0f, 1e-5f, -1e-5f})
                for (std::int32_t b : biases) {
                    s.target.rasterizer.depth_bias = b;
                    s.target.rasterizer.depth_bias_clamp = clamp;
                    set_quad(s, {1, 1, 1, 1}, z);
                    s.draw();
                    double const step = top ? 1 / top : std::ldexp(1.0, exponent - 23);
                    double const ideal = std::clamp(z + clamped(b * step, clamp), 0.0, 1.0);
                    if (top) {
                        // Nearest code of the ideal; z and the step are rounded to 2^-24 of it, so
                        // a tie may fall to either side: the suite allows a code.
                        double const code = s.depth.codes()[s.depth.index(1, 2)];
                        EXPECT_LE(std::fabs(code - std::floor(ideal * top + 0.5)), 1)
                            << z << " " << b << " " << clamp;
                    } else {
                        // The bias is exact, the sum rounds once.
                        EXPECT_EQ(s.depth.depth(1, 2), float(ideal)) << z << " " << b;
                    }
                }
    }
}

TEST(DepthBias, S38ASlopeCountsInDepthPerPixel)
{
    for (Format format : kDepthFormats) {
        Scene s(4, 200, 1, Format::R32G32B32A32_FLOAT, format);
        s.threads = 1;
        s.target.depth_stencil.depth_func = Comparison::Always;
        double const top = top_code(format);
        for (float range : {0.0f, 0.5f, 1.0f})
            for (float scale : {0.5f, 1.0f, 2.0f, 3.0f, 5.0f, 10.0f, 50.0f, 10000.0f})
                for (float clamp : {0.0f, 1e-5f}) {
                    s.target.rasterizer.slope_scaled_depth_bias = scale;
                    s.target.rasterizer.depth_bias_clamp = clamp;
                    set_quad(s);
                    for (std::size_t i = 0; i < 4; ++i) // range at the lower edge
                        s.vertices[8 * i + 2] = i % 2 ? 0.0f : range;
                    s.draw();
                    double const bias = clamped(double(scale) * range / 200, clamp);
                    for (int y = 0; y < 200; ++y) {
                        double const ideal = std::clamp((y + 0.5) / 200 * range + bias, 0.0, 1.0);
                        float const got = s.depth.depth(2, y);
                        // The suite's bounds: 64 ulp, 3 codes of 24 bits, 1 of 16.
                        if (top) {
                            EXPECT_LE(std::fabs(s.depth.codes()[s.depth.index(2, y)] -
                                                std::floor(ideal * top + 0.5)),
                                      format == Format::D16_UNORM ? 1 : 3)
                                << range << " " << scale << " " << y;
                        } else {
                            EXPECT_LE(ulps_between(got, float(ideal)), 64)
                                << range << " " << scale << " " << y;
                        }
                    }
                }
    }
}

TEST(DepthBias, S39ABiasOfOneIsOneCodeOfEachFormat)
{
    struct {
        Format format;
        std::uint32_t one_above, far_above; // cleared to, as bits
    } const table[] = {{Format::D16_UNORM, 0x3c802000, 0x3c820000},
                       {Format::D24_UNORM_S8_UINT, 0x3c800020, 0x3c800200},
                       {Format::D32_FLOAT, 0x3c800001, 0x3c800020}};
    for (auto const& row : table) {
        auto const passes = [&](std::int32_t bias, std::uint32_t clear) {
            Scene s(4, 4, 1, Format::R32G32B32A32_FLOAT, row.format);
            s.target.depth_stencil.depth_func = Comparison::GreaterEqual;
            s.target.rasterizer.depth_bias = bias;
            s.clear({}, std::bit_cast<float>(clear));
            set_quad(s, {1, 1, 1, 1}, std::bit_cast<float>(0x3c800000u));
            s.draw();
            return s.covered() == 16;
        };
        EXPECT_TRUE(passes(1, row.one_above));
        EXPECT_FALSE(passes(0, row.one_above));
        EXPECT_FALSE(passes(1, row.far_above));
    }
}

struct ShowDepth {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {p.position.z, T(1), T(1), T(1)};
    }
};

TEST(DepthBias, S40F3PixelsSeeItWithoutATestAndWithoutABuffer)
{
    enum class Buffer { D16, D24, D32, None };
    std::int32_t const bias = 1000;
    auto const seen = [&](Buffer buffer, bool test, UnboundDepthBias unbound) {
        Format const formats[] = {Format::D16_UNORM, Format::D24_UNORM_S8_UINT, Format::D32_FLOAT,
                                  Format::D32_FLOAT};
        Scene s(4, 4, 1, Format::R32G32B32A32_FLOAT, formats[int(buffer)]);
        s.use(ShowDepth{});
        if (buffer == Buffer::None) s.target.depth = nullptr;
        s.target.depth_stencil.depth_enable = test;
        s.target.rasterizer.depth_bias = bias;
        s.target.rasterizer.unbound_depth_bias = unbound;
        set_quad(s, {1, 1, 1, 1}, 0.25f);
        s.draw();
        return s.at(2, 1);
    };
    // 0.25 is 2^-2, so a float buffer's step is 2^-25 and half of one of 24 bits.
    float const float_step = 0.25f + float(bias) * 0x1p-25f,
                step_24 = 0.25f + float(bias) * (1 / 16777215.0f),
                step_16 = 0.25f + float(bias) * (1 / 65535.0f);
    ASSERT_NE(float_step, step_24);
    for (bool test : {true, false})
        for (UnboundDepthBias unbound : {UnboundDepthBias::Unorm24, UnboundDepthBias::Float}) {
            EXPECT_EQ(seen(Buffer::D16, test, unbound), step_16);
            EXPECT_EQ(seen(Buffer::D24, test, unbound), step_24);
            EXPECT_EQ(seen(Buffer::D32, test, unbound), float_step);
            // The specification's way, and drivers'.
            EXPECT_EQ(seen(Buffer::None, test, unbound),
                      unbound == UnboundDepthBias::Unorm24 ? step_24 : float_step);
        }
    EXPECT_EQ(RasterizerState{}.unbound_depth_bias, UnboundDepthBias::Unorm24);
}

// Depth from value.x, and nothing else.
struct DepthOnly {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        T depth;
    };
    template <class T> Out<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        return {in.value.x};
    }
};

TEST(DepthTest, S41ConservativeDepthIsTestedAndStoredAsWritten)
{
    // SV_DepthLessEqual and SV_DepthGreaterEqual are promises about SV_Depth (R132): z, what is
    // written, and whether it passes against 0.5.
    struct {
        float z, written;
        bool passes;
    } const table[] = {{0.7f, 0.7f, true},
                       {0.7f, 0.4f, false}, // less or equal
                       {0.4f, 0.4f, false}, // both
                       {0.4f, 0.6f, true}}; // greater or equal
    for (auto const& row : table) {
        Scene s(4, 4);
        s.use(DepthOnly{});
        s.clear({}, 0.5f);
        s.target.depth_stencil.depth_func = Comparison::GreaterEqual;
        set_quad(s, {row.written, 0, 0, 0}, row.z);
        EXPECT_EQ(s.draw().samples_passed, row.passes ? 16u : 0u);
        EXPECT_EQ(s.depth.depth(1, 1), row.passes ? row.written : 0.5f);
    }
}

struct ForcedEarly : ShowValue {
    static constexpr bool kForceEarlyDepthStencil = true;
};

TEST(DepthTest, S42AForcedEarlyTestDecidesWhichPixelsRun)
{
    Scene s(1, 100);
    s.use(ForcedEarly{});
    s.target.viewports = {{0, 0, 1, 100, 0.5f, 0.5f}};
    s.target.depth_stencil.depth_func = Comparison::LessEqual;
    s.target.depth_stencil.depth_write = false;
    set_quad(s);
    std::uint64_t run = 0;
    auto const after = [&](float clear) {
        s.clear({}, clear);
        return run += s.draw().pipeline.PSInvocations;
    };
    EXPECT_EQ(after(0.6f), 100u);
    EXPECT_EQ(after(0.6f), 200u);
    EXPECT_EQ(after(0.3f), 200u);
    EXPECT_EQ(after(0.55f), 300u);
    EXPECT_EQ(after(0.5f), 400u);
}

TEST(DepthTest, S43DepthIsWrittenWithoutAPixelShaderAndByOneThatWritesNothingElse)
{
    Scene s(4, 4);
    s.target.color.clear();
    auto const drawn = [&](float written) {
        set_quad(s, {written, 0, 0, 0});
        s.draw();
        return s.depth.depth(2, 2);
    };
    s.desc.pixel_shader = nullptr;
    EXPECT_EQ(drawn(0), 0.0f);
    s.use(DepthOnly{});
    EXPECT_EQ(drawn(0.7f), 0.0f); // not less than 0
    s.clear();
    EXPECT_EQ(drawn(0.7f), 0.7f);
    EXPECT_EQ(drawn(0.8f), 0.7f);
    EXPECT_EQ(drawn(0.5f), 0.5f);
}

TEST(DepthTest, S44EachFaceHasItsStencilTest)
{
    for (bool front_counter : {false, true})
        for (bool counter : {false, true}) {
            Scene s(8, 8, 1, Format::R32G32B32A32_FLOAT, Format::D24_UNORM_S8_UINT);
            s.target.rasterizer.front_counter_clockwise = front_counter;
            s.target.depth_stencil.depth_enable = false;
            s.target.depth_stencil.stencil_enable = true;
            s.target.depth_stencil.front.func = Comparison::Never;
            s.target.depth_stencil.back.func = Comparison::Always;
            set_quad(s);
            if (counter) // mirrored
                for (std::size_t i = 0; i < 4; ++i) s.vertices[8 * i] *= -1;
            s.draw();
            EXPECT_EQ(s.covered(), front_counter == counter ? 0 : 64) << front_counter << counter;
        }
}

TEST(DepthTest, G15WithoutABufferDepthAndStencilPass)
{
    for (bool has_shader : {true, false}) {
        Scene s(8, 8);
        s.target.depth = nullptr;
        auto& d = s.target.depth_stencil;
        d.depth_enable = d.stencil_enable = true;
        d.depth_func = d.front.func = d.back.func = Comparison::Never;
        if (!has_shader) s.desc.pixel_shader = nullptr;
        set_quad(s);
        EXPECT_EQ(s.draw().samples_passed, 64u);
        EXPECT_EQ(s.covered(), has_shader ? 64 : 0);
        // A format without stencil passes every stencil test, too.
        s.target.depth = &s.depth;
        d.depth_func = Comparison::Less;
        s.clear();
        EXPECT_EQ(s.draw().samples_passed, 64u);
    }
}

} // namespace
} // namespace tessemu::test
