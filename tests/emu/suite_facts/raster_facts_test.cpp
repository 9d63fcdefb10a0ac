// Facts S25 to S36 of other suites: geometry shader, viewports, clipping, culling, lines.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/quad_scene.h"

namespace tessemu::test {
namespace {

// A point becomes a square of half width 1/5 in clip space.
struct PointToSquare {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::PointList;
    static constexpr GeometryOutput kOutput = GeometryOutput::TriangleStrip;
    static constexpr int kMaxVertices = 4;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const&, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        for (int i = 0; i < 4; ++i) {
            SceneVertex<T> corner = v[0];
            corner.position.x = corner.position.x + T(i < 2 ? -0.2f : 0.2f);
            corner.position.y = corner.position.y + T(i % 2 ? 0.2f : -0.2f);
            out.append(corner);
        }
    }
};

TEST(GeometryShader, S25APointBecomesASquareAroundIt)
{
    Scene s(640, 480);
    s.target.depth_stencil.depth_enable = false;
    s.desc.geometry_shader = bind_geometry_shader(PointToSquare{}, {});
    s.call.topology = PrimitiveTopology::PointList;
    add_clip(s, {0, 0, 1, 1});
    s.draw();
    // 0.2 of half the width is 64 pixels, of half the height 48.
    EXPECT_TRUE(only_drawn(s, {256, 192, 384, 288}));
    EXPECT_NE(s.at(320, 240), 0.0f);
    for (auto [x, y] : {std::pair{255, 240}, {385, 240}, {320, 190}, {320, 290}})
        EXPECT_EQ(s.at(x, y), 0.0f) << x << "," << y;
}

// Each triangle into viewports 0 and 1.
struct ToBothViewports {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::TriangleList;
    static constexpr GeometryOutput kOutput = GeometryOutput::TriangleStrip;
    static constexpr int kMaxVertices = 6;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const& in, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        for (int viewport = 0; viewport < 2; ++viewport) {
            for (std::size_t k = 0; k < 3; ++k) {
                out.append(v[k], {in.primitive_id, int_of<T>(viewport)});
            }
            out.restart_strip();
        }
    }
};
// SV_ViewportArrayIndex plus one.
struct ShowViewport {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        return {T(p.viewport_index) + T(1), T(1), T(1), T(1)};
    }
};

struct TwoViewports : Scene {
    TwoViewports() : Scene(640, 480)
    {
        desc.geometry_shader = bind_geometry_shader(ToBothViewports{}, {});
        use(ShowViewport{});
        set_quad(*this);
        target.viewports = {{0, 0, 320, 480, 0, 1}, {320, 0, 320, 480, 0, 1}};
    }
    // Where viewport 0 and 1 are drawn; each pixel shows its viewport's number plus one.
    testing::AssertionResult shows(Rect left, Rect right) const
    {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                Rect const& r = x < 320 ? left : right;
                bool const in = x >= r.left && x < r.right && y >= r.top && y < r.bottom;
                float const expected = !in ? 0.0f : x < 320 ? 1.0f : 2.0f;
                if (at(x, y) != expected)
                    return testing::AssertionFailure()
                           << x << "," << y << " is " << at(x, y) << ", not " << expected;
            }
        return testing::AssertionSuccess();
    }
};

TEST(Viewport, S26ATriangleGoesToBothViewportsAndNowhereWithoutOne)
{
    TwoViewports s;
    EXPECT_EQ(s.draw().pipeline.CInvocations, 4u);
    EXPECT_TRUE(s.shows({0, 0, 320, 480}, {320, 0, 640, 480}));
    s.clear();
    s.target.viewports.resize(1); // the second is all zeros
    s.draw();
    EXPECT_TRUE(s.shows({0, 0, 320, 480}, {}));
    s.clear();
    s.target.viewports.clear();
    s.draw();
    EXPECT_TRUE(s.shows({}, {}));
    // Without a geometry shader there is one viewport, 0, on either way through the rasterizer.
    for (bool general : {false, true}) {
        Scene one(16, 16);
        one.use(ShowViewport{});
        one.target.blend.target[0].enable = general;
        set_quad(one);
        one.draw();
        EXPECT_EQ(one.at(3, 3), 1.0f);
    }
}

TEST(Viewport, S27EachViewportHasItsScissorAndTheDefaultIsEmpty)
{
    TwoViewports s;
    s.target.rasterizer.scissor_enable = true;
    s.target.scissors = {{0, 0, 320, 240}};
    s.draw();
    EXPECT_TRUE(s.shows({0, 0, 320, 240}, {}));
    s.clear();
    s.target.scissors.push_back({320, 0, 640, 240});
    s.draw();
    EXPECT_TRUE(s.shows({0, 0, 320, 240}, {320, 0, 640, 240}));
}

// Distances of value: value.x and value.y clip, or all four cull.
template <class T> struct TwoClips {
    float4<T> position, value;
    float2<T> clip;
    static constexpr int kClipDistances = 2;
    static constexpr auto signature()
    {
        return std::tuple{&TwoClips::position, &TwoClips::value, &TwoClips::clip};
    }
};
struct ClipByValue {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = TwoClips<T>;
    template <class T> TwoClips<T> operator()(VertexInput<T> const&, SceneVertex<T> const& v) const
    {
        return {v.position, {T(1), T(1), T(1), T(1)}, {v.value.x, v.value.y}};
    }
};
template <class T> struct FourCulls {
    float4<T> position, value, cull;
    static constexpr int kCullDistances = 4;
    static constexpr auto signature()
    {
        return std::tuple{&FourCulls::position, &FourCulls::value, &FourCulls::cull};
    }
};
struct CullByValue {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = FourCulls<T>;
    template <class T> FourCulls<T> operator()(VertexInput<T> const&, SceneVertex<T> const& v) const
    {
        return {v.position, {T(1), T(1), T(1), T(1)}, v.value};
    }
};

TEST(Clipping, S28ClipDistancesOfTheCornersCutHalves)
{
    auto const drawn = [](std::array<float, 4> x, std::array<float, 4> y, Rect r) {
        Scene s(640, 480);
        s.desc.vertex_shader = bind_vertex_shader(ClipByValue{}, {});
        std::array<std::array<float, 4>, 4> values{};
        for (std::size_t i = 0; i < 4; ++i) values[i] = {x[i], y[i], 0, 0};
        set_corners(s, values);
        s.draw();
        return only_drawn(s, r);
    };
    std::array<float, 4> const zero{}, one{1, 1, 1, 1}, minus{-1, -1, -1, -1}, left{1, 1, -1, -1},
        upper{-1, 1, -1, 1};
    Rect const all{0, 0, 640, 480};
    EXPECT_TRUE(drawn(zero, zero, all));
    EXPECT_TRUE(drawn(minus, one, {}));
    EXPECT_TRUE(drawn(one, minus, {}));
    // At a pixel's centre the distance is at least 1/640 away from 0.
    EXPECT_TRUE(drawn(left, one, {0, 0, 320, 480}));
    EXPECT_TRUE(drawn(one, upper, {0, 0, 640, 240}));
    EXPECT_TRUE(drawn(left, upper, {0, 0, 320, 240}));
}

TEST(Clipping, S29CullDistancesHideTheTriangleAllOfWhoseCornersAreBelowZero)
{
    auto const hidden = [](std::array<float, 4> distances, std::size_t component) {
        Scene s(32, 32);
        s.desc.vertex_shader = bind_vertex_shader(CullByValue{}, {});
        std::array<std::array<float, 4>, 4> values;
        for (std::size_t i = 0; i < 4; ++i) {
            values[i] = {1, 1, 1, 1};
            values[i][component] = distances[i];
        }
        set_corners(s, values);
        s.draw();
        // The strip's first triangle has the lower left corner, its second the upper right one;
        // the 32 centres on the diagonal lie on an edge that is left of the second.
        bool const first = s.at(4, 27) != 0, second = s.at(27, 4) != 0;
        EXPECT_EQ(s.covered(), 496 * first + 528 * second);
        return std::pair(!first, !second);
    };
    for (std::size_t component = 0; component < 4; ++component) {
        EXPECT_EQ(hidden({0, 0, 0, 0}, component), std::pair(false, false));
        for (unsigned below = 0; below < 16; ++below) {
            std::array<float, 4> d;
            for (std::size_t i = 0; i < 4; ++i) d[i] = below >> i & 1 ? -1.0f : 1.0f;
            EXPECT_EQ(hidden(d, component), std::pair((below & 7) == 7, (below & 14) == 14))
                << below << " " << component;
        }
    }
}

TEST(Clipping, S30DepthClipCutsOrTheViewportsRangeClamps)
{
    for (auto [clips, general] :
         {std::pair{true, true}, {true, false}, {false, true}, {false, false}}) {
        Scene s(8, 8);
        s.target.blend.target[0].enable = general; // takes the draws off the streaming path
        s.target.viewports = {{0, 0, 8, 8, 0.4f, 0.6f}};
        s.target.rasterizer.depth_clip_enable = clips;
        auto const drawn = [&](float z) {
            set_quad(s, {1, 1, 1, 1}, z);
            s.draw();
            return s.depth.depth(3, 5);
        };
        EXPECT_EQ(drawn(2), clips ? 1.0f : 0.6f) << general;
        EXPECT_EQ(drawn(0.5f), 0.5f); // 0.4 + 0.5 * 0.2, whose roundings cancel
        EXPECT_EQ(drawn(-1), clips ? 0.5f : 0.4f) << general;
    }
}

struct ShowPlaceAndValue {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const& in) const
    {
        return {p.position.x, p.position.y, in.value.x, in.value.y};
    }
};

TEST(Viewport, S31FractionalOffsetsMoveTexturesAndNotPixels)
{
    std::vector<float> offsets{0, 63.0f / 128};
    for (int i = 1; i <= 8; ++i) offsets.push_back(1.0f / float(1 << i));
    for (float const o : offsets) {
        Scene s(4, 4);
        s.use(ShowPlaceAndValue{});
        s.target.viewports = {{o, o, 4, 4, 0, 1}};
        set_corners(s, {{{0, 0, 0, 0}, {0, 1, 0, 0}, {1, 0, 0, 0}, {1, 1, 0, 0}}});
        s.draw();
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 4; ++x) {
                // Offsets are multiples of 1/256 and the area is a power of two: nothing rounds.
                float const px = float(x) + 0.5f, py = float(y) + 0.5f;
                std::array<float, 4> const expected{px, py, (px - o) / 4, 1 - (py - o) / 4};
                EXPECT_EQ(s.color.load(x, y), expected) << x << "," << y << " offset " << o;
            }
    }
}

TEST(Viewport, S32NegativeOffsetsLoseTheLastRowAndColumn)
{
    for (auto [offset, lost] : {std::pair{-0.4f, 1}, {-1.0f / 128, 1}, {0.0f, 0}, {-0.0f, 0}}) {
        Scene s(640, 480);
        s.target.viewports = {{offset, offset, 640, 480, 0, 1}};
        set_quad(s);
        s.draw();
        EXPECT_TRUE(only_drawn(s, {0, 0, 640 - lost, 480 - lost})) << offset;
    }
}

TEST(Rasterizer, S33TheScissorCutsDrawsAndNotClears)
{
    Scene s(640, 480);
    s.target.rasterizer.scissor_enable = true;
    s.target.scissors = {{160, 120, 480, 360}};
    s.clear({0.5f, 0, 0, 0});
    EXPECT_EQ(s.covered(), 640 * 480);
    s.clear();
    set_quad(s);
    s.draw();
    EXPECT_TRUE(only_drawn(s, {160, 120, 480, 360}));
}

// SV_IsFrontFace as bits, into an integer target.
struct ShowFront {
    template <class T> using Input = SceneValue<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, SceneValue<T> const&) const
    {
        using L = Lanes<lanes_of<T>>;
        T const bits(L(typename L::Raw(p.front_face.raw)));
        return {bits, T(1), T(1), T(1)};
    }
};

TEST(Rasterizer, S34CullModesAndSensesDecideWhatIsDrawnAndWhatIsFront)
{
    struct {
        CullMode cull;
        bool drawn[2][2]; // by FrontCounterClockwise, then clockwise and counter-clockwise
    } const table[] = {{CullMode::None, {{true, true}, {true, true}}},
                       {CullMode::Front, {{false, true}, {true, false}}},
                       {CullMode::Back, {{true, false}, {false, true}}}};
    for (auto const& row : table)
        for (bool front_counter : {false, true})
            for (bool counter : {false, true}) {
                Scene s(8, 8, 1, Format::R32G32B32A32_UINT);
                s.use(ShowFront{});
                s.target.rasterizer.cull = row.cull;
                s.target.rasterizer.front_counter_clockwise = front_counter;
                set_quad(s);
                if (counter) // mirrored
                    for (std::size_t i = 0; i < 4; ++i) s.vertices[8 * i] *= -1;
                s.draw();
                bool const drawn = row.drawn[front_counter][counter];
                EXPECT_EQ(word(s.color, 1, 1), drawn && counter == front_counter ? ~0u : 0u);
                EXPECT_EQ(s.at(1, 1, 1), drawn ? 1.0f : 0.0f)
                    << int(row.cull) << front_counter << counter;
            }
}

// Bit 4 y + x: pixel (x, y) of a target of 4x4 is drawn by a line across it.
unsigned line_mask(bool multisample)
{
    Scene s(4, 4);
    s.call.topology = PrimitiveTopology::LineList;
    s.target.rasterizer.multisample_enable = multisample;
    add_clip(s, {-1, -0.55f, 0, 1});
    add_clip(s, {1, 0.55f, 0, 1});
    s.draw();
    unsigned mask = 0;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            if (s.at(x, y) != 0) mask |= 1u << (4 * y + x);
    return mask;
}

TEST(Lines, S35G12AliasedPixelsAreExactAndARectangleHoldsThem)
{
    // (2,1) (3,1) (0,2) (1,2); with MultisampleEnable (3,0) (1,1) (2,2) (0,3) may join them.
    unsigned const aliased = 0x03c0, most = 0x17e8;
    EXPECT_EQ(line_mask(false), aliased);
    unsigned const wide = line_mask(true);
    EXPECT_EQ(wide & aliased, aliased);
    EXPECT_EQ(wide & ~most, 0u);
    EXPECT_EQ(wide, most); // a rectangle of 1.4 pixels holds their centres too
}

TEST(Rasterizer, G14ScissorAndViewportEndAtTheTarget)
{
    Scene s(16, 12);
    s.target.rasterizer.scissor_enable = true;
    s.target.scissors = {{-100, -100, 100000, 100000}};
    set_quad(s);
    s.draw();
    EXPECT_TRUE(only_drawn(s, {0, 0, 16, 12}));
    s.clear();
    s.target.scissors = {{8, 4, 100000, 100000}};
    s.draw();
    EXPECT_TRUE(only_drawn(s, {8, 4, 16, 12}));
    for (Viewport v : {Viewport{-8, -6, 32, 24, 0, 1}, Viewport{0, 0, 32767, 32767, 0, 1},
                       Viewport{-32768, -32768, 65535, 65535, 0, 1}}) {
        Scene wide(16, 12);
        wide.target.viewports = {v};
        set_quad(wide);
        EXPECT_EQ(wide.draw().samples_passed, 16u * 12);
        EXPECT_TRUE(only_drawn(wide, {0, 0, 16, 12})) << v.width;
    }
}

TEST(OutputMerger, G14TargetsOfDifferentSizesOrSamplesAreRefused)
{
    auto const message = [](int width, int height, int samples, bool is_depth) {
        Scene s(16, 16);
        ColorTarget color(width, height, Format::R8G8B8A8_UNORM, samples);
        DepthTarget depth(width, height, Format::D32_FLOAT, samples);
        if (is_depth)
            s.target.depth = &depth;
        else
            s.target.color.push_back(&color);
        set_quad(s);
        try {
            s.draw();
        } catch (Error const& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    for (bool is_depth : {false, true}) {
        EXPECT_EQ(message(32, 16, 1, is_depth),
                  "targets differ in size or samples: 32x16x1 beside 16x16x1");
        EXPECT_EQ(message(16, 8, 1, is_depth),
                  "targets differ in size or samples: 16x8x1 beside 16x16x1");
        EXPECT_EQ(message(16, 16, 4, is_depth),
                  "targets differ in size or samples: 16x16x4 beside 16x16x1");
        EXPECT_EQ(message(16, 16, 1, is_depth), "");
    }
}

} // namespace
} // namespace tessemu::test
