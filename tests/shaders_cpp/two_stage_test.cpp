// The two-stage form: control points against golden data, through the templates that draw; its
// costs; what its limits are.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame.h"
#include "pipeline/schemes/gregory/ring_constants.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/gregory/corner_hull_shader.h"
#include "shaders_cpp/gregory/ring_vertex_shader.h"
#include "tests/support/files.h"
#include "tests/support/random_mesh.h"
#include "tests/support/ring_vertices.h"
#include "tests/support/stencil_patch.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

using Json = nlohmann::json;

template <class F> using Vertices = test::RingVertices<F, RingVertexShader<F>>;

template <class F, TessellatorDomain kDomain>
void check_face(Topology const& topology, Vertices<F> const& vertices, Json const& expected,
                std::string const& mesh_name)
{
    constexpr int N = kDomain == TessellatorDomain::Quad ? 4 : 3;
    std::uint32_t const f = expected["face"];
    ControlMesh const& mesh = topology.mesh();
    std::vector<F> const input = vertices.of_face(mesh, f);
    test::FaceTables<F> const tables(topology, f);
    auto const hs = tables.template bind<CornerHullShader<kDomain, 5, F>>();
    ControlPoints<RingVertex<F>> const in(input.data(), N);
    // Bounds. double: 1e-12, as the golden data were compared. float, u = 2^-24, L the largest
    // coordinate: m_j and c_j err by 5 u L. The weights of A and B sum to at most 2 + 4 sigma < 4
    // in absolute value, and 15 terms add 30 roundings: 4 (5 + 30) u L; e adds 2/3 lambda (|A| +
    // |B|) < 0.9 of that twice and p's 40 u L; r is 2 differences of m and c: 20 u L. A face point
    // weighs p, two e and r by at most 1, 6/3, 2/3, 1/3.
    double largest = 0;
    for (auto const& x : mesh.positions)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double(x[k])));
    double const unit = std::ldexp(1, -24) * largest, e_bound = (40 + 2 * 0.9 * 140) * unit;
    double const bound = sizeof(F) == 8 ? 1e-12 : e_bound * (1 + 2 + 2.0 / 3) + 20 * unit;
    char const* const kinds[] = {"p", "e_plus", "e_minus", "f_plus", "f_minus"};
    for (int i = 0; i < N; ++i) {
        CornerVectors<5, F> const s = hs.template control_point<F>({0}, in, i);
        for (std::size_t k = 0; k < 5; ++k)
            ASSERT_LE(test::error(s.vectors[k], expected[kinds[k]][std::size_t(i)]), bound)
                << mesh_name << " face " << f << " " << kinds[k] << i;
    }
}

template <class F> class TwoStageOn : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(TwoStageOn, Scalars);

TYPED_TEST(TwoStageOn, ControlPointsAgreeWithGoldenData)
{
    using F = TypeParam;
    std::size_t faces = 0;
    for (char const* name : {"torus_regular", "cube", "l_shape", "trapezohedron6", "trapezohedron9",
                             "tetrahedron", "icosahedron", "bipyramid8", "antiprism7", "prism3",
                             "house", "open_grid", "open_mixed", "open_fan5"}) {
        Json const j =
            Json::parse(test::read_text(test::golden(std::string("loop09/") + name + ".json")));
        ControlMesh const mesh = test::mesh_from(j);
        Topology const topology(mesh);
        Vertices<F> const vertices(topology, make_ring_constants(1));
        for (Json const& g : j["gregory"]) {
            if (mesh.face(g["face"]).size() == 4)
                check_face<F, TessellatorDomain::Quad>(topology, vertices, g, name);
            else
                check_face<F, TessellatorDomain::Tri>(topology, vertices, g, name);
            if (testing::Test::HasFatalFailure()) return;
            ++faces;
        }
    }
    EXPECT_GT(faces, 150u);
}

// n triangles around a vertex, closed below by another.
ControlMesh bipyramid(int n)
{
    ControlMesh m;
    m.positions = {{0, 0, 1}, {0, 0, -1}};
    for (int i = 0; i < n; ++i) {
        float const t = 4 * float(i) / float(n); // around a square: no cosine needed
        int const side = int(t);
        float const x = t - float(side);
        float const at[4][2] = {{1 - 2 * x, 1}, {-1, 1 - 2 * x}, {2 * x - 1, -1}, {1, 2 * x - 1}};
        m.positions.emplace_back(at[side][0], at[side][1], 0);
    }
    for (int i = 0; i < n; ++i) {
        auto const a = std::uint32_t(2 + i), b = std::uint32_t(2 + (i + 1) % n);
        m.add_face(std::vector<std::uint32_t>{0, a, b});
        m.add_face(std::vector<std::uint32_t>{1, b, a});
    }
    return m;
}

StageStatistics const& stage(DrawStatistics const& s, std::string const& name)
{
    for (StageStatistics const& x : s.stages)
        if (x.stage == name) return x;
    throw std::runtime_error("no stage " + name);
}

TEST(TwoStage, DrawsValencesUpTo15AsThePaperDoesWhereStencilsNeedAnotherWay)
{
    // After a Catmull-Clark step quads of valences 15, 4, 3, 4 have 36 inputs.
    BuildOptions const fine{.subdivide = 1};
    SchemeOnMesh const on = build_scheme(find_scheme("gregory-two-stage"), bipyramid(15), fine);
    EXPECT_EQ(on.patches->patch_counts()[0].patches, 90u);
    EXPECT_FALSE(on.patches->another_way());
    SchemeOnMesh const stencils = build_scheme(find_scheme("gregory-stencil"), bipyramid(15), fine);
    ASSERT_TRUE(stencils.patches->another_way());
    EXPECT_NE(stencils.patches->another_way()->what.find("up to 36"), std::string::npos);
    EXPECT_TRUE(
        build_scheme(find_scheme("gregory-two-stage"), bipyramid(16)).patches->another_way());
}

// docs/math/loop09.md, 8: 30n + 6 a vertex with A and B, and 6 for the normal's cross product; 72 a
// triangle patch and 3 for each of the two field vectors across an edge. All vertices of a
// bipyramid are interior, two of valence n and n of valence 4.
TEST(TwoStage, CostsAreThoseOfThePage)
{
    for (int n : {5, 9, 15}) {
        SchemeOnMesh const on = build_scheme(find_scheme("gregory-two-stage"), bipyramid(n));
        FrameSettings settings;
        settings.vertex_cache = {VertexCacheModel::Kind::Infinite, 0};
        DrawStatistics const s = visit_surface(*on.patches, settings, ThreadPool(1), {}).total;
        auto const N = std::uint64_t(n);
        StageStatistics const& vs = stage(s, "vertex_shader");
        EXPECT_EQ(vs.invocations, N + 2); // each vertex once
        EXPECT_EQ(flops_loop10(vs.flops), 2 * (30 * N + 12) + N * (30 * 4 + 12));
        EXPECT_EQ(flops_loop10(stage(s, "hull_shader").flops), 2 * N * (72 + 3 * 2 * 3));
        for (FetchStatistics const& f : vs.fetches) {
            if (f.resource == "ring_entries") {
                EXPECT_EQ(f.count, 2 * (2 * N + N * 4));
            } else if (f.resource == "ring_positions") {
                EXPECT_EQ(f.count, 2 * N + N * 4); // no quads
            }
        }
    }
}

TEST(TwoStage, TheVertexCacheDecidesHowOftenTheVertexShaderRuns)
{
    SchemeOnMesh const on = build_scheme(find_scheme("gregory-two-stage"), bipyramid(15));
    auto const runs = [&](VertexCacheModel cache) {
        FrameSettings settings;
        settings.vertex_cache = cache;
        return visit_surface(*on.patches, settings, ThreadPool(1), {}).total.pipeline.VSInvocations;
    };
    EXPECT_EQ(runs({VertexCacheModel::Kind::Infinite, 0}), 17u);
    EXPECT_EQ(runs({VertexCacheModel::Kind::None, 0}), 90u);
    std::uint64_t const fifo = runs({VertexCacheModel::Kind::Fifo, 4});
    EXPECT_GT(fifo, 17u);
    EXPECT_LT(fifo, 90u);
}

} // namespace
} // namespace tessemu
