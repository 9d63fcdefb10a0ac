// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/connectivity.h"

#include "io/model.h"
#include "pipeline/commands/patch_mesh.h"
#include "pipeline/schemes/gregory/stencils.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace tessemu {
namespace {

TEST(Connectivity, InputsAreTheTwoRing)
{
    for (char const* name : {"jug", "spindle", "saddle_star"}) {
        ControlMesh const m = load_model(name).mesh;
        Topology const t(m);
        Neighbourhood n;
        for (std::uint32_t f = 0; f < m.faces(); ++f) {
            find_neighbourhood(t, f, n);
            EXPECT_EQ(std::set<std::uint32_t>(n.inputs.begin(), n.inputs.end()).size(),
                      n.inputs.size());
            auto sorted = n.inputs;
            std::sort(sorted.begin(), sorted.end());
            EXPECT_EQ(sorted, t.two_ring(f)) << name << " face " << f;
        }
    }
}

// Faces of one type have the same stencil, whatever patch it was made from.
TEST(Connectivity, EqualTypesHaveEqualStencilsBitForBit)
{
    for (char const* name : {"jug", "spindle", "saddle_star"}) {
        ControlMesh const m = load_model(name).mesh;
        Topology const t(m);
        std::map<std::string, PatchStencils> first;
        Neighbourhood n;
        for (std::uint32_t f = 0; f < m.faces(); ++f) {
            find_neighbourhood(t, f, n);
            PatchStencils const s = make_gregory_stencils(n, false, {});
            auto const [it, fresh] = first.try_emplace(n.key, s);
            EXPECT_EQ(it->second.rows, s.rows) << name << " face " << f;
        }
        EXPECT_LT(first.size(), m.faces());
    }
}

// Shared control points have weights with equal bits from all patches, per mesh vertex.
TEST(GregoryStencils, SharedControlPointsHaveEqualWeightsInEveryPatch)
{
    for (char const* name : {"jug", "spindle", "saddle_star"}) {
        ControlMesh const m = load_model(name).mesh;
        Topology const t(m);
        using Weights = std::map<std::uint32_t, double>;
        std::map<std::pair<std::uint32_t, std::uint32_t>, Weights> edge_points; // (vertex, towards)
        std::map<std::uint32_t, Weights> vertex_points;
        Neighbourhood n;
        std::size_t shared = 0;
        auto const check = [&](auto& seen, auto const& key, std::vector<double> const& row) {
            Weights w;
            for (std::size_t i = 0; i < row.size(); ++i)
                if (row[i] != 0) w[n.inputs[i]] = row[i];
            auto const [it, fresh] = seen.try_emplace(key, w);
            EXPECT_EQ(it->second, w) << name;
            shared += !fresh;
        };
        for (std::uint32_t f = 0; f < m.faces(); ++f) {
            find_neighbourhood(t, f, n);
            PatchStencils const s = make_gregory_stencils(n, false, {});
            auto const face = m.face(f);
            int const N = n.sides;
            auto const vertex = [&](int i) { return face[std::size_t((i + n.rotation + N) % N)]; };
            for (int i = 0; i < N; ++i) {
                check(vertex_points, vertex(i), s.rows[std::size_t(i)]);
                check(edge_points, std::pair(vertex(i), vertex(i + 1)), s.rows[std::size_t(N + i)]);
                check(edge_points, std::pair(vertex(i), vertex(i - 1)),
                      s.rows[std::size_t(2 * N + i)]);
            }
        }
        EXPECT_GT(shared, m.faces());
    }
}

TEST(GregoryStencil, HolesAndBoundaryRuleNoneAreNotDrawn)
{
    ControlMesh m = load_model("saddle_star").mesh;
    std::size_t const faces = m.faces();
    auto const drawn = [&] {
        std::size_t n = 0;
        SchemeOnMesh const on = build_scheme(find_scheme("gregory-stencil"), m);
        for (PatchCount const& c : on.patches->patch_counts()) n += c.patches;
        return n;
    };
    EXPECT_EQ(drawn(), faces);
    m.holes = {0, 5};
    EXPECT_EQ(drawn(), faces - 2);
    m.holes.clear();
    m.rules.boundary = BoundaryRule::None;
    EXPECT_LT(drawn(), faces);
}

namespace {
// 3 x 3 quads with their faces' numbers from 0 in rows.
ControlMesh grid3()
{
    ControlMesh m;
    for (std::uint32_t i = 0; i < 16; ++i) m.positions.emplace_back(i % 4, i / 4, 0);
    for (std::uint32_t f = 0; f < 9; ++f) {
        std::uint32_t const v = f / 3 * 4 + f % 3;
        std::uint32_t const face[] = {v, v + 1, v + 5, v + 4};
        m.add_face(face);
    }
    m.rules.boundary = BoundaryRule::None;
    return m;
}

std::set<std::uint32_t> drawn_faces(ControlMesh const& mesh)
{
    SchemeOnMesh const on = build_scheme(find_scheme("gregory-stencil"), mesh);
    std::vector<std::string> warnings;
    std::vector<char> const hidden = hidden_faces(*on.mesh, warnings);
    std::set<std::uint32_t> out;
    for (std::uint32_t f = 0; f < hidden.size(); ++f)
        if (!hidden[f]) out.insert(on.mesh->base().file_face(on.mesh->place(f).face));
    return out;
}
} // namespace

// OpenSubdiv: a face is a hole if a vertex of it has a boundary edge that is not infinitely sharp.
TEST(BoundaryRuleNone, KeepsFacesAmongInfinitelySharpBoundaryEdges)
{
    ControlMesh m = grid3();
    EXPECT_EQ(drawn_faces(m), std::set<std::uint32_t>{4});
    m.creases = {{0, 1, 10}, {2, 1, 10}, {2, 3, 12}};
    EXPECT_EQ(drawn_faces(m), (std::set<std::uint32_t>{1, 4}));
    m.creases[1].sharpness = 9.5f;
    EXPECT_EQ(drawn_faces(m), std::set<std::uint32_t>{4});
}

// A fin on an inner edge cuts the mesh there; the file has no boundary at that edge.
TEST(BoundaryRuleNone, ACutIsNoBoundary)
{
    ControlMesh m = grid3();
    m.positions.emplace_back(1, 1, 1);
    m.positions.emplace_back(2, 1, 1);
    for (auto const& c : {std::pair(5u, 6u), {6u, 17u}, {17u, 16u}, {16u, 5u}})
        m.creases.push_back({c.first, c.second, 10}); // the fin's own edges
    std::uint32_t const fin[] = {5, 6, 17, 16};
    m.add_face(fin);
    EXPECT_EQ(drawn_faces(m), (std::set<std::uint32_t>{4, 9}));
    m.creases.pop_back(); // one of them is soft: it is at vertex 5, of whatever copy
    EXPECT_EQ(drawn_faces(m), std::set<std::uint32_t>{});
}

TEST(BoundaryRuleNone, TheRuleIsAboutTheFilesFacesHoweverOftenTheyAreSplit)
{
    ControlMesh m = grid3();
    m.creases = {{0, 1, 10}, {2, 1, 10}, {2, 3, 10}};
    for (int steps : {0, 1, 2}) {
        SchemeOnMesh const on =
            build_scheme(find_scheme("gregory-stencil"), m, {.subdivide = steps});
        std::size_t patches = 0;
        for (PatchCount const& c : on.patches->patch_counts()) patches += c.patches;
        EXPECT_EQ(patches, 2u << (2 * steps));
    }
}

} // namespace
} // namespace tessemu
