// The scheme of tables on whole cages: the limit surface with all its tags, bit-exact edges, and
// the cracks that other sums have.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "analysis/watertight.h"
#include "io/model.h"
#include "pipeline/mesh/animation.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/bolz/table_pixel_shaders.h"
#include "tests/support/edges.h"
#include "tests/support/files.h"
#include "tests/support/limit_samples.h"
#include "tests/support/random_mesh.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <map>

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
    SchemeOnMesh const on = bolz(test::mesh_of_samples(test::shared(model)));
    ControlMesh const& base = on.mesh->base();
    std::map<MeshPoint, glm::vec3> vertices;
    visit_surface(*on.patches, segments(16), ThreadPool(0), [&](SurfacePatch const& p) {
        TessellatedPatch const& at = p.domain().patch;
        for (std::size_t i = 0; i < p.points(); ++i)
            vertices[mesh_point(base, p.place(), at.u[i], at.v[i])] = p.vertex(i).smooth;
    });
    test::LimitSamples const limit = test::read_limit_samples(test::shared(golden));
    std::size_t compared = 0;
    double worst = 0;
    for (auto const& sample : limit.samples) {
        PatchPlace place;
        place.face = sample.face;
        if (base.face(place.face).size() != 4) place.corner = std::uint16_t(sample.sub);
        auto const fixed = [](double x) { return std::uint32_t(x * 65536); };
        auto const found = vertices.find(mesh_point(base, place, fixed(sample.u), fixed(sample.v)));
        ASSERT_NE(found, vertices.end()) << sample.line;
        double const off = glm::length(glm::dvec3(found->second) - sample.position);
        worst = std::max(worst, off / limit.diagonal);
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
    for (std::uint32_t seed = 1; seed <= (test::kSlow ? 2 : 8); ++seed) {
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

// All tags infinite, for Biermann's rules know no others.
ControlMesh with_infinite_tags(ControlMesh mesh)
{
    for (auto& c : mesh.creases) c.sharpness = 10;
    for (auto& c : mesh.corners) c.sharpness = 10;
    return mesh;
}

// Three quads around a corner that they turn by more than half a circle.
ControlMesh l_shape()
{
    ControlMesh mesh;
    for (auto const& p : {glm::vec3(0, 0, 0),
                          {1, 0, 0},
                          {1, 1, .2f},
                          {0, 1, 0},
                          {-1, 1, 0},
                          {-1, 0, 0},
                          {-1, -1, .1f},
                          {0, -1, 0}})
        mesh.positions.push_back(p);
    for (auto const& f : {std::array<std::uint32_t, 4>{0, 1, 2, 3}, {0, 3, 4, 5}, {0, 5, 6, 7}})
        mesh.add_face(f);
    mesh.corners.push_back({0, 10});
    return mesh;
}

// A cube with four infinitely sharp edges at one face, and one of finite sharpness beside them.
ControlMesh half_sharp_cube(float other)
{
    ControlMesh mesh = test::cube().mesh;
    auto const top = mesh.face(0);
    for (std::size_t i = 0; i < 4; ++i) mesh.creases.push_back({top[i], top[(i + 1) % 4], 10});
    for (std::uint32_t f = 1; f < mesh.faces(); ++f)
        for (std::size_t i = 0; i < 4; ++i) {
            std::uint32_t const a = mesh.face(f)[i], b = mesh.face(f)[(i + 1) % 4];
            bool const leaves = (a == top[0]) != (b == top[0]);
            bool const beside = std::find(top.begin(), top.end(), a) != top.end() &&
                                std::find(top.begin(), top.end(), b) != top.end();
            if (!leaves || beside || other == 0) continue;
            mesh.creases.push_back({a, b, other});
            return mesh;
        }
    return mesh;
}

void expect_limit(ControlMesh const& mesh, ParameterTexts const& set, std::string const& what)
{
    SchemeOnMesh const on = bolz(mesh, set);
    EqualParameterErrors const e = equal_parameter_errors(*on.patches, {}, 3, ThreadPool(0));
    EXPECT_GT(e.position_statistics().samples, 50u) << what;
    EXPECT_LT(e.position_statistics().max, 5e-7) << what;
    // At corners of sides too: singles, and weights of theirs, turn a normal by some 1e-5.
    EXPECT_LT(e.normal_statistics().max, 1e-3) << what;
}

TEST(Bolz, HasTheNormalsOfAllSidesWhateverElseIsSharp)
{
    for (float other : {0.0f, 1.5f, 4.0f, 10.0f})
        expect_limit(half_sharp_cube(other), {}, "finite " + std::to_string(other));
    expect_limit(l_shape(), {}, "a corner of three faces");
}

TEST(Bolz, IsTheLimitSurfaceOfBiermannsRulesAtAnyFlatness)
{
    for (char const* flatness : {"", "0", "0.5", "1"}) {
        ParameterTexts set{{"rules", "biermann"}};
        if (*flatness) set.push_back({"flatness", flatness});
        std::string const what = std::string("flatness ") + flatness;
        expect_limit(l_shape(), set, what + ", L");
        expect_limit(half_sharp_cube(10), set, what + ", sharp cube");
        expect_limit(test::cube().mesh, set, what + ", cube");
        for (std::uint32_t seed = 1; seed <= (test::kSlow ? 0 : 2); ++seed) {
            SchemeOnMesh const on = bolz(
                with_infinite_tags(test::with_random_tags(test::random_mesh(seed), seed)), set);
            EqualParameterErrors const e =
                equal_parameter_errors(*on.patches, {}, 3, ThreadPool(0));
            EXPECT_LT(e.position_statistics().max, 5e-7) << what << ", seed " << seed;
        }
    }
}

// 40 infinitely sharp edges at a vertex, and faces back to back.
TEST(Bolz, ManySidesAndFoldsStayClosedWhenDisplaced)
{
    ControlMesh fan = test::trapezohedron(40).mesh;
    for (std::uint32_t f = 0; f < fan.faces(); ++f)
        for (std::size_t i = 0; i < 4; ++i)
            fan.creases.push_back({fan.face(f)[i], fan.face(f)[(i + 1) % 4], 10});
    ControlMesh envelope;
    for (auto const& p : {glm::vec3(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})
        envelope.positions.push_back(p);
    for (auto const& f : {std::array<std::uint32_t, 4>{0, 1, 2, 3}, {3, 2, 1, 0}})
        envelope.add_face(f);
    for (std::uint32_t i = 0; i < 4; ++i) envelope.creases.push_back({i, (i + 1) % 4, 10});
    for (ControlMesh const& mesh : {fan, envelope}) {
        SchemeOnMesh const on = bolz(mesh);
        WatertightSettings s;
        s.frame = segments(8);
        s.frame.displacement =
            std::make_shared<Displacement const>(Displacement::studs(0.1f, 0.02f));
        s.rays = 0;
        for (CheckedVerdict const& v : check_watertight(*on.patches, s, ThreadPool(0))) {
            if (v.name != "position" && v.name != "normal" && v.name != "displaced") continue;
            EXPECT_EQ(v.verdict, Verdict::Pass)
                << v.name << ' ' << (v.sites.empty() ? v.reason : v.sites[0].text);
        }
    }
}

// Level n's vertices are every 2^(5-n)th of level 5's, bit for bit (section 3's coordinates).
TEST(Bolz, CoarserLevelsSubsampleTheTables)
{
    EXPECT_EQ(PatchQuadVertexShader::of_level(5).low, 0.0f);
    EXPECT_EQ(PatchQuadVertexShader::of_level(5).high, 33.0f);
    EXPECT_EQ(PatchQuadVertexShader::of_level(4).low, -0.5f);
    EXPECT_EQ(PatchQuadVertexShader::of_level(4).high, 33.5f);
    EXPECT_EQ(PatchQuadVertexShader::of_level(0).low, -15.5f);
    EXPECT_EQ(PatchQuadVertexShader::of_level(0).high, 48.5f);
    SchemeOnMesh const on = bolz(with_infinite_tags(half_sharp_cube(10)));
    using Key =
        std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint16_t, std::uint16_t>;
    std::map<Key, std::array<glm::vec3, 2>> fine;
    std::size_t compared = 0;
    for (int n = 5; n >= 0; --n)
        visit_surface(
            *on.patches, segments(float(1 << n)), ThreadPool(0), [&](SurfacePatch const& p) {
                TessellatedPatch const& at = p.domain().patch;
                for (std::size_t i = 0; i < p.points(); ++i) {
                    PatchPlace const& place = p.place();
                    Key const key{place.face, at.u[i], at.v[i], place.i, place.j};
                    std::array<glm::vec3, 2> const v{p.vertex(i).position, p.vertex(i).normal};
                    if (n == 5) {
                        fine[key] = v;
                        continue;
                    }
                    EXPECT_EQ(fine.at(key), v);
                    ++compared;
                }
            });
    EXPECT_EQ(compared, 24u * (4 + 9 + 25 + 81 + 289));
}

std::vector<ControlMesh> tagged_cages()
{
    std::vector<ControlMesh> out;
    for (char const* name : {"golem", "jug", "saddle_star"}) out.push_back(load_model(name).mesh);
    for (std::uint32_t seed : {2u, 9u})
        out.push_back(test::with_random_tags(test::random_mesh(seed), seed));
    return out;
}

TEST(Bolz, SharedEdgesHaveEqualBitsAtAllLevelsUnderEveryContraction)
{
    ThreadPool const threads(0);
    for (ControlMesh const& mesh : tagged_cages()) {
        SchemeOnMesh const on = bolz(mesh);
        for (float n : test::kSlow ? std::vector{2.f, 8.f} : std::vector{1.f, 2.f, 4.f, 8.f, 32.f})
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
