// The substitutes that HOLL10 compares with, against golden data: PN, Phong and flat triangles
// (docs/math/subdivision.md, 6.5), what they cost, and where they crack.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/tally.h"
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/loop.h"
#include "pipeline/schemes/qas/limit_rows.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/flat/flat_triangle.h"
#include "shaders_cpp/phong/phong_triangle.h"
#include "shaders_cpp/pn_triangles/pn_triangle.h"
#include "shaders_cpp/qas/qas_triangle.h"
#include "tests/support/files.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tessemu {
namespace {

using Json = nlohmann::json;

struct Cost {
    FlopCount flops;
    std::uint64_t fetches = 0;
};
template <class Shader> constexpr Cost cost(int constants)
{
    Cost c;
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<NormalVertex<Tally>> const patch(sink, 3, &c.fetches);
        ControlPoints<ControlVertex<Tally>> const registers(sink, constants, &c.fetches);
        DomainInput<Tally> const in{Tally(0.25, sink), Tally(0.5, sink), Tally(0.25, sink), 0};
        (void)Shader{}(in, patch, registers);
    });
    return c;
}

// PN, mul: 3 squares, 3 cubes, 3 products, 9 for the weights of the b_ij, 2 for that of b111, 3
// for each of 10 positions and 6 normals, 6 for the normal's length. Add: 27, 15 and 2.
static_assert(cost<PnTriangle>(10).flops ==
              FlopCount{.add = 44, .mul = 74, .div = 1, .sqrt = 1, .compare = 1});
static_assert(cost<PnTriangle>(10).fetches == 13);
static_assert(cost<FlatTriangle>(0).flops ==
              FlopCount{.add = 14, .mul = 24, .div = 1, .sqrt = 1, .compare = 1});
static_assert(cost<FlatTriangle>(0).fetches == 3);

// A triangle through a hull shader's fork phase and a domain shader, in F.
template <class F> struct Triangle {
    F vertices[3][6]; // position, normal
    F registers[PnRegisters::kCount][3];

    explicit Triangle(F const (&v)[3][6])
    {
        std::copy_n(&v[0][0], 18, &vertices[0][0]);
        for (int i = 0; i < PnRegisters::kCount; ++i) {
            ControlVertex<F> const b =
                PnHullShader{}.patch_constant<F>({0}, corners(), corners(), i);
            F const xyz[] = {b.position.x, b.position.y, b.position.z};
            std::copy_n(xyz, 3, registers[i]);
        }
    }
    explicit Triangle(Json const& t)
        : Triangle([&] {
              struct {
                  F floats[3][6];
              } v;
              for (std::size_t i = 0; i < 3; ++i)
                  for (std::size_t k = 0; k < 3; ++k) {
                      v.floats[i][k] = t["P"][i][k];
                      v.floats[i][3 + k] = t["N"][i][k];
                  }
              return v;
          }()
                       .floats)
    {
    }
    ControlPoints<NormalVertex<F>> corners() const { return {&vertices[0][0], 3}; }
    template <class Shader> SurfacePoint<F> at(Shader const& shader, F u, F v, F w) const
    {
        ControlPoints<ControlVertex<F>> const constants(&registers[0][0], PnRegisters::kCount);
        return shader(DomainInput<F>{u, v, w, 0}, corners(), constants);
    }
};

void expect_near(float3<double> const& is, Json const& expected, std::string const& what)
{
    double const xyz[] = {is.x, is.y, is.z};
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(xyz[k], double(expected.at(k)), 1e-12) << what << ", " << k;
}

Json golden_triangles()
{
    return Json::parse(test::read_text(test::golden("subdivision/substitutes.json")))["triangles"];
}

template <class Shader> void expect_samples(Shader const& shader, char const* samples)
{
    std::size_t count = 0;
    for (Json const& t : golden_triangles()) {
        Triangle<double> const triangle(t);
        for (Json const& s : t[samples]) {
            double const u = s[0], v = s[1]; // the second and the third corner's
            SurfacePoint<double> const p = triangle.at(shader, 1 - u - v, u, v);
            expect_near(p.position, s[2], "position " + s.dump());
            expect_near(p.normal, s[3], "normal " + s.dump());
            ++count;
        }
    }
    EXPECT_EQ(count, 28u);
}

TEST(PnTriangles, ControlPointsAreTheGoldenOnes)
{
    // By our registers: edge k runs from corner k.
    constexpr char const* kNames[] = {"210", "021", "102", "120", "012", "201"};
    constexpr char const* kNormals[] = {"110", "011", "101"};
    for (Json const& t : golden_triangles()) {
        Triangle<double> const triangle(t);
        auto const at = [&](int i) {
            double const* const b = triangle.registers[i];
            return float3<double>(b[0], b[1], b[2]);
        };
        for (int i = 0; i < 6; ++i)
            expect_near(at(PnRegisters::kNear + i), t["pn"][kNames[i]], kNames[i]);
        for (int i = 0; i < 3; ++i)
            expect_near(at(PnRegisters::kNormal + i), t["pn_normal"][kNormals[i]], kNormals[i]);
        expect_near(at(PnRegisters::kCentre), t["pn"]["111"], "111");
    }
}

TEST(PnTriangles, PointsAndNormalsAreTheGoldenOnes)
{
    expect_samples(PnTriangle{}, "pn_samples");
}

TEST(Phong, PointsAndNormalsAreTheGoldenOnes)
{
    expect_samples(PhongTriangle{0.75f}, "phong_samples");
}

// Whole numbers up to 64 and weights in 1/65536 are exact in float; a normal is the vertices', each
// product of it rounded once, as Phong's is.
TEST(Flat, IsTheTriangleWithPhongsNormals)
{
    std::mt19937 random(20261127);
    std::uniform_int_distribution<int> number(-64, 64), weight(0, 65536);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int n = 0; n < 1000; ++n) {
        float vertices[3][6];
        for (auto& corner : vertices)
            for (int k = 0; k < 6; ++k) corner[k] = k < 3 ? float(number(random)) : unit(random);
        Triangle<float> const t(vertices);
        int u = weight(random), v = weight(random);
        if (u + v > 65536) u = 65536 - u, v = 65536 - v;
        float const weights[] = {float(u) / 65536, float(v) / 65536, float(65536 - u - v) / 65536};
        SurfacePoint<float> const p = t.at(FlatTriangle{}, weights[0], weights[1], weights[2]),
                                  q = t.at(PhongTriangle{0.75f}, weights[0], weights[1],
                                           weights[2]);
        float const at[] = {p.position.x, p.position.y, p.position.z};
        for (int k = 0; k < 3; ++k) {
            float sum = 0;
            for (int i = 0; i < 3; ++i) sum += weights[i] * vertices[i][k];
            ASSERT_EQ(at[k], sum);
        }
        ASSERT_EQ(p.normal.x, q.normal.x);
        ASSERT_EQ(p.normal.y, q.normal.y);
        ASSERT_EQ(p.normal.z, q.normal.z);
    }
}

// Normals of one plane: all control points lie on it, where the flat triangle has them.
TEST(PnTriangles, OfOnePlaneIsTheFlatTriangle)
{
    double const vertices[3][6] = {{0, 0, 2, 0, 0, 1}, {3, 1, 2, 0, 0, 1}, {-1, 4, 2, 0, 0, 1}};
    Triangle<double> const t(vertices);
    for (int i = 0; i <= 8; ++i)
        for (int k = 0; i + k <= 8; ++k) {
            double const u = i / 8.0, v = k / 8.0, w = 1 - u - v;
            SurfacePoint<double> const p = t.at(PnTriangle{}, u, v, w),
                                       q = t.at(FlatTriangle{}, u, v, w);
            EXPECT_NEAR(p.position.x, q.position.x, 1e-14);
            EXPECT_NEAR(p.position.y, q.position.y, 1e-14);
            EXPECT_NEAR(p.position.z, 2, 1e-14);
            EXPECT_NEAR(p.normal.z, 1, 1e-14);
        }
}

TEST(PnTriangles, AnEdgeWithoutLengthHasTheMeanNormal)
{
    float const vertices[3][6] = {{1, 2, 3, 0, 0, 1}, {1, 2, 3, 0, 0, 1}, {4, 2, 3, 0, 1, 0}};
    Triangle<float> const t(vertices);
    float const* const n = t.registers[PnRegisters::kNormal];
    EXPECT_EQ(n[0], 0);
    EXPECT_EQ(n[1], 0);
    EXPECT_EQ(n[2], 1);
    SurfacePoint<float> const p = t.at(PnTriangle{}, 0.5f, 0.5f, 0.0f);
    EXPECT_EQ(p.position.x, 1);
    EXPECT_EQ(p.normal.z, 1);
}

TEST(Substitutes, TheDrawnSurfaceGoesThroughTheVerticesUnderEveryContraction)
{
    for (char const* scheme : {"pn-triangles", "flat"}) {
        SchemeOnMesh const on = build_scheme(find_scheme(scheme), load_model("spindle").mesh);
        ControlMesh const& mesh = on.mesh->mesh();
        for (Machine const& machine : test::machines()) {
            FrameSettings s;
            s.tess_factor = 3;
            s.machine = machine;
            std::size_t corners = 0;
            visit_surface(*on.patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
                TessellatedPatch const& t = p.domain().patch;
                for (std::size_t i = 0; i < t.points(); ++i) {
                    MeshPoint const name = mesh_point(mesh, p.place(), t.u[i], t.v[i]);
                    if (name.kind != MeshPoint::Kind::Vertex) continue;
                    EXPECT_EQ(p.vertex(i).position, mesh.positions[name.a]) << scheme;
                    ++corners;
                }
            });
            EXPECT_EQ(corners, 3 * mesh.faces());
        }
    }
}

struct Counted {
    std::uint64_t patches = 0, points = 0, hull_mul = 0, domain_mul = 0, points_fetched = 0,
                  constants_fetched = 0;
};
Counted counted(std::string const& scheme, std::string const& normals, Machine const& machine)
{
    SchemeOnMesh const on = build_scheme(find_scheme(scheme), load_model("spindle").mesh,
                                         {.set = {{"normals", normals}}});
    FrameSettings s;
    s.tess_factor = 5.3f;
    s.machine = machine;
    DrawStatistics const d = visit_surface(*on.patches, s, ThreadPool(2), {}).total;
    Counted out{.patches = d.pipeline.HSInvocations, .points = d.pipeline.DSInvocations};
    for (StageStatistics const& stage : d.stages) {
        if (stage.stage == "hull_shader") out.hull_mul = stage.flops.mul;
        if (stage.stage != "domain_shader") continue;
        out.domain_mul = stage.flops.mul;
        for (FetchStatistics const& f : stage.fetches) {
            if (f.resource == "control_points") out.points_fetched = f.count;
            if (f.resource == "patch_constants") out.constants_fetched = f.count;
        }
    }
    return out;
}

// A hull shader multiplies 12 times for each b_ij, 16 for each n_ij, 33 for b111; and 12 for the
// normal of a face at each of three corners, 6 for a cross product and 6 for a length.
TEST(Substitutes, RunTimeCountsAreThoseOfThePage)
{
    for (Machine const& machine : test::machines()) {
        Counted const pn = counted("pn-triangles", "vertices", machine);
        EXPECT_GT(pn.points, 0u);
        EXPECT_EQ(pn.hull_mul, (6 * 12 + 3 * 16 + 33) * pn.patches);
        EXPECT_EQ(pn.domain_mul, (74 + 12) * pn.points) << "12 of them the camera's";
        EXPECT_EQ(pn.points_fetched, 3 * pn.points);
        EXPECT_EQ(pn.constants_fetched, 10 * pn.points);
        Counted const flat = counted("flat", "vertices", machine);
        EXPECT_EQ(flat.hull_mul, 0u);
        EXPECT_EQ(flat.domain_mul, (24 + 12) * flat.points);
        EXPECT_EQ(flat.points_fetched, 3 * flat.points);
        EXPECT_EQ(flat.constants_fetched, 0u);
        EXPECT_EQ(counted("flat", "faces", machine).hull_mul, 3 * 12 * flat.patches);
    }
}

// Limit points of a cage in double, through the hull shader's formula and the domain shader.
TEST(Qas, ControlPointsAndPointsAreTheGoldenOnes)
{
    Json const golden =
        Json::parse(test::read_text(test::golden("subdivision/substitutes.json")))["qas"];
    ControlMesh mesh;
    std::vector<glm::dvec3> x;
    for (Json const& v : golden["verts"]) x.emplace_back(v[0], v[1], v[2]);
    mesh.positions.assign(x.begin(), x.end());
    for (Json const& f : golden["faces"]) mesh.add_face(f.get<std::vector<std::uint32_t>>());
    Topology const topology(mesh);
    GradientRows const rows = loop_limit_rows(topology);
    PointNumbers const number(topology, true);
    std::size_t samples = 0;
    for (Json const& patch : golden["patches"]) {
        auto const face = patch["face"].get<std::vector<std::uint32_t>>();
        double points[6][6], control[6][6];
        for (std::size_t i = 0; i < 6; ++i) {
            std::uint32_t const point =
                i < 3 ? number.vertex(face[i])
                      : number.edge(topology.find_edge(face[i - 3], face[(i - 2) % 3]));
            glm::dvec3 sums[3] = {};
            for (std::uint32_t t = rows.first[point]; t < rows.first[point + 1]; ++t)
                for (std::size_t k = 0; k < 3; ++k)
                    sums[k] += rows.weights[3 * t + k] * x[rows.vertices[t]];
            glm::dvec3 const n = glm::normalize(glm::cross(sums[1], sums[2]));
            for (int k = 0; k < 3; ++k) points[i][k] = sums[0][k], points[i][3 + k] = n[k];
        }
        ControlPoints<NormalVertex<double>> const limits(&points[0][0], 6);
        for (int i = 0; i < 6; ++i) {
            NormalVertex<double> const c = QasHullShader{}.control_point<double>({0}, limits, i);
            constexpr char const* kNames[] = {"200", "020", "002", "110", "011", "101"};
            expect_near(c.position, patch["geometry"][kNames[i]], kNames[i]);
            expect_near(c.normal, patch["normal"][kNames[i]], kNames[i]);
            double const xyz[] = {c.position.x, c.position.y, c.position.z,
                                  c.normal.x,   c.normal.y,   c.normal.z};
            std::copy_n(xyz, 6, control[i]);
        }
        ControlPoints<NormalVertex<double>> const b(&control[0][0], 6);
        for (Json const& s : patch["samples"]) {
            double const u = s[0], v = s[1]; // the second and the third corner's
            SurfacePoint<double> const p =
                QasTriangle{}(DomainInput<double>{1 - u - v, u, v, 0}, b,
                              ControlPoints<ControlVertex<double>>(nullptr, 0));
            expect_near(p.position, s[2], "position " + s.dump());
            expect_near(p.normal, s[3], "normal " + s.dump());
            ++samples;
        }
    }
    EXPECT_GT(samples, 8u);
}

} // namespace
} // namespace tessemu
