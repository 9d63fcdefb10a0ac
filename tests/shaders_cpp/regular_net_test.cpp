// Regular patches both ways (LOOP10 4.1): Bezier by the hull shader's change of basis, and
// B-spline all through.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"
#include "emu/tally.h"
#include "shaders_cpp/bezier_hull_shader.h"
#include "shaders_cpp/pass_through.h"
#include "shaders_cpp/projection.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tessemu {
namespace {

struct Cost {
    FlopCount flops;
    std::uint64_t fetches = 0;
};
template <class Inside> constexpr Cost evaluation_cost()
{
    Cost c;
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<ControlVertex<Tally>> const patch(sink, Inside::kControlPoints, &c.fetches);
        DomainInput<Tally> const in{Tally(0.25, sink), Tally(0.5, sink), Tally(0, sink), 0};
        TangentFrame<Tally> const s = Inside::template evaluate<Tally>(patch, in, false);
        (void)cross(s.du, s.dv);
    });
    return c;
}
// LOOP10 4.1: 162, and 24 more with the B-spline's basis.
static_assert(flops_loop10(evaluation_cost<RegularQuadInside>().flops) == 162);
static_assert(flops_loop10(evaluation_cost<BsplineQuadInside>().flops) == 162 + 24);
static_assert(evaluation_cost<RegularQuadInside>().fetches == 16);
static_assert(evaluation_cost<BsplineQuadInside>().fetches == 16);

template <class Hull> constexpr Cost hull_cost(int id)
{
    Cost c;
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<ControlVertex<Tally>> const in(sink, 16, &c.fetches);
        (void)Hull{}.template control_point<Tally>({0}, in, id);
    });
    return c;
}

TEST(RegularNet, EveryThreadOfTheChangeOfBasisCostsLoop10s60AndTheOtherWayNothing)
{
    for (int id = 0; id < 16; ++id) {
        EXPECT_EQ(flops_loop10(hull_cost<BezierHullShader>(id).flops), 60u) << id;
        EXPECT_EQ(hull_cost<BezierHullShader>(id).fetches, 16u) << id;
        EXPECT_EQ(hull_cost<BsplineQuadHullShader>(id).flops, FlopCount{}) << id;
        EXPECT_EQ(hull_cost<BsplineQuadHullShader>(id).fetches, 1u) << id;
    }
}

template <class Surface> constexpr Cost domain_cost(double u, double v)
{
    Cost c;
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<ControlVertex<Tally>> const patch(sink, 16, &c.fetches);
        ControlPoints<ControlVertex<Tally>> const none(sink, 0);
        DomainInput<Tally> const in{Tally(u, sink), Tally(v, sink), Tally(0, sink), 0};
        (void)ProjectionEpilog{}(in, Surface{}(in, patch, none));
    });
    return c;
}

// Of a drawn patch: the stages' counts are the tallies, whatever the machine.
template <class Hull, class Surface> void expect_counts(FlopCount const& per_thread)
{
    std::mt19937 random(20261126);
    std::uniform_real_distribution<float> number(-2, 2);
    std::vector<float> net(48);
    for (float& x : net) x = number(random);
    for (Machine const& machine : test::machines()) {
        std::string const what = testing::PrintToString(machine);
        Hull hull;
        hull.factors.uniform = 5.3f;
        GraphicsPipelineDesc desc;
        desc.vertex_shader = bind_vertex_shader(PassThroughVertexShader{}, machine);
        desc.hull_shader = bind_hull_shader(hull, machine);
        desc.domain_shader = bind_domain_shader(Surface{}, machine);
        desc.domain_epilog = bind_domain_epilog(ProjectionEpilog{}, machine);
        desc.input_control_points = 16;
        DrawCall call;
        call.set_vertices(net, 3);
        call.vertex_count = 16;
        call.control_points = 16;
        Cost expected;
        auto const visit = [&](ShadedPatch const& p) {
            for (std::size_t i = 0; i < p.points->patch.points(); ++i) {
                Cost const c = domain_cost<Surface>(double(p.points->u[i]), double(p.points->v[i]));
                expected.flops += c.flops;
                expected.fetches += c.fetches;
            }
        };
        DrawStatistics const s = draw(GraphicsPipeline(desc), call, nullptr, visit, ThreadPool(2));
        auto const stage = [&](char const* name) {
            auto const found =
                std::find_if(s.stages.begin(), s.stages.end(),
                             [&](StageStatistics const& x) { return x.stage == name; });
            EXPECT_NE(found, s.stages.end()) << name;
            return *found;
        };
        EXPECT_GT(s.pipeline.DSInvocations, 16u) << what;
        EXPECT_EQ(stage("hull_shader").flops, per_thread * 16) << what;
        EXPECT_EQ(stage("domain_shader").flops, expected.flops) << what;
        for (FetchStatistics const& f : stage("domain_shader").fetches)
            EXPECT_EQ(f.count, f.resource == "control_points" ? expected.fetches : 0) << what;
    }
}

TEST(RegularNet, RunTimeCountsEqualTheTallies)
{
    expect_counts<BezierHullShader, BezierQuadDomainShader>(hull_cost<BezierHullShader>(0).flops);
    expect_counts<BsplineQuadHullShader, BsplineQuadDomainShader>({});
}

template <class F> std::vector<F> bezier_points(std::vector<F> const& net)
{
    ControlPoints<ControlVertex<F>> const in(net.data(), 16);
    std::vector<F> out;
    for (int id = 0; id < 16; ++id) {
        float3<F> const p = BezierHullShader{}.template control_point<F>({0}, in, id).position;
        out.insert(out.end(), {p.x, p.y, p.z});
    }
    return out;
}
template <class F> TangentFrame<F> by_bezier(std::vector<F> const& net, F u, F v)
{
    std::vector<F> const points = bezier_points(net);
    return regular_quad<F>(ControlPoints<ControlVertex<F>>(points.data(), 16), u, v);
}
template <class F> TangentFrame<F> by_bspline(std::vector<F> const& net, F u, F v)
{
    return bspline_quad<F>(ControlPoints<ControlVertex<F>>(net.data(), 16), u, v);
}

// The two ways differ by rounding alone. In units of 2^-24, to first order, with M the largest
// coordinate; all weights are at least 0 and their sum is 1.
//   Bezier: the hull shader's weights 1, products 1, sums 3, twice: 10. Basis 3, products 1, sums
//   3, twice: 14. Together 24.
//   B-spline: of the basis 3 from Bernstein's, then a sum 1, a constant 1, a product 1, sums 2: 8;
//   products 1, sums 3; twice: 24.
// So positions differ by 48 M. Derivatives' functions have absolute values, terms before they
// cancel, of sum 6, and rounding as the others': 6 times as much. What is of second order is
// below 2 M and 12 M.
template <class F> void expect_both_ways_equal(double unit)
{
    std::mt19937 random(20261126);
    std::uniform_real_distribution<double> number(-2, 2);
    std::uniform_int_distribution<int> place(0, 65536);
    for (int n = 0; n < 300; ++n) {
        std::vector<F> net(48);
        for (F& x : net) x = F(number(random));
        bool const side = n % 3 == 0;
        F const u = side ? F(n % 2) : F(place(random)) / F(65536), v = F(place(random)) / F(65536);
        TangentFrame<F> const a = by_bezier(net, u, v), b = by_bspline(net, u, v);
        auto const near = [&](float3<F> const& x, float3<F> const& y, double bound) {
            EXPECT_LE(std::abs(double(x.x) - double(y.x)), bound) << u << ' ' << v;
            EXPECT_LE(std::abs(double(x.y) - double(y.y)), bound) << u << ' ' << v;
            EXPECT_LE(std::abs(double(x.z) - double(y.z)), bound) << u << ' ' << v;
        };
        near(a.position, b.position, 50 * unit * 2);
        near(a.du, b.du, 300 * unit * 2);
        near(a.dv, b.dv, 300 * unit * 2);
    }
}
TEST(RegularNet, BothWaysGiveTheSameSurfaceWithinRounding)
{
    expect_both_ways_equal<float>(0x1p-24);
    expect_both_ways_equal<double>(0x1p-53); // 6.6e-14 of derivatives
}

// 6 times the B-splines and their derivatives at a/4, times 4^3 and 4^2.
std::array<long, 4> splines(long a)
{
    return {(4 - a) * (4 - a) * (4 - a), 3 * a * a * a - 24 * a * a + 256,
            -3 * a * a * a + 12 * a * a + 48 * a + 64, a * a * a};
}
std::array<long, 4> spline_derivatives(long a)
{
    return {-3 * (4 - a) * (4 - a), 9 * a * a - 48 * a, -9 * a * a + 24 * a + 48, 3 * a * a};
}
long product(std::vector<float> const& net, std::size_t c, std::array<long, 4> const& u,
             std::array<long, 4> const& v)
{
    long sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) sum += u[i] * v[j] * long(net[3 * (4 * i + j) + c]);
    return sum;
}

// Coordinates are multiples of 36. A rounded sixth, third or two thirds is off by 2^-25 of itself
// at most, so its product with a multiple of 6 rounds to the whole number; the points are whole
// numbers up to 288, and at quarters functions have 6 bits of fraction: all fits 24 bits.
TEST(RegularNet, TheChangeOfBasisAndItsPatchAreExactOnWholeNumbersAtQuarters)
{
    std::mt19937 random(20261126);
    std::uniform_int_distribution<int> number(-8, 8);
    for (int n = 0; n < 20; ++n) {
        std::vector<float> net(48);
        for (float& x : net) x = float(36 * number(random));
        for (long i = 0; i <= 4; ++i)
            for (long j = 0; j <= 4; ++j) {
                TangentFrame<float> const s = by_bezier<float>(net, float(i) / 4, float(j) / 4);
                auto const Bu = splines(i), Bv = splines(j), Du = spline_derivatives(i),
                           Dv = spline_derivatives(j);
                auto const expect = [&](float3<float> const& p, auto const& x, auto const& y,
                                        double scale) {
                    EXPECT_EQ(double(p.x) * scale, double(product(net, 0, x, y)));
                    EXPECT_EQ(double(p.y) * scale, double(product(net, 1, x, y)));
                    EXPECT_EQ(double(p.z) * scale, double(product(net, 2, x, y)));
                };
                expect(s.position, Bu, Bv, 36 * 64 * 64);
                expect(s.du, Du, Bv, 36 * 16 * 64);
                expect(s.dv, Bu, Dv, 36 * 64 * 16);
            }
    }
}

TEST(RegularNet, ANetOfOnePointHasItsPlaceAndZAsTheNormalBothWays)
{
    std::vector<float> net;
    for (int i = 0; i < 16; ++i) net.insert(net.end(), {6, -12, 36});
    std::vector<float> const points = bezier_points(net);
    ControlPoints<ControlVertex<float>> const none(nullptr, 0);
    DomainInput<float> const in{0.25f, 0.5f, 0, 0};
    SurfacePoint<float> const a =
        BezierQuadDomainShader{}(in, ControlPoints<ControlVertex<float>>(points.data(), 16), none);
    EXPECT_EQ(a.position.z, 36);
    EXPECT_EQ(a.normal.z, 1);
    SurfacePoint<float> const b =
        BsplineQuadDomainShader{}(in, ControlPoints<ControlVertex<float>>(net.data(), 16), none);
    EXPECT_NEAR(b.position.z, 36, 36 * 24 * 0x1p-24);
}

// Two nets out of five rows: edge 0 of the upper patch is edge 2 of the lower one, backwards.
TEST(RegularNet, AdaptiveFactorsOfAnEdgeAreEqualFromBothSides)
{
    std::mt19937 random(20261126);
    std::uniform_real_distribution<float> number(-2, 2);
    BezierHullShader hull;
    hull.factors.kind = TessFactorRule::Kind::ProjectedLength;
    hull.factors.eye = {1, 2, 7};
    hull.factors.scale = 30;
    for (int n = 0; n < 100; ++n) {
        float rows[5][4][3];
        for (auto& row : rows)
            for (auto& point : row)
                for (float& x : point) x = number(random);
        auto const factors = [&](int first) {
            std::vector<float> net;
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j)
                    net.insert(net.end(), rows[first + j][i], rows[first + j][i] + 3);
            ControlPoints<ControlVertex<float>> const in(net.data(), 16), none(nullptr, 0);
            return hull.tess_factors<float>({0}, in, none, none);
        };
        std::array<float, 6> const upper = factors(1), lower = factors(0);
        EXPECT_EQ(upper[1], lower[3]); // of v = 0 and of v = 1
        EXPECT_GT(upper[1], 1);
    }
}

} // namespace
} // namespace tessemu
