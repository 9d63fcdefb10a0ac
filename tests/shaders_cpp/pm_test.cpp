// Pm-patches against golden data, through the templates that draw; smoothness inside the patch;
// costs.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/tally.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/pm/constants.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/pm/pm_patch.h"
#include "shaders_cpp/pm/pm_vertex_shader.h"
#include "tests/support/files.h"
#include "tests/support/ring_vertices.h"
#include "tests/support/stencil_patch.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

using Json = nlohmann::json;

template <class F> using Vertices = test::RingVertices<F, PmVertexShader<F>>;

// The hull shader's sectors and registers of a face.
template <class F, int m> struct Patch {
    std::vector<F> sectors, registers;

    Patch(Topology const& topology, Vertices<F> const& vertices, std::uint32_t f)
    {
        constexpr auto kDomain = m == 4 ? TessellatorDomain::Quad : TessellatorDomain::Tri;
        test::FaceTables<F> const tables(topology, f);
        auto const hs = tables.template bind<PmHullShader<kDomain, F>>();
        std::vector<F> const input = vertices.of_face(topology.mesh(), f);
        ControlPoints<RingVertex<F>> const in(input.data(), m);
        for (int i = 0; i < m; ++i) {
            CornerVectors<5, F> const s = hs.template control_point<F>({0}, in, i);
            for_each_scalar(s, [&](F x) { sectors.push_back(x); });
        }
        for (int i = 0; i < hs.patch_constants(); ++i) {
            EdgeRegister<F> const r = hs.template patch_constant<F>({0}, in, sector_view(), i);
            for_each_scalar(r, [&](F x) { registers.push_back(x); });
        }
    }
    ControlPoints<CornerVectors<5, F>> sector_view() const { return {sectors.data(), m}; }
    ControlPoints<EdgeRegister<F>> register_view() const
    {
        return {registers.data(), PmRegisters<m>::kCount};
    }
};

template <class F, int m>
void check_face(Topology const& topology, Vertices<F> const& vertices, Json const& expected,
                std::string const& name)
{
    Patch<F, m> const patch(topology, vertices, expected["face"]);
    auto const sectors = patch.sector_view();
    auto const registers = patch.register_view();
    // double: 1e-12, as the golden data were compared. float, u = 2^-24, L the largest coordinate:
    // h and p are convex sums that err by at most 24 u L; A and B sum at most 15 g with weights
    // that sum to less than 2/lambda < 5, so t errs by 5 (24 + 32) u L + 24 u L < 310 u L. b211
    // adds t, h and at most 1/mu of their differences over S; S > 0.8 for valences up to 9, so it
    // errs by less than 6 times that; b112 and the centre are sums of those with weights below 2.
    double largest = 0;
    for (auto const& x : topology.mesh().positions)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double(x[k])));
    double const bound = sizeof(F) == 8 ? 1e-12 : 12 * 310 * std::ldexp(1, -24) * largest;
    for (int i = 0; i < m; ++i) {
        Json const& s = expected["sectors"][std::size_t(i)];
        int const next = (i + 1) % m;
        ASSERT_LE(test::error(sectors.vector(i, 0), s[0]), bound) << name << " p";
        ASSERT_LE(test::error(sectors.vector(i, 1), s[1]), bound) << name << " t+";
        ASSERT_LE(test::error(sectors.vector(next, 2), s[2]), bound) << name << " t-";
        ASSERT_LE(test::error(sectors.vector(i, 3), s[3]), bound) << name << " b211";
        ASSERT_LE(test::error(sectors.vector(i, 4), s[4]), bound) << name << " b121";
        ASSERT_LE(test::error(registers[PmRegisters<m>::kMiddle + i].vector, s[5]), bound)
            << name << " b112";
    }
    ASSERT_LE(test::error(registers[PmRegisters<m>::kCentre].vector, expected["centre"]), bound);
}

std::vector<std::string> closed_meshes()
{
    return {"cube",        "l_shape",    "trapezohedron6", "trapezohedron9", "tetrahedron",
            "icosahedron", "bipyramid8", "antiprism7",     "prism3",         "house"};
}

template <class F> class PmOn : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(PmOn, Scalars);

TYPED_TEST(PmOn, CoefficientsAgreeWithGoldenData)
{
    using F = TypeParam;
    std::size_t faces = 0;
    for (std::string const& name : closed_meshes()) {
        Json const j = Json::parse(test::read_text(test::golden("loop09/" + name + ".json")));
        ControlMesh const mesh = test::mesh_from(j);
        Topology const topology(mesh);
        Vertices<F> const vertices(topology, make_pm_constants());
        for (Json const& g : j["pm"]) {
            if (mesh.face(g["face"]).size() == 4)
                check_face<F, 4>(topology, vertices, g, name);
            else
                check_face<F, 3>(topology, vertices, g, name);
            if (testing::Test::HasFatalFailure()) return;
            ++faces;
        }
    }
    EXPECT_EQ(faces, 132u);
}

// Position and normal agree across the spokes and at the centre (C1 there), and on the patch's
// edges with the curve and the field that both neighbours evaluate.
template <int m> void check_smoothness(Topology const& topology, std::uint32_t f)
{
    Vertices<double> const vertices(topology, make_pm_constants());
    Patch<double, m> const patch(topology, vertices, f);
    auto const sectors = patch.sector_view();
    auto const registers = patch.register_view();
    auto const at = [&](int sector, double a, double b) {
        PmSectorPoint<m, double> p{a, b, 1 - a - b, {}};
        p.in[sector] = true;
        TangentFrame<double> const s = pm_patch<m, double>(sectors, registers, p);
        return std::pair(s.position, normalize(cross(s.du, s.dv)));
    };
    for (int i = 0; i < m; ++i) {
        int const next = (i + 1) % m;
        for (double t : {0.0, 0.25, 0.7}) { // along the spoke to corner i + 1
            auto const [p, n] = at(i, 0, t);
            auto const [q, o] = at(next, t, 0);
            EXPECT_LE(dot(p - q, p - q), 1e-26);
            EXPECT_NEAR(dot(n, o), 1, 1e-12) << "spoke " << i << " at " << t;
        }
        float3<double> W[4];
        for (int k = 0; k < 4; ++k) W[k] = registers[4 * i + k].vector;
        for (double t : {0.2, 0.5, 0.9}) {
            auto const [p, n] = at(i, 1 - t, t);
            auto const e = edge_point<double>(PmInside<m>::template edge<double>(sectors, i), W, t);
            EXPECT_LE(dot(p - e.position, p - e.position), 1e-26);
            EXPECT_NEAR(dot(n, normalize(e.normal)), 1, 1e-12) << "edge " << i << " at " << t;
        }
    }
}

TEST(Pm, SectorsJoinSmoothlyAndEdgesAreTheSharedOnes)
{
    for (std::string const& name : closed_meshes()) {
        Json const j = Json::parse(test::read_text(test::golden("loop09/" + name + ".json")));
        ControlMesh const mesh = test::mesh_from(j);
        Topology const topology(mesh);
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
            if (mesh.face(f).size() == 4)
                check_smoothness<4>(topology, f);
            else
                check_smoothness<3>(topology, f);
        }
    }
}

// The domain map: three coordinates that sum to 1, none negative, and the tessellator's point.
TEST(Pm, DomainMapIsABijection)
{
    double const corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i <= 16; ++i)
        for (int j = 0; j <= 16; ++j) {
            double const u = i / 16.0, v = j / 16.0;
            PmSectorPoint<4, double> const p = pm_sector_of_quad<double>(u, v);
            EXPECT_EQ(p.in[0] + p.in[1] + p.in[2] + p.in[3], 1);
            EXPECT_TRUE(p.a >= 0 && p.b >= 0 && p.c >= 0) << u << " " << v;
            EXPECT_EQ(p.a + p.b + p.c, 1);
            for (std::size_t s = 0; s < 4; ++s) {
                if (!p.in[s]) continue;
                double const *c0 = corner[s], *c1 = corner[(s + 1) % 4];
                EXPECT_EQ(p.a * c0[0] + p.b * c1[0] + p.c * 0.5, u);
                EXPECT_EQ(p.a * c0[1] + p.b * c1[1] + p.c * 0.5, v);
            }
            if (u + v > 1) continue;
            double const b[3] = {u, v, 1 - u - v};
            PmSectorPoint<3, double> const q = pm_sector_of_triangle<double>(b[0], b[1], b[2]);
            EXPECT_EQ(q.in[0] + q.in[1] + q.in[2], 1);
            EXPECT_TRUE(q.a >= 0 && q.b >= 0 && q.c >= 0);
            for (std::size_t s = 0; s < 3; ++s) {
                if (!q.in[s]) continue;
                EXPECT_NEAR(q.a + q.c / 3, b[s], 1e-15);
                EXPECT_NEAR(q.b + q.c / 3, b[(s + 1) % 3], 1e-15);
            }
        }
}

// docs/math/loop09.md, 8: 232 with the map and the cross product; 25 and 19 coefficients.
template <int m> constexpr std::array<std::uint64_t, 2> cost()
{
    std::uint64_t reads = 0;
    FlopCount const flops = tally([&](FlopCount* sink) {
        ControlPoints<CornerVectors<5, Tally>> const sectors(sink, m, &reads);
        ControlPoints<EdgeRegister<Tally>> const registers(sink, PmRegisters<m>::kCount, &reads);
        DomainInput<Tally> const in{Tally(0.25, sink), Tally(0.5, sink), Tally(0.25, sink), 0};
        TangentFrame<Tally> const s = PmInside<m>::template evaluate<Tally>(sectors, registers, in);
        (void)cross(s.du, s.dv);
    });
    return {flops_loop10(flops), reads};
}

TEST(Pm, CostsAreThoseOfThePage)
{
    EXPECT_EQ(cost<4>(), (std::array<std::uint64_t, 2>{232, 25}));
    EXPECT_EQ(cost<3>(), (std::array<std::uint64_t, 2>{232, 19}));
}

// 21n + 18 a vertex, 3 more for each triangle: 4 vertices of 3 triangles, 8 of 3 quads.
TEST(Pm, VertexShaderCostsWhatItsDocumentationSays)
{
    for (auto const& [name, mul] :
         {std::pair{"tetrahedron", 4 * (21 * 3 + 18 + 9)}, {"cube", 8 * (21 * 3 + 18)}}) {
        Json const j =
            Json::parse(test::read_text(test::golden(std::string("loop09/") + name + ".json")));
        ControlMesh const mesh = test::mesh_from(j);
        SchemeOnMesh const on = build_scheme(find_scheme("pm"), mesh);
        FrameSettings settings;
        settings.vertex_cache.kind = VertexCacheModel::Kind::Infinite;
        DrawStatistics const s = visit_surface(*on.patches, settings, ThreadPool(1), {}).total;
        for (StageStatistics const& stage : s.stages)
            if (stage.stage == "vertex_shader") {
                EXPECT_EQ(flops_loop10(stage.flops), std::uint64_t(mul)) << name;
            }
    }
}

TEST(Pm, RefusesABoundary)
{
    ControlMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    EXPECT_THROW(build_scheme(find_scheme("pm"), mesh), MeshError);
}

} // namespace
} // namespace tessemu
