// Phong triangles: their identities and their cost (docs/math/subdivision.md, 6.5).
//
// SPDX-License-Identifier: Apache-2.0
#include "shaders_cpp/phong/phong_triangle.h"

#include "emu/tally.h"
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/edges.h"
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
constexpr Cost cost()
{
    Cost c;
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<NormalVertex<Tally>> const patch(sink, 3, &c.fetches);
        ControlPoints<ControlVertex<Tally>> const none(sink, 0, &c.fetches);
        DomainInput<Tally> const in{Tally(0.25, sink), Tally(0.5, sink), Tally(0.25, sink), 0};
        (void)PhongTriangle{}(in, patch, none);
    });
    return c;
}

// Mul: 9 for p and 9 for the normal, 9 a projection, 6 for alpha, 6 for the normal's length. Add: 6
// for p and 6 for the normal, 8 a projection and 6 for their sum, 3 for alpha, 2 for the length.
static_assert(cost().flops == FlopCount{.add = 47, .mul = 57, .div = 1, .sqrt = 1, .compare = 1});
static_assert(cost().fetches == 3);

TEST(Phong, RunTimeCountsAreThoseOfThePage)
{
    SchemeOnMesh const on = build_scheme(find_scheme("phong"), load_model("spindle").mesh);
    for (Machine const& machine : test::machines()) {
        FrameSettings s;
        s.tess_factor = 5.3f;
        s.machine = machine;
        DrawStatistics const d = visit_surface(*on.patches, s, ThreadPool(2), {}).total;
        std::uint64_t const points = d.pipeline.DSInvocations;
        EXPECT_GT(points, 0u);
        auto const stage =
            std::find_if(d.stages.begin(), d.stages.end(),
                         [](StageStatistics const& st) { return st.stage == "domain_shader"; });
        ASSERT_NE(stage, d.stages.end());
        EXPECT_EQ(stage->flops.mul, (57 + 12) * points) << "12 of them the camera's";
        for (FetchStatistics const& f : stage->fetches)
            EXPECT_EQ(f.count, f.resource == "control_points" ? 3 * points : 0) << f.resource;
    }
}

// A triangle: of each corner position and normal, which need not have unit length here.
template <class F> struct Triangle {
    F floats[3][6];

    F const* position(std::size_t i) const { return floats[i]; }
    F const* normal(std::size_t i) const { return floats[i] + 3; }
    float3<F> at(float alpha, F u, F v) const
    {
        ControlPoints<NormalVertex<F>> const patch(&floats[0][0], 3);
        ControlPoints<ControlVertex<F>> const none(nullptr, 0);
        DomainInput<F> const in{u, v, 1 - u - v, 0};
        return PhongTriangle{alpha}(in, patch, none).position;
    }
};

/// number(random) for each scalar of a position, unit(random) for each of a normal.
template <class F, class Random>
Triangle<F> random_triangle(Random& random, auto& position, auto& normal)
{
    Triangle<F> t;
    for (auto& corner : t.floats)
        for (int k = 0; k < 6; ++k) corner[k] = k < 3 ? F(position(random)) : F(normal(random));
    return t;
}

// At a corner two weights are 0: p is the vertex x, and so is its projection. What is left to round
// is (1 - alpha) x + alpha x. With 3/4, the default, x/4 is exact, 3x/4 is off by at most half a
// unit of x, and the sum rounds to x: to the even number where it is halfway, but then x has a
// multiple of two units, as 3x/4 has a half left over. Otherwise 1 - alpha, both products and the
// sum round: 1/2 + 1 + 1 and, for what is of second order, 1/2 more units of 2^-24.
TEST(Phong, CornersAreInterpolated)
{
    std::mt19937 random(20261124);
    std::uniform_real_distribution<float> number(-4, 4), unit(-1, 1), fraction(0, 1);
    for (int n = 0; n < 1000; ++n) {
        Triangle<float> const t = random_triangle<float>(random, number, unit);
        float const other = fraction(random);
        for (std::size_t i = 0; i < 3; ++i) {
            float const u = i == 0, v = i == 1;
            float3<float> const p = t.at(0.75f, u, v), q = t.at(other, u, v);
            float const *const x = t.position(i), at[] = {p.x, p.y, p.z}, near[] = {q.x, q.y, q.z};
            for (int k = 0; k < 3; ++k) {
                ASSERT_EQ(at[k], x[k]);
                ASSERT_LE(std::abs(double(near[k]) - double(x[k])),
                          3 * 0x1p-24 * std::abs(double(x[k])))
                    << other;
            }
        }
    }
}

TEST(Phong, TheDrawnSurfaceGoesThroughTheVerticesUnderEveryContraction)
{
    SchemeOnMesh const on = build_scheme(find_scheme("phong"), load_model("spindle").mesh);
    ControlMesh const& mesh = on.mesh->mesh();
    for (Machine const& machine : test::contraction_policies()) {
        FrameSettings s;
        s.tess_factor = 3;
        s.machine = machine;
        std::size_t corners = 0;
        visit_surface(*on.patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
            TessellatedPatch const& t = p.domain().patch;
            for (std::size_t i = 0; i < t.points(); ++i) {
                MeshPoint const name = mesh_point(mesh, p.place(), t.u[i], t.v[i]);
                if (name.kind != MeshPoint::Kind::Vertex) continue;
                EXPECT_EQ(p.vertex(i).position, mesh.positions[name.a]);
                ++corners;
            }
        });
        EXPECT_EQ(corners, 3 * mesh.faces());
    }
}

// Whole numbers up to 64 and weights in 1/65536: every product and sum fits 24 bits.
TEST(Phong, WithoutAlphaItIsTheFlatTriangle)
{
    std::mt19937 random(20261124);
    std::uniform_int_distribution<int> number(-64, 64), weight(0, 65536);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int n = 0; n < 1000; ++n) {
        Triangle<float> const t = random_triangle<float>(random, number, unit);
        int u = weight(random), v = weight(random);
        if (u + v > 65536) u = 65536 - u, v = 65536 - v;
        float3<float> const p = t.at(0, float(u) / 65536, float(v) / 65536);
        float const at[] = {p.x, p.y, p.z};
        for (int k = 0; k < 3; ++k)
            ASSERT_EQ(at[k] * 65536, float(u * int(t.position(0)[k]) + v * int(t.position(1)[k]) +
                                           (65536 - u - v) * int(t.position(2)[k])));
    }
}

// The parameter arrives: a product and two sums round on the way to a point of the flat triangle,
// 3 units of 2^-24 of the largest coordinate and a thousandth for what is of second order.
TEST(Phong, AlphaOfTheSchemeIsTheShaders)
{
    SchemeOnMesh const on =
        build_scheme(find_scheme("phong"), load_model("spindle").mesh, {.set = {{"alpha", "0"}}});
    ControlMesh const& mesh = on.mesh->mesh();
    double largest = 0;
    for (glm::vec3 const& p : mesh.positions)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double(p[k])));
    FrameSettings s;
    s.tess_factor = 5.3f;
    std::size_t points = 0;
    visit_surface(*on.patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
        auto const face = mesh.face(p.place().face);
        for (std::size_t i = 0; i < p.points(); ++i) {
            double const u = double(p.domain().u[i]), v = double(p.domain().v[i]);
            for (int k = 0; k < 3; ++k) {
                double const flat = u * double(mesh.positions[face[0]][k]) +
                                    v * double(mesh.positions[face[1]][k]) +
                                    (1 - u - v) * double(mesh.positions[face[2]][k]);
                EXPECT_NEAR(double(p.vertex(i).position[k]), flat, 3.001 * 0x1p-24 * largest);
            }
            ++points;
        }
    });
    EXPECT_GT(points, 3 * mesh.faces());
}

// The same as a quadratic Bezier triangle, for normals of any length. Small whole numbers, weights
// in 1/32 and alpha in quarters: exact in double.
TEST(Phong, IsAQuadraticBezierTriangle)
{
    std::mt19937 random(20261124);
    std::uniform_int_distribution<int> number(-8, 8), normal(-2, 2), weight(0, 32), quarter(0, 4);
    for (int n = 0; n < 1000; ++n) {
        Triangle<double> const t = random_triangle<double>(random, number, normal);
        double const alpha = quarter(random) / 4.0;
        int u = weight(random), v = weight(random);
        if (u + v > 32) u = 32 - u, v = 32 - v;
        double const weights[] = {u / 32.0, v / 32.0, (32 - u - v) / 32.0};
        float3<double> const p = t.at(float(alpha), weights[0], weights[1]);
        double const at[] = {p.x, p.y, p.z};
        // Component k of vertex j projected on the tangent plane of vertex i.
        auto const projected = [&](std::size_t i, std::size_t j, int k) {
            double height = 0;
            for (int c = 0; c < 3; ++c)
                height += (t.position(j)[c] - t.position(i)[c]) * t.normal(i)[c];
            return t.position(j)[k] - height * t.normal(i)[k];
        };
        for (int k = 0; k < 3; ++k) {
            double sum = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                std::size_t const j = (i + 1) % 3;
                double const middle = (1 - alpha) * (t.position(i)[k] + t.position(j)[k]) / 2 +
                                      alpha * (projected(i, j, k) + projected(j, i, k)) / 2;
                sum += weights[i] * weights[i] * t.position(i)[k] +
                       2 * weights[i] * weights[j] * middle;
            }
            ASSERT_EQ(at[k], sum);
        }
    }
}

} // namespace
} // namespace tessemu
