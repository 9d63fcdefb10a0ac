// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/manifold.h"

#include "io/obj_reader.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/topology.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace tessemu {
namespace {

ControlMesh mesh_of(std::size_t vertices, std::vector<std::vector<std::uint32_t>> const& faces)
{
    ControlMesh m;
    for (std::size_t i = 0; i < vertices; ++i) m.positions.emplace_back(i, i * i, 0);
    for (auto const& f : faces) m.add_face(f);
    return m;
}

std::vector<std::vector<std::uint32_t>> faces_of(ControlMesh const& m)
{
    std::vector<std::vector<std::uint32_t>> out;
    for (std::size_t f = 0; f < m.faces(); ++f)
        out.emplace_back(m.face(f).begin(), m.face(f).end());
    return out;
}

using Faces = std::vector<std::vector<std::uint32_t>>;

Faces const kCube{{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                  {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};

TEST(Manifold, LeavesAManifoldAsItIs)
{
    ControlMesh m = mesh_of(8, kCube);
    m.creases = {{0, 1, 2}};
    m.holes = {3};
    ManifoldMesh const out = make_manifold(m);
    EXPECT_EQ(faces_of(out.mesh), kCube);
    EXPECT_EQ(out.mesh.positions, m.positions);
    EXPECT_TRUE(out.mesh.file_vertices.empty());
    EXPECT_TRUE(in_words(out.repairs).empty());
}

TEST(Manifold, LosesRepetitionsDegenerateFacesAndUnusedVertices)
{
    ControlMesh m = mesh_of(8, {{1, 2, 2, 3}, {3, 2, 5, 2}, {6, 6, 7}, {1, 3, 4, 1}, {7}});
    m.holes = {1, 3};
    m.corners = {{4, 1.5f}, {0, 2}};
    m.coordinates.resize(3);
    m.face_coordinates = {0, 1, 2, 0, 0, 0, 0, 0, 0, 0, 0, 2, 1, 0, 2, 0};
    ManifoldMesh const out = make_manifold(m);
    EXPECT_EQ(faces_of(out.mesh), (Faces{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_EQ(out.mesh.file_vertices, (std::vector<std::uint32_t>{1, 2, 3, 4}));
    EXPECT_EQ(out.mesh.file_faces, (std::vector<std::uint32_t>{0, 3}));
    EXPECT_EQ(out.mesh.holes, std::vector<std::uint32_t>{1});
    ASSERT_EQ(out.mesh.corners.size(), 1u);
    EXPECT_EQ(out.mesh.corners[0].vertex, 3u);
    // Of two equal corners in a row the second stays, with its texture coordinates.
    EXPECT_EQ(out.mesh.face_coordinates, (std::vector<std::uint32_t>{0, 2, 0, 2, 1, 0}));
    EXPECT_EQ(
        in_words(out.repairs),
        (std::vector<std::string>{
            "2 faces name a vertex twice in a row and lose the repetition; the first is face "
            "1",
            "3 faces have fewer than three different vertices, or name one twice, not in a row: "
            "left out; the first "
            "is face 2",
            "4 vertices are in no face: left out; the first is vertex 1"}));
    EXPECT_THROW(make_manifold(mesh_of(3, {{0, 1}, {2, 2, 2}})), MeshError);
}

// Two triangles that meet in a vertex.
TEST(Manifold, GivesEachFanOfAVertexItsOwnCopy)
{
    ManifoldMesh const out = make_manifold(mesh_of(5, {{0, 1, 2}, {2, 3, 4}}));
    EXPECT_EQ(faces_of(out.mesh), (Faces{{0, 1, 2}, {5, 3, 4}}));
    EXPECT_EQ(out.mesh.file_vertex(5), 2u);
    EXPECT_EQ(out.mesh.cut_edges, 0u);
    ASSERT_EQ(out.mesh.corners.size(), 2u); // no crease of cut edges passes it: a sharp vertex
    EXPECT_EQ(out.mesh.corners[0].vertex, 2u);
    EXPECT_EQ(out.mesh.corners[1].vertex, 5u);
    EXPECT_EQ(
        in_words(out.repairs),
        std::vector<std::string>{"vertex 3 has several fans of faces: each gets a copy of it"});
}

// A cube with a fin on an edge: the edge is cut, and what was one vertex at both ends stays one.
TEST(Manifold, SlitsAClosedSurfaceWhereAFinStandsOnIt)
{
    Faces faces = kCube;
    faces.push_back({0, 1, 8, 9});
    ManifoldMesh const out = make_manifold(mesh_of(10, faces));
    EXPECT_EQ(out.mesh.cut_edges, 1u);
    EXPECT_EQ(out.mesh.slits, (std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}}));
    EXPECT_EQ(faces_of(out.mesh)[6], (std::vector<std::uint32_t>{10, 11, 8, 9}));
    Topology const t(out.mesh);
    EXPECT_EQ(t.twin(out.mesh.face_start[0]), Topology::kNone);
    EXPECT_EQ(t.ring(0).size(), 3u);
    EXPECT_EQ(t.valence(0), 4u); // the slit's two sides
    EXPECT_TRUE(t.is_boundary(0));
    EXPECT_FALSE(t.is_boundary(2));
    // After a step of subdivision the two sides have points of their own.
    ControlMesh const fine = catmull_clark_step(t).mesh;
    EXPECT_TRUE(fine.slits.empty());
    EXPECT_EQ(summarize(Topology(fine)).boundary_edges, 2u + 2 + 4 * 2);
}

// A crease where three sheets meet: inside it no vertex is sharp, at its ends they are.
TEST(Manifold, IsSharpAsOpenSubdivMakesIt)
{
    // Sheets left, right and up, each of two quads along the edges 0-1, 1-2.
    Faces const sheets{{0, 1, 4, 3}, {1, 2, 5, 4},  {1, 0, 6, 7},
                       {2, 1, 7, 8}, {0, 1, 10, 9}, {1, 2, 11, 10}};
    ManifoldMesh const out = make_manifold(mesh_of(12, sheets));
    EXPECT_EQ(out.mesh.cut_edges, 2u);
    EXPECT_TRUE(out.mesh.slits.empty());
    std::multiset<std::uint32_t> sharp;
    for (auto const& c : out.mesh.corners) sharp.insert(out.mesh.file_vertex(c.vertex));
    EXPECT_EQ(sharp, (std::multiset<std::uint32_t>{0, 0, 0, 2, 2, 2}));
    EXPECT_EQ(out.mesh.creases.size(), 6u);
    Topology const t(out.mesh);
    for (auto const& c : out.mesh.creases) {
        HalfEdge const h = t.find_edge(c.a, c.b);
        ASSERT_NE(h, Topology::kNone);
        EXPECT_EQ(t.twin(h), Topology::kNone);
        EXPECT_GE(c.sharpness, 10);
    }
}

// Any faces at all become a manifold in which two faces share an edge exactly where two of the
// given faces ran along it in opposite directions and no other did.
TEST(Manifold, KeepsEverySharedEdgeOfAnyFacesAndNoOther)
{
    std::mt19937 random(20261125);
    std::size_t cut = 0, slit = 0, split = 0;
    for (int round = 0; round < 3000; ++round) {
        std::size_t const vertices = 5 + random() % 8;
        Faces faces;
        for (std::size_t f = 0, n = 1 + random() % 14; f < n; ++f) {
            std::vector<std::uint32_t> face;
            for (std::size_t i = 0, sides = 3 + random() % 3; i < sides; ++i)
                face.push_back(std::uint32_t(random() % vertices));
            faces.push_back(face);
        }
        ControlMesh const given = mesh_of(vertices, faces);
        ManifoldMesh out;
        try {
            out = make_manifold(given);
        } catch (MeshError const&) {
            continue;
        }
        ControlMesh const& m = out.mesh;
        Topology const t(m); // throws for what is no manifold
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<bool>> uses;
        auto const ends = [&](HalfEdge h) {
            return std::pair(m.file_vertex(t.vertex_of(h)), m.file_vertex(t.vertex_of(t.next(h))));
        };
        for (HalfEdge h = 0; h < m.face_vertices.size(); ++h) {
            auto const [a, b] = ends(h);
            uses[std::minmax(a, b)].push_back(a < b);
            EXPECT_EQ(m.positions[t.vertex_of(h)], given.positions[a]);
        }
        for (HalfEdge h = 0; h < m.face_vertices.size(); ++h) {
            auto const [a, b] = ends(h);
            auto const& use = uses[std::minmax(a, b)];
            bool const shared = use.size() == 2 && use[0] != use[1];
            ASSERT_EQ(t.twin(h) != Topology::kNone, shared) << "round " << round;
            if (shared) {
                EXPECT_EQ(ends(t.twin(h)), std::pair(b, a));
            }
        }
        cut += m.cut_edges, slit += m.slits.size(), split += out.repairs.split.number;
        // Faces as they were, but for what in_words tells of.
        for (std::size_t f = 0; f < m.faces(); ++f) {
            auto const& was = faces[m.file_face(std::uint32_t(f))];
            std::vector<std::uint32_t> now, expected;
            for (std::uint32_t v : m.face(f)) now.push_back(m.file_vertex(v));
            for (std::size_t i = 0; i < was.size(); ++i)
                if (was[i] != was[(i + 1) % was.size()]) expected.push_back(was[i]);
            EXPECT_EQ(now, expected);
        }
        // Once more changes nothing.
        ManifoldMesh const again = make_manifold(m);
        EXPECT_EQ(faces_of(again.mesh), faces_of(m));
        EXPECT_TRUE(in_words(again.repairs).empty());
        EXPECT_EQ(again.mesh.slits, m.slits);
    }
    EXPECT_GT(cut, 1000u);
    EXPECT_GT(slit, 10u);
    EXPECT_GT(split, 1000u);
}

} // namespace
} // namespace tessemu
