// ACC's control points and tangent fields against golden data, through the templates that draw.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/acc/stencils.h"
#include "shaders_cpp/acc/acc_hull_shader.h"
#include "tests/support/files.h"
#include "tests/support/stencil_patch.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

using Json = nlohmann::json;

// 25 control points in the face's own order of corners.
template <class F> test::StencilPatch<F> acc_patch(Topology const& topology, std::uint32_t face)
{
    Neighbourhood n;
    find_neighbourhood(topology, face, n);
    test::StencilPatch<F> const rotated = test::run_stencils<F, AccHullShader<SummedRows<4, F>>>(
        topology.mesh(), n, make_acc_stencils(n, false, false));
    test::StencilPatch<F> out = rotated;
    for (std::size_t i = 0; i < 4; ++i) {
        std::size_t const to = (i + std::size_t(n.rotation)) % 4;
        for (std::size_t kind = 0; kind < 6; ++kind)
            std::copy_n(rotated.points.data() + 4 * (4 * kind + i), 4,
                        out.points.data() + 4 * (4 * kind + to));
        out.points[4 * AccLayout::kCosines + to] = rotated.points[4 * AccLayout::kCosines + i];
    }
    return out;
}

// sum of B_i(u) B_j(v) c[i][j] in double.
std::array<double, 3> tensor(Json const& c, double u, double v)
{
    auto const basis = [](std::size_t n, double t) {
        double const s = 1 - t;
        return n == 3 ? std::vector<double>{s * s, 2 * s * t, t * t}
                      : std::vector<double>{s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t};
    };
    auto const Bu = basis(c.size(), u), Bv = basis(c[0].size(), v);
    std::array<double, 3> out{};
    for (std::size_t i = 0; i < Bu.size(); ++i)
        for (std::size_t j = 0; j < Bv.size(); ++j)
            for (std::size_t k = 0; k < 3; ++k) out[k] += Bu[i] * Bv[j] * double(c[i][j][k]);
    return out;
}

template <class F> double error(float3<F> const& p, std::array<double, 3> const& expected)
{
    return std::max({std::abs(double(p.x) - expected[0]), std::abs(double(p.y) - expected[1]),
                     std::abs(double(p.z) - expected[2])});
}

template <class F> class AccOn : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(AccOn, Scalars);

// Bounds. double: 1e-12, as the golden data were compared. float, u = 2^-24: a control point errs
// by 34 u times its scale (see gregory_golden_test.cpp). A derived tangent is the sum of two
// cosines times tangents, at most 3 (tangents are 3 times differences of points, so 6 scale), and 3
// times a difference: at most 12 control point errors and 12 roundings of it; evaluation adds 24
// roundings.
TYPED_TEST(AccOn, ControlPointsAndTangentFieldsAgreeWithGoldenData)
{
    using F = TypeParam;
    std::size_t faces = 0;
    for (char const* name : {"cube", "house", "l_shape", "open_fan5", "open_grid", "open_mixed",
                             "prism3", "trapezohedron6", "trapezohedron9"}) {
        Json const j =
            Json::parse(test::read_text(test::golden(std::string("loop09/") + name + ".json")));
        ControlMesh const mesh = test::mesh_from(j);
        Topology const topology(mesh);
        for (Json const& g : j["acc"]) {
            test::StencilPatch<F> const p = acc_patch<F>(topology, g["face"]);
            double const ulp = std::ldexp(1, -24);
            double const point_bound = sizeof(F) == 8 ? 1e-12 : 34 * ulp * p.scale;
            double const field_bound =
                sizeof(F) == 8 ? 1e-12 : 12 * point_bound + 36 * 6 * ulp * p.largest_point;
            ControlPoints<AccControlPoint<F>> const patch(p.points.data(), AccLayout::kPoints);
            for (double u : {0.0, 0.125, 0.5, 0.75, 1.0})
                for (double v : {0.0, 0.25, 0.625, 1.0}) {
                    TangentFrame<F> const s = acc_quad<F>(patch, F(u), F(v));
                    ASSERT_LE(error(s.position, tensor(g["b"], u, v)),
                              point_bound + (sizeof(F) == 8 ? 0 : 24 * ulp * p.largest_point))
                        << name << " face " << g["face"] << " at " << u << " " << v;
                    ASSERT_LE(error(s.du, tensor(g["u_tangents"], u, v)), field_bound)
                        << name << " face " << g["face"] << " at " << u << " " << v;
                    ASSERT_LE(error(s.dv, tensor(g["v_tangents"], u, v)), field_bound)
                        << name << " face " << g["face"] << " at " << u << " " << v;
                }
            ++faces;
        }
    }
    EXPECT_EQ(faces, 89u);
}

// The edge that both patches evaluate is the patch's own: same curve, same normal direction.
TEST(AccEdge, SharedEdgeFieldIsParallelToThePatchsOwnNormal)
{
    Json const j = Json::parse(test::read_text(test::golden("loop09/l_shape.json")));
    ControlMesh const mesh = test::mesh_from(j);
    Topology const topology(mesh);
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        Neighbourhood n;
        find_neighbourhood(topology, f, n);
        PatchStencils const s = make_acc_stencils(n, false, false);
        auto const p = test::run_stencils<double, AccHullShader<SummedRows<4, double>>>(mesh, n, s);
        ControlPoints<AccControlPoint<double>> const patch(p.points.data(), AccLayout::kPoints);
        for (int k = 0; k < 4; ++k) {
            float3<double> W[4];
            for (int m = 0; m < 4; ++m) {
                float3<double> sum(0, 0, 0);
                auto const& row = s.rows[std::size_t(s.control_points + 4 * k + m)];
                for (std::size_t i = 0; i < row.size(); ++i) {
                    auto const& x = mesh.positions[n.inputs[i]];
                    double const w = m < 2 ? row[i] : -row[i];
                    sum = sum + float3<double>(w * double(x.x), w * double(x.y), w * double(x.z));
                }
                W[m] = sum;
            }
            for (double t : {0.1, 0.5, 0.8}) {
                auto const e = edge_point<double>(AccQuadInside::edge<double>(patch, k), W, t);
                double const u = k == 0 ? t : k == 1 ? 1 : k == 2 ? 1 - t : 0;
                double const v = k == 0 ? 0 : k == 1 ? t : k == 2 ? 1 : 1 - t;
                TangentFrame<double> const own = acc_quad<double>(patch, u, v);
                float3<double> const a = normalize(e.normal), b = normalize(cross(own.du, own.dv));
                EXPECT_NEAR(dot(a, b), 1, 1e-12) << "face " << f << " edge " << k << " t " << t;
                float3<double> const gap = e.position - own.position;
                EXPECT_LE(dot(gap, gap), 1e-28);
            }
        }
    }
}

} // namespace
} // namespace tessemu
