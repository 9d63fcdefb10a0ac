// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/join.h"

#include "pipeline/mesh/manifold.h"
#include "pipeline/schemes/scheme.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace tessemu {
namespace {

using Numbers = std::vector<std::uint32_t>;

// A face for every three vertices, so that none is unused.
ControlMesh cloud(std::vector<glm::vec3> points)
{
    ControlMesh m;
    m.positions = std::move(points);
    for (std::uint32_t v = 0; v + 2 < m.positions.size(); v += 3)
        m.add_face(Numbers{v, v + 1, v + 2});
    return m;
}

// A cube of which each face has its own vertices, and which is `jitter` wide of closed.
ControlMesh cube24(float jitter = 0)
{
    static constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                         {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    ControlMesh m;
    for (auto const& f : kFaces) {
        Numbers face;
        for (int v : f) {
            face.push_back(std::uint32_t(m.positions.size()));
            float const shift = jitter * float(m.positions.size() % 3);
            m.positions.push_back(2.0f * glm::vec3(v & 1, v >> 1 & 1, v >> 2) - 1.0f + shift);
        }
        m.add_face(face);
    }
    return m;
}

std::size_t open_edges(ControlMesh const& m)
{
    ControlMesh const manifold = make_manifold(m).mesh; // what is joined in part is none
    return summarize(Topology(manifold)).boundary_edges;
}

// All pairs, in whole numbers.
Numbers clusters_by_pairs(std::vector<glm::ivec3> const& points, int squared_distance)
{
    Numbers lowest(points.size());
    std::iota(lowest.begin(), lowest.end(), 0u);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = 0; j < points.size(); ++j) {
                glm::ivec3 const d = points[i] - points[j];
                if (d.x * d.x + d.y * d.y + d.z * d.z > squared_distance) continue;
                if (lowest[i] < lowest[j]) lowest[j] = lowest[i], changed = true;
            }
    }
    return lowest;
}

TEST(Join, MakesTheClustersThatAllPairsMake)
{
    std::mt19937 random(7);
    std::size_t several = 0;
    for (int trial = 0; trial < 200; ++trial) {
        int const size = 1 + int(random() % 40), squared = int(random() % 40);
        std::vector<glm::ivec3> points(30 + random() % 120);
        for (glm::ivec3& p : points)
            for (int k = 0; k < 3; ++k) p[k] = int(random() % unsigned(size));
        Numbers const lowest = clusters_by_pairs(points, squared);
        std::vector<glm::vec3> positions(points.begin(), points.end());
        Numbers staying;
        for (std::uint32_t v = 0; v < lowest.size(); ++v)
            if (lowest[v] == v) staying.push_back(v);
        // A root is rounded: the distance that just reaches.
        double distance = std::sqrt(double(squared));
        if (distance * distance < squared) distance = std::nextafter(distance, INFINITY);
        ControlMesh mesh = cloud(positions);
        mesh.positions.emplace_back(1000, 0, 0); // three that stay apart, so that a face is left
        mesh.positions.emplace_back(2000, 0, 0);
        mesh.positions.emplace_back(3000, 0, 0);
        auto const n = std::uint32_t(points.size());
        mesh.add_face(Numbers{n, n + 1, n + 2});
        JoinedMesh const out = join_vertices(mesh, distance);
        for (std::uint32_t v : {n, n + 1, n + 2}) staying.push_back(v);
        ASSERT_EQ(out.join.joined, points.size() + 3 - staying.size());
        if (out.join.joined == 0) continue;
        ++several;
        ASSERT_EQ(out.mesh.file_vertices, staying);
        for (std::size_t i = 0; i < staying.size(); ++i)
            ASSERT_EQ(out.mesh.positions[i], mesh.positions[staying[i]]);
        for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
            std::uint32_t const v = mesh.face_vertices[c];
            ASSERT_EQ(out.mesh.file_vertex(out.mesh.face_vertices[c]), v < n ? lowest[v] : v);
        }
    }
    EXPECT_GT(several, 100u);
}

TEST(Join, OfAChainTheLowestNumberStaysWhereItLies)
{
    JoinedMesh const out = join_vertices(cloud({{5, 0, 0},
                                                {2, 0, 0},
                                                {1, 0, 0},
                                                {0, 0, 0},
                                                {9, 0, 0},
                                                {9, 9, 0},
                                                {9, 5, 0},
                                                {3, 0, 0},
                                                {7, 7, 7}}),
                                         1);
    EXPECT_EQ(out.mesh.file_vertices, (Numbers{0, 1, 4, 5, 6, 8}));
    EXPECT_EQ(out.mesh.positions[1], glm::vec3(2, 0, 0));
    EXPECT_EQ(out.join.joined, 3u);
    EXPECT_EQ(out.join.first, 2u);
    EXPECT_EQ(out.join.into, 1u);
    EXPECT_EQ(out.join.collapsed, 1u);
    EXPECT_EQ(
        in_words(out.join, 1),
        (std::vector<std::string>{
            "3 vertices are joined with others within 1; the first is vertex 3, with vertex 2",
            "face 1 has fewer vertices by that"}));
}

TEST(Join, ClosesACubeWhoseFacesHaveTheirOwnVertices)
{
    EXPECT_EQ(open_edges(cube24()), 24u);
    JoinedMesh const out = join_vertices(cube24(), 0);
    EXPECT_EQ(out.join.joined, 16u);
    EXPECT_EQ(out.mesh.positions.size(), 8u);
    EXPECT_EQ(open_edges(out.mesh), 0u);
    EXPECT_EQ(out.mesh.file_vertex(7), 7u) << "two faces opposite each other have all eight";
    // Nothing is left for make_manifold to warn of.
    EXPECT_TRUE(in_words(make_manifold(out.mesh).repairs).empty());
    BuildOptions options;
    options.join = 0;
    SchemeOnMesh const on = build_scheme(find_scheme("gregory-stencil"), cube24(), options);
    EXPECT_EQ(on.warnings, (std::vector<std::string>{
                               "16 vertices are joined with others within 0; the first is vertex "
                               "9, with vertex 1"}));
    EXPECT_EQ(summarize(on.mesh->base_topology()).boundary_edges, 0u);
    // Faces of what is not left are named as in the file.
    options.strict = true;
    EXPECT_EQ(summarize(build_scheme(find_scheme("acc"), cube24(), options).mesh->base_topology())
                  .boundary_edges,
              0u);
}

TEST(Join, TagsHolesAndTextureCoordinatesFollow)
{
    ControlMesh m = cube24();
    Numbers const one_corner = [&] {
        Numbers out;
        for (std::uint32_t v = 0; v < 24; ++v)
            if (m.positions[v] == m.positions[0]) out.push_back(v);
        return out;
    }();
    ASSERT_EQ(one_corner.size(), 3u);
    m.corners = {{one_corner[1], 1.5f}, {one_corner[2], 2}, {5, 3}};
    m.holes = {2};
    m.coordinates.resize(24);
    for (std::uint32_t c = 0; c < 24; ++c) m.face_coordinates.push_back(23 - c);
    // The edge of face 1 between its corners 0 and 1, and the same edge of another face.
    std::uint32_t a = 0, b = 0;
    for (std::uint32_t v = 4; v < 24; ++v) {
        if (m.positions[v] == m.positions[0]) a = v;
        if (m.positions[v] == m.positions[1]) b = v;
    }
    m.creases = {{0, 1, 1}, {b, a, 4}, {0, a, 7}, {1, 3, 2}};
    JoinedMesh const out = join_vertices(m, 0);
    ASSERT_EQ(out.mesh.corners.size(), 2u);
    EXPECT_EQ(out.mesh.corners[0].vertex, 0u);
    EXPECT_EQ(out.mesh.corners[0].sharpness, 2) << "the sharpest";
    ASSERT_EQ(out.mesh.creases.size(), 2u) << "one between joined vertices goes";
    EXPECT_EQ(out.mesh.creases[0].a, 0u);
    EXPECT_EQ(out.mesh.creases[0].b, 1u);
    EXPECT_EQ(out.mesh.creases[0].sharpness, 4);
    EXPECT_EQ(out.mesh.holes, m.holes);
    EXPECT_EQ(out.mesh.face_coordinates, m.face_coordinates);
}

TEST(Join, RefusesDistancesThatAreNoneAndThoseThatLeaveNoFace)
{
    for (double bad : {-1.0, -1e-300, double(NAN), -double(INFINITY)})
        EXPECT_THROW(join_vertices(cube24(), bad), Error) << bad;
    EXPECT_EQ(join_vertices(cube24(), -0.0).join.joined, 16u);
    try {
        join_vertices(cube24(), 2.5);
        FAIL();
    } catch (MeshError const& e) {
        EXPECT_EQ(e.what(), std::string("no face is left where vertices within 2.5 are joined: the "
                                        "shortest edge is 2"));
    }
    // Without faces that a join could cost, nothing is its fault.
    ControlMesh points;
    points.positions = {{0, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(join_vertices(points, 1).mesh.positions.size(), 1u);
}

TEST(Seams, AreOpenEdgesThatLieOnEachOtherWithOtherVertices)
{
    ControlMesh const exact = cube24();
    Seams const all = find_seams(Topology(exact));
    EXPECT_EQ(all.edges, 24u);
    EXPECT_EQ(all.apart, 0);
    ControlMesh const closed = join_vertices(exact, 0).mesh;
    EXPECT_EQ(find_seams(Topology(closed)).edges, 0u);

    ControlMesh const wide = cube24(1e-7f); // of a diagonal of 3.5
    Seams const near = find_seams(Topology(wide));
    EXPECT_EQ(near.edges, 24u);
    EXPECT_GT(near.apart, 0);
    EXPECT_EQ(open_edges(join_vertices(wide, near.apart).mesh), 0u);
    EXPECT_GT(open_edges(join_vertices(wide, near.apart / 4).mesh), 0u);
    ControlMesh const apart = cube24(1e-4f);
    EXPECT_EQ(find_seams(Topology(apart)).edges, 0u);
}

// Both sides of a cut are one edge of the file: joining cannot help.
TEST(Seams, CutsAreNone)
{
    ControlMesh m;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
    for (std::uint32_t v : {2, 3, 4}) m.add_face(Numbers{0, 1, v});
    ControlMesh const cut = make_manifold(m).mesh;
    ASSERT_EQ(cut.cut_edges, 1u);
    EXPECT_EQ(find_seams(Topology(cut)).edges, 0u);
}

// A plane of 200,000 vertices in 50,000 places, which pairs would take minutes for; and all of them
// within the distance.
TEST(Join, TakesMeshesOfAnySize)
{
    std::vector<glm::vec3> points;
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 50000; ++i) points.emplace_back(i % 250, i / 250, 0);
    EXPECT_EQ(join_vertices(cloud(points), 0).join.joined, 150000u);
    EXPECT_EQ(join_vertices(cloud(points), 0.9).join.joined, 150000u);
    EXPECT_THROW(join_vertices(cloud(points), 1), MeshError) << "one chain";
    EXPECT_THROW(join_vertices(cloud(points), 1e6), MeshError);
}

} // namespace
} // namespace tessemu
