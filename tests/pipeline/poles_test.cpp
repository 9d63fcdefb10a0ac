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

// A dome of quads whose top row of n vertices lies on one point; `drop` below it the next row.
ControlMesh dome(int n, double drop)
{
    ControlMesh m;
    double const radius[] = {0, 0.5, 1, 1.1}, height[] = {1, 1 - drop, 0.5, -0.4};
    for (int row = 0; row < 4; ++row)
        for (int j = 0; j < n; ++j) {
            double const a = 2 * 3.14159265358979323846 * j / n;
            m.positions.emplace_back(float(radius[row] * std::cos(a)),
                                     float(radius[row] * std::sin(a)), float(height[row]));
        }
    for (int row = 0; row < 3; ++row)
        for (int j = 0; j < n; ++j) {
            auto const v = [&](int r, int k) { return std::uint32_t(r * n + k % n); };
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
        {"pointed dome", dome(12, 0.3), {z}, {z}},
        {"dome with many segments", dome(40, 0.1), {z}, {z}},
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

// v/|v| in float, with a product's 3 roundings, a sum's, a root's, a quotient's and a product's: 8
// units of 2^-24 in each component, with a word to spare.
constexpr double kUnit = 16 * 0x1p-24;

TEST(Poles, NormalsThereAreOfUnitLengthAndTheSameFromAllPatches)
{
    ThreadPool const threads;
    for (Case const& c : cases())
        for (auto const& scheme : schemes()) {
            if (!test::takes(*scheme, c.mesh)) continue;
            SCOPED_TRACE(scheme->info().name + " on a " + c.name);
            SchemeOnMesh const m = build_scheme(*scheme, c.mesh);
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
                                ASSERT_NEAR(v.normal[j], c.normals[k][j], 1e-6);
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
    ControlMesh const mesh = dome(12, 0.3);
    SpineRig const rig(mesh);
    for (char const* name : {"gregory-stencil", "gregory-two-stage", "acc"}) {
        SchemeOnMesh const m = build_scheme(find_scheme(name), mesh);
        FrameSettings s;
        s.tess_factor = 5;
        auto const pose = std::make_shared<Pose>(rig.sway(0.3));
        s.pose = pose;
        glm::dvec3 area(0);
        for (std::size_t j = 0; j < 12; ++j) { // the top row is a triangle fan
            auto const at = [&](std::size_t v) {
                return glm::dvec3(pose->posed(v, mesh.positions[v]));
            };
            area += cross(at(12 + j) - at(0), at(12 + (j + 1) % 12) - at(0));
        }
        glm::dvec3 const expected = normalize(area), top(pose->posed(0, mesh.positions[0]));
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
        EXPECT_EQ(seen, 12u * 6) << name; // the points of twelve collapsed edges
    }
}

TEST(Poles, DisplacementLeavesNoDent)
{
    ThreadPool const threads;
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), dome(8, 0.1));
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
            EXPECT_NEAR(v.position.x, v.smooth.x, 1e-6);
        }
    };
    run_commands(m.patches->commands(surface_settings(s)), threads, options);
    EXPECT_GT(seen, 0u);
}

} // namespace
} // namespace tessemu
