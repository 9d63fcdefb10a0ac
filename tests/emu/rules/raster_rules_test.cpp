// Rules R90 to R119: clipping, viewport, coverage, lines, points, samples.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessemu::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A vertex with clip and cull distances behind the value.
template <class T> struct Distances {
    float4<T> position, value;
    T clip, cull;
    static constexpr int kClipDistances = 1, kCullDistances = 1;
    static constexpr auto signature()
    {
        return std::tuple{&Distances::position, &Distances::value, &Distances::clip,
                          &Distances::cull};
    }
};
// Clip distance = value.y, cull distance = value.z.
struct DistanceShader {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = Distances<T>;
    template <class T> Distances<T> operator()(VertexInput<T> const&, SceneVertex<T> const& v) const
    {
        return {v.position, v.value, v.value.y, v.value.z};
    }
};

TEST(Clipping, R90I12ClipsDepthExactlyAndXAndYToTheGuardBandOnly)
{
    Scene s;
    s.add(0, 0, -0.5f).add(32, 0, 0.5f).add(0, 32, 0.5f);
    s.draw();
    EXPECT_EQ(s.at(2, 2), 0.0f); // z below 0
    EXPECT_NE(s.at(12, 12), 0.0f);
    Scene outside; // partly left of the view, inside the band: not clipped
    outside.add(-100, 0).add(16, 0).add(16, 16);
    EXPECT_EQ(outside.draw().pipeline.CPrimitives, 1u);
    Scene tight; // I-12: a band of 0 clips at the viewport
    tight.target.rasterizer.guard_band_px = 0;
    tight.add(-100, 0).add(16, 0).add(16, 16);
    EXPECT_EQ(tight.draw().pipeline.CPrimitives, 2u);
    EXPECT_EQ(tight.covered(), outside.covered());
}

TEST(Clipping, R91DepthClipOffKeepsTheTriangleAndClampsItsDepth)
{
    Scene s;
    s.target.rasterizer.depth_clip_enable = false;
    s.target.depth_stencil.depth_func = Comparison::LessEqual;
    s.add_full(7.0f);
    s.draw();
    EXPECT_EQ(s.covered(), 256);
    EXPECT_EQ(s.depth.depth(3, 3), 1.0f); // R135
    Scene behind;
    behind.target.rasterizer.depth_clip_enable = false;
    behind.add(0, 0, 0.5f, -1).add(32, 0, 0.5f, -1).add(0, 32, 0.5f, -1);
    behind.draw();
    EXPECT_EQ(behind.covered(), 0); // w > 0 holds always
}

TEST(Clipping, R92CullDistanceDropsAPrimitiveAllOfWhoseVerticesAreBelowZero)
{
    auto const covered = [](std::array<float, 3> cull) {
        Scene s;
        s.desc.vertex_shader = bind_vertex_shader(DistanceShader{}, {});
        for (std::size_t i = 0; i < 3; ++i)
            s.add(i == 1 ? 32.0f : 0, i == 2 ? 32.0f : 0, 0.5f, 1, {1, 1, cull[i], 1});
        s.draw();
        return s.covered();
    };
    EXPECT_EQ(covered({-1, -1, -1}), 0);
    EXPECT_EQ(covered({-1, kNan, -1}), 0); // NaN counts as below 0
    EXPECT_EQ(covered({-1, 0, -1}), 256);
}

TEST(Clipping, R93ClipDistanceKeepsTheSamplesWhereItIsNotNegative)
{
    Scene s;
    s.desc.vertex_shader = bind_vertex_shader(DistanceShader{}, {});
    s.add(0, 0, 0.5f, 1, {1, -8, 1, 1}).add(32, 0, 0.5f, 1, {1, 24, 1, 1});
    s.add(0, 32, 0.5f, 1, {1, -8, 1, 1}); // distance x - 8
    s.draw();
    EXPECT_EQ(s.at(7, 5), 0.0f);
    EXPECT_NE(s.at(8, 5), 0.0f);
    EXPECT_EQ(s.covered(), 8 * 16);
    Scene nan;
    nan.desc.vertex_shader = bind_vertex_shader(DistanceShader{}, {});
    nan.add(0, 0, 0.5f, 1, {1, 1, 1, 1}).add(32, 0, 0.5f, 1, {1, kNan, 1, 1});
    nan.add(0, 32, 0.5f, 1, {1, 1, 1, 1});
    nan.draw();
    EXPECT_EQ(nan.covered(), 0);
}

TEST(Clipping, R94I13NanAndInfinityDropThePrimitiveAndLargeInputsDoNot)
{
    for (float bad : {kNan, std::numeric_limits<float>::infinity()}) {
        Scene s;
        s.add_full();
        s.vertices[1] = bad;
        EXPECT_EQ(s.draw().pipeline.CPrimitives, 0u);
    }
    Scene s; // within FLT_MAX / 16
    float const big = std::numeric_limits<float>::max() / 16;
    s.add_full();
    for (std::size_t i = 0; i < 24; i += 8)
        for (std::size_t k = 0; k < 4; ++k) s.vertices[i + k] *= k < 3 ? 1 : 1;
    s.vertices[8] = big, s.vertices[11] = 1;
    s.draw();
    EXPECT_GT(s.covered(), 0);
}

template <class T> struct Modes {
    T constant, smooth, flat, rest;
    static constexpr std::array<Interpolation, 4> kInterpolation{
        Interpolation::Constant, Interpolation::Linear, Interpolation::LinearNoperspective,
        Interpolation::Linear};
    static constexpr auto signature()
    {
        return std::tuple{&Modes::constant, &Modes::smooth, &Modes::flat, &Modes::rest};
    }
};
struct ShowModes {
    template <class T> using Input = Modes<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, Modes<T> const& in) const
    {
        return {in.constant, in.smooth, in.flat, in.rest};
    }
};

TEST(Clipping, R95CutVerticesKeepWhatTheUncutTriangleShows)
{
    // The same triangle, once cut at the far left by a tight band and once whole.
    std::array<float, 4> seen[2][2];
    for (int i = 0; i < 2; ++i) {
        Scene s;
        s.use(ShowModes{});
        s.target.rasterizer.guard_band_px = i == 0 ? 16384.0f : 0.0f;
        s.add(-60, 2, 0.5f, 4, {7, 1, 1, 1}).add(16, 0, 0.5f, 1, {8, 2, 2, 2});
        s.add(16, 16, 0.5f, 2, {9, 3, 3, 3});
        EXPECT_EQ(s.draw().pipeline.CPrimitives, i == 0 ? 1u : 2u);
        seen[i][0] = s.color.load(3, 4);
        seen[i][1] = s.color.load(12, 8);
    }
    for (int p = 0; p < 2; ++p) {
        EXPECT_EQ(seen[1][p][0], 7.0f); // the leading vertex's bits
        // A dozen roundings of values up to 3, and corners snapped anew to 1/512 pixel of 76.
        for (std::size_t k = 1; k < 3; ++k)
            EXPECT_NEAR(seen[0][p][k], seen[1][p][k], 12 * 3 * 0x1p-24 + 3.0 / 256 / 16);
    }
    EXPECT_NE(seen[0][0][1], seen[0][0][2]); // perspective matters here
}

TEST(Viewport, R96MapsClipSpaceToPixelsAndDepthToItsRange)
{
    Scene s;
    s.target.viewports = {{4, 6, 8, 4, 0.25f, 0.75f}};
    // The whole clip square at z = 0.5.
    for (auto [x, y] : {std::pair{-1.0f, 1.0f}, {3.0f, 1.0f}, {-1.0f, -3.0f}})
        s.vertices.insert(s.vertices.end(), {x, y, 0.5f, 1, 1, 1, 1, 1});
    s.draw();
    EXPECT_EQ(s.covered(), 8 * 4);
    EXPECT_NE(s.at(4, 6), 0.0f);
    EXPECT_NE(s.at(11, 9), 0.0f);
    EXPECT_EQ(s.depth.depth(5, 7), 0.5f);
}

TEST(Viewport, R97RefusesWhatLiesOutsideAndTheDefaultIsEmpty)
{
    for (Viewport v : {Viewport{0, 0, 40000, 1, 0, 1}, Viewport{0, 0, 4, 4, 0.5f, 0.25f},
                       Viewport{0, 0, 4, 4, 0, 1.5f}, Viewport{-40000, 0, 4, 4, 0, 1}}) {
        Scene s;
        s.target.viewports = {v};
        s.add_full();
        EXPECT_THROW(s.draw(), Error);
    }
    Scene many;
    many.target.scissors.resize(17);
    many.add_full();
    EXPECT_THROW(many.draw(), LimitError);
    Scene none;
    none.target.viewports = {};
    none.add_full();
    none.draw();
    EXPECT_EQ(none.covered(), 0);
}

TEST(Viewport, R98TheImplicitScissorFloorsSumsAndTheScissorIsHalfOpen)
{
    Scene s;
    s.target.viewports = {{1.75f, 2.75f, 4.5f, 4.5f, 0, 1}}; // 1.75 + 4.5 = 6.25: pixels 1 to 5
    s.add(-100, -100).add(300, -100).add(-100, 300);
    s.draw();
    EXPECT_NE(s.at(2, 3), 0.0f);
    EXPECT_EQ(s.at(6, 3), 0.0f);
    EXPECT_EQ(s.at(2, 7), 0.0f);
    Scene cut;
    cut.target.rasterizer.scissor_enable = true;
    cut.add_full();
    cut.draw();
    EXPECT_EQ(cut.covered(), 0); // the default rectangle is empty
    cut.target.scissors = {{3, 4, 5, 9}};
    cut.draw();
    EXPECT_EQ(cut.covered(), 2 * 5);
}

// One memory serves draws into targets of other sizes, formats and pipelines.
TEST(DrawMemory, ServesAnyDrawAfterAnyOther)
{
    DrawMemory memory;
    for (int round = 0; round < 2; ++round)
        for (auto [size, format] : {std::pair{1000, Format::R8G8B8A8_UNORM},
                                    {64, Format::R32G32B32A32_FLOAT},
                                    {300, Format::R8G8B8A8_UNORM},
                                    {1000, Format::R32G32B32A32_FLOAT}}) {
            Scene s(size, size, 1, format);
            s.options.memory = &memory;
            s.add_full();
            EXPECT_EQ(s.draw().samples_passed, std::uint64_t(size) * std::uint64_t(size));
            EXPECT_EQ(s.covered(), size * size);
        }
}

TEST(Rasterizer, R100R112PixelCentresLieAtOneHalfAndTargetsReach16384)
{
    Scene s;
    s.add(0.25f, 0.25f).add(0.75f, 0.25f).add(0.5f, 0.75f); // around the centre of pixel 0
    s.draw();
    EXPECT_EQ(s.covered(), 1);
    ColorTarget const wide(16384, 1, Format::R8_UNORM);
    EXPECT_EQ(wide.width(), 16384);
    EXPECT_THROW(ColorTarget(16385, 1), LimitError);
}

TEST(Rasterizer, R102R103I15SharedEdgesCoverEachSampleOnceAtEverySampleCount)
{
    // A fan of thin triangles around a point that is no pixel centre.
    for (int samples : {1, 2, 4, 8}) {
        Scene s(64, 64, samples);
        CoverageCounts counts(64, 64, samples);
        s.target.coverage = &counts;
        float const cx = 31.3f, cy = 29.7f;
        std::vector<std::pair<float, float>> rim;
        for (int i = 0; i < 64; i += 3) rim.emplace_back(float(i), 0.0f);
        for (int i = 0; i < 64; i += 5) rim.emplace_back(64.0f, float(i));
        for (int i = 64; i > 0; i -= 7) rim.emplace_back(float(i), 64.0f);
        for (int i = 64; i > 0; i -= 2) rim.emplace_back(0.0f, float(i));
        for (std::size_t i = 0; i < rim.size(); ++i) {
            auto const a = rim[i], b = rim[(i + 1) % rim.size()];
            s.add(cx, cy).add(a.first, a.second).add(b.first, b.second);
        }
        s.draw();
        for (std::uint32_t n : counts.count) ASSERT_EQ(n, 1u) << samples << " samples";
    }
}

TEST(Rasterizer, R104R105ZeroAreaIsBackFacingAndCoversNothing)
{
    Scene s;
    s.add(2, 2).add(8, 8).add(14, 14);
    EXPECT_EQ(s.draw().pipeline.CPrimitives, 1u);
    EXPECT_EQ(s.covered(), 0);
    // In wireframe its lines are there, unless back faces are culled.
    s.target.rasterizer.fill = FillMode::Wireframe;
    s.draw();
    EXPECT_GT(s.covered(), 0);
    s.clear();
    s.target.rasterizer.cull = CullMode::Back;
    s.draw();
    EXPECT_EQ(s.covered(), 0);
}

// Pixels of one line, as text.
std::string line_pixels(float x0, float y0, float x1, float y1)
{
    Scene s(8, 8);
    s.call.topology = PrimitiveTopology::LineList;
    s.add(x0, y0).add(x1, y1);
    s.draw();
    std::string out;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            if (s.at(x, y) != 0) out += " " + std::to_string(x) + "," + std::to_string(y);
    return out;
}

TEST(Lines, R106I19DrawThePixelsWhoseDiamondIsLeft)
{
    EXPECT_EQ(line_pixels(1.5f, 2.5f, 4.5f, 2.5f), " 1,2 2,2 3,2"); // the last one is not left
    EXPECT_EQ(line_pixels(4.5f, 2.5f, 1.5f, 2.5f), " 2,2 3,2 4,2");
    EXPECT_EQ(line_pixels(2.5f, 1.5f, 2.5f, 4.5f), " 2,1 2,2 2,3");
    EXPECT_EQ(line_pixels(1.5f, 1.5f, 4.5f, 4.5f), " 1,1 2,2 3,3");
    EXPECT_EQ(line_pixels(2.25f, 2.5f, 2.75f, 2.5f), "");    // inside one diamond
    EXPECT_EQ(line_pixels(2.5f, 2.5f, 3.25f, 2.5f), " 2,2"); // out into the gap
    EXPECT_EQ(line_pixels(2.5f, 2.5f, 2.5f, 2.5f), "");      // no length
    // Along y = 3 exactly, between rows: the bottom corners of row 2's diamonds belong to them.
    EXPECT_EQ(line_pixels(1.0f, 3.0f, 5.0f, 3.0f), " 1,2 2,2 3,2 4,2");
    // Along x = 3, y-major: the right corners of column 2 belong to it.
    EXPECT_EQ(line_pixels(3.0f, 1.0f, 3.0f, 4.0f), " 2,1 2,2 2,3");
}

TEST(Lines, R106AStripGivesEachInnerPixelOnce)
{
    Scene s(32, 32);
    s.call.topology = PrimitiveTopology::LineStrip;
    CoverageCounts counts(32, 32);
    s.target.coverage = &counts;
    s.add(2.5f, 3.5f).add(20.5f, 9.5f).add(29.5f, 27.5f);
    s.draw();
    std::uint32_t most = 0, all = 0;
    for (std::uint32_t n : counts.count) most = std::max(most, n), all += n;
    EXPECT_EQ(most, 1u);
    EXPECT_EQ(all, 18u + 18u); // as many as columns, then rows
}

TEST(Lines, R107MultisampledLinesAreRectanglesOneAndTwoFifthsWide)
{
    Scene s(32, 32, 8);
    s.call.topology = PrimitiveTopology::LineList;
    s.target.rasterizer.multisample_enable = true;
    s.add(4, 16, 0.5f, 1, {1, 0, 0, 0}).add(24, 16, 0.5f, 1, {2, 0, 0, 0});
    s.draw();
    // The rectangle: x from 4 to 24, y from 16 - 179/256 to 16 + 179/256. Of the samples' offsets
    // from a pixel's centre, in 1/16 (-7, -5, -3, -1, 1, 3, 5, 7), those from -3 on lie in it in
    // row 15 and those up to 3 in row 16; each has 6. Along the line pixels have all or none.
    EXPECT_EQ(s.covered(), 20 * (6 + 6));
    for (int x = 0; x < 32; ++x)
        for (int y : {14, 15, 16, 17}) {
            int samples = 0;
            for (int k = 0; k < 8; ++k) {
                float const v = s.at(x, y, 0, k);
                if (v == 0) continue;
                ++samples;
                // Of the pixel's centre, so constant across and growing along. Three roundings: the
                // reciprocal of the squared length and that times the distance, of a number up to
                // 1; a sum up to 2.
                EXPECT_NEAR(v, 1 + (x + 0.5 - 4) / 20, 3.0001 * 0x1p-24) << x << "," << y;
            }
            bool const in = x >= 4 && x < 24 && (y == 15 || y == 16);
            EXPECT_EQ(samples, in ? 6 : 0) << x << "," << y;
        }
}

TEST(Points, R108AreSquaresOfOnePixelAndNeverCulled)
{
    Scene s;
    s.call.topology = PrimitiveTopology::PointList;
    s.target.rasterizer.cull = CullMode::Front;
    s.add(3.5f, 4.5f).add(9.0f, 9.0f);
    s.draw();
    EXPECT_EQ(s.covered(), 2);
    EXPECT_NE(s.at(3, 4), 0.0f);
    EXPECT_NE(s.at(8, 8), 0.0f); // left and top edges of the square own their centres
    Scene fine(16, 16, 8);
    fine.call.topology = PrimitiveTopology::PointList;
    fine.add(9, 9);
    fine.draw();
    EXPECT_EQ(fine.covered(), 8); // the square is a pixel large wherever it lies
}

TEST(Wireframe, R109DrawsOriginalEdgesOnlyAndSharedOnesTwice)
{
    Scene s(32, 32);
    s.target.rasterizer.fill = FillMode::Wireframe;
    s.target.rasterizer.guard_band_px = 0;
    s.add(-40, 4.5f).add(28.5f, 4.5f).add(28.5f, 28.5f); // cut at the left
    s.draw();
    int left = 0;
    for (int y = 8; y < 28; ++y) left += s.at(0, y) != 0;
    EXPECT_LE(left, 2); // where the slanted edge comes in; no edge runs along the cut
    EXPECT_NE(s.at(10, 4), 0.0f);
    EXPECT_NE(s.at(28, 15), 0.0f);
    Scene two(32, 32);
    CoverageCounts counts(32, 32);
    two.target.coverage = &counts;
    two.target.rasterizer.fill = FillMode::Wireframe;
    two.add(4.5f, 4.5f).add(20.5f, 4.5f).add(4.5f, 20.5f);
    two.add(20.5f, 4.5f).add(20.5f, 20.5f).add(4.5f, 20.5f);
    two.draw();
    EXPECT_EQ(counts.at(12, 12, 0), 2u); // the diagonal
    EXPECT_EQ(counts.at(12, 4, 0), 1u);
}

TEST(DepthBias, R110AddsAConstantAndTheSlopeAndClamps)
{
    auto const depth = [](Format format, std::int32_t bias, float slope_scale, float clamp,
                          FillMode fill = FillMode::Solid) {
        Scene s(16, 16, 1, Format::R32G32B32A32_FLOAT, format);
        s.target.rasterizer.depth_bias = bias;
        s.target.rasterizer.slope_scaled_depth_bias = slope_scale;
        s.target.rasterizer.depth_bias_clamp = clamp;
        s.target.rasterizer.fill = fill;
        // z = 0.25 + x/64
        s.add(0, 0, 0.25f).add(16, 0, 0.5f).add(0, 16, 0.25f);
        s.draw();
        return s.depth.depth(3, 4);
    };
    float const plain = depth(Format::D32_FLOAT, 0, 0, 0);
    EXPECT_EQ(plain, 0.25f + 3.5f / 64);
    // Float depth: the exponent of the largest z, 0.5, is 2^-1.
    EXPECT_EQ(depth(Format::D32_FLOAT, 1024, 0, 0), plain + 1024 * 0x1p-24f);
    EXPECT_EQ(depth(Format::D32_FLOAT, 0, 2, 0), plain + 2.0f / 64);
    EXPECT_EQ(depth(Format::D32_FLOAT, 0, 2, 1.0f / 64), plain + 1.0f / 64);
    EXPECT_EQ(depth(Format::D32_FLOAT, 0, -2, -1.0f / 64), plain - 1.0f / 64);
    // UNORM: the smallest code above 0.
    EXPECT_EQ(depth(Format::D16_UNORM, 100, 0, 0),
              float_from_unorm(unorm_from_float(plain + 100.0f / 65535, 16), 16));
}

struct ShowDepth {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {p.position.z, p.position.w, p.position.x, p.position.y};
    }
};

TEST(Rasterizer, R111R122PixelsSeeTheInterpolatedUnclampedDepth)
{
    Scene s;
    s.use(ShowDepth{});
    s.target.rasterizer.depth_clip_enable = false;
    s.target.depth_stencil.depth_func = Comparison::Always;
    s.add(0, 0, -1, 2).add(32, 0, -1, 2).add(0, 32, -1, 2);
    s.draw();
    EXPECT_EQ(s.at(3, 4), -1.0f);
    EXPECT_EQ(s.at(3, 4, 1), 2.0f);
    EXPECT_EQ(s.at(3, 4, 2), 3.5f); // R121
    EXPECT_EQ(s.at(3, 4, 3), 4.5f);
    EXPECT_EQ(s.depth.depth(3, 4), 0.0f);
}

TEST(Multisampling, R113ShadesPixelsOnceAndBroadcasts)
{
    Scene s(16, 16, 4);
    s.add(0, 0, 0.5f, 1, {1, 0, 0, 0}).add(16, 0, 0.5f, 1, {17, 0, 0, 0});
    s.add(0, 16, 0.5f, 1, {1, 0, 0, 0});
    PipelineStatistics const p = s.draw().pipeline;
    int pixels = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            float first = 0;
            bool any = false;
            for (int k = 0; k < 4; ++k)
                if (float const v = s.at(x, y, 0, k); v != 0) {
                    ASSERT_TRUE(!any || v == first);
                    first = v, any = true;
                }
            pixels += any;
        }
    EXPECT_EQ(p.PSInvocations, std::uint64_t(pixels));
    EXPECT_EQ(s.statistics.samples_passed, std::uint64_t(s.covered()));
}

struct SampleIndex {
    static constexpr bool kSampleFrequency = true;
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {T(p.sample_index) + T(1), p.position.x, p.position.y, T(1)};
    }
};

TEST(Multisampling, R114R121SampleModesShadeEverySample)
{
    Scene s(16, 16, 4);
    s.use(SampleIndex{});
    s.add_full();
    EXPECT_EQ(s.draw().pipeline.PSInvocations, 16u * 16 * 4);
    for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(s.at(3, 5, 0, k), float(k + 1));
        EXPECT_EQ(s.at(3, 5, 1, k), 3.5f + float(sample_pattern(4)[std::size_t(k)].x) / 16);
        EXPECT_EQ(s.at(3, 5, 2, k), 5.5f + float(sample_pattern(4)[std::size_t(k)].y) / 16);
    }
}

TEST(Multisampling, R115R116SamplesLieInTheStandardPatternsAndResolveToTheirMean)
{
    std::vector<SampleOffset> const eight{{1, -3}, {-1, 3},  {5, 1}, {-3, -5},
                                          {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(sample_pattern(8)[i].x, eight[i].x);
        EXPECT_EQ(sample_pattern(8)[i].y, eight[i].y);
    }
    // A half plane x < 8 + o/16 covers exactly the samples left of it.
    for (int samples : {2, 4, 8})
        for (int o = -7; o <= 7; ++o) {
            Scene s(16, 16, samples);
            float const edge = 8.5f + float(o) / 16;
            s.add(edge - 100, -100).add(edge, -100).add(edge, 300);
            s.draw();
            for (int k = 0; k < samples; ++k) {
                bool const left = sample_pattern(samples)[std::size_t(k)].x < o;
                ASSERT_EQ(s.at(8, 7, 0, k) != 0, left) << samples << " " << o << " " << k;
            }
        }
    ColorTarget four(1, 1, Format::R8G8B8A8_UNORM_SRGB, 4), one(1, 1, Format::R8G8B8A8_UNORM_SRGB);
    for (int k = 0; k < 4; ++k)
        encode(four.format(), {k < 2 ? 1.0f : 0.0f, 0, 0, 1}, four.texel(0, 0, k));
    resolve(four, one);
    EXPECT_EQ(std::uint8_t(*one.texel(0, 0)), srgb8_from_linear(0.5f)); // linear mean
}

struct Show {
    template <class T> struct In {
        float2<T> centroid, centre;
        static constexpr std::array<Interpolation, 2> kInterpolation{Interpolation::LinearCentroid,
                                                                     Interpolation::Linear};
        static constexpr auto signature() { return std::tuple{&In::centroid, &In::centre}; }
    };
    template <class T> using Input = In<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, In<T> const& in) const
    {
        return {in.centroid.x, in.centroid.y, in.centre.x, in.centre.y};
    }
};

TEST(Multisampling, R117CentroidIsTheCentreOrTheFirstCoveredSample)
{
    Scene s(16, 16, 4);
    s.use(Show{});
    // The value is the place in pixels; the right border cuts pixel 8.
    auto const v = [](float x, float y) { return std::array<float, 4>{x, y, x, y}; };
    float const edge = 8.5f; // samples 0 and 2 (x = -2, -6) lie left of it
    s.add(0, -64, 0.5f, 1, v(0, -64)).add(edge, -64, 0.5f, 1, v(edge, -64));
    s.add(edge, 192, 0.5f, 1, v(edge, 192));
    s.draw();
    auto const p = s.color.load(8, 7, 0);
    EXPECT_EQ(p[0], 8.5f - 2 / 16.0f);
    EXPECT_EQ(p[1], 7.5f - 6 / 16.0f);
    EXPECT_EQ(p[2], 8.5f);
    EXPECT_EQ(s.color.load(6, 7, 0)[0], 6.5f); // fully covered
}

struct Coverage {
    template <class T> using Input = SceneValue<T>;
    template <class T> struct Out {
        float4<T> color;
        int_of<T> coverage;
    };
    template <class T> Out<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {{T(p.coverage), T(1), T(1), T(0.1)}, p.coverage & int_of<T>(6)};
    }
};

TEST(Multisampling, R118R119I17I22MasksCutSamplesAndAlphaBecomesCoverage)
{
    Scene s(8, 8, 4);
    s.use(Coverage{});
    s.target.blend.sample_mask = 0b1011;
    s.target.blend.alpha_to_coverage = true; // disabled by the shader's own coverage
    s.add_full();
    s.draw();
    EXPECT_EQ(s.at(2, 2, 0, 1), float(0b1011)); // InputCoverage is after the mask
    EXPECT_EQ(s.covered(), 64);                 // only bit 1 is in both masks
    EXPECT_EQ(s.statistics.samples_passed, 64u);
    for (auto [alpha, samples] : {std::pair{0.0f, 0}, {0.5f, 2}, {0.7f, 3}, {1.0f, 4}, {kNan, 0}}) {
        Scene a(4, 4, 4);
        a.target.blend.alpha_to_coverage = true;
        a.add_full(0.5f, {1, 1, 1, alpha});
        a.draw();
        EXPECT_EQ(a.covered(), 16 * samples) << alpha;
    }
    Scene one; // the mask holds with one sample too
    one.target.blend.sample_mask = 2;
    one.add_full();
    one.draw();
    EXPECT_EQ(one.covered(), 0);
}

} // namespace
} // namespace tessemu::test
