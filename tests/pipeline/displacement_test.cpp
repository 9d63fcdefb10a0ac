// Displaced surfaces stay closed, and points move where they should.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/displaced.h"

#include "io/model.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/cages.h"
#include "tests/support/edges.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

void expect_closed_displaced(std::string const& model, std::string const& scheme)
{
    static HeightImage const image = test::noise(2048);
    ControlMesh mesh = load_model(model).mesh;
    test::add_charts(mesh);
    SchemeOnMesh const m = test::build_watertight(find_scheme(scheme), std::move(mesh));
    std::shared_ptr<Displacement const> const maps[] = {
        std::make_shared<Displacement>(Displacement::studs(0.1f, 0.05f)),
        std::make_shared<Displacement>(m.mesh, image, 0.05f)};
    for (Machine const& machine : test::contraction_policies())
        for (std::size_t i = 0; i < std::size(maps); ++i) {
            if (!test::meets_case(machine, i, std::size(maps))) continue;
            FrameSettings s;
            s.tess_factor = 7.3f;
            s.machine = machine;
            s.displacement = maps[i];
            test::EdgeComparison const c = test::compare_edges(*m.patches, s, ThreadPool());
            ASSERT_GT(c.shared_points, 100u);
            ASSERT_EQ(c.differing_positions, 0u)
                << model << " " << scheme << ": " << c.first_difference;
            ASSERT_EQ(c.differing_normals, 0u) << model << " " << scheme;
        }
}

TEST(Displacement, EverySchemeStaysClosedAcrossTextureSeams)
{
    if (test::kSlow) GTEST_SKIP() << "with sanitizers Determinism draws every scheme so";
    for (auto const& scheme : schemes())
        for (std::string const& model : test::models_of(*scheme))
            expect_closed_displaced(model, scheme->info().name);
}

// Where every face has a chart of its own, each patch's own coordinates would tear the surface.
TEST(Displacement, OwnCoordinatesDifferAcrossASeamAndOwnedOnesDoNot)
{
    ControlMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    mesh.add_face(std::array<std::uint32_t, 4>{0, 1, 4, 3});
    mesh.add_face(std::array<std::uint32_t, 4>{1, 2, 5, 4});
    mesh.coordinates = {{0, 0},     {.25f, 0},   {.25f, .25f}, {0, .25f},
                        {.5f, .5f}, {.75f, .5f}, {.75f, .75f}, {.5f, .75f}};
    mesh.face_coordinates = {0, 1, 2, 3, 4, 5, 6, 7};
    auto const refined = std::make_shared<RefinedMesh const>(mesh, 0, catmull_clark_step);
    Displacement const d(refined, test::noise(16), 1);
    // In texels: c 16 - 1/2, rows from the top. A pair's whole number is its face's, edge's or
    // vertex's.
    auto const at = [&](std::size_t corner, std::size_t pair, std::size_t k) {
        constexpr std::size_t kWhole[] = {4, 5, 5, 6};
        float const* const record = d.corners().data() + corner * OwnedCoordinates::kFloats;
        return record[2 * pair + k] + record[2 * kWhole[pair] + k];
    };
    // Edge 1-4 belongs to face 0: corners 1 and 2 there. Face 1 has it as corner 7 (vertex 4) to
    // corner 4 (vertex 1); canonical from vertex 1 to vertex 4.
    EXPECT_EQ(at(7, 0, 0), 7.5f); // own
    EXPECT_EQ(at(7, 1, 0), 3.5f); // owner at vertex 1
    EXPECT_EQ(at(7, 1, 1), 15.5f);
    EXPECT_EQ(at(7, 2, 1), 11.5f); // owner at vertex 4
    EXPECT_EQ(at(7, 3, 1), 11.5f); // vertex 4 belongs to face 0
    EXPECT_EQ(at(4, 3, 0), 3.5f);
    EXPECT_EQ(at(5, 1, 0), 11.5f); // an edge of face 1 alone
    for (std::size_t pair = 1; pair < 3; ++pair)
        for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(at(1, pair, k), at(7, pair, k));
}

// P' = P + scale h N of what the shader hands on, recomputed.
TEST(Displacement, MovesPointsAlongTheNormalByTheMap)
{
    ControlMesh mesh = load_model("jug").mesh;
    test::add_charts(mesh);
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), std::move(mesh));
    FrameSettings s;
    s.tess_factor = 5;
    s.displacement = std::make_shared<Displacement>(m.mesh, test::noise(32), 0.25f);
    HeightMap const map = s.displacement->height_map();
    std::size_t inside = 0, moved = 0;
    DrawStatistics const statistics =
        visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
            TessellatedPatch const& t = p.domain().patch;
            for (std::size_t i = 0; i < t.points(); ++i) {
                if (t.u[i] == 0 || t.v[i] == 0 || t.u[i] + t.v[i] == kFixedOne ||
                    t.u[i] == kFixedOne || t.v[i] == kFixedOne)
                    continue;
                ++inside;
                SurfaceVertex const at = p.vertex(i);
                float const h =
                    0.25f * map(float3<float>(at.smooth.x, at.smooth.y, at.smooth.z),
                                TexelPlace<float>{{0, 0}, {at.coordinates.x, at.coordinates.y}});
                // Coordinates, below 128 texels, are rounded on their way here, and from texel to
                // texel a height changes by 1 at most, across and down. The rest, of numbers below
                // 4, rounds a few times.
                for (int k = 0; k < 3; ++k)
                    ASSERT_NEAR(at.position[k], at.smooth[k] + h * at.normal[k],
                                0.25 * 2 * 0x1p-18 + 4 * 0x1p-23);
                moved += h != 0;
            }
        }).total;
    EXPECT_GT(inside, 1000u);
    EXPECT_GT(moved, inside * 9 / 10);
    // Every point reads four texels.
    for (StageStatistics const& stage : statistics.stages)
        for (FetchStatistics const& f : stage.fetches)
            if (f.resource == "height_map") {
                EXPECT_EQ(f.count, 4 * stage.invocations);
                EXPECT_EQ(f.kind, ResourceKind::Texture);
                EXPECT_EQ(f.bytes, 4 * f.count);
            }
}

TEST(Displacement, AMeshWithoutTextureCoordinatesTakesNoImage)
{
    ControlMesh const mesh = load_model("spindle").mesh;
    auto const refined = std::make_shared<RefinedMesh const>(mesh, 0, catmull_clark_step);
    EXPECT_THROW(Displacement(refined, test::noise(4), 1), Error);
    EXPECT_THROW(Displacement::studs(0, 1), Error);
}

} // namespace
} // namespace tessemu
