// The fast way for triangles against the reader's rasterizer and against the general one.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/patches.h"
#include "tests/support/reference_rasterizer.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace tessemu {
namespace {

template <class T> struct Vertex {
    float4<T> position;
    float2<T> smooth, flat;
    T constant;
    static constexpr auto signature()
    {
        return std::tuple{&Vertex::position, &Vertex::smooth, &Vertex::flat, &Vertex::constant};
    }
};
template <class T> struct Attributes {
    float2<T> smooth, flat;
    T constant;
    static constexpr std::array<Interpolation, 3> kInterpolation{
        Interpolation::Linear, Interpolation::LinearNoperspective, Interpolation::Constant};
    static constexpr auto signature()
    {
        return std::tuple{&Attributes::smooth, &Attributes::flat, &Attributes::constant};
    }
};
struct PassThrough {
    template <class T> using Input = Vertex<T>;
    template <class T> using Output = Vertex<T>;
    template <class T> Vertex<T> operator()(VertexInput<T> const&, Vertex<T> const& v) const
    {
        return v;
    }
};
// A shader that the library has never seen: everything it gets goes into the colour.
struct ShowAll {
    template <class T> using Input = Attributes<T>;
    template <class T> float4<T> operator()(PixelInput<T> const& p, Attributes<T> const& a) const
    {
        T const facing = select(p.front_face, T(0.5), T(0.25));
        return {T(a.smooth.x + facing * a.flat.x), T(a.smooth.y * a.flat.y),
                T(a.constant + T(p.primitive_id) * T(1 / 64.0f)),
                T(p.position.z * p.position.w + p.position.x * T(1 / 128.0f))};
    }
};

constexpr int kWidth = 150, kHeight = 140; // two tiles by two

struct Soup {
    std::vector<float> vertices;
    std::vector<std::uint32_t> indices;
    CullMode cull;
    bool counter_clockwise, scissor, depth_clip;
    Comparison func;
    Format format;
    Viewport viewport;
    Rect rect;
    float guard;
};

Soup soup()
{
    Soup s;
    int const points = *rc::gen::inRange(3, 40), triangles = *rc::gen::inRange(1, 60);
    float const spread = *rc::gen::element(0.05f, 0.4f, 1.5f, 60.0f);
    auto const real = [](int n) { return float(*rc::gen::inRange(-n, n)) / float(n); };
    float const cx = real(1000), cy = real(1000);
    for (int i = 0; i < points; ++i) {
        float const w = *rc::gen::element(1.0f, 0.5f, 3.0f, 1.25f, -0.5f);
        s.vertices.insert(s.vertices.end(),
                          {(cx + spread * real(4096)) * w, (cy + spread * real(4096)) * w,
                           (0.5f + 0.7f * real(1000)) * w, w, real(100), real(100), real(100),
                           real(100), float(i)});
    }
    for (int i = 0; i < 3 * triangles; ++i)
        s.indices.push_back(std::uint32_t(*rc::gen::inRange(0, points)));
    s.cull = *rc::gen::element(CullMode::None, CullMode::Back, CullMode::Front);
    s.counter_clockwise = *rc::gen::arbitrary<bool>();
    s.scissor = *rc::gen::arbitrary<bool>();
    s.depth_clip = *rc::gen::arbitrary<bool>();
    s.func = *rc::gen::element(Comparison::Less, Comparison::LessEqual);
    s.format = *rc::gen::element(Format::R8G8B8A8_UNORM, Format::R32G32B32A32_FLOAT);
    s.viewport = *rc::gen::element(Viewport{0, 0, kWidth, kHeight, 0, 1},
                                   Viewport{10.5f, -7.25f, 100, 200, 0.25f, 0.75f},
                                   Viewport{-300, -300, 700, 700, 0, 1});
    s.rect = {*rc::gen::inRange(0, 60), *rc::gen::inRange(0, 60), *rc::gen::inRange(60, 200),
              *rc::gen::inRange(60, 200)};
    s.guard = *rc::gen::element(16384.0f, 0.0f, 100.0f);
    return s;
}

RC_GTEST_PROP(TriangleStream, SoupsEqualTheReadersRasterizerInEveryBitAndCount, ())
{
    Soup const s = soup();
    GraphicsPipelineDesc d;
    d.vertex_shader = bind_vertex_shader(PassThrough{}, {});
    d.pixel_shader = bind_pixel_shader(ShowAll{}, {});
    DrawCall call;
    call.topology = PrimitiveTopology::TriangleList;
    call.set_vertices(s.vertices, 9);
    call.indices = std::span<std::uint32_t const>(s.indices);

    std::array<float, 4> const background{0.1f, 0.2f, 0.3f, 0.4f};
    ColorTarget color(kWidth, kHeight, s.format);
    DepthTarget depth(kWidth, kHeight);
    RasterTarget raster{{&color}, &depth, {s.viewport}, {s.rect}};
    raster.rasterizer.cull = s.cull;
    raster.rasterizer.front_counter_clockwise = s.counter_clockwise;
    raster.rasterizer.scissor_enable = s.scissor;
    raster.rasterizer.depth_clip_enable = s.depth_clip;
    raster.rasterizer.guard_band_px = s.guard;
    raster.depth_stencil.depth_func = s.func;

    test::ReferenceRasterizer reference(raster, d.pixel_shader, background);
    for (std::size_t t = 0; t < s.indices.size() / 3; ++t) {
        std::array<std::vector<float>, 3> v;
        for (std::size_t k = 0; k < 3; ++k) {
            auto const at = s.vertices.begin() + 9 * std::ptrdiff_t(s.indices[3 * t + k]);
            v[k].assign(at, at + 9);
        }
        reference.triangle(v, std::int32_t(t));
    }

    CoverageCounts coverage(kWidth, kHeight);
    // With coverage counts the draw takes the general way.
    for (CoverageCounts* counts : {static_cast<CoverageCounts*>(nullptr), &coverage}) {
        raster.coverage = counts;
        color.clear(background, ThreadPool(1));
        depth.clear(1, 0, ThreadPool(1));
        DrawStatistics const n = draw(GraphicsPipeline(d), call, &raster, {}, ThreadPool(2));
        RC_ASSERT(reference.differing_pixels(color, depth) == 0u);
        RC_ASSERT(n.pipeline.CInvocations == reference.clip_invocations);
        RC_ASSERT(n.pipeline.CPrimitives == reference.clip_primitives);
        RC_ASSERT(n.pipeline.PSInvocations == reference.passed);
        RC_ASSERT(n.samples_passed == reference.passed);
        FlopCount const flops = d.pixel_shader.probe().flops * reference.passed;
        for (StageStatistics const& stage : n.stages)
            if (stage.stage == "pixel_shader") RC_ASSERT(stage.flops == flops);
    }
    std::uint64_t covered = 0;
    for (std::uint32_t c : coverage.count) covered += c;
    RC_ASSERT(covered == reference.fragments);
}

// Between four control points.
struct BilinearDomain {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    template <class T> using ControlPoint = test::SceneVertex<T>;
    template <class T> using PatchConstant = test::Constant<T>;
    template <class T> using Output = test::SceneVertex<T>;
    template <class T>
    test::SceneVertex<T> operator()(DomainInput<T> const& in,
                                    ControlPoints<test::SceneVertex<T>> const& p,
                                    ControlPoints<test::Constant<T>> const&) const
    {
        auto const between = [&](float4<T> const& a, float4<T> const& b, float4<T> const& c,
                                 float4<T> const& d) {
            auto const linear = [](T t, float4<T> const& from, float4<T> const& to) {
                return float4<T>{from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                                 from.z + t * (to.z - from.z), from.w + t * (to.w - from.w)};
            };
            return linear(in.v, linear(in.u, a, b), linear(in.u, c, d));
        };
        return {between(p[0].position, p[1].position, p[2].position, p[3].position),
                between(p[0].value, p[1].value, p[2].value, p[3].value)};
    }
};

void use_patches(test::PatchScene& s, float factor)
{
    s.desc.hull_shader =
        bind_hull_shader(test::PatchHull<TessellatorDomain::Quad>{4, {test::uniform(factor)}}, {});
    s.desc.domain_shader = bind_domain_shader(BilinearDomain{}, {});
    s.desc.partitioning = Partitioning::Integer;
    s.desc.output_primitive = OutputPrimitive::TriangleCw;
    s.desc.input_control_points = s.call.control_points = 4;
    s.call.topology = PrimitiveTopology::PatchList;
}

struct Drawn {
    DrawStatistics statistics;
    std::vector<std::array<float, 4>> colors;
    std::vector<std::uint32_t> depths;

    friend bool operator==(Drawn const&, Drawn const&) = default;
};
// As triangles in the common state, and the general way, which coverage counts ask for.
std::pair<Drawn, Drawn> both_ways(test::PatchScene& s)
{
    CoverageCounts coverage(s.width, s.height);
    auto const drawn = [&](CoverageCounts* counts) {
        s.target.coverage = counts;
        s.clear();
        Drawn d;
        d.statistics = s.draw();
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x) {
                d.colors.push_back(s.color.load(x, y, 0));
                d.depths.push_back(s.depth.codes()[s.depth.index(x, y)]);
            }
        return d;
    };
    Drawn const fast = drawn(nullptr);
    return {fast, drawn(&coverage)};
}

// Patches of a fraction of a pixel to more than the target, folded and one over the other, in one
// plane too: triangles without a pixel, within 4x4, larger, and too large for 32 bits.
RC_GTEST_PROP(TriangleStream, PatchesEqualTheGeneralWayInEveryBitAndCount, ())
{
    constexpr int kSize = 256;
    test::PatchScene s(kSize, kSize, 1,
                       *rc::gen::element(Format::R8G8B8A8_UNORM, Format::R32G32B32A32_FLOAT));
    int const patches = *rc::gen::inRange(1, 12);
    for (int i = 0; i < patches; ++i) {
        float const extent = *rc::gen::element(0.7f, 4.0f, 20.0f, 60.0f, 118.0f, 300.0f);
        auto const share = [] { return float(*rc::gen::inRange(0, 4097)) / 4096; };
        float const x = kSize * share(), y = kSize * share(), flat = share();
        bool const even = *rc::gen::arbitrary<bool>(), square = *rc::gen::arbitrary<bool>();
        for (int k = 0; k < 4; ++k)
            s.add(x + extent * ((square ? float(k & 1) : share()) - 0.5f),
                  y + extent * ((square ? float(k >> 1) : share()) - 0.5f),
                  even ? 0.5f : 0.3f + 0.6f * (flat + share()) / 2,
                  *rc::gen::element(1.0f, 1.0f, 0.5f, 3.0f),
                  {share(), share(), share(), float(i + 1)});
    }
    use_patches(s, float(*rc::gen::inRange(1, 20)));
    s.target.rasterizer.cull = *rc::gen::element(CullMode::None, CullMode::Back, CullMode::Front);
    s.target.depth_stencil.depth_func = *rc::gen::element(Comparison::Less, Comparison::LessEqual);
    auto const [fast, general] = both_ways(s);
    RC_ASSERT(fast == general);
}

// Eight triangles of 59 x 59 pixels are more than a queue holds.
TEST(TriangleStream, LargeTrianglesFillTheQueueMoreThanOnce)
{
    test::PatchScene s(256, 256);
    for (int k = 0; k < 4; ++k)
        s.add(60.3f + 118 * float(k & 1), 60.7f + 118 * float(k >> 1), 0.5f, 1,
              {float(k), float(k & 1), 0.25f, 1});
    use_patches(s, 2);
    auto const [fast, general] = both_ways(s);
    EXPECT_TRUE(fast == general);
    EXPECT_EQ(fast.statistics.samples_passed, 118u * 118u);
}

// A patch of two triangles, a small one and, over it in the same plane, one of 84 x 4 pixels: the
// first one's colours stay.
TEST(TriangleStream, TooLargeForThirtyTwoBitsComesAfterWhatWaits)
{
    test::PatchScene s(256, 256);
    s.add(100, 100, 0.5f, 1, {1, 0, 0, 1}).add(104, 100, 0.5f, 1, {0, 1, 0, 1});
    s.add(100, 104, 0.5f, 1, {0, 0, 1, 1}).add(20, 101, 0.5f, 1, {1, 1, 1, 1});
    use_patches(s, 1);
    auto const [fast, general] = both_ways(s);
    EXPECT_TRUE(fast == general);
    std::array<float, 4> const cleared{0, 0, 0, 0};
    EXPECT_NE(fast.colors[101 * 256 + 60], cleared); // half way to the far corner
}

} // namespace
} // namespace tessemu
