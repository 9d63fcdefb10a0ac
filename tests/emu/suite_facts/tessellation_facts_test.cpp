// Facts S1 to S8 and gaps G2, G3, G6, G7: tessellation with the stages around it.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/patches.h"

#include <gtest/gtest.h>

namespace tessemu::test {
namespace {

using D = TessellatorDomain;
using P = Partitioning;
using O = OutputPrimitive;

// Control points 0 to 1 and 2 to 3 along u, then along v.
struct LerpQuad {
    static constexpr D kDomain = D::Quad;
    static constexpr int kControlPoints = 4;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = Constant<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(DomainInput<T> const& in, ControlPoints<SceneVertex<T>> const& p,
                              ControlPoints<Constant<T>> const&) const
    {
        auto const lerp4 = [](float4<T> const& a, float4<T> const& b, T t) {
            return float4<T>(a.x + t * T(b.x - a.x), a.y + t * T(b.y - a.y), a.z + t * T(b.z - a.z),
                             a.w + t * T(b.w - a.w));
        };
        float4<T> const low = lerp4(p[0].position, p[1].position, in.u),
                        high = lerp4(p[2].position, p[3].position, in.u);
        return {lerp4(low, high, in.v), {T(1), T(1), T(1), T(1)}};
    }
};

struct QuadPatch : PatchScene {
    explicit QuadPatch(TessFactors const& factors = uniform(1)) : PatchScene(640, 480)
    {
        use_patches(PatchHull<D::Quad>{4, {factors}});
        desc.domain_shader = bind_domain_shader(LerpQuad{}, {});
        for (auto [x, y] : {std::pair{-1.0f, -1.0f}, {-1, 1}, {1, -1}, {1, 1}})
            vertices.insert(vertices.end(), {x, y, 0, 1, 1, 1, 1, 1});
    }
};

using Corners = std::vector<std::vector<float>>;

TEST(TessellationFacts, S1ACounterClockwiseQuadStreamsItsTwoTrianglesAndIsCulledAsABackFace)
{
    QuadPatch s;
    s.desc.output_primitive = O::TriangleCcw;
    s.target.rasterizer.cull = CullMode::Back;
    s.draw();
    EXPECT_EQ(s.statistics.pipeline.CInvocations, 2u);
    EXPECT_EQ(s.covered(), 0);
    s.stream_out(0, 2);
    s.draw();
    EXPECT_EQ(s.streamed(), (Corners{{-1, -1}, {1, -1}, {-1, 1}, {-1, 1}, {1, -1}, {1, 1}}));
}

TEST(TessellationFacts, S2AClockwiseQuadStreamsItsTwoTrianglesAndCoversTheTarget)
{
    QuadPatch s;
    s.target.rasterizer.cull = CullMode::Back;
    s.draw();
    EXPECT_EQ(s.covered(), 640 * 480);
    s.stream_out(0, 2);
    s.draw();
    EXPECT_EQ(s.streamed(), (Corners{{-1, -1}, {-1, 1}, {1, -1}, {-1, 1}, {1, 1}, {1, -1}}));
}

TEST(TessellationFacts, S3EdgeFactorsDecideHowManyPrimitivesAreStreamed)
{
    auto const written = [](TessFactors const& f) {
        QuadPatch s(f);
        s.stream_out();
        return s.draw().stream_output[0].NumPrimitivesWritten;
    };
    EXPECT_EQ(written({2, 2, 2, 2, 1, 1}), 8u);
    EXPECT_EQ(written({0, 2, 2, 2, 1, 1}), 0u);
    EXPECT_EQ(written({5, 2, 2, 2, 1, 1}), 11u);
}

TEST(TessellationFacts, S4FourIsolinePatchesStreamNineLinesWithTheirPatchsConstants)
{
    PatchScene s;
    s.use_patches(PatchHull<D::Isoline>{1, {{1, 1}, {2, 1}, {1, 2}, {2, 2}}});
    for (int i = 0; i < 4; ++i) s.add(8, 8, 0.5f, 1, {float(10 + i), 0, 0, 0});
    s.stream_out(4, 3);
    s.draw();
    EXPECT_EQ(s.statistics.stream_output[0].NumPrimitivesWritten, 9u);
    Corners expected;
    int const lines[] = {1, 2, 2, 4};
    for (int i = 0; i < 4; ++i)
        expected.insert(expected.end(), std::size_t(2 * lines[i]),
                        {float(i), float(i), float(10 + i)});
    EXPECT_EQ(s.streamed(), expected);
}

TEST(TessellationFacts, S5G6ADrawWithOtherControlPointsThanTheHullShaderDeclaresIsRefused)
{
    for (int declared : {3, 5}) {
        QuadPatch s;
        s.desc.input_control_points = declared;
        try {
            s.draw();
            FAIL() << declared;
        } catch (Error const& e) {
            EXPECT_EQ(std::string(e.what()),
                      "the draw has 4 control points per patch, the pipeline was created for " +
                          std::to_string(declared));
        }
    }
}

// A point for each triangle: the value as it came, and PrimitiveID of the geometry shader last.
struct IdOfTriangle {
    static constexpr PrimitiveTopology kInput = PrimitiveTopology::TriangleList;
    static constexpr GeometryOutput kOutput = GeometryOutput::PointList;
    static constexpr int kMaxVertices = 1;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    void operator()(GeometryInput<T> const& in, std::span<SceneVertex<T> const> v,
                    VertexStream<SceneVertex<T>>& out) const
    {
        SceneVertex<T> o = v[0];
        o.value.w = T(in.primitive_id);
        out.append(o, {in.primitive_id, int_of<T>(0)});
    }
};

TEST(TessellationFacts, S6G3HullDomainAndGeometryShaderSeeThePatchsNumberWhichInstancesRestart)
{
    PatchScene s;
    s.use_patches(PatchHull<D::Tri>{1, {{2, 2, 2, 1}}});
    s.desc.geometry_shader = bind_geometry_shader(IdOfTriangle{}, {});
    s.call.instance_count = 2;
    for (int i = 0; i < 4; ++i) s.add(8, 8, 0.5f, 1, {float(i), 0, 0, 0});
    s.stream_out(4, 4);
    s.draw();
    Corners expected;
    for (int instance = 0; instance < 2; ++instance)
        for (int i = 0; i < 4; ++i)
            expected.insert(expected.end(), 6, {float(i), float(i), float(i), float(i)});
    EXPECT_EQ(s.streamed(), expected);
    EXPECT_EQ(s.buffer.filled, 4u * 2 * 6 * 16);
}

// Moves instance i down by i pixels of 16.
struct InstanceRows {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(VertexInput<T> const& in, SceneVertex<T> const& v) const
    {
        SceneVertex<T> o = v;
        o.position.y = o.position.y - T(float(in.instance_id) / 8);
        return o;
    }
};

TEST(TessellationFacts, G3ThePixelShaderSeesThePatchsNumberInEveryInstance)
{
    PatchScene s;
    s.use_patches(PatchHull<D::Quad>{});
    s.desc.output_primitive = O::Point;
    s.desc.vertex_shader = bind_vertex_shader(InstanceRows{}, {});
    s.use(ShowPrimitiveId{});
    s.call.instance_count = 3;
    for (int i = 0; i < 4; ++i) s.add(2.5f + float(i), 5.5f);
    s.draw();
    EXPECT_EQ(s.covered(), 4 * 3);
    for (int instance = 0; instance < 3; ++instance)
        for (int i = 0; i < 4; ++i) EXPECT_EQ(s.at(2 + i, 5 + instance), float(i + 1));
}

// Clip distances behind the attribute.
template <int n, class T> struct Distances {
    float4<T> position, value;
    std::array<T, std::size_t(n)> clip;
    static constexpr int kClipDistances = n;
    static constexpr auto signature()
    {
        return std::tuple{&Distances::position, &Distances::value, &Distances::clip};
    }
};
template <class T> using OneDistance = Distances<1, T>;

// What the vertex and the hull shader write is behind every plane.
struct ClippedVertex {
    template <class T> using Input = SceneVertex<T>;
    template <class T> using Output = OneDistance<T>;
    template <class T>
    OneDistance<T> operator()(VertexInput<T> const&, SceneVertex<T> const& v) const
    {
        return {v.position, v.value, {T(-1)}};
    }
};
struct ClippedHull {
    static constexpr D kDomain = D::Quad;
    template <class T> using Input = OneDistance<T>;
    template <class T> using ControlPoint = OneDistance<T>;
    template <class T> using PatchConstant = Constant<T>;
    float factor = 1;
    int control_points() const { return 1; }
    int patch_constants() const { return 0; }
    template <class T>
    OneDistance<T> control_point(PatchInput, ControlPoints<OneDistance<T>> const& in,
                                 int_of<T> id) const
    {
        return in[id];
    }
    template <class T>
    Constant<T> patch_constant(PatchInput, ControlPoints<OneDistance<T>> const&,
                               ControlPoints<OneDistance<T>> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<OneDistance<T>> const&,
                                  ControlPoints<OneDistance<T>> const&,
                                  ControlPoints<Constant<T>> const&) const
    {
        T const f(factor);
        return {f, f, f, f, f, f};
    }
};
// Covers the target; keeps u < `keep` by its last distance, all others are in front.
template <int n> struct ClippedDomain {
    static constexpr D kDomain = D::Quad;
    template <class T> using ControlPoint = OneDistance<T>;
    template <class T> using PatchConstant = Constant<T>;
    template <class T> using Output = Distances<n, T>;
    float keep = 1;
    template <class T>
    Distances<n, T> operator()(DomainInput<T> const& in, ControlPoints<OneDistance<T>> const&,
                               ControlPoints<Constant<T>> const&) const
    {
        Distances<n, T> o{
            {T(2) * in.u - T(1), T(1) - T(2) * in.v, T(0.5f), T(1)}, {T(1), T(1), T(1), T(1)}, {}};
        for (T& c : o.clip) c = T(1);
        o.clip[std::size_t(n - 1)] = T(keep) - in.u;
        return o;
    }
};
// Without distances of its own; its last scalar would be one of the vertex shader's.
struct UnclippedDomain : ClippedDomain<1> {
    template <class T> using Output = SceneVertex<T>;
    template <class T>
    SceneVertex<T> operator()(DomainInput<T> const& in, ControlPoints<OneDistance<T>> const&,
                              ControlPoints<Constant<T>> const&) const
    {
        return {{T(2) * in.u - T(1), T(1) - T(2) * in.v, T(0.5f), T(1)}, {T(1), T(1), T(1), T(-1)}};
    }
};

// Two clip distances in front, then three cull distances: the last is negative for u > `keep`.
template <class T> struct Culled {
    float4<T> position, value;
    std::array<T, 5> distances;
    static constexpr int kClipDistances = 2, kCullDistances = 3;
    static constexpr auto signature()
    {
        return std::tuple{&Culled::position, &Culled::value, &Culled::distances};
    }
};
struct CulledDomain : ClippedDomain<1> {
    template <class T> using Output = Culled<T>;
    template <class T>
    Culled<T> operator()(DomainInput<T> const& in, ControlPoints<OneDistance<T>> const&,
                         ControlPoints<Constant<T>> const&) const
    {
        return {{T(2) * in.u - T(1), T(1) - T(2) * in.v, T(0.5f), T(1)},
                {T(1), T(1), T(1), T(1)},
                {T(1), T(1), T(1), T(1), T(keep) - in.u}};
    }
};

template <class Domain> int covered_by(Domain const& domain, float factor)
{
    PatchScene s;
    s.desc.vertex_shader = bind_vertex_shader(ClippedVertex{}, {});
    s.desc.hull_shader = bind_hull_shader(ClippedHull{factor}, {});
    s.desc.domain_shader = bind_domain_shader(domain, {});
    s.desc.partitioning = P::Pow2;
    s.desc.input_control_points = s.call.control_points = 1;
    s.call.topology = PrimitiveTopology::PatchList;
    s.add(0, 0);
    s.draw();
    return s.covered();
}

TEST(TessellationFacts, S7G7OnlyTheDomainShadersClipAndCullDistancesCount)
{
    for (float factor : {1.0f, 2.0f}) {
        EXPECT_EQ(covered_by(UnclippedDomain{}, factor), 16 * 16);
        EXPECT_EQ(covered_by(ClippedDomain<1>{2}, factor), 16 * 16);
        EXPECT_EQ(covered_by(ClippedDomain<1>{-1}, factor), 0);
        EXPECT_EQ(covered_by(ClippedDomain<1>{0.5f}, factor), 8 * 16);
        // The fifth of five, in a second register.
        EXPECT_EQ(covered_by(ClippedDomain<5>{0.25f}, factor), 4 * 16);
        // Culled are triangles that have u > keep all over: those of the right half at factor 2.
        EXPECT_EQ(covered_by(CulledDomain{{-1}}, factor), 0);
        EXPECT_EQ(covered_by(CulledDomain{{0.25f}}, factor), factor == 1 ? 16 * 16 : 8 * 16);
    }
}

template <D domain> std::uint64_t domain_points_of_four_patches()
{
    PatchScene s;
    s.use_patches(PatchHull<domain>{1, {uniform(4)}});
    for (int i = 0; i < 4; ++i) s.add(8, 8);
    return s.draw().pipeline.DSInvocations;
}

TEST(TessellationFacts, S8FourPatchesAtLevelFourRunTheDomainShaderOncePerPoint)
{
    EXPECT_EQ(domain_points_of_four_patches<D::Tri>(), 76u);
    EXPECT_EQ(domain_points_of_four_patches<D::Isoline>(), 80u);
    EXPECT_EQ(domain_points_of_four_patches<D::Quad>(), 100u);
}

TEST(TessellationFacts, G2ACulledPatchTakesItsPrimitiveId)
{
    PatchScene s;
    std::vector<TessFactors> factors(4, uniform(1));
    factors[0] = uniform(0);
    factors[2] = uniform(-1);
    s.use_patches(PatchHull<D::Quad>{1, factors});
    s.desc.output_primitive = O::Point;
    s.stream_out(4, 3);
    for (int i = 0; i < 100; ++i) s.add(8, 8, 0.5f, 1, {float(i), 0, 0, 0});
    s.draw();
    Corners expected;
    for (int i = 1; i < 100; i += 2)
        expected.insert(expected.end(), 4, {float(i), float(i), float(i)});
    EXPECT_EQ(s.streamed(), expected);
}

} // namespace
} // namespace tessemu::test
