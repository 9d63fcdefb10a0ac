// The scheme of tables on whole cages: the limit surface with all its tags, bit-exact edges, and the
// cracks that other sums have.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "analysis/watertight.h"
#include "io/model.h"
#include "pipeline/mesh/animation.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/edges.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"
#include "tests/support/random_mesh.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <map>
#include <sstream>

namespace tessemu {
namespace {

SchemeOnMesh bolz(ControlMesh mesh, ParameterTexts set = {}, int subdivide = 0)
{
    return build_scheme(find_scheme("bolz"), std::move(mesh),
                        {.subdivide = subdivide, .set = std::move(set)});
}

FrameSettings segments(float n)
{
    FrameSettings out;
    out.tess_factor = n;
    return out;
}

// Limit positions, of the cages' tags, by OpenSubdiv.
class TaggedSamples : public testing::TestWithParam<std::string> {};

// A float sum of 44 weights errs by about 1e-7 of the diagonal: 22 roundings of half an ulp of
// sums that reach the diagonal's size, weights' own 22 at random.
TEST_P(TaggedSamples, AreVerticesOfTheDraw)
{
    std::string const name = GetParam(),
                      model = "models/" + name.substr(0, name.find('.')) + ".obj",
                      golden = "golden/limit/" + name + ".csv.gz";
    TESSEMU_NEEDS_SHARED(model);
    TESSEMU_NEEDS_SHARED(golden);
    ControlMesh mesh = load_model(test::shared(model).string()).mesh;
    if (test::read_text(test::shared(model)).find("t interpolateboundary") == std::string::npos)
        mesh.rules.boundary = BoundaryRule::EdgeOnly; // as the samples have it
    SchemeOnMesh const on = bolz(mesh);
    ControlMesh const& base = on.mesh->base();
    std::map<MeshPoint, glm::vec3> vertices;
    visit_surface(*on.patches, segments(16), ThreadPool(0), [&](SurfacePatch const& p) {
        TessellatedPatch const& at = p.domain().patch;
        for (std::size_t i = 0; i < p.points(); ++i)
            vertices[mesh_point(base, p.place(), at.u[i], at.v[i])] = p.vertex(i).smooth;
    });
    std::istringstream in(test::read_gzip(test::shared(golden)));
    std::string line;
    std::getline(in, line);
    double const diagonal = std::stod(line.substr(line.find("bbox_diag=") + 10));
    std::getline(in, line);
    std::size_t compared = 0;
    double worst = 0;
    while (std::getline(in, line)) {
        double c[7];
        std::istringstream row(line);
        for (double& x : c) {
            row >> x;
            row.ignore();
        }
        PatchPlace place;
        place.face = std::uint32_t(c[0]);
        if (base.face(place.face).size() != 4) place.corner = std::uint16_t(c[1]);
        auto const fixed = [](double x) { return std::uint32_t(x * 65536); };
        auto const found = vertices.find(mesh_point(base, place, fixed(c[2]), fixed(c[3])));
        ASSERT_NE(found, vertices.end()) << line;
        double const off = glm::length(glm::dvec3(found->second) - glm::dvec3(c[4], c[5], c[6]));
        worst = std::max(worst, off / diagonal);
        ++compared;
    }
    EXPECT_GT(compared, 20u);
    // The reference is no better there.
    EXPECT_LT(worst, name.starts_with("catmark_inf_crease0") ? 1e-4 : 5e-7) << compared;
}

INSTANTIATE_TEST_SUITE_P(
    Cages, TaggedSamples,
    testing::Values("catmark_cube_corner0.dyadic", "catmark_cube_corner4.dyadic",
                    "catmark_cube_creases2.dyadic", "catmark_dart_edgeonly.dyadic",
                    "catmark_edgecorner.dyadic", "catmark_edgeonly.dyadic",
                    "catmark_hole_test1.dyadic", "catmark_inf_crease0.dyadic",
                    "catmark_pawn.dyadic", "catmark_pyramid_creases0.dyadic", "catmark_rook.dyadic",
                    "catmark_smoothtris0.dyadic", "catmark_tent_creases0.dyadic",
                    "catmark_torus_creases0.dyadic", "spot_control.dyadic", "two_hole.dyadic"),
    [](auto const& test) {
        std::string name = test.param;
        for (char& c : name)
            if (c == '.') c = '_';
        return name;
    });

TEST(Bolz, IsTheLimitSurfaceOfRandomTaggedMeshes)
{
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        ControlMesh const mesh =
            test::with_random_tags(test::join_faces(test::random_mesh(seed), seed), seed);
        SchemeOnMesh const on = bolz(mesh);
        EqualParameterErrors const e = equal_parameter_errors(*on.patches, {}, 3, ThreadPool(0));
        EXPECT_GT(e.position_statistics().samples, 100u);
        EXPECT_LT(e.position_statistics().max, 5e-7) << seed;
        // Away from poles, whose normals are a choice, singles know a normal to about 1e-3 at the
        // corners of small faces.
        EXPECT_LT(quantile(e.angle, e.weight, 0.99), 1e-3) << seed;
    }
}

std::vector<ControlMesh> tagged_cages()
{
    std::vector<ControlMesh> out;
    for (char const* name : {"golem", "jug", "saddle_star"}) out.push_back(load_model(name).mesh);
    for (std::uint32_t seed : {2u, 5u, 9u})
        out.push_back(test::with_random_tags(test::random_mesh(seed), seed));
    return out;
}

TEST(Bolz, SharedEdgesHaveEqualBitsAtAllLevelsUnderEveryContraction)
{
    ThreadPool const threads(0);
    for (ControlMesh const& mesh : tagged_cages()) {
        SchemeOnMesh const on = bolz(mesh);
        for (float n : {1.f, 2.f, 4.f, 8.f, 16.f, 32.f})
            for (Machine const& machine : test::contraction_policies(n == 4 ? 20 : 1)) {
                WatertightSettings s;
                s.frame = segments(n);
                s.frame.machine = machine;
                s.frame.width = s.frame.height = 16;
                s.rays = 0;
                auto const verdicts = check_watertight(*on.patches, s, threads);
                for (CheckedVerdict const& v : verdicts) {
                    if (v.name != "topology" && v.name != "position" && v.name != "normal")
                        continue;
                    EXPECT_NE(v.verdict, Verdict::Fail)
                        << mesh.name << ' ' << n << ' ' << v.name << ' '
                        << (v.sites.empty() ? "" : v.sites[0].text);
                    EXPECT_TRUE(v.checked > 0 || (n == 1 && v.name == "topology")) << mesh.name;
                }
            }
    }
}

TEST(Bolz, DisplacedAndPosedSurfacesAreClosedAtCreasesToo)
{
    ThreadPool const threads(0);
    for (ControlMesh const& mesh : tagged_cages()) {
        SchemeOnMesh const on = bolz(mesh);
        float const size = float(bounding_box_diagonal(on.mesh->base()));
        for (Machine const& machine : test::contraction_policies(3)) {
            WatertightSettings s;
            s.frame = segments(8);
            s.frame.machine = machine;
            s.frame.width = s.frame.height = 16;
            s.frame.displacement =
                std::make_shared<Displacement const>(Displacement::studs(size / 16, 0.03f * size));
            s.frame.pose = std::make_shared<Pose const>(SpineRig(on.mesh->base()).sway(0.3));
            s.rays = 0;
            for (CheckedVerdict const& v : check_watertight(*on.patches, s, threads)) {
                if (v.name != "position" && v.name != "normal" && v.name != "displaced") continue;
                EXPECT_EQ(v.verdict, Verdict::Pass) << mesh.name << ' ' << v.name << ' '
                                                    << (v.sites.empty() ? "" : v.sites[0].text);
                EXPECT_GT(v.checked, 100u);
            }
        }
    }
}

TEST(Bolz, EachSideOfAnInfinitelySharpEdgeHasItsNormal)
{
    ControlMesh mesh = test::cube().mesh;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
        for (std::size_t i = 0; i < 4; ++i)
            mesh.creases.push_back({mesh.face(f)[i], mesh.face(f)[(i + 1) % 4], 10});
    SchemeOnMesh const on = bolz(mesh);
    EXPECT_TRUE(on.patches->has_creases());
    // The limit is the cube itself, whose edges part every point on them.
    visit_surface(*on.patches, segments(4), ThreadPool(0), [&](SurfacePatch const& p) {
        for (std::size_t i = 0; i < p.points(); ++i) {
            glm::vec3 const n = glm::abs(p.vertex(i).normal);
            EXPECT_GT(std::max({n.x, n.y, n.z}), 1 - 1e-6f); // weights round
        }
    });
    WatertightSettings s;
    s.frame = segments(4);
    s.rays = 0;
    auto const verdicts = check_watertight(*on.patches, s, ThreadPool(0));
    EXPECT_EQ(verdicts[2].verdict, Verdict::Pass);
    // 12 edges of 7 points each and 8 corners.
    EXPECT_TRUE(verdicts[2].reason.find("92 points on infinitely sharp edges") != std::string::npos)
        << verdicts[2].reason;
}

TEST(Bolz, TheOrderOfTheTablesCracks)
{
    SchemeOnMesh const on = bolz(load_model("golem").mesh, {{"order", "table"}});
    WatertightSettings s;
    s.frame = segments(8);
    s.rays = 0;
    auto const verdicts = check_watertight(*on.patches, s, ThreadPool(0));
    EXPECT_EQ(verdicts[1].name, "position");
    EXPECT_EQ(verdicts[1].verdict, Verdict::Fail);
    EXPECT_EQ(verdicts[2].verdict, Verdict::Fail);
}

} // namespace
} // namespace tessemu
