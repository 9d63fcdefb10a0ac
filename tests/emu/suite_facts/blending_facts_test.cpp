// Facts S52 to S58 of other suites: blending, write masks, clears, special numbers.
//
// Words are ours; where a suite's differ they are given too, with the codes that it allows.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/quad_scene.h"

#include <algorithm>
#include <memory>

namespace tessemu::test {
namespace {

// The attribute into eight targets.
struct EightColors {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        std::array<float4<T>, 8> color;
    };
    template <class T> Out<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        Out<T> out;
        out.color.fill(in.value);
        return out;
    }
};

struct EightTargets : Scene {
    std::vector<std::unique_ptr<ColorTarget>> targets;
    explicit EightTargets(std::array<float, 4> const& cleared) : Scene(4, 4)
    {
        target.color.clear();
        for (int i = 0; i < 8; ++i) {
            targets.push_back(std::make_unique<ColorTarget>(4, 4));
            targets.back()->clear(cleared, ThreadPool(1));
            target.color.push_back(targets.back().get());
        }
        target.depth_stencil.depth_enable = false;
        use(EightColors{});
    }
    std::uint32_t word_of(std::size_t i) const { return word(*targets[i], 2, 1); }
};

TEST(Blending, S52EightTargetsBlendEachInItsOwnWay)
{
    using B = Blend;
    using O = BlendOp;
    // Colour, then alpha: source factor, destination factor, operation.
    RenderTargetBlend const states[8] = {
        {true, B::SrcAlpha, B::DestAlpha, O::Add, B::One, B::Zero, O::Add},
        {true, B::One, B::Zero, O::Add, B::Zero, B::One, O::Add},
        {true, B::SrcColor, B::DestColor, O::Add, B::SrcAlpha, B::DestAlpha, O::Add},
        {true, B::One, B::One, O::Min, B::One, B::One, O::Min},
        {true, B::BlendFactor, B::BlendFactor, O::Add, B::One, B::One, O::Max},
        {true, B::BlendFactor, B::SrcAlpha, O::Subtract, B::One, B::One, O::RevSubtract},
        {},
        {true, B::DestColor, B::SrcColor, O::Add, B::InvSrcAlpha, B::InvDestAlpha, O::Subtract}};
    std::uint32_t const suite[8] = {0x66426e1c, 0xb34c3319, 0xa6214a05, 0x66333319,
                                    0xb34c4829, 0x4d19000a, 0x664c3319, 0x081f3305};
    for (bool independent : {true, false}) {
        EightTargets s({0.1f, 0.5f, 0.2f, 0.7f});
        s.target.blend.independent_blend = independent;
        s.target.blend.blend_factor = {0.8f, 0.4f, 0.6f, 0.2f};
        std::copy(std::begin(states), std::end(states), s.target.blend.target.begin());
        set_quad(s, {0.1f, 0.2f, 0.3f, 0.4f});
        s.draw();
        for (std::size_t i = 0; i < 8; ++i)
            EXPECT_TRUE(near_word(s.word_of(i), suite[independent ? i : 0], 1)) << i;
    }
}

TEST(Blending, S53FactorsOfAlphaAndOfTheStatesColor)
{
    using B = Blend;
    auto const blended = [](B src, B dest, B src_alpha, B dest_alpha,
                            std::array<float, 4> const& color) {
        Scene s(4, 4, 1, Format::R8G8B8A8_UNORM);
        s.clear({1, 0, 0, 0.5f});
        s.target.blend.blend_factor = {0.3f, 0.4f, 0.8f, 0.9f};
        s.target.blend.target[0] = {true,      src,        dest,        BlendOp::Add,
                                    src_alpha, dest_alpha, BlendOp::Add};
        set_quad(s, color);
        s.draw();
        return word(s.color, 1, 2);
    };
    auto const both = [&](B src, B dest, std::array<float, 4> const& color) {
        return blended(src, dest, src, dest, color);
    };
    std::array<float, 4> const green{0, 1, 0, 0.25f}, blue{0, 0, 1, 0.75f};
    // The stored alpha is 128/255.
    EXPECT_EQ(both(B::SrcAlpha, B::InvSrcAlpha, green), 0x700040bfu);
    EXPECT_EQ(both(B::DestAlpha, B::InvDestAlpha, blue), 0xa080007fu);
    auto const factor = [&](std::array<float, 4> const& color) {
        return blended(B::BlendFactor, B::InvBlendFactor, B::DestAlpha, B::InvDestAlpha, color);
    };
    EXPECT_TRUE(near_word(factor(green), 0x600066b3, 1)); // red is 178.5 codes
    EXPECT_TRUE(near_word(factor(blue), 0xa0cc00b3, 1));
}

struct TwoSources {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        std::array<float4<T>, 2> color;
    };
    template <class T> Out<T> operator()(PixelInput<T> const&, SceneValue<T> const&) const
    {
        return {{float4<T>(T(0.5), T(0.5), T(0), T(0.5)), float4<T>(T(0), T(0.5), T(0.5), T(0))}};
    }
};

TEST(Blending, S54ASecondSourceWeighsBothSides)
{
    Scene s(4, 4, 1, Format::R8G8B8A8_UNORM);
    s.use(TwoSources{});
    s.clear({0.7f, 0, 1, 1});
    s.target.blend.target[0] = {true,       Blend::Src1Color, Blend::Src1Color, BlendOp::Add,
                                Blend::One, Blend::Zero,      BlendOp::Add};
    set_quad(s);
    s.draw();
    EXPECT_EQ(word(s.color, 1, 1), 0x80804000u);
}

TEST(Blending, S55WriteMasksAreEachTargetsOrTheFirst)
{
    std::uint8_t const masks[8] = {1, 2, 4, 15, 8, 3, 10, 0}; // R G B RGBA A RG GA none
    std::uint32_t const words[8] = {0xff000080, 0xff0080ff, 0xff8000ff, 0x80808080,
                                    0x800000ff, 0xff008080, 0x800080ff, 0xff0000ff};
    for (bool independent : {true, false}) {
        EightTargets s({1, 0, 0, 1});
        s.target.blend.independent_blend = independent;
        for (std::size_t i = 0; i < 8; ++i) s.target.blend.target[i].write_mask = masks[i];
        set_quad(s, {0.5f, 0.5f, 0.5f, 0.5f});
        s.draw();
        for (std::size_t i = 0; i < 8; ++i)
            EXPECT_EQ(s.word_of(i), words[independent ? i : 0]) << i;
    }
}

TEST(Blending, S56EachSideWeighedByItsAlphaIsTheSameInEitherOrder)
{
    std::array<float, 4> const red{1, 0, 0, 0.8f}, green{0, 1, 0, 0.5f};
    for (bool red_first : {true, false}) {
        Scene s(4, 4, 1, Format::R8G8B8A8_UNORM);
        s.clear(red_first ? red : green);
        s.target.blend.target[0] = {true,         Blend::SrcAlpha, Blend::DestAlpha,
                                    BlendOp::Add, Blend::SrcAlpha, Blend::DestAlpha,
                                    BlendOp::Add};
        set_quad(s, red_first ? green : red);
        s.draw();
        EXPECT_TRUE(near_word(word(s.color, 3, 3), 0xe2007fcc, 1)); // green is 127.5 codes
    }
}

TEST(Clear, S57ColorsAreRoundedToTheFormat)
{
    // 25.5, 127.5, 76.5 and 191.25 codes: the suite rounds halves down and allows a code.
    for (auto [format, ours, suite] : {std::tuple{Format::R8G8B8A8_UNORM, 0xbf4d801au, 0xbf4c7f19u},
                                       {Format::R8G8B8A8_UNORM_SRGB, 0xbf95bc59u, 0xbf95bc59u}}) {
        ColorTarget t(7, 5, format);
        t.clear({0.1f, 0.5f, 0.3f, 0.75f}, ThreadPool(1));
        EXPECT_EQ(word(t, 6, 4), ours);
        EXPECT_TRUE(near_word(ours, suite, 1));
    }
}

struct Quotients {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, SceneValue<T> const& in) const
    {
        T const zero = in.value.x, one = in.value.y;
        return {zero / zero, one / zero, T(-one) / zero, one};
    }
};

TEST(OutputMerger, S58F4QuotientsByZeroAreNanAndInfinities)
{
    for (bool general : {false, true}) {
        Scene s(4, 4);
        s.use(Quotients{});
        s.target.blend.target[0].enable = general; // takes the draw off the streaming path
        set_quad(s, {0, 1, 0, 0});
        s.draw();
        std::uint32_t bits[4];
        std::memcpy(bits, s.color.texel(2, 2), 16);
        // The suite has ffc00000, which x86 makes of 0/0; the one NaN of targets has no sign (I-4).
        EXPECT_EQ(bits[0], kCanonicalNan);
        EXPECT_EQ(bits[1], 0x7f800000u);
        EXPECT_EQ(bits[2], 0xff800000u);
        EXPECT_EQ(bits[3], 0x3f800000u);
    }
}

} // namespace
} // namespace tessemu::test
