// Control points and evaluation against golden data, through the templates that draw.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/gregory/stencils.h"
#include "shaders_cpp/gregory/domain_shaders.h"
#include "tests/support/files.h"
#include "tests/support/stencil_patch.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

using Json = nlohmann::json;

using test::mesh_from;

// A face's patch, turned back so that corner 0 is the face's first vertex.
template <class F> struct Patch : test::StencilPatch<F> {
    ControlPoints<ControlVertex<F>> view() const
    {
        return {this->points.data(), int(this->points.size() / 3)};
    }
};

template <class F, TessellatorDomain kDomain>
Patch<F> patch_of(Topology const& topology, std::uint32_t face)
{
    Neighbourhood n;
    find_neighbourhood(topology, face, n);
    test::StencilPatch<F> const rotated =
        test::run_stencils<F, StencilHullShader<kDomain, SummedRows<sides_of(kDomain), F>>>(
            topology.mesh(), n, make_gregory_stencils(n, false, {}));
    Patch<F> out{rotated};
    auto const N = std::size_t(n.sides);
    for (std::size_t id = 0; id < 5 * N; ++id)
        std::copy_n(rotated.points.data() + 3 * id, 3,
                    out.points.data() + 3 * (id / N * N + (id + std::size_t(n.rotation)) % N));
    return out;
}

double error(float3<float> const& p, Json const& expected, double scale = 1)
{
    return std::max({std::abs(double(p.x) * scale - double(expected[0])),
                     std::abs(double(p.y) * scale - double(expected[1])),
                     std::abs(double(p.z) * scale - double(expected[2]))});
}
double error(float3<double> const& p, Json const& expected, double scale = 1)
{
    return std::max({std::abs(p.x * scale - double(expected[0])),
                     std::abs(p.y * scale - double(expected[1])),
                     std::abs(p.z * scale - double(expected[2]))});
}

// Error bounds. double: 1e-12, as the golden data were compared. float, with u = 2^-24: a stencil
// sum of n <= 32 terms rounds each weight, product and partial sum, so it errs by at most (n + 2) u
// sum|w||x|. Evaluation is a convex combination of control points through at most 24 roundings on
// any path (blend weights 4, blend 2, basis 4, row 4, column 4, and 6 spare); a derivative
// multiplies that by the sum of the absolute derivative weights, 6 for a cubic, 8 for a quartic.
template <class F> double point_bound(Patch<F> const& p)
{
    return sizeof(F) == 8 ? 1e-12 : 34 * std::ldexp(1, -24) * p.scale;
}
template <class F> double evaluation_bound(Patch<F> const& p)
{
    return sizeof(F) == 8 ? 1e-12 : point_bound(p) + 24 * std::ldexp(1, -24) * p.largest_point;
}

template <class F> class GregoryOn : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(GregoryOn, Scalars);

std::vector<std::string> golden_meshes()
{
    return {"torus_regular", "cube",        "l_shape",    "trapezohedron6", "trapezohedron9",
            "tetrahedron",   "icosahedron", "bipyramid8", "antiprism7",     "prism3",
            "house",         "open_grid",   "open_mixed", "open_fan5"};
}

template <class F, TessellatorDomain kDomain>
void check_face(Topology const& topology, Json const& expected, std::string const& mesh,
                bool true_normals)
{
    constexpr int N = kDomain == TessellatorDomain::Quad ? 4 : 3;
    std::uint32_t const face = expected["face"];
    Patch<F> const patch = patch_of<F, kDomain>(topology, face);
    char const* kinds[] = {"p", "e_plus", "e_minus", "f_plus", "f_minus"};
    for (int kind = 0; kind < 5; ++kind)
        for (int i = 0; i < N; ++i) {
            F const* const c = patch.points.data() + 3 * (kind * N + i);
            float3<F> const p(c[0], c[1], c[2]);
            ASSERT_LE(error(p, expected[kinds[kind]][std::size_t(i)]), point_bound(patch))
                << mesh << " face " << face << " " << kinds[kind] << i;
        }
    double const bound = evaluation_bound(patch);
    for (auto const& e : expected["eval"]) {
        auto const& at = e["at"];
        TangentFrame<F> s;
        double derivative_scale = 1, weights = 6;
        if constexpr (N == 4) {
            s = gregory_quad<F>(patch.view(), F(at[0]), F(at[1]), true_normals);
        } else {
            s = gregory_triangle<F>(patch.view(), F(at[0]), F(at[1]), F(at[2]), true_normals);
            derivative_scale = 4, weights = 8;
        }
        ASSERT_LE(error(s.position, e["position"]), bound)
            << mesh << " face " << face << " at " << at;
        if (!true_normals) {
            ASSERT_LE(error(s.du, e["du"], derivative_scale), weights * bound)
                << mesh << " face " << face << " " << at;
            ASSERT_LE(error(s.dv, e["dv"], derivative_scale), weights * bound)
                << mesh << " face " << face << " " << at;
        } else if (e.contains("true_normal")) {
            float3<F> const n = normalize(cross(s.du, s.dv));
            // To first order a unit normal errs by |d(du x dv)| / |du x dv|. The dF terms add at
            // most four times 9 uv/(u+v)^2 v 2 <= 4.5 to the derivative weights. sqrt(3):
            // components to length; 4 ulp for cross and normalize.
            double const delta = std::sqrt(3.0) * (weights + 18) * bound / derivative_scale;
            double const length_u = std::sqrt(double(dot(s.du, s.du))),
                         length_v = std::sqrt(double(dot(s.dv, s.dv)));
            float3<F> const c = cross(s.du, s.dv);
            double const normal_bound =
                delta * (length_u + length_v) / std::sqrt(double(dot(c, c))) +
                4 * std::ldexp(1, -24);
            ASSERT_LE(error(n, e["true_normal"]), normal_bound)
                << mesh << " face " << face << " " << at;
        }
    }
}

template <class F> void check_all(bool true_normals)
{
    std::size_t faces = 0;
    for (std::string const& name : golden_meshes()) {
        Json const j = Json::parse(test::read_text(test::golden("loop09/" + name + ".json")));
        ControlMesh const mesh = mesh_from(j);
        Topology const topology(mesh);
        for (auto const& expected : j["gregory"]) {
            if (mesh.face(expected["face"]).size() == 4)
                check_face<F, TessellatorDomain::Quad>(topology, expected, name, true_normals);
            else
                check_face<F, TessellatorDomain::Tri>(topology, expected, name, true_normals);
            if (testing::Test::HasFatalFailure()) return;
            ++faces;
        }
    }
    EXPECT_GT(faces, 150u);
}

TYPED_TEST(GregoryOn, ControlPointsPointsAndDerivativesAgreeWithGoldenData)
{
    check_all<TypeParam>(false);
}
TYPED_TEST(GregoryOn, TrueNormalsAgreeWithGoldenData)
{
    check_all<TypeParam>(true);
}

TEST(GregoryStencils, AgreeWithGoldenStencilsAndSumToOne)
{
    for (char const* name : {"house", "l_shape", "open_mixed"}) {
        Json const j =
            Json::parse(test::read_text(test::golden(std::string("loop09/") + name + ".json")));
        ControlMesh const mesh = mesh_from(j);
        Topology const topology(mesh);
        for (auto const& g : j["gregory_stencils"]) {
            std::uint32_t const face = g["face"];
            Neighbourhood n;
            find_neighbourhood(topology, face, n);
            PatchStencils const s = make_gregory_stencils(n, false, {});
            auto const inputs = g["inputs"].get<std::vector<std::uint32_t>>();
            EXPECT_EQ(inputs, topology.two_ring(face));
            for (int i = 0; i < n.sides; ++i)
                for (int kind = 0; kind < 5; ++kind) {
                    auto const& expected =
                        g["weights"][std::size_t((i + n.rotation) % n.sides * 5 + kind)];
                    auto const& row = s.rows[std::size_t(kind * n.sides + i)];
                    double sum = 0;
                    for (std::size_t k = 0; k < inputs.size(); ++k) {
                        auto const at = std::find(n.inputs.begin(), n.inputs.end(), inputs[k]) -
                                        n.inputs.begin();
                        EXPECT_NEAR(row[std::size_t(at)], double(expected[k]), 1e-12)
                            << name << " face " << face;
                        sum += row[std::size_t(at)];
                    }
                    EXPECT_NEAR(sum, 1, 1e-14);
                }
        }
    }
}

// Regular faces are the uniform bicubic B-spline: M P M^T (docs/math/loop09.md, 7).
TEST(GregoryStencils, RegularFaceIsTheBSpline)
{
    Json const j = Json::parse(test::read_text(test::golden("loop09/torus_regular.json")));
    ControlMesh const mesh = mesh_from(j);
    Topology const topology(mesh);
    ASSERT_TRUE(is_regular(topology, 0));
    Neighbourhood n;
    find_neighbourhood(topology, 0, n);
    PatchStencils const regular = make_gregory_stencils(n, true, {});
    ASSERT_EQ(regular.control_points, 16);
    // f is (4 v + 2 d + 2 d' + x) / 9
    auto const& f0 = regular.rows[12];
    std::vector<double> sorted = f0;
    std::sort(sorted.rbegin(), sorted.rend());
    EXPECT_NEAR(sorted[0], 4.0 / 9, 1e-15);
    EXPECT_NEAR(sorted[1], 2.0 / 9, 1e-15);
    EXPECT_NEAR(sorted[2], 2.0 / 9, 1e-15);
    EXPECT_NEAR(sorted[3], 1.0 / 9, 1e-15);
    for (std::size_t i = 4; i < sorted.size(); ++i) EXPECT_NEAR(sorted[i], 0, 1e-15);
    // The Gregory patch of the same face has f+ = f-.
    PatchStencils const gregory = make_gregory_stencils(n, false, {});
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < n.inputs.size(); ++k)
            EXPECT_NEAR(gregory.rows[12 + i][k], gregory.rows[16 + i][k], 1e-15);
}

} // namespace
} // namespace tessemu
