// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/catmull_clark.h"

#include "io/model.h"
#include "io/obj_reader.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

ControlMesh grid(int n)
{
    ControlMesh m;
    for (int y = 0; y <= n; ++y)
        for (int x = 0; x <= n; ++x) m.positions.emplace_back(x, y, 0);
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            auto const at = [&](int i, int j) { return std::uint32_t(j * (n + 1) + i); };
            std::uint32_t const f[4] = {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)};
            m.add_face(f);
        }
    return m;
}

TEST(Topology, InteriorRingsStartAtTheSmallestNeighbourCounterClockwise)
{
    ControlMesh const m = grid(2);
    Topology const t(m);
    ASSERT_EQ(t.ring(4).size(), 4u);
    EXPECT_FALSE(t.is_boundary(4));
    std::vector<std::uint32_t> far;
    for (HalfEdge h : t.ring(4)) far.push_back(t.vertex_of(t.next(h)));
    EXPECT_EQ(far, (std::vector<std::uint32_t>{1, 5, 7, 3}));
    for (std::uint32_t j = 0; j < 4; ++j) EXPECT_EQ(t.ring_index(t.ring(4)[j]), j);
}

TEST(Topology, BoundaryRingsStartWhereAFaceLiesOnlyOnTheLeft)
{
    ControlMesh const m = grid(2);
    Topology const t(m);
    ASSERT_EQ(t.ring(1).size(), 2u);
    EXPECT_TRUE(t.is_boundary(1));
    EXPECT_EQ(t.vertex_of(t.next(t.ring(1)[0])), 2u);
    EXPECT_EQ(t.vertex_of(t.previous(t.ring(1)[1])), 0u);
    EXPECT_EQ(t.valence(1), 3u);
    EXPECT_EQ(t.valence(0), 2u);
}

TEST(Topology, TwinsMatch)
{
    ControlMesh const m = grid(3);
    Topology const t(m);
    std::size_t open = 0;
    for (HalfEdge h = 0; h < m.face_vertices.size(); ++h) {
        HalfEdge const other = t.twin(h);
        if (other == Topology::kNone) {
            ++open;
            continue;
        }
        EXPECT_EQ(t.twin(other), h);
        EXPECT_EQ(t.vertex_of(other), t.vertex_of(t.next(h)));
    }
    EXPECT_EQ(open, 12u);
}

TEST(Topology, SectorsAreCutAtCreasesAndBoundary)
{
    ControlMesh const m = grid(2);
    Topology const t(m);
    auto all = t.sectors(4, {});
    ASSERT_EQ(all.size(), 1u);
    EXPECT_TRUE(all[0].closed);
    auto const two = t.sectors(4, {{4, 1, 10}, {7, 4, 10}});
    ASSERT_EQ(two.size(), 2u);
    EXPECT_EQ(two[0].faces, 2u);
    EXPECT_EQ(two[1].faces, 2u);
    auto const dart = t.sectors(4, {{4, 5, 10}});
    ASSERT_EQ(dart.size(), 1u);
    EXPECT_EQ(dart[0].first_face, 1u);
    EXPECT_EQ(dart[0].faces, 4u);
    auto const boundary = t.sectors(1, {{1, 4, 10}});
    ASSERT_EQ(boundary.size(), 2u);
    EXPECT_EQ(boundary[0].faces, 1u);
}

std::string refusal(std::string const& faces)
{
    std::string text;
    for (int i = 0; i < 9; ++i)
        text += "v " + std::to_string(i % 3) + " " + std::to_string(i / 3) + " 0\n";
    try {
        Topology const t(read_obj(text + faces, "a").mesh);
    } catch (MeshError const& e) {
        return e.what();
    }
    return "";
}

TEST(Topology, SaysWhatIsWrongAndWhere)
{
    EXPECT_NE(refusal("f 1 2 5 4\nf 2 3 6 5\nf 2 8 9 5\n")
                  .find("edge 5-2 is used in the same direction by faces 2 and 3"),
              std::string::npos);
    EXPECT_NE(refusal("f 1 2 5 4\nf 2 5 6 3\n").find("edge 2-5"), std::string::npos);
    EXPECT_NE(refusal("f 1 2 5\nf 5 6 9\n").find("vertex 5 form more than one fan"),
              std::string::npos);
    EXPECT_EQ(refusal("f 1 2 5 4\nf 2 3 6 5\n"), "");
}

// The reader has refused such a file before; a mesh of a program's own making comes here first.
TEST(Topology, RefusesAFaceThatNamesAVertexTwice)
{
    auto const refusal = [](std::vector<std::vector<std::uint32_t>> const& faces) -> std::string {
        ControlMesh mesh;
        for (int i = 0; i < 9; ++i) mesh.positions.emplace_back(i % 3, i / 3, 0);
        for (auto const& face : faces) mesh.add_face(face);
        try {
            Topology const t(mesh);
        } catch (MeshError const& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(refusal({{0, 1, 4}}), "");
    EXPECT_NE(refusal({{0, 1, 1, 4}}).find("face 1 names vertex 2 twice"), std::string::npos);
    // A face around another one, slit along edge 1-5, with faces of others between its corners.
    EXPECT_NE(refusal({{0, 1, 2, 3, 0, 4, 7, 6, 5, 4}, {4, 5, 6, 7}, {0, 3, 8}, {1, 0, 8}})
                  .find("face 1 names vertex 1 twice"),
              std::string::npos);
}

// docs/math/subdivision.md, 1.1: quads only after a step; F' = sum of sides, V' = F + E + V.
TEST(CatmullClark, SplitsEveryFaceAndKeepsTheLimit)
{
    ControlMesh const m =
        read_obj("v 0 0 0\nv 2 0 0\nv 3 2 0\nv 1 3 0\nv -1 2 0\nf 1 2 3 4 5\n", "pentagon").mesh;
    Topology const t(m);
    ControlMesh const s = catmull_clark_step(t).mesh;
    EXPECT_EQ(s.faces(), 5u);
    EXPECT_EQ(s.positions.size(), 5u + 5 + 1);
    for (std::size_t f = 0; f < 5; ++f) EXPECT_EQ(s.face(f).size(), 4u);
    EXPECT_EQ(s.positions[0], glm::vec3(1, 1.4f, 0)); // face, edges, vertices
    EXPECT_EQ(s.positions[6], m.positions[0]);        // one face: interpolated
    Topology const refined(s);
    EXPECT_EQ(summarize(refined).boundary_edges, 10u);
}

TEST(Summary, CountsOfSharedModels)
{
    TESSEMU_NEEDS_SHARED("models/suzanne.obj");
    ControlMesh const m = load_model(test::shared("models/suzanne.obj").string()).mesh;
    Topology const t(m);
    MeshSummary const s = summarize(t);
    EXPECT_EQ(s.edges, 1005u);
    EXPECT_EQ(s.boundary_edges, 42u);
    EXPECT_EQ(s.components, 3u);
    EXPECT_EQ(s.regular_faces, 204u);
}

} // namespace
} // namespace tessemu
