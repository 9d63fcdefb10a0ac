// Adaptive levels of table-driven patches as they are drawn: closed to the bit, and as close to the
// limit surface as asked.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "analysis/watertight.h"
#include "io/model.h"
#include "pipeline/mesh/placement.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace tessemu {
namespace {

SchemeOnMesh adaptive(ControlMesh mesh, std::string const& distance, int subdivide = 0)
{
    return build_scheme(find_scheme("bolz"), std::move(mesh),
                        {.subdivide = subdivide, .set = {{"adapt", distance}}});
}

std::map<std::string, ControlMesh> cages()
{
    std::map<std::string, ControlMesh> out;
    for (char const* name : {"golem", "jug"}) out.emplace(name, load_model(name).mesh);
    out.emplace("torus", test::torus(8, 5).mesh);
    out.emplace("tagged cube", test::tagged_cube());
    return out;
}

WatertightSettings settings_of(ControlMesh const& mesh)
{
    WatertightSettings out;
    out.frame.width = out.frame.height = 192;
    out.frame.camera = frame_points(mesh.positions, {0.4f, 0.3f, 1}, 1);
    out.rays = 3000;
    return out;
}

void expect_closed(SchemeOnMesh const& on, WatertightSettings const& settings,
                   std::string const& about)
{
    std::set<std::string> passed;
    for (CheckedVerdict const& v : check_watertight(*on.patches, settings, ThreadPool(0))) {
        EXPECT_NE(v.verdict, Verdict::Fail)
            << about << ": " << v.name << " " << (v.sites.empty() ? v.reason : v.sites[0].text);
        if (v.verdict == Verdict::Pass) passed.insert(v.name);
    }
    std::vector<std::string> expected{"position", "normal"};
    // With one segment everywhere there is no point inside an edge.
    if (on.patches->level_counts()[0] < on.patches->mesh().mesh().faces())
        expected.push_back("topology");
    for (std::string const& name : expected)
        EXPECT_TRUE(passed.count(name)) << about << ": " << name;
    if (settings.frame.displacement) {
        EXPECT_TRUE(passed.count("displaced")) << about;
    }
}

std::set<std::size_t> levels_of(SchemeOnMesh const& on)
{
    std::set<std::size_t> out;
    std::vector<std::uint64_t> const counts = on.patches->level_counts();
    for (std::size_t i = 0; i < counts.size(); ++i)
        if (counts[i]) out.insert(i);
    return out;
}

TEST(BolzAdaptive, IsClosedAtAllDistances)
{
    for (auto const& [name, mesh] : cages()) {
        std::set<std::size_t> used;
        for (char const* distance : {"1e-2", "1e-3", "1e-4"}) {
            SchemeOnMesh const on = adaptive(mesh, distance);
            used.merge(levels_of(on));
            expect_closed(on, settings_of(mesh), name + ", " + distance);
        }
        EXPECT_GE(used.size(), 3u) << name;
    }
}

TEST(BolzAdaptive, IsClosedUnderEveryContractionAndDisplaced)
{
    for (auto const& [name, mesh] : cages()) {
        SchemeOnMesh const on = adaptive(mesh, "1e-3");
        WatertightSettings settings = settings_of(mesh);
        settings.rays = 0;
        float const diagonal = float(bounding_box_diagonal(mesh));
        settings.frame.displacement = std::make_shared<Displacement const>(
            Displacement::studs(diagonal / 16, 0.01f * diagonal));
        settings.frame.machine.contraction = Contraction::All;
        expect_closed(on, settings, name + ", all");
        settings.frame.machine.contraction = Contraction::Mixed;
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            settings.frame.machine.seed = seed;
            expect_closed(on, settings, name + ", mixed:" + std::to_string(seed));
        }
    }
}

TEST(BolzAdaptive, LiesWithinTheDistanceOfTheLimitSurface)
{
    for (auto const& [name, mesh] : cages())
        for (double distance : {1e-2, 1e-3}) {
            SchemeOnMesh const on = adaptive(mesh, std::to_string(distance));
            SurfaceComparison const c = compare_with_limit(*on.patches, {}, 4, ThreadPool(0));
            EXPECT_GT(c.from_limit.samples, 1000u) << name;
            EXPECT_LE(c.from_limit.max, distance) << name;
            EXPECT_LT(c.equal_position.max, 5e-7) << name; // vertices are on it
        }
}

TEST(BolzAdaptive, LevelsAreOfTheMeshAtRestAndOfNoTessFactor)
{
    SchemeOnMesh const on = adaptive(load_model("jug").mesh, "1e-3");
    std::set<std::size_t> points;
    for (float factor : {1.0f, 64.0f}) {
        FrameSettings frame;
        frame.tess_factor = factor;
        std::size_t count = 0;
        visit_surface(*on.patches, frame, ThreadPool(0),
                      [&](SurfacePatch const& p) { count += p.points(); });
        points.insert(count);
    }
    EXPECT_EQ(points.size(), 1u);
    SchemeOnMesh const uniform = build_scheme(find_scheme("bolz"), load_model("jug").mesh);
    EXPECT_TRUE(uniform.patches->level_counts().empty());
}

TEST(BolzAdaptive, WarnsWhereTheTablesEndBeforeTheDistance)
{
    SchemeOnMesh const near = adaptive(test::tagged_cube(), "1e-9");
    ASSERT_FALSE(near.warnings.empty());
    EXPECT_NE(near.warnings.back().find("single precision"), std::string::npos);
    // A sharp bend on patches that are large.
    std::string said;
    for (std::string const& w : adaptive(test::tagged_cube(), "2e-5").warnings) said += w;
    EXPECT_NE(said.find("--subdivide"), std::string::npos) << said;
    EXPECT_NE(said.find("adapt=2e-05: "), std::string::npos) << said;
    for (std::string const& w : adaptive(load_model("golem").mesh, "1e-2").warnings)
        EXPECT_EQ(w.find("adapt="), std::string::npos) << w;
}

class SharedCages : public testing::TestWithParam<std::string> {};

TEST_P(SharedCages, AreClosedWithSeveralLevels)
{
    std::string const model = "models/" + GetParam() + ".obj";
    TESSEMU_NEEDS_SHARED(model);
    ControlMesh const mesh = load_model(test::shared(model).string()).mesh;
    std::set<std::size_t> used;
    for (char const* distance : {"1e-2", "1e-3", "1e-4"}) {
        SchemeOnMesh const on = adaptive(mesh, distance);
        used.merge(levels_of(on));
        WatertightSettings settings = settings_of(mesh);
        if (distance == std::string("1e-3")) {
            float const diagonal = float(bounding_box_diagonal(mesh));
            settings.frame.displacement = std::make_shared<Displacement const>(
                Displacement::studs(diagonal / 16, 0.005f * diagonal));
            settings.frame.machine = {kNativeLanes, Contraction::Mixed, 3};
        }
        expect_closed(on, settings, GetParam() + ", " + distance);
    }
    EXPECT_GE(used.size(), 3u);
}

INSTANTIATE_TEST_SUITE_P(BolzAdaptive, SharedCages,
                         testing::Values("catmark_car", "bigguy", "canyon_grid"));

} // namespace
} // namespace tessemu
