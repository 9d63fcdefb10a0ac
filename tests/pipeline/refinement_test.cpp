// What steps of subdivision carry along: tags, holes, places; and what they refuse.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/refinement.h"

#include "io/model.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/random_mesh.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace tessemu {
namespace {

// The refined vertices by name.
std::vector<MeshPoint> names_of(RefinedMesh const& m)
{
    std::vector<MeshPoint> out(m.mesh().positions.size());
    constexpr std::uint32_t kCorner[4][2] = {{0, 0}, {65536, 0}, {65536, 65536}, {0, 65536}};
    for (std::uint32_t f = 0; f < m.mesh().faces(); ++f)
        for (std::size_t k = 0; k < 4; ++k)
            out[m.mesh().face(f)[k]] =
                mesh_point(m.base(), m.place(f), kCorner[k][0], kCorner[k][1]);
    return out;
}

constexpr float kSharpness[] = {0.5f, 1, 1.5f, 2, 3.25f, 9.5f, 10, 12};

float after(float sharpness, int steps)
{
    return sharpness >= 10 ? sharpness : std::max(0.0f, sharpness - float(steps));
}

TEST(Refinement, CreasesLoseOneAStepOnBothHalvesOfTheirEdge)
{
    ControlMesh mesh = test::prism(5);
    std::map<std::pair<std::uint32_t, std::uint32_t>, float> sharpness;
    for (std::uint32_t i = 0; i < 8; ++i) {
        auto const face = mesh.face(i % 5 + 2); // two edges of the sides each, given either way
        std::uint32_t const a = face[i / 5], b = face[i / 5 + 1];
        mesh.creases.push_back({i % 2 ? a : b, i % 2 ? b : a, kSharpness[i]});
        ASSERT_TRUE(sharpness.try_emplace(std::minmax(a, b), kSharpness[i]).second);
    }
    for (int steps = 1; steps <= 4; ++steps) {
        RefinedMesh const m(mesh, steps, catmull_clark_step);
        std::vector<MeshPoint> const names = names_of(m);
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> pieces;
        for (ControlMesh::Crease const& c : m.mesh().creases) {
            ASSERT_NE(m.topology().find_edge(c.a, c.b), Topology::kNone);
            // Both ends lie on one edge of the file's mesh; the lower one tells which piece it is.
            MeshPoint low = names[c.a], high = names[c.b];
            for (auto const& [edge, s] : sharpness) {
                auto const at = [ends = edge](MeshPoint const& p) -> std::int64_t {
                    constexpr std::int64_t kElsewhere = -1;
                    if (p.kind == MeshPoint::Kind::Edge)
                        return p.a == ends.first && p.b == ends.second ? p.t : kElsewhere;
                    if (p.kind != MeshPoint::Kind::Vertex) return kElsewhere;
                    return p.a == ends.first    ? 0
                           : p.a == ends.second ? MeshPoint::kOne
                                                : kElsewhere;
                };
                if (at(low) < 0 || at(high) < 0) continue;
                EXPECT_EQ(c.sharpness, after(s, steps));
                EXPECT_EQ(std::abs(at(low) - at(high)), MeshPoint::kOne >> steps);
                EXPECT_TRUE(pieces[edge].insert(std::uint32_t(std::min(at(low), at(high)))).second);
            }
        }
        std::size_t expected = 0;
        for (auto const& [edge, s] : sharpness) {
            std::size_t const n = after(s, steps) > 0 ? std::size_t(1) << steps : 0;
            EXPECT_EQ(pieces[edge].size(), n) << "sharpness " << s << " after " << steps;
            expected += n;
        }
        EXPECT_EQ(m.mesh().creases.size(), expected);
    }
}

TEST(Refinement, CornersLoseOneAStep)
{
    ControlMesh mesh = test::prism(5);
    for (std::uint32_t v = 0; v < 8; ++v) mesh.corners.push_back({v, kSharpness[v]});
    for (int steps = 1; steps <= 4; ++steps) {
        RefinedMesh const m(mesh, steps, catmull_clark_step);
        std::vector<MeshPoint> const names = names_of(m);
        std::map<std::uint32_t, float> left;
        for (ControlMesh::Corner const& c : m.mesh().corners) {
            ASSERT_EQ(names[c.vertex].kind, MeshPoint::Kind::Vertex);
            EXPECT_TRUE(left.try_emplace(names[c.vertex].a, c.sharpness).second);
        }
        for (std::uint32_t v = 0; v < 8; ++v)
            EXPECT_EQ(left[v], after(kSharpness[v], steps)) << v << " after " << steps;
    }
}

TEST(Refinement, ChildrenOfHolesAreHolesAndTheBoundaryRuleStays)
{
    for (BoundaryRule rule :
         {BoundaryRule::None, BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly}) {
        ControlMesh mesh = load_model("jug").mesh; // quads and triangles
        mesh.rules.boundary = rule;
        std::set<std::uint32_t> holes;
        for (std::uint32_t f = 3; f < mesh.faces(); f += 7) holes.insert(f);
        mesh.holes.assign(holes.begin(), holes.end());
        for (int steps = 0; steps <= 3; ++steps) {
            RefinedMesh const m(mesh, steps, catmull_clark_step);
            EXPECT_EQ(m.mesh().rules.boundary, rule);
            std::set<std::uint32_t> expected;
            for (std::uint32_t f = 0; f < m.mesh().faces(); ++f)
                if (holes.count(m.place(f).face)) expected.insert(f);
            EXPECT_EQ(std::set(m.mesh().holes.begin(), m.mesh().holes.end()), expected);
            EXPECT_EQ(m.mesh().holes.size(), expected.size());
        }
    }
}

// Every unit is covered by the cells of its own face, in the order of the faces, none twice.
TEST(Refinement, PlacesTileTheirFaces)
{
    for (ControlMesh const& mesh :
         {test::prism(5), load_model("jug").mesh, test::join_faces(test::random_mesh(4), 4)})
        for (int steps = 1; steps <= 3; ++steps) {
            RefinedMesh const m(mesh, steps, catmull_clark_step);
            std::uint32_t f = 0;
            for (std::uint32_t base = 0; base < mesh.faces(); ++base) {
                std::size_t const n = mesh.face(base).size();
                int const level = n == 4 ? steps : steps - 1;
                std::set<std::array<int, 3>> cells;
                for (std::size_t k = 0; k < n << 2 * (steps - 1); ++k, ++f) {
                    PatchPlace const p = m.place(f);
                    ASSERT_EQ(p.face, base);
                    ASSERT_EQ(p.sides, 4);
                    ASSERT_EQ(p.level, level);
                    ASSERT_EQ(p.corner == PatchPlace::kWhole, n == 4);
                    ASSERT_TRUE(n == 4 || p.corner < n);
                    ASSERT_LT(p.i, 1 << level);
                    ASSERT_LT(p.j, 1 << level);
                    EXPECT_TRUE(cells.insert({p.corner, p.i, p.j}).second);
                }
            }
            EXPECT_EQ(f, m.mesh().faces());
        }
}

// A quad alone is split to quads of the same place: the child at corner k holds corner k.
TEST(Refinement, SplitKeepsTheCorner)
{
    for (int rotation = 0; rotation < 4; ++rotation)
        for (int corner = 0; corner < 4; ++corner) {
            PatchPlace face;
            face.rotation = std::uint8_t(rotation);
            constexpr float kCorner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
            UnitPoint const old = domain_to_unit(face, kCorner[corner][0], kCorner[corner][1]);
            UnitPoint const now = domain_to_unit(split(face, 4, corner), 0, 0);
            EXPECT_EQ(now.u, old.u);
            EXPECT_EQ(now.v, old.v);
        }
}

Scheme const& stencils()
{
    return find_scheme("gregory-stencil");
}

TEST(Refinement, TakesZeroToSixSteps)
{
    ControlMesh const mesh = test::prism(3);
    for (int steps : {7, 100}) try {
            build_scheme(stencils(), mesh, {.subdivide = steps});
            ADD_FAILURE() << steps << " steps";
        } catch (LimitError const& e) {
            EXPECT_EQ(e.limit, 6u);
        }
    EXPECT_EQ(build_scheme(stencils(), mesh, {.subdivide = 0}).mesh->steps(), 0);
    SchemeOnMesh const most = build_scheme(stencils(), mesh, {.subdivide = 6});
    EXPECT_EQ(most.mesh->mesh().faces(), 18u << 10); // 2 triangles, 3 quads
    EXPECT_THROW(RefinedMesh(mesh, RefinedMesh::kMaxSteps + 1, catmull_clark_step), LimitError);
}

TEST(Refinement, LargeFacesGetAStepOfTheirOwnWithAWarning)
{
    auto const speaks_of_sides = [](SchemeOnMesh const& m) {
        return std::count_if(m.warnings.begin(), m.warnings.end(), [](std::string const& w) {
            return w.find("more than 4 sides") != std::string::npos;
        });
    };
    SchemeOnMesh const none = build_scheme(stencils(), test::prism(5));
    EXPECT_EQ(none.mesh->steps(), 1);
    ASSERT_EQ(speaks_of_sides(none), 1);
    EXPECT_NE(none.warnings[0].find("2 faces have more than 4 sides (up to 5)"), std::string::npos)
        << none.warnings[0];
    EXPECT_NE(none.warnings[0].find("30 quads of the mesh's 7 faces"), std::string::npos)
        << none.warnings[0];
    for (int steps : {1, 2}) {
        SchemeOnMesh const m = build_scheme(stencils(), test::prism(5), {.subdivide = steps});
        EXPECT_EQ(m.mesh->steps(), 1 + steps);
        EXPECT_EQ(m.warnings, none.warnings);
    }
    SchemeOnMesh const quads = build_scheme(stencils(), test::prism(4));
    EXPECT_EQ(quads.mesh->steps(), 0);
    EXPECT_TRUE(quads.warnings.empty());
}

// Cameras are put by it, so pictures of a mesh stay in place however often it is subdivided.
TEST(Refinement, TheBaseMeshDoesNotDependOnTheSteps)
{
    for (int sides : {4, 5}) { // five take one step of the scheme's own
        ControlMesh const mesh = test::prism(sides);
        for (int steps : {0, 1, 2, 3}) {
            SchemeOnMesh const m = build_scheme(stencils(), mesh, {.subdivide = steps});
            EXPECT_EQ(m.mesh->base().positions, mesh.positions) << sides << " " << steps;
        }
    }
}

TEST(Refinement, MoreFacesThanMemoryHoldsAreRefusedBeforeTheyAreMade)
{
    ControlMesh const grid = test::grid(100, 100).mesh; // 40,000 corners
    try {
        RefinedMesh(grid, 7, catmull_clark_step);
        FAIL();
    } catch (LimitError const& e) {
        EXPECT_EQ(e.value, 40000ull << 12);
        EXPECT_NE(std::string(e.what()).find("7 steps of subdivision (5 would do)"),
                  std::string::npos)
            << e.what();
    }
}

TEST(Refinement, NegativeStepsAreRefused)
{
    EXPECT_THROW(RefinedMesh(test::prism(4), -1, catmull_clark_step), Error);
    try {
        build_scheme(stencils(), test::prism(4), {.subdivide = -1});
        FAIL();
    } catch (Error const& e) {
        EXPECT_NE(std::string(e.what()).find("-1"), std::string::npos) << e.what();
    }
}

// The number behind a word, counted from 1 in messages, from 0 here; -1 without one.
std::int64_t number_behind(std::string const& text, std::string const& word)
{
    std::size_t const at = text.find(word + " ");
    return at == std::string::npos ? -1 : std::stoll(text.substr(at + word.size() + 1)) - 1;
}

// Whatever is refused, and after however many steps: the user knows the file's mesh alone.
TEST(Refinement, RefusalsNameAFaceAndAVertexOfTheFilesMesh)
{
    ControlMesh fan; // 40 triangles around two vertices: too many inputs for a stencil
    fan.positions = {{0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t i = 0; i < 40; ++i) {
        fan.positions.emplace_back(std::cos(float(i)), std::sin(float(i)), 0);
        std::uint32_t const a = 2 + i, b = 2 + (i + 1) % 40;
        fan.add_face(std::array{a, b, 0u});
        fan.add_face(std::array{b, a, 1u});
    }
    std::size_t refusals = 0, vertices = 0;
    for (ControlMesh const& mesh :
         {load_model("jug").mesh, load_model("saddle_star").mesh, load_model("spindle").mesh, fan,
          test::join_faces(load_model("jug").mesh, 2)})
        for (auto const& scheme : schemes())
            for (int steps = 0; steps <= 2; ++steps) {
                std::string what;
                std::int64_t face = -1;
                try {
                    build_scheme(*scheme, mesh, {.subdivide = steps});
                    continue;
                } catch (MeshError const& e) {
                    what = e.what();
                    face = e.face;
                    EXPECT_NE(what.find("face " + std::to_string(face + 1)), std::string::npos)
                        << what;
                } catch (LimitError const& e) {
                    what = e.what();
                    face = number_behind(what, "of face");
                    if (face < 0) continue; // of a vertex
                }
                ++refusals;
                SCOPED_TRACE(what + ", after " + std::to_string(steps) + " steps");
                ASSERT_GE(face, 0);
                ASSERT_LT(face, std::int64_t(mesh.faces()));
                if (std::int64_t const v = number_behind(what, "has vertex"); v >= 0) {
                    ++vertices;
                    auto const corners = mesh.face(std::size_t(face));
                    EXPECT_EQ(std::count(corners.begin(), corners.end(), std::uint32_t(v)), 1);
                    EXPECT_TRUE(Topology(mesh).is_boundary(std::uint32_t(v)));
                }
            }
    EXPECT_GT(refusals, 10u);
    EXPECT_GT(vertices, 5u);
}

} // namespace
} // namespace tessemu
