// SPDX-License-Identifier: Apache-2.0
#include "emu/graph.h"

#include "emu/record.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

TEST(Graph, SharesEqualSubexpressionsAndFusesProducts)
{
    ExpressionGraph g;
    Graph const a = Graph::input(g), b = Graph::input(g);
    Graph const p = a * b, q = b * a; // one node
    Graph const s = p + q;
    (void)s;
    EXPECT_EQ(g.shared(), (FlopCount{.add = 1, .mul = 1}));
    EXPECT_EQ(g.fused(), (FlopCount{.add = 1, .mul = 1})); // the product has two uses
}

TEST(Graph, ADotProductIsOneMultiplicationAndTwoMads)
{
    ExpressionGraph g;
    auto const in = [&] { return Graph::input(g); };
    float3<Graph> const a(in(), in(), in()), b(in(), in(), in());
    (void)dot(a, b);
    EXPECT_EQ(g.shared(), (FlopCount{.add = 2, .mul = 3}));
    EXPECT_EQ(g.fused(), (FlopCount{.mul = 1, .mad = 2}));
}

TEST(Graph, FoldsConstants)
{
    ExpressionGraph g;
    Graph const x = Graph::input(g);
    (void)(x * (Graph(2) * Graph(3) - sqrt(Graph(4))));
    EXPECT_EQ(g.shared(), (FlopCount{.mul = 1}));
    EXPECT_EQ(g.nodes().back().op, ExpressionGraph::Op::Mul);
}

} // namespace
} // namespace tessemu
