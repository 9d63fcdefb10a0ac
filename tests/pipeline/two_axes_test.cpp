// Kernels of subdivision with more threads than one axis of a dispatch holds.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/subdivision.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

// Edges whose points are whole numbers, exact in every order of the sum: of edge i the vertices
// i mod 7 and others.
TEST(TwoAxes, EveryEdgeOfTheSecondRowOfGroupsHasItsPoint)
{
    constexpr std::uint32_t kOneAxis = kMaxDispatch * 64, kEdges = kOneAxis + 1000, kVertices = 7;
    SubdivisionTables t;
    t.edges = kEdges;
    t.vertices = kVertices;
    for (std::uint32_t e = 0; e < kEdges; ++e)
        for (std::uint32_t k : {0, 1, 2, 4}) t.edge_index.push_back((e + k) % kVertices);
    t.vertex_offset_valence.assign(2 * kVertices, 0);
    constexpr std::size_t kStride = RWVectorBuffer::kStride;
    std::vector<float> points(kStride * t.buffer_size(), -1);
    for (std::uint32_t v = 0; v < kVertices; ++v)
        for (std::uint32_t k = 0; k < 3; ++k) points[kStride * v + k] = float(4 * (v * v + k));
    CommandList list;
    add_subdivision(list, std::span(&t, 1), points, {});
    ListStatistics const statistics = run_commands(list, ThreadPool(2));
    ASSERT_EQ(statistics.commands.size(), 2u); // no face
    EXPECT_EQ(std::get<Dispatch>(list.commands[0]).groups,
              (std::array<std::uint32_t, 3>{kMaxDispatch, 2, 1}));
    EXPECT_EQ(statistics.commands[0].statistics.stages[0].fetches[0].count, 4u * kEdges);
    std::size_t wrong = 0;
    for (std::uint32_t e = 0; e < kEdges; ++e) {
        float const* const p = points.data() + kStride * (t.first_edge_point() + e);
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint32_t sum = 0;
            for (std::uint32_t j : {0, 1, 2, 4}) {
                std::uint32_t const v = (e + j) % kVertices;
                sum += v * v + k;
            }
            wrong += p[k] != float(sum);
        }
    }
    EXPECT_EQ(wrong, 0u);
    for (std::uint32_t v = 0; v < kVertices; ++v) // behind them, and untouched by other threads
        for (std::uint32_t k = 0; k < 3; ++k)
            EXPECT_EQ(points[kStride * (t.first_vertex_point() + v) + k], float(4 * (v * v + k)));
}

} // namespace
} // namespace tessemu
