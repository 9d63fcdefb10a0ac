// The biseptic scheme on whole cages: what it shares with stam, cracks and their absence.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/isolated_nets.h"
#include "tests/support/printed.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <tuple>

namespace tessemu {
namespace {

using test::checked, test::patches_of;

SchemeOnMesh biseptic(ControlMesh mesh, ParameterTexts set = {})
{
    return build_scheme(find_scheme("biseptic"), std::move(mesh), {.set = std::move(set)});
}

void expect_closed(SchemeOnMesh const& on, WatertightSettings const& s, std::string const& what)
{
    auto const verdicts = checked(*on.patches, s);
    for (char const* name : {"topology", "position", "normal"}) {
        CheckedVerdict const& v = verdicts.at(name);
        EXPECT_EQ(v.verdict, Verdict::Pass)
            << what << ": " << name << ": " << (v.sites.empty() ? "" : v.sites[0].text);
        EXPECT_GT(v.checked, 0u) << what << ": " << name;
    }
}

// None of -2, all of -1, mixed of other seeds.
Machine contracted(int seed)
{
    Machine machine;
    machine.contraction = seed == -2   ? Contraction::None
                          : seed == -1 ? Contraction::All
                                       : Contraction::Mixed;
    machine.seed = std::uint64_t(std::max(seed, 0));
    return machine;
}

// Whatever a compiler contracts: of mixed contraction 20 ways.
TEST(Biseptic, WithSharedEdgesIsClosedUnderAnyContraction)
{
    std::vector<std::pair<std::string, ControlMesh>> meshes{{"golem", load_model("golem").mesh}};
    for (int n : {3, 5, 8, 12})
        meshes.emplace_back("trapezohedron " + std::to_string(n), test::trapezohedron(n).mesh);
    for (auto const& [name, mesh] : meshes) {
        SchemeOnMesh const on = biseptic(mesh, test::kSharedEdges);
        for (int seed = -2; seed < 20; ++seed) {
            WatertightSettings s;
            s.frame.tess_factor = (seed + 3) % 3 ? 6.6f : 5;
            s.frame.machine = contracted(seed);
            expect_closed(on, s, name + ", " + std::to_string(seed));
        }
    }
}

class ClosedCages : public testing::TestWithParam<char const*> {};

TEST_P(ClosedCages, AreClosedWithSharedEdges)
{
    std::string const model = std::string("models/") + GetParam() + ".obj";
    TESSEMU_NEEDS_SHARED(model);
    SchemeOnMesh const on =
        biseptic(load_model(test::shared(model).string()).mesh, test::kSharedEdges);
    bool const small = on.mesh->mesh().faces() < 2000;
    for (int seed = -2; seed < (small ? 20 : 2); ++seed) {
        WatertightSettings s;
        s.frame.tess_factor = 4.6f;
        s.frame.machine = contracted(seed);
        expect_closed(on, s, GetParam() + (", " + std::to_string(seed)));
    }
    // Factors from the camera.
    WatertightSettings s;
    s.frame.camera = frame_points(on.mesh->base().positions, {0.5f, 0.4f, 1}, 1);
    s.frame.adaptive = {AdaptiveFactors::Kind::Pixels, 0.7f};
    expect_closed(on, s, GetParam() + std::string(", adaptive"));
}
INSTANTIATE_TEST_SUITE_P(Models, ClosedCages,
                         testing::Values("bigguy", "monsterfrog", "catmark_cube", "catmark_torus",
                                         "two_hole", "spot_control", "chamfer_cube",
                                         "fertility_quads"),
                         [](auto const& test) { return std::string(test.param); });

// LOOP10: "In joins between biseptic and bicubic patches, the shared boundary control points will
// not coincide". Spokes are another matter: both patches have their points with equal weights, and
// rows are summed in one order; but normals are each patch's own.
TEST(Biseptic, AsThePaperDrawsItCheckNamesOuterEdges)
{
    for (ControlMesh const& mesh : {load_model("golem").mesh, test::cylinder(6).mesh}) {
        SchemeOnMesh const on = biseptic(mesh);
        WatertightSettings s;
        s.frame.tess_factor = 7.3f;
        auto const verdicts = checked(*on.patches, s);
        EXPECT_EQ(verdicts.at("topology").verdict, Verdict::Pass);
        CheckedVerdict const &position = verdicts.at("position"), &normal = verdicts.at("normal");
        EXPECT_EQ(position.verdict, Verdict::Fail);
        EXPECT_EQ(normal.verdict, Verdict::Fail);
        EXPECT_NE(position.reason.find("differ on an outer edge"), position.reason.npos)
            << position.reason;
        EXPECT_EQ(position.reason.find("spoke"), position.reason.npos) << position.reason;
        EXPECT_NE(normal.reason.find("differ on a spoke"), normal.reason.npos) << normal.reason;
    }
}

TEST(Biseptic, AWarningCountsTheFacesBeyondItsValences)
{
    auto const beyond = [](SchemeOnMesh const& on) {
        for (std::string const& w : on.warnings)
            if (w.find("more than 12 edges") != std::string::npos) return w;
        return std::string();
    };
    for (ParameterTexts const& set : {ParameterTexts{}, test::kSharedEdges}) {
        EXPECT_EQ(beyond(biseptic(test::trapezohedron(12).mesh, set)), "");
        SchemeOnMesh const on = biseptic(test::trapezohedron(13).mesh, set);
        EXPECT_EQ(beyond(on), "26 patches at a vertex of more than 12 edges are Gregory patches, "
                              "not of one curvature "
                              "at the vertex: the derived basis is for vertices of 3 to 12 edges");
        EXPECT_EQ(patches_of(*on.patches, "Gregory quad"), 26u);
        EXPECT_EQ(patches_of(*on.patches, "biseptic quad of valence 3"), 26u * 3);
    }
    BuildOptions strict;
    strict.strict = true;
    EXPECT_THROW(build_scheme(find_scheme("biseptic"), test::trapezohedron(13).mesh, strict),
                 MeshError);
    EXPECT_TRUE(
        build_scheme(find_scheme("biseptic"), test::trapezohedron(12).mesh, strict).patches);
}

// Regular patches do not know which scheme is beside them.
TEST(Biseptic, RegularPatchesAreStams)
{
    ControlMesh const mesh = load_model("golem").mesh;
    for (ParameterTexts const& set : {ParameterTexts{}, test::kSharedEdges}) {
        std::map<std::tuple<std::uint32_t, int, int>, std::vector<float>> points[2];
        char const* const schemes[] = {"stam", "biseptic"};
        for (int i = 0; i < 2; ++i) {
            SchemeOnMesh const on = build_scheme(find_scheme(schemes[i]), mesh, {.set = set});
            FrameSettings s;
            s.tess_factor = 5.3f;
            visit_surface(*on.patches, s, ThreadPool(1), [&](SurfacePatch const& p) {
                if (p.kind().name != "regular quad") return;
                std::vector<float>& to =
                    points[i][{p.place().face, int(p.place().i), int(p.place().j)}];
                for (std::size_t k = 0; k < p.points(); ++k) {
                    SurfaceVertex const v = p.vertex(k);
                    for (int c = 0; c < 3; ++c) to.insert(to.end(), {v.position[c], v.normal[c]});
                }
            });
        }
        EXPECT_GT(points[0].size(), 0u);
        EXPECT_EQ(points[0], points[1]);
    }
}

// Closed edges are the surface's own: both ways differ by roundings. A sum of K = 2n + 60 terms is
// off by K units of 2^-24 of its size at most, and as roundings go by sqrt(K), which is asked for
// here, of the largest coordinate. Normals: a tangent is 7 differences of such points, over its
// length, a third of the shortest edge at least. Stam's normals, which the extraordinary vertex must
// not have, are further away than twice that.
TEST(Biseptic, SharedEdgesAreTheSurfacesOwn)
{
    ControlMesh const mesh = load_model("golem").mesh;
    std::map<std::tuple<std::uint32_t, int, int>, std::vector<SurfaceVertex>> paper;
    double apart = 0, turned = 0, turned_from_stams = 0, largest = 0, shortest = INFINITY;
    std::size_t compared = 0;
    FrameSettings s;
    s.tess_factor = 5;
    auto const each = [&](SchemeOnMesh const& on, auto const& work) {
        visit_surface(*on.patches, s, ThreadPool(1), [&](SurfacePatch const& p) {
            auto& known = paper[{p.place().face, int(p.place().i), int(p.place().j)}];
            for (std::size_t i = 0; i < p.points(); ++i) work(known, i, p.vertex(i));
        });
    };
    SchemeOnMesh const as_is = biseptic(mesh), shared = biseptic(mesh, test::kSharedEdges),
                       stam = build_scheme(find_scheme("stam"), mesh);
    ControlMesh const refined = drawn_mesh(*as_is.mesh, {}, ThreadPool(1)).mesh;
    for (std::size_t f = 0; f < refined.faces(); ++f)
        for (std::size_t k = 0; k < 4; ++k) {
            glm::vec3 const a = refined.positions[refined.face(f)[k]],
                            b = refined.positions[refined.face(f)[(k + 1) % 4]];
            shortest = std::min(shortest, double(glm::length(a - b)));
            for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(double(a[c])));
        }
    each(as_is, [&](auto& known, std::size_t, SurfaceVertex const& v) { known.push_back(v); });
    each(shared, [&](auto& known, std::size_t i, SurfaceVertex const& v) {
        apart = std::max(apart, double(glm::length(v.position - known.at(i).position)));
        turned = std::max(turned, double(glm::length(v.normal - known.at(i).normal)));
        ++compared;
    });
    each(stam, [&](auto& known, std::size_t i, SurfaceVertex const& v) {
        bool const corner = known.at(i).position == v.position; // a limit point of both
        if (corner)
            turned_from_stams =
                std::max(turned_from_stams, double(glm::length(v.normal - known.at(i).normal)));
    });
    double const unit = std::sqrt(2 * 6 + 60) * 0x1p-24 * largest,
                 turn = 2 * 7 * unit / (shortest / 3);
    EXPECT_GT(compared, 1000u);
    EXPECT_LE(apart, unit);
    EXPECT_LE(turned, turn);
    EXPECT_GT(turned_from_stams, 2 * turn);
    RecordProperty("worst", std::to_string(apart / unit) + ", " + std::to_string(turned / turn) +
                                ", " + std::to_string(turned_from_stams / turn));
}

// It is another surface than the limit, but near it: docs/biseptic.md says how near on golem.
TEST(Biseptic, IsAsNearTheLimitSurfaceAsThePageSays)
{
    EqualParameterErrors const e =
        equal_parameter_errors(*biseptic(load_model("golem").mesh).patches, {}, 3, ThreadPool(2));
    ErrorStatistics const position = e.position_statistics(), normal = e.normal_statistics();
    RecordProperty("position_max", std::to_string(position.max));
    // "At equal (u, v) points are up to 1.1e-3 apart", normals 0.06 of a radian.
    EXPECT_TRUE(test::printed("1.1e-3").rounds_from(position.max)) << position.max;
    EXPECT_TRUE(test::printed("0.06").rounds_from(normal.max)) << normal.max;
}

} // namespace
} // namespace tessemu
