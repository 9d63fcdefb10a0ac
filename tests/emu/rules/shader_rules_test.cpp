// Rules R8 to R18 and R41 to R55, R80, R81: arithmetic, vertex, hull and domain shader.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessemu::test {
namespace {

using L = Lanes<8>;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kTiny = 1e-40f; // a denormal

std::uint32_t bits(float f)
{
    return std::bit_cast<std::uint32_t>(f);
}

struct Flushing {
    DenormalMode mode{DenormalMode::Flush};
};

TEST(Arithmetic, R9R13DenormalsFlushAtEveryOperation)
{
    Flushing const f;
    volatile float tiny = kTiny, small = 1.5e-38f, one = 1, zero = 0;
    float const t = tiny;
    EXPECT_EQ(bits((L(t) * L(one)).raw[0]), 0u);
    EXPECT_EQ(bits((L(-t) * L(one)).raw[0]), 0x80000000u); // sign-preserved
    EXPECT_EQ(bits((L(t) + L(zero)).raw[0]), 0u);
    EXPECT_EQ(bits((L(small) * L(0.5f)).raw[0]), 0u); // a result
    EXPECT_EQ(bits((L(small) - L(1.4e-38f)).raw[0]), 0u);
    EXPECT_EQ(bits(min(L(t), L(one)).raw[0]), 0u); // I-5
    EXPECT_EQ(bits(sqrt(L(t)).raw[0]), 0u);
    // select is a move.
    EXPECT_EQ(bits(select(Mask<8>(true), L(t), L(one)).raw[0]), bits(kTiny));
    for (float x : {1.25f, -7e30f, 3e-38f}) {
        EXPECT_EQ((L(x) * L(1.0f)).raw[0], x);
        EXPECT_EQ((L(x) / L(1.0f)).raw[0], x);
        EXPECT_EQ((L(x) - L(zero)).raw[0], x);
    }
    EXPECT_EQ(bits((L(-0.0f) + L(zero)).raw[0]), 0u); // -0 + 0 = +0
}

TEST(Arithmetic, I9LargeIntegersRoundToNearestEven)
{
    for (auto [i, f] :
         {std::pair{16777217, 16777216.0f}, {16777219, 16777220.0f}, {-16777217, -16777216.0f}})
        EXPECT_EQ(L(IntLanes<8>(i)).raw[3], f);
}

TEST(Arithmetic, R11I4SpecialValues)
{
    volatile float zero = 0, inf = kInf, minus = -2;
    L const z(zero), i(inf);
    EXPECT_EQ((L(1.0f) / z).raw[0], kInf);
    EXPECT_EQ((L(1.0f) / -z).raw[0], -kInf);
    for (L const n : {z / z, i - i, i * z, sqrt(L(minus))}) EXPECT_TRUE(n.raw[0] != n.raw[0]);
    EXPECT_EQ(bits(sqrt(-z).raw[0]), 0x80000000u);
}

TEST(Arithmetic, R12R18I5NanLosesInMinAndMaxAndComparesFalse)
{
    L const n(kNan), x(3.0f);
    EXPECT_EQ(min(x, n).raw[0], 3.0f);
    EXPECT_EQ(max(n, x).raw[0], 3.0f);
    EXPECT_EQ(min(n, x).raw[0], 3.0f);
    EXPECT_FALSE(any(n < x) || any(n > x) || any(n <= x) || any(n >= x) || any(n == n));
    EXPECT_TRUE(all(n != n));
    EXPECT_TRUE(all(L(-0.0f) == L(0.0f)));
    EXPECT_EQ(bits(min(L(0.0f), L(-0.0f)).raw[0]), 0x80000000u);
    EXPECT_EQ(bits(max(L(-0.0f), L(0.0f)).raw[0]), 0u);
    EXPECT_EQ(floor(L(-1.5f)).raw[0], -2.0f);
}

TEST(Arithmetic, R8R17I7RootsAndQuotientsAreCorrectlyRounded)
{
    // The exact root lies within half an ulp: (r +- ulp/2)^2 brackets x, in double.
    std::uint32_t seed = 1;
    for (int i = 0; i < 20000; ++i) {
        seed = seed * 1664525u + 1013904223u;
        float const x = std::bit_cast<float>((seed >> 2) % 0x7e000000u + 0x00800000u);
        float const r = sqrt(L(x)).raw[0];
        double const low = (double(r) + double(std::nextafter(r, 0.0f))) / 2,
                     high = (double(r) + double(std::nextafter(r, kInf))) / 2;
        ASSERT_LE(low * low, double(x) * (1 + 1e-15));
        ASSERT_GE(high * high, double(x) * (1 - 1e-15));
        float const q = (L(1.0f) / L(x)).raw[0];
        if (q > 1.2e-38f) {
            ASSERT_EQ(q, float(1 / double(x))); // double rounding is harmless here
        }
    }
}

TEST(Arithmetic, R14R15R16I6SumsOfProductsRoundTwiceUnlessFusedByName)
{
    volatile float av = 1 + 0x1p-12f, cv = -(1 + 0x1p-11f);
    L const a(av), c(cv);
    EXPECT_EQ((a * a + c).raw[0], 0.0f); // the product rounds first
    EXPECT_EQ(mad(a, a, c).raw[0], 0x1p-24f);
    float3<L> const v(a, L(0.0f), c);
    EXPECT_EQ(dot(v, float3<L>(a, L(1.0f), L(1.0f))).raw[0], 0.0f); // left to right
}

// A hull shader whose join reads what forks wrote, and output control points.
template <class T> struct Register {
    float4<T> value;
    static constexpr auto signature() { return std::tuple{&Register::value}; }
};
struct Hull {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr float kMaxTessFactor = 8;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = Register<T>;
    int points = 2, registers = 3;
    int control_points() const { return points; }
    int patch_constants() const { return registers; }
    template <class T>
    SceneVertex<T> control_point(PatchInput, ControlPoints<SceneVertex<T>> const& in,
                                 int_of<T> id) const
    {
        SceneVertex<T> v = in[3]; // every input is seen by every invocation
        v.value.x = T(id);
        return v;
    }
    template <class T>
    Register<T> patch_constant(PatchInput in, ControlPoints<SceneVertex<T>> const& patch,
                               ControlPoints<SceneVertex<T>> const& out, int_of<T> instance) const
    {
        T const seen = out.size() ? T(out[1].value.x) : T(0);
        return {{T(instance), seen, patch[0].value.y, T(float(in.primitive_id))}};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<SceneVertex<T>> const&,
                                  ControlPoints<SceneVertex<T>> const& out,
                                  ControlPoints<Register<T>> const& forked) const
    {
        T const f = out.size() ? T(forked[2].value.x + out[1].value.x) : T(1); // 2 + 1
        return {f, f, f, f, T(100), T(1)};
    }
};
template <int points> struct Domain {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = points;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = Register<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(DomainInput<T> const& in, ControlPoints<SceneVertex<T>> const& p,
                              ControlPoints<Register<T>> const& c) const
    {
        SceneVertex<T> v{};
        v.position = float4<T>(in.u, in.v, T(0), T(1));
        Register<T> const r = c[1];
        T const last = points ? T(p[points - 1].value.x) : T(-1);
        v.value = float4<T>(r.value.x, r.value.y, r.value.z, T(last + r.value.w * T(100)));
        return v;
    }
};

struct Patches {
    Scene scene;
    std::vector<std::array<float, 4>> values; ///< of the first point of each patch
    std::vector<std::size_t> points;

    template <int n> void draw(Hull const& hull, std::size_t patches = 2, int inputs = 4)
    {
        scene.call.topology = PrimitiveTopology::PatchList;
        scene.call.control_points = inputs;
        scene.desc.hull_shader = bind_hull_shader(hull, {});
        scene.desc.domain_shader = bind_domain_shader(Domain<n>{}, {});
        scene.desc.partitioning = Partitioning::Integer;
        scene.desc.input_control_points = inputs;
        for (std::size_t i = 0; i < patches * std::size_t(inputs); ++i)
            scene.add(1, 1, 0.5f, 1, {0, 42, 0, 0});
        scene.call.set_vertices(scene.vertices, 8);
        scene.call.vertex_count = std::uint32_t(scene.vertices.size() / 8);
        scene.statistics = tessemu::draw(
            GraphicsPipeline(scene.desc), scene.call, nullptr,
            [&](ShadedPatch const& p) {
                auto const v = [&](std::size_t k) { return p.outputs[(4 + k) * p.stride]; };
                values.push_back({v(0), v(1), v(2), v(3)});
                points.push_back(p.points->patch.points());
            },
            ThreadPool(2));
    }
};

TEST(HullShader, R45R47R48R54R80PhasesSeeWhatTheyMay)
{
    Patches p;
    p.draw<2>(Hull{});
    ASSERT_EQ(p.values.size(), 2u);
    EXPECT_EQ(p.values[0], (std::array<float, 4>{1, 1, 42, 1}));
    EXPECT_EQ(p.values[1], (std::array<float, 4>{1, 1, 42, 101})); // PrimitiveID 1
    PipelineStatistics const& n = p.scene.statistics.pipeline;
    EXPECT_EQ(n.HSInvocations, 2u); // R159
    EXPECT_EQ(n.HSControlPointInvocations, 4u);
    EXPECT_EQ(n.HSPatchConstantInvocations, 2u * 4);
}

TEST(HullShader, R53I28FactorsAboveTheDeclaredMaximumAreClampedAndReported)
{
    Patches p;
    p.draw<2>(Hull{}); // inside factors 100 and 1, maximum 8; edges 3
    EXPECT_EQ(p.scene.statistics.tess_factors_above_max, 2u);
    EXPECT_EQ(p.points[0], 4u * 3 + (8 - 1) * (2 - 1));
}

TEST(HullShader, R46NoOutputControlPointsIsLegal)
{
    Patches p;
    p.draw<0>(Hull{0, 3});
    EXPECT_EQ(p.values[0][3], -1.0f);
}

TEST(HullShader, R49R50LimitsOfStorageAndInstances)
{
    auto const build = [](Hull const& hull, auto domain) {
        GraphicsPipelineDesc d;
        d.vertex_shader = bind_vertex_shader(SceneVertexShader{}, {});
        d.hull_shader = bind_hull_shader(hull, {});
        d.domain_shader = bind_domain_shader(domain, {});
        d.input_control_points = 4;
        return GraphicsPipeline(d);
    };
    EXPECT_NO_THROW(build(Hull{32, 30}, Domain<32>{}));
    EXPECT_THROW(build(Hull{2, 31}, Domain<2>{}), LimitError); // 124 + 6 scalars
}

TEST(HullShader, R43PatchListsUseTheVertexCache)
{
    Patches p;
    p.scene.indices = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
    p.scene.call.indices = std::span<std::uint32_t const>(p.scene.indices);
    p.draw<2>(Hull{}, 3);
    PipelineStatistics const& n = p.scene.statistics.pipeline;
    EXPECT_EQ(n.IAVertices, 12u);
    EXPECT_EQ(n.IAPrimitives, 3u);
    EXPECT_EQ(n.VSInvocations, 4u);
}

TEST(Pipeline, R3R38R44R81LimitsOfRegisters)
{
    GraphicsPipelineDesc d;
    EXPECT_THROW(GraphicsPipeline{d}, Error); // the vertex shader is always there
    d.vertex_shader = bind_vertex_shader(SceneVertexShader{}, {});
    EXPECT_NO_THROW(GraphicsPipeline{d});
    d.hull_shader = bind_hull_shader(Hull{}, {});
    EXPECT_THROW(GraphicsPipeline{d}, Error); // both or none
    d.domain_shader = bind_domain_shader(Domain<2>{}, {});
    d.input_control_points = 33;
    EXPECT_THROW(GraphicsPipeline{d}, LimitError);
}

} // namespace
} // namespace tessemu::test
