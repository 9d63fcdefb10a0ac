// Schemes of isolated nets on whole cages: what is drawn in another way, cracks and their absence.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "analysis/mistakes.h"
#include "io/model.h"
#include "pipeline/mesh/animation.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/isolated_nets.h"
#include "tests/support/printed.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

namespace tessemu {
namespace {

using test::all_choices, test::boundary_faces, test::checked, test::patches_of,
    test::with_valence_two;

class IsolatedNets : public testing::TestWithParam<char const*> {
protected:
    SchemeOnMesh build(ControlMesh mesh, ParameterTexts set = {}) const
    {
        return build_scheme(find_scheme(GetParam()), std::move(mesh), {.set = std::move(set)});
    }
};
INSTANTIATE_TEST_SUITE_P(Schemes, IsolatedNets, testing::Values("stam", "biseptic"),
                         [](auto const& test) { return std::string(test.param); });

// Faces at the boundary are counted; all others are the limit surface.
TEST_P(IsolatedNets, OnOpenCagesTheFacesAtTheBoundaryAreGregoryPatches)
{
    for (char const* name : {"jug", "saddle_star", "grid"}) {
        ControlMesh const mesh =
            name == std::string("grid") ? test::grid(5, 4).mesh : load_model(name).mesh;
        for (ParameterTexts const& choices : all_choices()) {
            SCOPED_TRACE(std::string(name) + ", " + choices[0].second);
            SchemeOnMesh const on = build(mesh, choices);
            std::size_t const expected = boundary_faces(on.mesh->topology());
            EXPECT_EQ(patches_of(*on.patches, "Gregory quad"), expected);
            std::size_t warnings = 0;
            for (std::string const& w : on.warnings)
                warnings += w.find(std::to_string(expected) +
                                   " patches at the boundary are Gregory patches") == 0;
            EXPECT_EQ(warnings, expected ? 1u : 0u);
            BuildOptions strict;
            strict.strict = true;
            strict.set = choices;
            if (expected) {
                EXPECT_THROW(build_scheme(find_scheme(GetParam()), mesh, strict), MeshError);
            }
        }
    }
    // Two quads in from the boundary of a flat grid nothing but B-splines reaches.
    SchemeOnMesh const on = build(test::grid(5, 4).mesh);
    std::size_t exact = 0;
    visit_surface(*on.patches, {}, ThreadPool(1),
                  [&](SurfacePatch const& p) { exact += p.kind().name == "regular quad"; });
    EXPECT_EQ(exact, (2 * 5 - 2) * (2 * 4 - 2));
}

// They are gregory-stencil's of the same refined mesh, to the bit.
TEST_P(IsolatedNets, FacesAtTheBoundaryAreThoseOfGregoryStencil)
{
    struct Cage {
        ControlMesh mesh;
        int steps;
    };
    for (Cage const& cage : {Cage{load_model("jug").mesh, 2}, Cage{test::grid(5, 4).mesh, 1}}) {
        FrameSettings s;
        s.tess_factor = 5.3f;
        std::map<std::tuple<std::uint32_t, int, int, int, int>, std::vector<float>> gregory;
        auto const each = [&](PatchMesh const& patches, auto const& work) {
            visit_surface(patches, s, ThreadPool(1), [&](SurfacePatch const& p) {
                if (p.kind().name != "Gregory quad") return;
                PatchPlace const& at = p.place();
                std::vector<float> points;
                for (std::size_t i = 0; i < p.points(); ++i) {
                    SurfaceVertex const v = p.vertex(i);
                    for (int k = 0; k < 3; ++k)
                        points.insert(points.end(), {v.position[k], v.normal[k]});
                }
                work(std::tuple(at.face, int(at.corner), int(at.i), int(at.j), int(at.rotation)),
                     points);
            });
        };
        SchemeOnMesh const reference =
            build_scheme(find_scheme("gregory-stencil"), cage.mesh, {.subdivide = cage.steps});
        each(*reference.patches, [&](auto const& at, auto const& points) { gregory[at] = points; });
        for (ParameterTexts const& choices : all_choices()) {
            SchemeOnMesh const on = build(cage.mesh, choices);
            std::size_t compared = 0;
            each(*on.patches, [&](auto const& at, auto const& points) {
                ASSERT_TRUE(gregory.count(at));
                EXPECT_EQ(points, gregory[at]);
                ++compared;
            });
            EXPECT_EQ(compared, boundary_faces(on.mesh->topology()));
        }
    }
}

TEST_P(IsolatedNets, AtAVertexOfTwoEdgesAreGregoryPatches)
{
    ControlMesh const mesh = with_valence_two();
    for (ParameterTexts const& choices : all_choices()) {
        SchemeOnMesh const on = build(mesh, choices);
        EXPECT_EQ(patches_of(*on.patches, "Gregory quad"), 4u * 2);
        std::size_t warnings = 0;
        for (std::string const& w : on.warnings)
            warnings += w.find("8 patches at a vertex of 2 edges are Gregory patches") == 0;
        EXPECT_EQ(warnings, 1u);
    }
}

// The page's table, to the digit.
TEST_P(IsolatedNets, AsThePaperDrawsItAsManyPointsDifferAsThePageSays)
{
    TESSEMU_NEEDS_SHARED("models/bigguy.obj");
    TESSEMU_NEEDS_SHARED("models/monsterfrog.obj");
    std::size_t cells_compared = 0;
    for (auto const& cells :
         test::table_of("docs/" + std::string(GetParam()) + ".md", "| | spokes | outer edges")) {
        ASSERT_EQ(cells.size(), 4u);
        std::string const model = cells[0].substr(0, cells[0].find(',')),
                          verdict = cells[0].substr(model.size() + 2);
        WatertightSettings s;
        s.frame.tess_factor = 7.3f;
        SchemeOnMesh const on =
            build(load_model(test::shared("models/" + model + ".obj").string()).mesh);
        auto const verdicts = checked(*on.patches, s);
        std::string const& reason =
            verdicts.at(verdict.substr(0, verdict.size() - 1)).reason; // "positions"
        char const* const where[] = {"on a spoke", "on an outer edge",
                                     "at corners and on other edges"};
        for (std::size_t k = 0; k < 3; ++k) {
            std::string const& cell = cells[k + 1];
            std::size_t const of = cell.find(" of ");
            ASSERT_NE(of, cell.npos);
            std::string const words =
                cell.substr(0, of) + " points" + cell.substr(of) + " differ " + where[k];
            if (cell.substr(0, of) == "0")
                EXPECT_EQ(reason.find(std::string("differ ") + where[k]), reason.npos) << reason;
            else
                EXPECT_NE(reason.find(words), reason.npos) << words << " is not in: " << reason;
            ++cells_compared;
        }
    }
    EXPECT_EQ(cells_compared, 12u);
}

// Adaptive factors agree all the same: they follow the cage's edges, or the cubics of shared ones.
TEST_P(IsolatedNets, PatchesAgreeOnAdaptiveFactors)
{
    for (char const* name : {"golem", "jug", "spindle"})
        for (ParameterTexts const& choices : all_choices()) {
            SchemeOnMesh const on = build(load_model(name).mesh, choices);
            WatertightSettings s;
            s.frame.camera = frame_points(on.mesh->base().positions, {0.5f, 0.4f, 1}, 1);
            s.frame.adaptive = {AdaptiveFactors::Kind::Pixels, 0.5f};
            auto const verdicts = checked(*on.patches, s);
            std::vector<char const*> all{"topology"};
            if (choices[0].second == "shared") all.insert(all.end(), {"position", "normal"});
            for (char const* verdict : all)
                EXPECT_EQ(verdicts.at(verdict).verdict, Verdict::Pass)
                    << name << ", " << choices[0].second << ", " << choices[1].second << ": "
                    << verdict;
        }
}

// All points of all shared edges, plain and displaced, at rest and in a pose, under contraction:
// every kind of patch beside every other.
TEST_P(IsolatedNets, WithSharedEdgesAllHolds)
{
    std::vector<std::pair<std::string, ControlMesh>> meshes;
    for (char const* name : {"golem", "jug", "spindle", "saddle_star"})
        meshes.emplace_back(name, load_model(name).mesh);
    meshes.emplace_back("trapezohedron 13", test::trapezohedron(13).mesh);
    meshes.emplace_back("valence 2", with_valence_two());
    for (auto const& [name, mesh] : meshes)
        for (char const* regular : {"bezier", "bspline"}) {
            ParameterTexts choices = test::kSharedEdges;
            choices.emplace_back("regular", regular);
            SchemeOnMesh const on = build(mesh, choices);
            auto const pose = std::make_shared<Pose>(SpineRig(on.mesh->base()).sway(0.3));
            for (int i = 0; i < 6; ++i) {
                WatertightSettings s;
                s.frame.tess_factor = i % 2 ? 6.6f : 3;
                s.frame.machine.contraction = Contraction(i % 3);
                s.frame.machine.seed = std::uint64_t(i);
                s.frame.displacement =
                    std::make_shared<Displacement>(Displacement::studs(0.2f, 0.02f));
                if (i >= 3) s.frame.pose = pose;
                auto const verdicts = checked(*on.patches, s);
                for (char const* verdict : {"topology", "position", "normal", "displaced"}) {
                    CheckedVerdict const& v = verdicts.at(verdict);
                    EXPECT_EQ(v.verdict, Verdict::Pass)
                        << name << ", " << regular << ", " << i << ": " << verdict << ": "
                        << (v.sites.empty() ? "" : v.sites[0].text);
                }
            }
        }
}

// Mistakes of shared edges have no place where edges are not shared.
TEST_P(IsolatedNets, AsThePaperDrawsItMistakesOfSharedEdgesAreRefused)
{
    SchemeOnMesh const on = build(load_model("golem").mesh);
    for (Mistake m : {Mistake::Order, Mistake::Contraction, Mistake::Normals, Mistake::Weights})
        EXPECT_THROW(with_mistake(*on.patches, plant_mistake(*on.mesh, m), {}), Error);
}

} // namespace
} // namespace tessemu
