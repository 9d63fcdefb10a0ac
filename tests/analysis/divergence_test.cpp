// Turns of loops, counted by hand.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/divergence.h"

#include "io/model.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/sort_by_valence.h"

#include <gtest/gtest.h>

#include <random>

namespace tessemu {
namespace {

// Rows of these valences, whose offsets nobody asks for.
std::vector<std::uint32_t> rows(std::initializer_list<std::uint32_t> valences)
{
    std::vector<std::uint32_t> out;
    for (std::uint32_t v : valences) out.insert(out.end(), {0, v});
    return out;
}

SubdivisionTables tables_of_faces(std::initializer_list<std::uint32_t> sides)
{
    SubdivisionTables t;
    t.faces = std::uint32_t(sides.size());
    t.face_offset_valence = rows(sides);
    return t;
}

SubdivisionTables tables_of_vertices(std::initializer_list<std::uint32_t> valences)
{
    SubdivisionTables t;
    t.vertices = std::uint32_t(valences.size());
    t.vertex_offset_valence = rows(valences);
    return t;
}

TEST(Divergence, AGroupOfFacesRunsAsLongAsItsLargest)
{
    // 4 + 4 waits for 4; 3 + 5 for 5; 3 is alone.
    SubdivisionTables const t = tables_of_faces({4, 4, 3, 5, 3});
    EXPECT_EQ(divergence(t, 2).face_points, (LoopTurns{19, 2 * 4 + 2 * 5 + 1 * 3}));
    EXPECT_EQ(divergence(t, 4).face_points, (LoopTurns{19, 4 * 5 + 1 * 3}));
    EXPECT_EQ(divergence(t, 32).face_points, (LoopTurns{19, 5 * 5}));
    EXPECT_EQ(divergence(t, 1).face_points, (LoopTurns{19, 19}));
    EXPECT_EQ(divergence(t, 1).face_points.lost(), 0);
    EXPECT_EQ(divergence(t, 32).face_points.lost(), 6.0 / 25);
}

TEST(Divergence, VerticesOnCurvesTakeTheOtherSideOfABranch)
{
    // Both sides: 5 turns for those inside, one for the curve's; a corner waits for all.
    EXPECT_EQ(divergence(tables_of_vertices({5, 1, 0, 4}), 4).vertex_points,
              (LoopTurns{10, 4 * (5 + 1)}));
    // One side alone.
    EXPECT_EQ(divergence(tables_of_vertices({1, 1, 0, 1}), 4).vertex_points, (LoopTurns{3, 4}));
    EXPECT_EQ(divergence(tables_of_vertices({0, 0, 0, 0}), 4).vertex_points, (LoopTurns{0, 0}));
    EXPECT_EQ(divergence(tables_of_vertices({0, 0, 0, 0}), 4).vertex_points.lost(), 0);
    // Sorted, so that groups are of one kind.
    EXPECT_EQ(divergence(tables_of_vertices({5, 1, 4, 1}), 2).vertex_points,
              (LoopTurns{11, 2 * 6 + 2 * 5}));
    EXPECT_EQ(divergence(tables_of_vertices({1, 1, 4, 5}), 2).vertex_points,
              (LoopTurns{11, 2 * 1 + 2 * 5}));
}

TEST(Divergence, QuadsByTheEdgeKernelHaveNoLoopToDiffer)
{
    SubdivisionTables t;
    t.faces = 7;
    EXPECT_EQ(divergence(t, 4).face_points, (LoopTurns{28, 28}));
}

TEST(Divergence, BlendedPointsRunAsManyTermsAsTheLongest)
{
    SubdivisionTables t;
    t.blended.target = {0, 1, 2};
    t.blended.first = {0, 4, 6, 13}; // 4, 2, 7 terms
    EXPECT_EQ(divergence(t, 2).blended_points, (LoopTurns{13, 2 * 4 + 7}));
}

TEST(Divergence, NeedsOfACageAreItsCornersInWhateverOrder)
{
    for (char const* model : {"golem", "spindle"}) { // closed: no vertex on a curve
        ControlMesh const mesh = load_model(model).mesh;
        SubdivisionTables const t = catmull_clark_step(Topology(mesh)).tables;
        ControlMesh const by_valence = sort_by_valence(mesh, t);
        SubdivisionTables const sorted = catmull_clark_step(Topology(by_valence)).tables;
        for (int width : {1, 4, kWarpOfGtx480, kWavefrontOfRadeon5870})
            for (StepDivergence const& d : {divergence(t, width), divergence(sorted, width)})
                for (LoopTurns const& turns : {d.face_points, d.vertex_points}) {
                    EXPECT_EQ(turns.needed, mesh.face_vertices.size()) << model;
                    EXPECT_GE(turns.run, turns.needed) << model;
                }
    }
}

// In full groups of one side of the branch: no other order has so small a sum of largest ones.
TEST(Divergence, NoOrderLosesLessThanTheSorted)
{
    std::mt19937 random(5);
    for (int trial = 0; trial < 100; ++trial) {
        std::vector<std::uint32_t> sides;
        for (int i = 0; i < 64; ++i) sides.push_back(3 + random() % 7);
        auto const run = [&](std::vector<std::uint32_t> const& order) {
            SubdivisionTables t;
            t.faces = std::uint32_t(order.size());
            for (std::uint32_t n : order)
                t.face_offset_valence.insert(t.face_offset_valence.end(), {0, n});
            return divergence(t, 8).face_points.run;
        };
        std::vector<std::uint32_t> sorted = sides;
        std::sort(sorted.begin(), sorted.end());
        EXPECT_LE(run(sorted), run(sides));
        EXPECT_LT(run(sorted), 64u * 9);
    }
}

TEST(Divergence, AWidthBelowOneIsRefused)
{
    EXPECT_THROW(divergence({}, 0), Error);
}

} // namespace
} // namespace tessemu
