// Second derivatives and mean curvature: of given shapes, of bicubics, of Stam's patches and around
// their extraordinary vertices.
//
// SPDX-License-Identifier: Apache-2.0
#include "shaders_cpp/curvature.h"

#include "shaders_cpp/bezier_hull_shader.h"
#include "shaders_cpp/stam/stam_domain_shaders.h"
#include "tests/support/biseptic_evaluation.h"
#include "tests/support/files.h"
#include "tests/support/printed.h"
#include "tests/support/stam_evaluation.h"
#include "tests/support/vertex_neighbourhood.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>

namespace tessemu {
namespace {

using Json = nlohmann::json;
using Frame = SecondOrderFrame<double>;

// z = (a x^2 + 2 b x y + c y^2) / 2 at the origin, normal z: H = -(a + c)/2.
Frame graph(double a, double b, double c)
{
    return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, a}, {0, 0, b}, {0, 0, c}};
}
// With u for 2^k u, and u + v for v: of the same surface, exact.
Frame reparametrized(Frame const& f, int k)
{
    double const s = std::ldexp(1.0, k);
    return {f.position,
            s * f.du,
            f.du + f.dv,
            s * s * f.duu,
            s * float3<double>(f.duu + f.duv),
            f.duu + 2.0 * f.duv + f.dvv};
}

TEST(MeanCurvature, IsPositiveWhereTheSurfaceBendsAwayFromItsNormal)
{
    EXPECT_EQ(mean_curvature(graph(-0.5, 0, -0.5)), 0.5); // a sphere of radius 2 from outside
    EXPECT_EQ(mean_curvature(graph(0.5, 0, 0.5)), -0.5);  // and from inside
    EXPECT_EQ(mean_curvature(graph(-1, 0, 0)), 0.5);      // a cylinder of radius 1
    EXPECT_EQ(mean_curvature(graph(-3, 5, 3)), 0);        // a saddle
    EXPECT_EQ(mean_curvature(graph(0, 0, 0)), 0);
}

TEST(MeanCurvature, DoesNotDependOnTheParametersButOnTheScale)
{
    for (int k : {-12, -1, 0, 3, 20}) {
        EXPECT_EQ(mean_curvature(reparametrized(graph(-3, 1, 1), k)), 1) << k;
        EXPECT_EQ(mean_curvature(reparametrized(graph(-3, 5, 3), k)), 0) << k;
    }
    Frame f = graph(-3, 1, 1);
    for (float3<double>* v : {&f.du, &f.dv, &f.duu, &f.duv, &f.dvv}) *v = 8.0 * *v;
    EXPECT_EQ(mean_curvature(f), 0.125);
}

TEST(MeanCurvature, IsZeroWhereThereIsNoTangentPlane)
{
    Frame const f = graph(1, 2, 3);
    EXPECT_EQ(mean_curvature(Frame{f.position, f.du, 2.0 * f.du, f.duu, f.duv, f.dvv}), 0);
    EXPECT_EQ(mean_curvature(Frame{f.position, {0, 0, 0}, f.dv, f.duu, f.duv, f.dvv}), 0);
}

// 6 times the B-splines and their derivatives at a/4, times 4^3, 4^2 and 4.
using Weights = std::array<long, 4>;
Weights spline(long a, int order)
{
    if (order == 0)
        return {(4 - a) * (4 - a) * (4 - a), 3 * a * a * a - 24 * a * a + 256,
                -3 * a * a * a + 12 * a * a + 48 * a + 64, a * a * a};
    if (order == 1)
        return {-3 * (4 - a) * (4 - a), 9 * a * a - 48 * a, -9 * a * a + 24 * a + 48, 3 * a * a};
    return {6 * (4 - a), 6 * (3 * a - 8), 6 * (4 - 3 * a), 6 * a};
}

// Coordinates are multiples of 36, so Bezier points are whole numbers, also as seen from the first
// one, and all sums fit 24 bits: singles are exact (see the same of first derivatives in
// regular_net_test.cpp). B-splines have rounded sixths: in double they are off by less than 2^-40.
TEST(SecondOrder, OfBicubicsIsExactOnWholeNumbersAtQuarters)
{
    std::mt19937 random(20261127);
    std::uniform_int_distribution<int> number(-8, 8);
    for (int turn = 0; turn < 20; ++turn) {
        std::vector<float> net(48), points;
        for (float& x : net) x = float(36 * number(random));
        ControlPoints<ControlVertex<float>> const in(net.data(), 16);
        for (int id = 0; id < 16; ++id) {
            float3<float> const p =
                BezierHullShader{}.template control_point<float>({0}, in, id).position;
            points.insert(points.end(), {p.x, p.y, p.z});
        }
        std::vector<double> const nets(net.begin(), net.end());
        for (long i = 0; i <= 4; ++i)
            for (long j = 0; j <= 4; ++j) {
                DomainInput<float> const at{float(i) / 4, float(j) / 4, 0, 0};
                SecondOrderFrame<float> const bezier = RegularQuadInside::second_order<float>(
                    ControlPoints<ControlVertex<float>>(points.data(), 16), at);
                Frame const bspline = BsplineQuadInside::second_order<double>(
                    ControlPoints<ControlVertex<double>>(nets.data(), 16),
                    {double(i) / 4, double(j) / 4, 0, 0});
                auto const expect = [&](float3<float> const& a, float3<double> const& b,
                                        int along_u, int along_v) {
                    Weights const u = spline(i, along_u), v = spline(j, along_v);
                    double const scale = 36 * std::pow(4, 6 - along_u - along_v);
                    double const x[3] = {double(a.x), double(a.y), double(a.z)},
                                 y[3] = {b.x, b.y, b.z};
                    for (std::size_t c = 0; c < 3; ++c) {
                        long sum = 0;
                        for (std::size_t k = 0; k < 4; ++k)
                            for (std::size_t l = 0; l < 4; ++l)
                                sum += u[k] * v[l] * long(net[3 * (4 * k + l) + c]);
                        EXPECT_EQ(x[c] * scale, double(sum)) << along_u << along_v << i << j;
                        EXPECT_NEAR(y[c], double(sum) / scale, 0x1p-40);
                    }
                };
                expect(bezier.position, bspline.position, 0, 0);
                expect(bezier.du, bspline.du, 1, 0);
                expect(bezier.dv, bspline.dv, 0, 1);
                expect(bezier.duu, bspline.duu, 2, 0);
                expect(bezier.duv, bspline.duv, 1, 1);
                expect(bezier.dvv, bspline.dvv, 0, 2);
            }
    }
}

double size_of(float3<double> const& v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// Inside a sub-patch the surface is a bicubic. First derivatives, which the golden data have, are
// cubics at most along u and v, of which the five-point difference is exact. What is left is
// rounding: a first derivative is off by some (2 K + 32) 2^-53 of its terms, K = 32 functions at
// most; the difference divides by a step of 1/16 of a sub-patch and has coefficients of sum 18/12,
// so 96 * 24 * 2^-53 < 1e-12 in units of the terms, times the sub-patches a patch's side has. Terms
// are at most a few times the derivative and, of the constant function, the position times that
// number.
TEST(SecondOrder, OfStamsPatchesAgreesWithDifferencesOfFirstDerivatives)
{
    Json const j = Json::parse(test::read_text(test::golden("subdivision/stam.json")));
    std::size_t compared = 0;
    for (Json const& net : j["nets"]) {
        test::Evaluation<double> e(net["n"]);
        e.project(net["net"]);
        for (int k : {0, 1, 4, 10})
            for (auto [x, y] : {std::pair{0.75, 0.25}, {0.6875, 0.8125}, {0.25, 0.625}}) {
                double const u = std::ldexp(x, -k), v = std::ldexp(y, -k),
                             h = std::ldexp(1, -k - 5);
                auto const difference = [&](auto const& at) {
                    float3<double> const far = at(2 * h) - at(-2 * h), near = at(h) - at(-h);
                    return (1 / (12 * h)) * float3<double>(8.0 * near - far);
                };
                Frame const f = e.second_order_at(u, v);
                TangentFrame<double> const first = e.at(u, v);
                double const pieces = std::ldexp(1, k + 1);
                double const terms =
                    size_of(first.du) + size_of(first.dv) + pieces * size_of(first.position);
                auto const near = [&](float3<double> const& a, float3<double> const& b,
                                      double bound) {
                    EXPECT_LE(size_of(a - b), bound) << net["n"] << " at " << u << ' ' << v;
                    ++compared;
                };
                near(f.position, first.position, 1e-12);
                near(f.du, first.du, 1e-12 * terms);
                near(f.dv, first.dv, 1e-12 * terms);
                double const bound = 1e-11 * pieces * terms;
                near(f.duu, difference([&](double d) { return e.at(u + d, v).du; }), bound);
                near(f.duv, difference([&](double d) { return e.at(u, v + d).du; }), bound);
                near(f.duv, difference([&](double d) { return e.at(u + d, v).dv; }), bound);
                near(f.dvv, difference([&](double d) { return e.at(u, v + d).dv; }), bound);
            }
    }
    EXPECT_EQ(compared, 10u * 4 * 3 * 7);
}

TEST(SecondOrder, AtTheExtraordinaryVertexIsThatOfTheNearestDomainPoint)
{
    test::Evaluation<double> e(7);
    e.project(test::VertexNeighbourhood(7, 1).net(0));
    Frame const corner = e.second_order_at(0, 0), near = e.second_order_at(0x1p-16, 0x1p-16);
    EXPECT_EQ(mean_curvature(corner), mean_curvature(near));
    EXPECT_NE(mean_curvature(corner), 0);
}

/// Second derivatives of patch `j` around a vertex.
using PatchesAround = std::function<Frame(int j, double u, double v)>;

PatchesAround stam_around(int n, unsigned seed)
{
    std::vector<test::Evaluation<double>> patches;
    test::VertexNeighbourhood const around(n, seed);
    for (int j = 0; j < n; ++j) patches.emplace_back(n).project(around.net(j));
    return [=](int j, double u, double v) { return patches[std::size_t(j)].second_order_at(u, v); };
}

PatchesAround biseptic_around(int n, unsigned seed)
{
    std::vector<test::BisepticEvaluation<double>> patches;
    test::VertexNeighbourhood const around(n, seed);
    for (int j = 0; j < n; ++j) patches.emplace_back(n, around.net(j));
    return [=](int j, double u, double v) { return patches[std::size_t(j)].second_order_at(u, v); };
}

constexpr int kFirstRing = 2, kLastRing = 10;

/// max - min of the mean curvature over max(u, v) = 2^-k of all patches, k = 2 to 10.
std::vector<double> spreads(int n, PatchesAround const& patches)
{
    std::vector<double> out;
    for (int k = kFirstRing; k <= kLastRing; ++k) {
        double low = INFINITY, high = -INFINITY;
        double const ring = std::ldexp(1, -k);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i <= 16; ++i)
                for (bool turned : {false, true}) {
                    double const a = ring, b = ring * i / 16;
                    double const h = mean_curvature(turned ? patches(j, b, a) : patches(j, a, b));
                    low = std::min(low, h), high = std::max(high, h);
                }
        out.push_back(high - low);
    }
    return out;
}

// Both patches at a spoke have the same curvature there, so the net and its turns are right.
TEST(CurvatureAtAVertex, AgreesAcrossSpokes)
{
    for (int n = 3; n <= 12; ++n) {
        PatchesAround const patches = stam_around(n, 20261126);
        for (int j = 0; j < n; ++j)
            for (double t : {1.0, 0.7, 0.3, 0.01}) {
                double const a = mean_curvature(patches(j, 0, t)),
                             b = mean_curvature(patches((j + 1) % n, t, 0));
                // Second derivatives of size 1 in double, from 4^7 times sums of size 4^-7.
                EXPECT_NEAR(a, b, 1e-9 * (1 + std::abs(a))) << n << ' ' << j << ' ' << t;
            }
    }
}

// From ring to ring by the third largest eigenvalue over the square of the second, which is above 1
// for n > 4 (docs/smoothness.md). What the next eigenvalues add falls from ring to ring; at the
// last one it is less than 3 %.
TEST(CurvatureAtAVertex, OfStamsPatchesSpreadsMoreAndMoreForMoreThanFourEdges)
{
    for (int n = 3; n <= 12; ++n) {
        std::vector<double> const s = spreads(n, stam_around(n, 20261126));
        std::size_t const last = s.size() - 1;
        for (std::size_t k = 1; k <= last; ++k) {
            if (n > 4) {
                EXPECT_GT(s[k], s[k - 1]) << n << ", ring " << k + kFirstRing;
            } else {
                EXPECT_LT(s[k], s[k - 1]) << n << ", ring " << k + kFirstRing;
            }
        }
        if (n == 4) {
            EXPECT_LT(s[last], s[0] / 100); // a regular patch: continuous
        }
        if (n <= 4) continue;
        std::vector<double> size = stam_eigen(n).eigenvalues;
        std::sort(size.rbegin(), size.rend());
        double const rate = size[3] / (size[1] * size[1]);
        EXPECT_GT(rate, 1) << n;
        EXPECT_NEAR(s[last] / s[last - 1], rate, 0.03 * rate) << n;
    }
}

// All patches have one curvature at the vertex and a polynomial's away from it: at the ring h = 2^-k
// the spread is a h + b h^2 + ..., which falls from ring to ring by a factor that is 1/2 but for
// (b/a) h / 2. On these nets b/a is below 40: less than 0.02 at the last ring.
TEST(CurvatureAtAVertex, OfBisepticPatchesIsOne)
{
    for (int n = 3; n <= 12; ++n) {
        std::vector<double> const s = spreads(n, biseptic_around(n, 20261126));
        std::size_t const last = s.size() - 1;
        for (std::size_t k = 1; k <= last; ++k)
            EXPECT_LT(s[k], s[k - 1]) << n << ", ring " << k + kFirstRing;
        EXPECT_NEAR(s[last] / s[last - 1], 0.5, 0.02) << n;
    }
}

TEST(CurvatureAtAVertex, SpreadsAsThePageSays)
{
    auto const rows = test::table_of("docs/smoothness.md", "| n | 3 | 4 |");
    std::size_t compared = 0;
    for (int n = 3; n <= 12; ++n) {
        std::vector<double> const stam = spreads(n, stam_around(n, 20261126)),
                                  biseptic = spreads(n, biseptic_around(n, 20261126));
        std::map<std::string, double> const values{{"`stam`: spread at 2^-2", stam.front()},
                                                   {"`stam`: at 2^-10", stam.back()},
                                                   {"`biseptic`: spread at 2^-2", biseptic.front()},
                                                   {"`biseptic`: at 2^-10", biseptic.back()}};
        for (auto const& cells : rows) {
            auto const value = values.find(cells.at(0));
            if (value == values.end()) continue;
            EXPECT_TRUE(test::printed(cells.at(std::size_t(n - 2))).rounds_from(value->second))
                << cells[0] << ", n = " << n << ": " << value->second;
            ++compared;
        }
    }
    EXPECT_EQ(compared, 40u);
}

} // namespace
} // namespace tessemu
