// Patches with more inputs than a patch of Direct3D 11 has, or a vertex of more edges than output
// registers hold: a dispatch makes their control points, with the bits of the patches beside them.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/stencil_form.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/animation.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/cages.h"
#include "tests/support/edges.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessemu {
namespace {

struct Cage {
    test::Shape shape;
    std::size_t wide_stencils, wide_rings; ///< patches
    int inputs, edges;                     ///< the most of a patch, and at a vertex
};

// A face of a trapezohedron has a pole of valence n, whose ring holds the whole equator, and
// vertices of the equator, whose rings hold the other pole: 2n + 2 inputs. A face of a fan has all
// vertices.
std::vector<Cage> cages()
{
    return {
        {test::trapezohedron(15), 0, 0, 32, 15},    {test::trapezohedron(16), 32, 32, 34, 16},
        {test::trapezohedron(33), 66, 66, 68, 33},  {test::trapezohedron(200), 400, 400, 402, 200},
        {test::uv_sphere(32, 5), 64, 64, 37, 32},   {test::open_fan(33, true), 33, 33, 68, 34},
        {test::open_fan(40, false), 40, 40, 42, 41}};
}

std::string warning_of(SchemeOnMesh const& m, std::string const& word)
{
    for (std::string const& w : m.warnings)
        if (w.find(word) != std::string::npos) return w;
    return {};
}

TEST(WidePatches, SharedPointsHaveEqualBitsUnderEveryContraction)
{
    ThreadPool const threads;
    int drawn = 0;
    for (Cage const& cage : cages())
        for (auto const& scheme : schemes()) {
            if (!test::takes(*scheme, cage.shape.mesh)) continue;
            SCOPED_TRACE(scheme->info().name + " on " + cage.shape.name + " of " +
                         std::to_string(cage.edges));
            SchemeOnMesh const m = test::build_watertight(*scheme, cage.shape.mesh);
            auto const rig = SpineRig(m.mesh->base());
            for (Machine const& machine : test::contraction_policies(4))
                for (bool const animated : {false, true}) {
                    if (!test::meets_case(machine, animated, 2)) continue;
                    FrameSettings s;
                    s.tess_factor = 3;
                    s.machine = machine;
                    if (animated) s.pose = std::make_shared<Pose>(rig.sway(0.3));
                    test::EdgeComparison const c = test::compare_edges(*m.patches, s, threads);
                    ASSERT_GT(c.shared_points, 0u);
                    ASSERT_EQ(c.differing_positions, 0u) << c.first_difference;
                    ASSERT_EQ(c.differing_normals, 0u) << c.first_difference;
                    if (cage.shape.closed) {
                        ASSERT_EQ(c.lonely_points, 0u);
                    }
                }
            ++drawn;
        }
    // Both Gregory forms, Stam, biseptic, bolz and Catmull-Clark's tables, ACC where all faces are
    // quads, where nothing is wide Pm, and of triangles alone Loop's and Butterfly's tables, QAS, PN
    // triangles, Phong and flat ones.
    EXPECT_EQ(drawn, 6 * 7 + 5 + 1 + 6);
}

TEST(WidePatches, AWarningCountsThem)
{
    for (Cage const& cage : cages()) {
        SCOPED_TRACE(cage.shape.name + " of " + std::to_string(cage.edges));
        auto const expect_warning = [&](char const* scheme, std::size_t patches,
                                        std::string const& what) {
            EXPECT_EQ(warning_of(build_scheme(find_scheme(scheme), cage.shape.mesh), "dispatch"),
                      patches ? std::to_string(patches) + " patches have " + what : "");
        };
        expect_warning("gregory-stencil", cage.wide_stencils,
                       "more than 32 inputs (up to " + std::to_string(cage.inputs) +
                           "): a dispatch sums their control points before the draw");
        expect_warning("gregory-two-stage", cage.wide_rings,
                       "a vertex of more than 15 edges (up to " + std::to_string(cage.edges) +
                           "): a dispatch makes their corners before the draw");
    }
}

// Corners of the schemes here lie on the limit surface.
TEST(WidePatches, CornersAreLimitPoints)
{
    ThreadPool const threads;
    for (int n : {16, 33, 200})
        for (char const* name : {"gregory-stencil", "gregory-two-stage", "acc"}) {
            SCOPED_TRACE(std::string(name) + " at valence " + std::to_string(n));
            SchemeOnMesh const m = build_scheme(find_scheme(name), test::trapezohedron(n).mesh);
            std::vector<glm::dvec3> const limit = [&] {
                // LOOP09 3.3: the pole's limit point, (n - 3) v + 4/n sum (m_j + c_j), over n + 5.
                std::vector<glm::dvec3> out;
                ControlMesh const& mesh = m.mesh->mesh();
                for (std::uint32_t pole : {0u, 1u}) {
                    glm::dvec3 const v(mesh.positions[pole]);
                    glm::dvec3 sum(0);
                    for (HalfEdge h : m.mesh->topology().ring(pole)) {
                        auto const face = mesh.face(m.mesh->topology().face_of(h));
                        for (std::uint32_t i : face) sum += 0.25 * glm::dvec3(mesh.positions[i]);
                        std::uint32_t const d =
                            m.mesh->topology().vertex_of(m.mesh->topology().next(h));
                        sum += 0.5 * (v + glm::dvec3(mesh.positions[d]));
                    }
                    out.push_back((double(n - 3) * v + 4.0 / n * sum) / double(n + 5));
                }
                return out;
            }();
            FrameSettings s;
            s.tess_factor = 1;
            // Coordinates are at most 1. p has weights that add up to 1, but for valences below 3
            // none negative: 2n + 1 terms, or as many roundings of the ring's sums.
            double const bound = (2 * n + 8) * 0x1p-24;
            int corners = 0;
            CommandOptions options;
            options.visit = [&](SurfacePatch const& p) {
                for (std::size_t i = 0; i < p.points(); ++i) {
                    glm::dvec3 const at(p.vertex(i).position);
                    std::size_t const pole = at.z > 0 ? 0 : 1;
                    if (at.x * at.x + at.y * at.y > 0.01) continue;
                    ++corners;
                    for (int k = 0; k < 3; ++k) EXPECT_NEAR(at[k], limit[pole][k], bound);
                }
            };
            run_commands(m.patches->commands(surface_settings(s)), threads, options);
            EXPECT_EQ(corners, 2 * n);
        }
}

TEST(WidePatches, AStageCountsWhatTheyCost)
{
    SchemeOnMesh const m =
        build_scheme(find_scheme("gregory-stencil"), test::uv_sphere(32, 5).mesh);
    ListStatistics const s = run_commands(m.patches->commands(surface_settings({})), ThreadPool(1));
    std::size_t dispatches = 0;
    for (CommandStatistics const& c : s.commands)
        if (c.kind == "dispatch") {
            EXPECT_EQ(c.name, "stencils");
            dispatches += c.number;
        }
    EXPECT_EQ(dispatches, 1u);
    for (StageStatistics const& stage : s.total.stages)
        if (stage.stage == "compute_shader") {
            // 64 triangles of 15 points, 12 rows of edges and 6 of corners, in groups of 64.
            EXPECT_EQ(stage.invocations, 64u * 33);
            auto const& tables = dynamic_cast<StencilForm const&>(*m.patches).tables();
            ASSERT_EQ(tables.wide.size(), 1u);
            EXPECT_EQ(stage.flops.mul, 3 * tables.wide[0].weights.size());
        }
}

TEST(WidePatches, ALimitThatStaysIsNamed)
{
    try {
        build_scheme(find_scheme("pm"), test::trapezohedron(16).mesh);
        FAIL();
    } catch (MeshError const& e) {
        EXPECT_EQ(e.face, 0u);
        EXPECT_STREQ(e.what(), "pm draws vertices of at most 15 edges: vertex 1 of face 1 has 16; "
                               "schemes that draw this mesh: gregory-stencil, gregory-two-stage, "
                               "acc, stam, biseptic, bolz, tables-catmull-clark, tables-loop, "
                               "tables-butterfly, qas, pn-triangles, phong, flat");
    }
    try {
        build_scheme(find_scheme("gregory-stencil"), test::uv_sphere(2049, 3).mesh);
        FAIL();
    } catch (MeshError const& e) {
        EXPECT_STREQ(e.what(), "gregory-stencil draws vertices of at most 2048 edges: vertex 1 of "
                               "face 1 has 2049; schemes that draw this mesh: "
                               "qas, pn-triangles, phong, flat");
    }
    // A step of subdivision makes a vertex of each face.
    try {
        build_scheme(find_scheme("pm"), test::cylinder(32).mesh);
        FAIL();
    } catch (MeshError const& e) {
        EXPECT_NE(std::string(e.what()).find("makes one of 32 in face 33"), std::string::npos)
            << e.what();
    }
}

TEST(WidePatches, StrictRefusesThem)
{
    BuildOptions strict;
    strict.strict = true;
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"}) try {
            build_scheme(find_scheme(scheme), test::uv_sphere(32, 5).mesh, strict);
            FAIL() << scheme;
        } catch (MeshError const& e) {
            EXPECT_EQ(e.face, 0u);
            EXPECT_NE(std::string(e.what()).find("--strict refuses"), std::string::npos);
        }
    EXPECT_TRUE(build_scheme(find_scheme("acc"), test::trapezohedron(15).mesh, strict).patches);
}

} // namespace
} // namespace tessemu
