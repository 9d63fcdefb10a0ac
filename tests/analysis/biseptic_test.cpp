// The biseptic scheme on whole cages: what it shares with stam, cracks and their absence.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/isolated_nets.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

namespace tessemu {
namespace {

using test::checked, test::patches_of;

SchemeOnMesh biseptic(ControlMesh mesh, ParameterTexts set = {})
{
    return build_scheme(find_scheme("biseptic"), std::move(mesh), {.set = std::move(set)});
}
ParameterTexts const kShared{{"edges", "shared"}};

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

// Whatever a compiler contracts: of mixed contraction 20 ways.
TEST(Biseptic, WithSharedEdgesIsClosedUnderAnyContraction)
{
    std::vector<std::pair<std::string, ControlMesh>> meshes{{"golem", load_model("golem").mesh}};
    for (int n : {3, 5, 8, 12})
        meshes.emplace_back("trapezohedron " + std::to_string(n), test::trapezohedron(n).mesh);
    for (auto const& [name, mesh] : meshes) {
        SchemeOnMesh const on = biseptic(mesh, kShared);
        for (int seed = -2; seed < 20; ++seed) {
            WatertightSettings s;
            s.frame.tess_factor = seed % 2 ? 6.6f : 5;
            Machine& machine = s.frame.machine;
            machine.contraction = seed == -2   ? Contraction::None
                                  : seed == -1 ? Contraction::All
                                               : Contraction::Mixed;
            machine.seed = std::uint64_t(std::max(seed, 0));
            expect_closed(on, s, name + ", " + std::to_string(seed));
        }
    }
}

class ClosedCages : public testing::TestWithParam<char const*> {};

TEST_P(ClosedCages, AreClosedWithSharedEdges)
{
    std::string const model = std::string("models/") + GetParam() + ".obj";
    TESSEMU_NEEDS_SHARED(model);
    SchemeOnMesh const on = biseptic(load_model(test::shared(model).string()).mesh, kShared);
    for (Contraction c : {Contraction::None, Contraction::All, Contraction::Mixed}) {
        WatertightSettings s;
        s.frame.tess_factor = 4.6f;
        s.frame.machine.contraction = c;
        s.frame.machine.seed = 7;
        expect_closed(on, s, GetParam());
    }
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
    for (ParameterTexts const& set : {ParameterTexts{}, kShared}) {
        EXPECT_EQ(beyond(biseptic(test::trapezohedron(12).mesh, set)), "");
        SchemeOnMesh const on = biseptic(test::trapezohedron(13).mesh, set);
        EXPECT_EQ(beyond(on),
                  "26 faces at a vertex of more than 12 edges are Gregory patches, not curvature "
                  "continuous: the derived basis is for vertices of 3 to 12 edges");
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
    for (ParameterTexts const& set : {ParameterTexts{}, kShared}) {
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

// It is another surface than the limit, but near it: docs/biseptic.md says how near on golem.
TEST(Biseptic, IsAsNearTheLimitSurfaceAsThePageSays)
{
    EqualParameterErrors const e =
        equal_parameter_errors(*biseptic(load_model("golem").mesh).patches, {}, 3, ThreadPool(2));
    ErrorStatistics const position = e.position_statistics(), normal = e.normal_statistics();
    RecordProperty("position_max", std::to_string(position.max));
    EXPECT_LE(position.max, 1.2e-3);
    EXPECT_GE(position.max, 1e-4); // no Catmull-Clark surface
    EXPECT_LE(normal.max, 0.06);
}

} // namespace
} // namespace tessemu
