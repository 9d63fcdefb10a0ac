// Loop and Butterfly subdivision against golden data: steps, limits, and the kernels' tables.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/loop.h"

#include "pipeline/mesh/butterfly.h"

#include "pipeline/mesh/triangulate.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"
#include "tests/support/point_sets.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <glm/geometric.hpp>

namespace tessemu {
namespace {

using Vec = glm::dvec3;

struct Golden {
    std::string name;
    ControlMesh mesh;
    std::vector<Vec> x;
    nlohmann::json json;
};

Vec vec(nlohmann::json const& j)
{
    return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

std::vector<Golden> golden_meshes()
{
    std::vector<Golden> out;
    auto const all =
        nlohmann::json::parse(test::read_gzip(test::golden("subdivision/loop_butterfly.json.gz")));
    for (auto const& [name, m] : all["meshes"].items()) {
        Golden& g = out.emplace_back();
        g.name = name;
        g.json = m;
        for (auto const& v : m["verts"]) g.x.push_back(vec(v));
        g.mesh.positions.assign(g.x.begin(), g.x.end());
        for (auto const& f : m["faces"]) g.mesh.add_face(f.get<std::vector<std::uint32_t>>());
        for (auto const& c : m["creases"]) g.mesh.creases.push_back({c[0], c[1], kInfinitelySharp});
        g.mesh.rules.boundary = BoundaryRule::EdgeOnly;
    }
    return out;
}

// "loop" or "butterfly"
template <class Masks> void expect_golden_steps(std::string const& scheme)
{
    std::size_t compared = 0;
    for (Golden const& g : golden_meshes()) {
        SCOPED_TRACE(g.name);
        if (!g.json.contains(scheme + "1")) continue;
        Topology const topology(g.mesh);
        Sharpness const sharpness(topology);
        auto const next = refined_points<Masks, Vec>(topology, sharpness, g.x);
        auto const& wanted = g.json[scheme + "1"];
        PointNumbers const number(topology, true);
        ASSERT_EQ(next.size(), wanted.size());
        for (std::uint32_t v = 0; v < g.x.size(); ++v, ++compared)
            EXPECT_LT(distance(next[number.vertex(v)], vec(wanted[v])), 1e-12) << "vertex " << v;
        for (std::size_t e = 0; e < g.json["edges"].size(); ++e, ++compared) {
            auto const& edge = g.json["edges"][e];
            HalfEdge const h = topology.find_edge(edge[0], edge[1]);
            EXPECT_LT(distance(next[number.edge(h)], vec(wanted[g.x.size() + e])), 1e-12)
                << "edge " << e;
        }
        if (!g.json.contains(scheme + "2")) continue;
        ControlMesh const fine = split_mesh(topology, sharpness, next, true);
        Topology const second(fine);
        auto const last = refined_points<Masks, Vec>(second, Sharpness(second), next);
        EXPECT_LT(test::worst_distance(last, g.json[scheme + "2"]), 1e-12);
        compared += last.size();
    }
    EXPECT_GT(compared, 1000u);
}

TEST(Loop, StepsAreTheGoldenOnes)
{
    expect_golden_steps<Loop>("loop");
}

TEST(Butterfly, StepsAreTheGoldenOnes)
{
    expect_golden_steps<Butterfly>("butterfly");
}

TEST(Loop, LimitsAreTheGoldenOnes)
{
    std::size_t compared = 0;
    for (Golden const& g : golden_meshes()) {
        SCOPED_TRACE(g.name);
        Topology const t(g.mesh);
        Sharpness const sharpness(t);
        Limits<Loop> limits;
        RingSharpness sharp;
        for (std::uint32_t v = 0; v < g.x.size(); ++v) {
            auto const& wanted = g.json["loop_limit0"][v];
            auto const ring = t.ring(v);
            Ring<Vec> around{g.x[v], {}, {}};
            for (HalfEdge h : ring) around.edge.push_back(g.x[t.vertex_of(t.next(h))]);
            if (t.is_boundary(v)) around.edge.push_back(g.x[t.vertex_of(t.previous(ring.back()))]);
            sharpness.around(v, sharp);
            auto const limit = limits.of(around, sharp);
            if (limit.rule == VertexRule::Dart) {
                // The golden value is a smooth vertex's mask, which is not an eigenvector here:
                // the limit is what steps come to.
                Ring<Vec> far = around;
                for (int step = 0; step < 60; ++step) far = split_ring<Loop>(far, sharp);
                EXPECT_LT(distance(limit.position, far.vertex), 1e-12) << "vertex " << v;
                EXPECT_GT(distance(limit.position, vec(wanted[0])), 1e-3) << "vertex " << v;
                continue;
            }
            EXPECT_LT(distance(limit.position, vec(wanted[0])), 1e-12) << "vertex " << v;
            ++compared;
            if (wanted[1].is_null() || limit.sides.size() != 1) continue;
            auto const& [a, b] = limit.sides[0].tangents;
            EXPECT_LT(distance(normalize(cross(a, b)), vec(wanted[1])), 1e-10) << "vertex " << v;
        }
    }
    EXPECT_GT(compared, 100u);
}

// An eigenvector of the boundary's refinement, whose value falls by l with each step.
TEST(Loop, TangentAcrossABoundaryIsAnEigenvector)
{
    for (int k = 2; k <= 17; ++k) {
        RingSharpness sharp;
        sharp.open = true;
        sharp.edge.assign(std::size_t(k) + 1, 0);
        sharp.edge.front() = sharp.edge.back() = kInfinitelySharp;
        for (int unit = 0; unit <= k + 1; ++unit) {
            Ring<double> ring{unit == 0 ? 1.0 : 0.0, std::vector<double>(std::size_t(k) + 1), {}};
            if (unit > 0) ring.edge[std::size_t(unit) - 1] = 1;
            auto const across = [&](Ring<double> const& r) {
                auto const edge = [&](std::size_t j) -> double const& { return r.edge[j]; };
                return Loop::crease_across(k, r.vertex, edge, edge);
            };
            double const l = 0.375 + cos_pi(1, k) / 4;
            EXPECT_NEAR(across(split_ring<Loop>(ring, sharp)), l * across(ring), 1e-14)
                << k << " faces, unit " << unit;
        }
    }
}

TEST(Loop, KernelsTablesHoldTheSameWeights)
{
    for (Golden const& g : golden_meshes()) {
        SCOPED_TRACE(g.name);
        Topology const topology(g.mesh);
        RefinedStep const step = loop_step(topology, 7);
        auto const& rows = step.tables.blended;
        ASSERT_EQ(rows.target.size(), step.mesh.positions.size());
        EXPECT_EQ(step.tables.first_face_point(), 7 + g.x.size());
        for (std::size_t r = 0; r < rows.target.size(); ++r) {
            Vec sum(0);
            for (std::uint32_t t = rows.first[r]; t < rows.first[r + 1]; ++t)
                sum += double(rows.weights[t]) * g.x[rows.points[t] - 7];
            std::uint32_t const v = rows.target[r] - step.tables.first_face_point();
            EXPECT_LT(distance(sum, Vec(step.mesh.positions[v])), 1e-6);
        }
    }
}

// Texture coordinates are split linearly, so they say where a face of a face of a triangle lies.
TEST(TriangleSplits, PlacesAreWhereLinearCoordinatesAre)
{
    ControlMesh mesh; // two triangles, with an edge walked both ways
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (std::vector<std::uint32_t> const& f :
         {std::vector<std::uint32_t>{2, 0, 1}, std::vector<std::uint32_t>{0, 2, 3}})
        mesh.add_face(f);
    mesh.coordinates = {{3, 1}, {11, 2}, {5, 17}, {-4, 7}};
    mesh.face_coordinates = mesh.face_vertices;
    for (int steps = 1; steps <= 4; ++steps) {
        RefinedMesh const m(mesh, steps, loop_step);
        ControlMesh const& fine = m.mesh();
        ASSERT_EQ(fine.faces(), std::size_t(2) << 2 * steps);
        for (std::uint32_t f = 0; f < fine.faces(); ++f)
            for (int rotation = 0; rotation < 3; ++rotation) {
                PatchPlace const place = m.place(f, rotation);
                auto const base = mesh.face(place.face);
                constexpr std::uint32_t kCorner[3][2] = {{65536, 0}, {0, 65536}, {0, 0}};
                for (std::size_t k = 0; k < 3; ++k) {
                    UnitPoint const at = domain_to_unit(place, float(kCorner[k][0]) / 65536,
                                                        float(kCorner[k][1]) / 65536);
                    double const w[3] = {at.u, at.v, 1.0 - at.u - at.v};
                    glm::dvec2 linear(0);
                    for (std::size_t i = 0; i < 3; ++i) linear += w[i] * mesh.coordinates[base[i]];
                    std::size_t const corner = 3 * f + (k + std::size_t(rotation)) % 3;
                    EXPECT_LT(distance(linear, fine.coordinates[fine.face_coordinates[corner]]),
                              1e-12);
                }
            }
    }
}

TEST(TriangleSplits, NeighboursNamePointsAndEdgesAlike)
{
    ControlMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (std::vector<std::uint32_t> const& f :
         {std::vector<std::uint32_t>{2, 0, 1}, std::vector<std::uint32_t>{0, 2, 3}})
        mesh.add_face(f);
    RefinedMesh const m(mesh, 3, loop_step);
    Topology const& t = m.topology();
    std::size_t shared = 0;
    for (HalfEdge h = 0; h < m.mesh().face_vertices.size(); ++h) {
        HalfEdge const twin = t.twin(h);
        if (twin == Topology::kNone) continue;
        ++shared;
        auto const place = [&](HalfEdge edge) {
            return m.place(t.face_of(edge), int(edge % 3)); // its corner 0 is the edge's
        };
        MeshInterval const a = mesh_interval(mesh, place(h), 0),
                           b = mesh_interval(mesh, place(twin), 0);
        EXPECT_EQ(a.line, b.line);
        EXPECT_EQ(a.from, b.to);
        EXPECT_EQ(a.to, b.from);
        for (std::uint32_t s : {0u, 512u, 21845u, 65536u})
            EXPECT_EQ(mesh_point(mesh, place(h), 65536 - s, s),
                      mesh_point(mesh, place(twin), s, 65536 - s));
    }
    EXPECT_GT(shared, 100u);
}

TEST(Triangulate, CutsFromTheFirstVertexAndKeepsNumbersHolesAndCoordinates)
{
    ControlMesh m;
    m.positions.resize(6);
    for (std::vector<std::uint32_t> const& f :
         {std::vector<std::uint32_t>{0, 1, 2}, std::vector<std::uint32_t>{2, 1, 3, 4, 5}})
        m.add_face(f);
    m.coordinates.resize(9);
    m.face_coordinates = {0, 1, 2, 4, 5, 6, 7, 8};
    m.holes = {1};
    TriangulatedMesh const cut = triangulate(m);
    EXPECT_EQ(cut.cut_faces, 1u);
    EXPECT_EQ(cut.first_cut, 1u);
    EXPECT_EQ(cut.mesh.face_vertices,
              (std::vector<std::uint32_t>{0, 1, 2, 2, 1, 3, 2, 3, 4, 2, 4, 5}));
    EXPECT_EQ(cut.mesh.face_coordinates,
              (std::vector<std::uint32_t>{0, 1, 2, 4, 5, 6, 4, 6, 7, 4, 7, 8}));
    EXPECT_EQ(cut.mesh.holes, (std::vector<std::uint32_t>{1, 2, 3}));
    EXPECT_EQ(cut.mesh.file_face(3), 1u);
}

TEST(Triangulate, IsWhatSchemesOfTrianglesDoUnlessTheyAreStrict)
{
    ControlMesh m;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    m.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    SchemeOnMesh const s = build_scheme(find_scheme("tables-loop"), m);
    EXPECT_EQ(s.mesh->base().faces(), 2u);
    ASSERT_FALSE(s.warnings.empty());
    EXPECT_NE(s.warnings[0].find("1 face is cut into triangles"), std::string::npos);
    EXPECT_THROW(build_scheme(find_scheme("tables-loop"), m, {.strict = true}), MeshError);
}

} // namespace
} // namespace tessemu
