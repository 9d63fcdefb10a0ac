// Where a surface has no normal of its own it gets the mean of the faces around: of unit length,
// the same from all patches, in every scheme.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame.h"
#include "pipeline/mesh/animation.h"
#include "pipeline/mesh/builtin_models.h"
#include "pipeline/mesh/poles.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/cages.h"
#include "tests/support/edges.h"
#include "tests/support/shapes.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include <bit>

namespace tessemu {
namespace {

ControlMesh mesh_of(std::vector<glm::vec3> const& points,
                    std::vector<std::vector<std::uint32_t>> const& faces)
{
    ControlMesh m;
    m.positions = points;
    for (auto const& f : faces) m.add_face(f);
    return m;
}

// A dome of quads whose top row of n vertices, a multiple of four, lies on one point; the next row
// is a square around it, `drop` below. Coordinates are halves and drops eighths: the faces' areas
// and their sums are exact in float, so the mean of the top's faces is z times a number.
ControlMesh dome(int n, double drop)
{
    ControlMesh m;
    int const k = n / 4;
    auto const on_square = [&](int j) { // from a corner, anticlockwise
        double const along = j % k - k / 2.0, out = k / 2.0;
        switch (j / k) {
        case 0:
            return glm::dvec2(out, along);
        case 1:
            return glm::dvec2(-along, out);
        case 2:
            return glm::dvec2(-out, -along);
        default:
            return glm::dvec2(along, -out);
        }
    };
    double const radius[] = {0, 1, 2, 3}, height[] = {1, 1 - drop, 0.5 - drop, -1 - drop};
    for (int row = 0; row < 4; ++row)
        for (int j = 0; j < n; ++j) {
            glm::dvec2 const p = radius[row] * on_square(j);
            m.positions.emplace_back(float(p.x), float(p.y), float(height[row]));
        }
    for (int row = 0; row < 3; ++row)
        for (int j = 0; j < n; ++j) {
            auto const v = [&](int r, int i) { return std::uint32_t(r * n + i % n); };
            m.add_face(std::vector{v(row, j), v(row + 1, j), v(row + 1, j + 1), v(row, j + 1)});
        }
    return m;
}

TEST(Poles, OfAMeshWithoutDegeneraciesThereAreNone)
{
    for (BuiltinModel const& model : builtin_models()) {
        ControlMesh const mesh = load_model(std::string(model.name)).mesh;
        EXPECT_TRUE(find_poles(Topology(mesh)).empty()) << model.name;
    }
    for (test::Shape const& shape : test::first_objects())
        EXPECT_TRUE(find_poles(Topology(shape.mesh)).empty()) << shape.name;
}

// Two vertices inside a flat grid on one point: the rings around are still spread out.
TEST(Poles, ACollapsedEdgeInsideNeedNotBeOne)
{
    ControlMesh m = test::grid(4, 4).mesh;
    m.positions[12] = m.positions[13];
    EXPECT_TRUE(find_poles(Topology(m)).empty());
}

TEST(Poles, ARowOnOnePointIsOnePole)
{
    ControlMesh const m = dome(8, 0);
    Poles const poles = find_poles(Topology(m));
    ASSERT_EQ(poles.size(), 1u);
    for (std::uint32_t v = 0; v < m.positions.size(); ++v)
        EXPECT_EQ(poles.at(v), v < 8 ? 0 : Poles::kNone);
    EXPECT_EQ(poles.first, (std::vector<std::uint32_t>{0, 8})); // each face once
    EXPECT_TRUE(poles.collapsed(7, 0));
    EXPECT_FALSE(poles.collapsed(7, 8));
}

TEST(Poles, ACornerWhoseEdgesLieInALineIsOne)
{
    ControlMesh const m = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}});
    Poles const poles = find_poles(Topology(m));
    ASSERT_EQ(poles.size(), 1u);
    EXPECT_EQ(poles.at(1), 0u);
}

TEST(Poles, DoNotDependOnWhereOrHowLargeTheMeshIs)
{
    for (double scale : {0x1p-20, 1.0, 0x1p20}) {
        ControlMesh m = dome(8, 0.25);
        for (glm::vec3& p : m.positions) p = float(scale) * p;
        EXPECT_EQ(find_poles(Topology(m)).size(), 1u);
    }
}

struct Case {
    char const* name;
    ControlMesh mesh;
    std::vector<glm::vec3> poles; ///< where they are
    std::vector<glm::vec3> normals;
};

std::vector<Case> cases()
{
    glm::vec3 const x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    return {
        {"flat dome", dome(8, 0), {z}, {z}},
        {"pointed dome", dome(12, 0.25), {z}, {z}},
        {"dome with many segments", dome(40, 0.125), {z}, {z}},
        {"corner in a line",
         mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 2, 3}}),
         {x},
         {z}},
        {"face without area",
         mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {3, 1, 0}},
                 {{0, 1, 2, 3}, {0, 3, 5, 4}}),
         {},
         {}},
        {"face of one point",
         mesh_of({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{0, 1, 2, 3}}),
         {{0, 0, 0}},
         {z}},
        {"triangle without area",
         mesh_of({x, y, z, 0.5f * (x + y)}, {{0, 3, 1}, {0, 1, 2}}),
         {},
         {}},
    };
}

// v/|v| in float has 8 roundings: a product's and two sums' of the square, half of them in the
// root, the root's, the quotient's and a product's, at most. A pole's normal goes through it twice,
// as the dispatch's unit vector and as the cross product of its tangents: 16 units of 2^-24.
constexpr double kUnit = 16 * 0x1p-24;

TEST(Poles, NormalsThereAreOfUnitLengthAndTheSameFromAllPatches)
{
    ThreadPool const threads;
    for (Case const& c : cases())
        for (auto const& scheme : schemes()) {
            if (!test::takes(*scheme, c.mesh)) continue;
            SCOPED_TRACE(scheme->info().name + " on a " + c.name);
            SchemeOnMesh const m = test::build_watertight(*scheme, c.mesh);
            for (Machine const& machine : test::contraction_policies(2)) {
                FrameSettings s;
                s.tess_factor = 5;
                s.machine = machine;
                std::vector<std::size_t> seen(c.poles.size());
                std::vector<std::optional<glm::vec3>> first(c.poles.size());
                CommandOptions options;
                options.visit = [&](SurfacePatch const& p) {
                    for (std::size_t i = 0; i < p.points(); ++i) {
                        SurfaceVertex const v = p.vertex(i);
                        ASSERT_NEAR(glm::length(glm::dvec3(v.normal)), 1, kUnit);
                        for (std::size_t k = 0; k < c.poles.size(); ++k) {
                            if (glm::length(v.position - c.poles[k]) > 1e-6f) continue;
                            ++seen[k];
                            if (!first[k]) first[k] = v.normal;
                            ASSERT_EQ(v.normal, *first[k]);
                            for (int j = 0; j < 3; ++j)
                                ASSERT_NEAR(v.normal[j], c.normals[k][j], kUnit);
                        }
                    }
                };
                run_commands(m.patches->commands(surface_settings(s)), threads, options);
                for (std::size_t n : seen) EXPECT_GT(n, 0u);
                test::EdgeComparison const e = test::compare_edges(*m.patches, s, threads);
                EXPECT_EQ(e.differing_normals, 0u) << e.first_difference;
            }
        }
}

TEST(Poles, InAPoseTheyTurnWithTheFacesAround)
{
    ThreadPool const threads;
    ControlMesh const mesh = dome(8, 0.25);
    SpineRig const rig(mesh);
    for (char const* name : {"gregory-stencil", "gregory-two-stage", "acc"}) {
        SchemeOnMesh const m = build_scheme(find_scheme(name), mesh);
        FrameSettings s;
        s.tess_factor = 5;
        auto const pose = std::make_shared<Pose>(rig.sway(0.3));
        s.pose = pose;
        glm::dvec3 area(0);
        for (std::size_t j = 0; j < 8; ++j) { // the top row is a triangle fan
            auto const at = [&](std::size_t v) {
                return glm::dvec3(pose->posed(v, mesh.positions[v]));
            };
            area += cross(at(8 + j) - at(0), at(8 + (j + 1) % 8) - at(0));
        }
        glm::dvec3 const expected = normalize(area), top(pose->posed(0, mesh.positions[0]));
        // In units u = 2^-24: a posed point has 9 roundings of its largest coordinate, 1.5, here
        // and in the shader; of its offset, which is at least 1.2, that is 2 9 1.5 / 1.2 < 23, of a
        // product of two offsets 46. The eight products' sum has 8 + 8 roundings more of both
        // products of a component. The offsets' lengths multiply to 1.42 times the area: (46 + 32)
        // 1.42 + kUnit < 127 u < 1e-5.
        std::size_t seen = 0;
        CommandOptions options;
        options.visit = [&](SurfacePatch const& p) {
            for (std::size_t i = 0; i < p.points(); ++i) {
                SurfaceVertex const v = p.vertex(i);
                ASSERT_NEAR(glm::length(glm::dvec3(v.normal)), 1, kUnit);
                if (glm::length(glm::dvec3(v.position) - top) > 1e-5) continue;
                ++seen;
                for (int k = 0; k < 3; ++k) EXPECT_NEAR(v.normal[k], expected[k], 1e-5);
            }
        };
        run_commands(m.patches->commands(surface_settings(s)), threads, options);
        EXPECT_EQ(seen, 8u * 6) << name; // the points of eight collapsed edges
    }
}

TEST(Poles, DisplacementLeavesNoDent)
{
    ThreadPool const threads;
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), dome(8, 0.125));
    FrameSettings s;
    s.tess_factor = 5;
    s.displacement = std::make_shared<Displacement>(Displacement::studs(0.5f, 0.2f));
    std::size_t seen = 0;
    CommandOptions options;
    options.visit = [&](SurfacePatch const& p) {
        for (std::size_t i = 0; i < p.points(); ++i) {
            SurfaceVertex const v = p.vertex(i);
            if (glm::length(v.smooth - glm::vec3(0, 0, 1)) > 1e-6f) continue;
            ++seen;
            EXPECT_NEAR(v.normal.z, 1, kUnit);
            EXPECT_GE(v.position.z, v.smooth.z);
            EXPECT_NEAR(v.position.x, v.smooth.x, 0.2 * kUnit + 0x1p-24); // the studs are 0.2 high
        }
    };
    run_commands(m.patches->commands(surface_settings(s)), threads, options);
    EXPECT_GT(seen, 0u);
}

} // namespace
} // namespace tessemu
