// Costs of the kernels of subdivision against those of a thread of each kind.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/subdivision_cost.h"

#include "io/model.h"
#include "pipeline/commands/patch_mesh.h"
#include "pipeline/mesh/catmull_clark.h"
#include "tests/support/random_mesh.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

std::vector<StepCost> costs(RefinedMesh const& m)
{
    return subdivision_cost(m.tables(), drawn_mesh(m, {}, ThreadPool(2)).statistics);
}

// Of a thread, docs/math/subdivision.md 1.5: adds, products (with quotients), index and vertex
// fetches.
struct ThreadCost {
    std::uint64_t add = 0, mul = 0, index = 0, vertex = 0;
    ThreadCost& operator+=(ThreadCost const& o)
    {
        add += o.add, mul += o.mul, index += o.index, vertex += o.vertex;
        return *this;
    }
    friend bool operator==(ThreadCost const&, ThreadCost const&) = default;
};
ThreadCost of_face(std::uint64_t m)
{
    return {3 * (m - 1), 3 + 1, 2 + m, m};
}
ThreadCost of_edge()
{
    return {9, 3, 4, 4};
}
ThreadCost of_vertex(std::uint64_t n)
{
    if (n == 0) return {0, 0, 2, 1};
    if (n == 1) return {6, 6, 4, 3};
    return {6 * n, 6 + 2, 2 + 2 * n, 1 + 2 * n};
}

ThreadCost counted(KernelCost const& k)
{
    EXPECT_EQ(k.fetched_bytes, 4 * k.index_fetches + 12 * k.vertex_fetches) << k.kernel;
    return {k.flops.add, flops_loop10(k.flops), k.index_fetches, k.vertex_fetches};
}

// LOOP10's figure 2: four triangles and a quad, four vertices of valence 3 and one of 4.
TEST(SubdivisionCost, OfThePyramid)
{
    ControlMesh m;
    for (int v = 0; v < 5; ++v) m.positions.emplace_back(v == 1 || v == 2, v == 0, v > 2);
    for (auto const& f :
         {std::vector<std::uint32_t>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {4, 3, 2, 1}})
        m.add_face(f);
    std::vector<StepCost> const steps = costs(RefinedMesh(m, 1, catmull_clark_step));
    ASSERT_EQ(steps.size(), 1u);
    EXPECT_EQ(std::tuple(steps[0].faces, steps[0].edges, steps[0].vertices), std::tuple(5, 8, 5));
    auto const& k = steps[0].kernels;
    ASSERT_EQ(k.size(), 3u);
    EXPECT_EQ(k[0].kernel, "face points");
    EXPECT_EQ(k[0].threads, 5u);
    EXPECT_EQ(counted(k[0]), (ThreadCost{33, 20, 26, 16}));
    EXPECT_EQ(k[0].gtx480, (LoopTurns{16, 5 * 4}));
    EXPECT_EQ(k[1].kernel, "edge points");
    EXPECT_EQ(counted(k[1]), (ThreadCost{72, 24, 32, 32}));
    EXPECT_EQ(k[1].gtx480, LoopTurns());
    EXPECT_EQ(k[2].kernel, "vertex points");
    EXPECT_EQ(counted(k[2]), (ThreadCost{96, 40, 42, 37}));
    EXPECT_EQ(k[2].radeon5870, (LoopTurns{16, 5 * 4}));
}

TEST(SubdivisionCost, IsTheSumOfItsThreadsAtEveryStep)
{
    for (ControlMesh const& mesh :
         {load_model("jug").mesh, load_model("saddle_star").mesh, test::prism(7)}) {
        RefinedMesh const m(mesh, 3, catmull_clark_step);
        std::vector<StepCost> const steps = costs(m);
        ASSERT_EQ(steps.size(), 3u);
        for (std::size_t s = 0; s < 3; ++s) {
            SubdivisionTables const& t = m.tables()[s];
            ThreadCost faces, edges, vertices;
            for (std::uint32_t f = 0; f < t.faces; ++f)
                faces += s ? of_edge() : of_face(t.face_offset_valence[2 * f + 1]);
            for (std::uint32_t e = 0; e < t.edges; ++e) edges += of_edge();
            for (std::uint32_t v = 0; v < t.vertices; ++v)
                vertices += of_vertex(t.vertex_offset_valence[2 * v + 1]);
            auto const& k = steps[s].kernels;
            ASSERT_EQ(k.size(), 3u);
            EXPECT_EQ(counted(k[0]), faces);
            EXPECT_EQ(counted(k[1]), edges);
            EXPECT_EQ(counted(k[2]), vertices);
        }
    }
}

TEST(SubdivisionCost, SemiSharpTagsHaveAKernelOfTheirOwnUntilTheyEnd)
{
    ControlMesh m = load_model("golem").mesh;
    m.creases.push_back({m.face(0)[0], m.face(0)[1], 1.5f});
    std::vector<StepCost> const steps = costs(RefinedMesh(m, 3, catmull_clark_step));
    ASSERT_EQ(steps.size(), 3u);
    std::size_t blended = 0;
    for (StepCost const& s : steps)
        if (s.kernels.back().kernel == "blended points") {
            ++blended;
            EXPECT_GT(s.kernels.back().threads, 0u);
            EXPECT_GE(s.kernels.back().gtx480.run, s.kernels.back().gtx480.needed);
        }
    EXPECT_EQ(blended, 1u) << "1.5 falls to 0.5 in the first step and ends in the second";
    EXPECT_EQ(steps[1].kernels.size(), 4u);
}

} // namespace
} // namespace tessemu
