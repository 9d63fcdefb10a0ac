// Coverage, depth and interpolation against a plain reference in exact integers.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace tessemu {
namespace {

template <class T> struct Vertex {
    float4<T> position;
    float2<T> tag;
    static constexpr auto signature() { return std::tuple{&Vertex::position, &Vertex::tag}; }
};
template <class T> struct Tag {
    float2<T> tag;
    static constexpr auto signature() { return std::tuple{&Tag::tag}; }
};
struct PassThrough {
    template <class T> using Input = Vertex<T>;
    template <class T> using Output = Vertex<T>;
    template <class T> Vertex<T> operator()(VertexInput<T> const&, Vertex<T> const& v) const
    {
        return v;
    }
};
// Colour: attribute, primitive id, facing.
struct ShowAttributes {
    template <class T> using Input = Tag<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, Tag<T> const& in) const
    {
        return {in.tag.x, in.tag.y, T(p.primitive_id), select(p.front_face, T(1), T(0))};
    }
};

constexpr int kSize = 96;

struct Scene {
    ColorTarget color{kSize, kSize, Format::R32G32B32A32_FLOAT};
    DepthTarget depth{kSize, kSize};
    PipelineStatistics statistics;
    Scene()
    {
        color.clear({-1, -1, -1, -1}, ThreadPool(1));
        depth.clear(1, 0, ThreadPool(1));
    }
};

// Triangles given in pixels, with depth and w.
Scene draw_triangles(std::vector<std::array<float, 4>> const& corners,
                     CullMode cull = CullMode::None, bool scissor = false, Rect rect = {},
                     int threads = 2)
{
    std::vector<float> vertices;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        auto const [x, y, z, w] = corners[i];
        vertices.insert(vertices.end(), {(x / (kSize / 2.0f) - 1) * w, (1 - y / (kSize / 2.0f)) * w,
                                         z * w, w, float(i % 3), float(i)});
    }
    DrawCall call;
    call.topology = PrimitiveTopology::TriangleList;
    call.set_vertices(vertices, 6);
    call.vertex_count = std::uint32_t(corners.size());
    GraphicsPipelineDesc d;
    d.vertex_shader = bind_vertex_shader(PassThrough{}, {});
    d.pixel_shader = bind_pixel_shader(ShowAttributes{}, {});
    Scene s;
    RasterTarget raster{{&s.color}, &s.depth, {{0, 0, kSize, kSize, 0, 1}}, {rect}};
    raster.rasterizer.cull = cull;
    raster.rasterizer.scissor_enable = scissor;
    s.statistics = draw(GraphicsPipeline(d), call, &raster, {}, ThreadPool(threads)).pipeline;
    return s;
}

// Corners on the 1/256 grid, so that the viewport transform and snapping change nothing.
rc::Gen<std::vector<std::array<float, 4>>> soup()
{
    return rc::gen::exec([] {
        std::vector<std::array<float, 4>> t;
        int const triangles = *rc::gen::inRange(1, 12),
                  scale = *rc::gen::element(8, 64, 2048, kSize * 256);
        for (int i = 0; i < triangles; ++i) {
            int const cx = *rc::gen::inRange(-2000, kSize * 256 + 2000),
                      cy = *rc::gen::inRange(-2000, kSize * 256 + 2000);
            for (int k = 0; k < 3; ++k)
                t.push_back({float(cx + *rc::gen::inRange(-scale, scale)) / 256.0f,
                             float(cy + *rc::gen::inRange(-scale, scale)) / 256.0f,
                             float(*rc::gen::inRange(0, 256)) / 256.0f, 1.0f});
        }
        return t;
    });
}

// Rules R101 to R104 in 64-bit integers: inside, or on a top or left edge.
bool covers(std::array<float, 4> const* t, int px, int py)
{
    std::int64_t x[3], y[3];
    for (int i = 0; i < 3; ++i) {
        x[i] = std::int64_t(std::nearbyint(double(t[i][0]) * 256));
        y[i] = std::int64_t(std::nearbyint(double(t[i][1]) * 256));
    }
    std::int64_t area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (area == 0) return false;
    if (area < 0) std::swap(x[1], x[2]), std::swap(y[1], y[2]);
    std::int64_t const cx = px * 256 + 128, cy = py * 256 + 128;
    for (int i = 0; i < 3; ++i) {
        int const j = (i + 1) % 3;
        std::int64_t const dx = x[j] - x[i], dy = y[j] - y[i];
        std::int64_t const e = dx * (cy - y[i]) - dy * (cx - x[i]);
        bool const top_left = dy < 0 || (dy == 0 && dx > 0);
        if (e < 0 || (e == 0 && !top_left)) return false;
    }
    return true;
}

RC_GTEST_PROP(Rasterizer, R101R102CoverageEqualsTheRuleInExactIntegers, ())
{
    auto const t = *soup();
    Scene const s = draw_triangles(t);
    std::uint64_t covered = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            bool any = false;
            for (std::size_t i = 0; i < t.size(); i += 3) any = covers(&t[i], x, y) || any;
            RC_ASSERT(any == (s.color.load(x, y)[0] != -1.0f));
            covered += any;
        }
    RC_ASSERT(s.statistics.PSInvocations >= covered);
}

// Nearest depth wins; on equal depth the first triangle stays (LESS).
RC_GTEST_PROP(Rasterizer, R1FlatTrianglesResolveByDepthThenOrder, ())
{
    auto t = *soup();
    for (std::size_t i = 0; i < t.size(); ++i) t[i][2] = t[i / 3 * 3][2];
    Scene const s = draw_triangles(t);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            float depth = 1, id = -1;
            for (std::size_t i = 0; i < t.size(); i += 3)
                if (t[i][2] < depth && covers(&t[i], x, y)) depth = t[i][2], id = float(i / 3);
            RC_ASSERT(s.depth.depth(x, y) == depth);
            RC_ASSERT(s.color.load(x, y)[2] == id);
        }
}

RC_GTEST_PROP(Rasterizer, R1ThreadsDoNotChangeABit, ())
{
    auto const t = *soup();
    Scene const a = draw_triangles(t, CullMode::None, false, {}, 1),
                b = draw_triangles(t, CullMode::None, false, {}, 3);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            RC_ASSERT(a.color.load(x, y) == b.color.load(x, y));
            RC_ASSERT(a.depth.depth(x, y) == b.depth.depth(x, y));
        }
    RC_ASSERT(a.statistics == b.statistics);
}

// A fan around a centre, over the whole target: every sample exactly once.
RC_GTEST_PROP(Rasterizer, ATriangulationWritesEverySampleOnce, ())
{
    float const cx = float(*rc::gen::inRange(0, kSize * 256)) / 256,
                cy = float(*rc::gen::inRange(0, kSize * 256)) / 256;
    std::vector<std::array<float, 2>> rim{{0, 0}, {kSize, 0}, {kSize, kSize}, {0, kSize}};
    std::vector<std::array<float, 4>> t;
    for (std::size_t i = 0; i < 4; ++i) {
        auto const a = rim[i], b = rim[(i + 1) % 4];
        float const z =
            float(i) / 8; // increasing depth: an overlap would pass only once, so count instead
        t.push_back({cx, cy, 0.9f - z, 1}), t.push_back({a[0], a[1], 0.9f - z, 1}),
            t.push_back({b[0], b[1], 0.9f - z, 1});
    }
    Scene const s = draw_triangles(t);
    RC_ASSERT(s.statistics.PSInvocations == std::uint64_t(kSize * kSize));
}

// Direct3D's own example: 36 pixels, each once, in both orientations of the second triangle.
TEST(Rasterizer, TwoTrianglesOnOneEdgeCoverThirtySixPixels)
{
    std::array<float, 4> const p[4] = {{0.5f, 0.49993896484375f, 0.5f, 1},
                                       {0.5f, 6.5f, 0.5f, 1},
                                       {6.50006103515625f, 0.49993896484375f, 0.5f, 1},
                                       {6.50006103515625f, 6.5f, 0.5f, 1}};
    for (bool turned : {false, true}) {
        std::vector<std::array<float, 4>> t{p[0], p[1], p[2], p[3], p[2], p[1]};
        if (turned) std::swap(t[4], t[5]);
        for (std::size_t i = 3; i < 6; ++i) t[i][2] = 0.25f; // nearer: passes wherever it covers
        EXPECT_EQ(draw_triangles(t).statistics.PSInvocations, 36u);
    }
}

TEST(Rasterizer, R24R101PositionsSnapToTheNearestEvenTie)
{
    // A left edge at 10.5 + 1/512 pixel: a tie between 10.5 and 10.5 + 1/256; even is 10.5, and the
    // centre of pixel 10 then lies on a left edge. At 10.5 + 3/512 the even neighbour is 10.5 +
    // 2/256.
    for (auto const& [x, covered] : std::vector<std::pair<float, bool>>{
             {10.5f + 1 / 512.0f, true}, {10.5f + 3 / 512.0f, false}}) {
        Scene const s = draw_triangles({{x, 0, 0.5f, 1}, {60, 0, 0.5f, 1}, {x, 60, 0.5f, 1}});
        EXPECT_EQ(s.color.load(10, 5)[0] != -1.0f, covered) << x;
    }
}

TEST(Rasterizer, R104R105CullsByScreenOrientation)
{
    std::vector<std::array<float, 4>> const clockwise{
        {10, 10, 0.5f, 1}, {50, 10, 0.5f, 1}, {10, 50, 0.5f, 1}};
    EXPECT_GT(draw_triangles(clockwise, CullMode::Back).statistics.PSInvocations, 0u);
    EXPECT_EQ(draw_triangles(clockwise, CullMode::Front).statistics.PSInvocations, 0u);
    EXPECT_EQ(draw_triangles(clockwise).color.load(15, 15)[3], 1.0f);
}

TEST(Rasterizer, R98TheScissorCutsHalfOpen)
{
    std::vector<std::array<float, 4>> const all{
        {0, 0, 0.5f, 1}, {3 * kSize, 0, 0.5f, 1}, {0, 3 * kSize, 0.5f, 1}};
    Scene const s = draw_triangles(all, CullMode::None, true, {5, 7, 11, 9});
    EXPECT_EQ(s.statistics.PSInvocations, 6u * 2);
    EXPECT_NE(s.color.load(5, 7)[0], -1.0f);
    EXPECT_EQ(s.color.load(5, 9)[0], -1.0f);
    EXPECT_EQ(s.color.load(11, 7)[0], -1.0f);
}

// Perspective: attributes are linear in the plane, not on the screen (R120).
TEST(Rasterizer, R120AttributesArePerspectiveCorrect)
{
    std::vector<std::array<float, 4>> const t{{0, 0, 0.5f, 1}, {96, 0, 0.5f, 4}, {0, 96, 0.5f, 1}};
    Scene const s = draw_triangles(t);
    for (int x : {10, 40, 80}) {
        double const a = (x + 0.5) / 96, b = 0.5 / 96;
        // weights times 1/w: (1-a-b)/1, a/4, b/1; the tag is 0, 1, 2 at the corners
        double const denominator = (1 - a - b) + a / 4 + b;
        double const expected = (a / 4 + 2 * b) / denominator;
        // A dozen float roundings of values below 4.
        EXPECT_NEAR(s.color.load(x, 0)[0], expected, 12 * 4 * 0x1p-24) << x;
    }
}

// Near and far planes cut; the cut triangle counts what is left (R90, R162).
TEST(Clipping, R90R162CutsAtNearAndFarAndCountsPrimitives)
{
    std::vector<std::array<float, 4>> const through{
        {10, 10, -0.5f, 1}, {80, 10, 0.5f, 1}, {10, 80, 0.5f, 1}};
    Scene const s = draw_triangles(through);
    EXPECT_EQ(s.statistics.CInvocations, 1u);
    EXPECT_EQ(s.statistics.CPrimitives, 2u);   // a quad in two
    EXPECT_EQ(s.color.load(11, 11)[0], -1.0f); // in front of the near plane
    EXPECT_NE(s.color.load(45, 40)[0], -1.0f);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) ASSERT_GE(s.depth.depth(x, y), 0.0f);

    std::vector<std::array<float, 4>> outside = through;
    for (auto& v : outside) v[2] = 1.5f;
    Scene const o = draw_triangles(outside);
    EXPECT_EQ(o.statistics.CInvocations, 1u);
    EXPECT_EQ(o.statistics.CPrimitives, 0u);
}

TEST(Clipping, ATriangleFarBeyondTheGuardBandIsDrawnWhereItIsVisible)
{
    std::vector<std::array<float, 4>> const huge{
        {-1e6f, -1e6f, 0.5f, 1}, {1e6f, -1e6f, 0.5f, 1}, {48, 1e6f, 0.5f, 1}};
    Scene const s = draw_triangles(huge);
    EXPECT_EQ(s.statistics.PSInvocations, std::uint64_t(kSize * kSize));
}

TEST(Clipping, BehindTheEyeNothingIsDrawn)
{
    std::vector<std::array<float, 4>> const behind{
        {10, 10, 0.5f, -1}, {80, 10, 0.5f, -1}, {10, 80, 0.5f, -1}};
    EXPECT_EQ(draw_triangles(behind).statistics.PSInvocations, 0u);
    std::vector<std::array<float, 4>> const broken{
        {10, NAN, 0.5f, 1}, {80, 10, 0.5f, 1}, {10, 80, 0.5f, 1}};
    EXPECT_EQ(draw_triangles(broken).statistics.PSInvocations, 0u);
}

} // namespace
} // namespace tessemu
