// SPDX-License-Identifier: Apache-2.0
#include "emu/graph.h"

#include "emu/memory.h"
#include "emu/tally.h"
#include "emu/texture.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace tessemu {
namespace {

using Op = ExpressionGraph::Op;

TEST(Graph, SharesEqualSubexpressionsAndFusesProducts)
{
    ExpressionGraph g;
    Graph const a = Graph::input(g), b = Graph::input(g);
    Graph const p = a * b, q = b * a; // one node
    Graph const s = p + q;
    (void)s;
    EXPECT_EQ(g.shared(), (FlopCount{.add = 1, .mul = 1}));
    EXPECT_EQ(g.fused(), (FlopCount{.add = 1, .mul = 1})); // the product has two uses
    EXPECT_EQ(g.written(), (FlopCount{.add = 1, .mul = 2}));
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

TEST(Graph, AProductThatIsComparedIsNotFused)
{
    ExpressionGraph g;
    Graph const a = Graph::input(g), p = a * a;
    (void)select(p > Graph(0), p + a, a);
    EXPECT_EQ(g.fused(), (FlopCount{.add = 1, .mul = 1, .compare = 1}));
}

TEST(Graph, FoldsConstantsAsFloats)
{
    ExpressionGraph g;
    Graph const x = Graph::input(g);
    (void)(x * (Graph(2) * Graph(3) - sqrt(Graph(4))));
    EXPECT_EQ(g.shared(), (FlopCount{.mul = 1}));
    EXPECT_EQ(g.written(), (FlopCount{.mul = 1}));
    EXPECT_EQ(g.nodes().back().op, Op::Mul);
    EXPECT_EQ(Graph(Graph(0.1) * Graph(0.3)).constant, 0.1f * 0.3f);
    EXPECT_EQ(mad(Graph(0.1), Graph(0.3), Graph(-0.1f * 0.3f)).constant,
              mad(0.1f, 0.3f, -0.1f * 0.3f));
    Graph const a(-2.5), b(0.3);
    EXPECT_EQ(Graph(a - b).constant, -2.5f - 0.3f);
    EXPECT_EQ(Graph(a / b).constant, -2.5f / 0.3f);
    EXPECT_EQ(Graph(-a).constant, 2.5f);
    EXPECT_EQ(abs(a).constant, 2.5f);
    EXPECT_EQ(floor(a).constant, -3.0f);
    EXPECT_EQ(min(a, b).constant, -2.5f);
    EXPECT_EQ(max(a, b).constant, 0.3f);
}

TEST(Graph, KeepsTheSignOfAZeroAndFindsANanAgain)
{
    ExpressionGraph g;
    Graph const x = Graph::input(g);
    EXPECT_NE(Graph(x + Graph(0.0f)).id, Graph(x + Graph(-0.0f)).id);
    Graph const nan(__builtin_nanf(""));
    EXPECT_EQ(Graph(x + nan).id, Graph(x + nan).id);
}

// Every operation that a shader may use.
template <class T> void every_operation(T x, T y)
{
    T const two(2);
    (void)(x + y), (void)(two - x), (void)(x * x), (void)(y / x), (void)-y;
    (void)mad(x, two, y), (void)mad(two, two, y), (void)sqrt(x), (void)floor(y), (void)abs(x);
    (void)min(x, two), (void)max(two, y);
    (void)(x < y), (void)(two > y), (void)(x <= y), (void)(x >= two), (void)(x == y);
    (void)select(x != y, x, y);
    (void)(two + two), (void)(two < two), (void)sqrt(two), (void)mad(two, two, two);
}

TEST(Graph, CountsAsWrittenWhatATallyCounts)
{
    ExpressionGraph g;
    every_operation(Graph::input(g), Graph::input(g));
    FlopCount const tallied =
        tally([](FlopCount* sink) { every_operation(Tally(1.0, sink), Tally(1.0, sink)); });
    EXPECT_EQ(g.written(), tallied);
    EXPECT_EQ(tallied,
              (FlopCount{.add = 2, .mul = 1, .mad = 2, .div = 1, .sqrt = 1, .compare = 8}));
    EXPECT_EQ(g.shared().compare, 7u); // x == y and x != y are one
}

TEST(GraphComparison, ARecordedValueIsAboveConstantsAndAboveWhatWasRecordedBefore)
{
    ExpressionGraph g;
    Graph const c(1e30f), x = Graph::input(g), y = Graph::input(g);
    Graph const rising[] = {c, x, y, x + y};
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            EXPECT_EQ(rising[i] < rising[k], i < k);
            EXPECT_EQ(rising[i] > rising[k], i > k);
            EXPECT_EQ(rising[i] <= rising[k], i <= k);
            EXPECT_EQ(rising[i] >= rising[k], i >= k);
            EXPECT_EQ(rising[i] == rising[k], i == k);
            EXPECT_EQ(rising[i] != rising[k], i != k);
        }
    EXPECT_EQ(select(x > c, x, y).id, x.id);
    EXPECT_EQ(select(x < c, x, y).id, y.id);
}

TEST(GraphComparison, ConstantsCompareAsNumbers)
{
    Graph const one(1), two(2), nan(__builtin_nanf(""));
    EXPECT_TRUE(one < two && one <= two && two > one && two >= one && one == one && one != two);
    EXPECT_FALSE(two < one || two <= one || one > two || one >= two || one == two || one != one);
    EXPECT_TRUE(nan != nan);
    EXPECT_FALSE(nan == nan || nan < one || nan <= one || nan > one || nan >= one);
}

// The branches of when() that a recording follows, and a loop.
template <class T> T branches(T x)
{
    T s = T(0);
    for (int i : loop<T>(3)) s = s + T(float(i)) * x;
    s = when(
        x == T(0), [&] { return sqrt(s); }, s);
    return when(
        x > T(0), [&] { return s / x; }, s);
}

TEST(GraphComparison, WhenRecordsTheSideThatIsFollowedAndNothingOfTheOther)
{
    ExpressionGraph g;
    Graph const r = branches(Graph::input(g));
    EXPECT_EQ(g.nodes()[std::size_t(r.id)].op, Op::Div);
    EXPECT_EQ(g.written(), (FlopCount{.add = 3, .mul = 3, .div = 1, .compare = 2}));
}

// ---- memory

template <class T> struct Point {
    float3<T> position;
    T weight;
    static constexpr auto signature() { return std::tuple{&Point::position, &Point::weight}; }
};
template <class T> struct Pair {
    static constexpr int kVectors = 2;
    std::array<float3<T>, 2> vectors;
    static constexpr auto signature() { return std::tuple{&Pair::vectors}; }
};

TEST(GraphMemory, AFetchOfTheSameControlPointGivesTheSameNodes)
{
    ExpressionGraph g;
    ControlPoints<Point<Graph>> const patch(g, 3), other(g, 3);
    Point<Graph> const p = patch[2], again = patch[2];
    EXPECT_EQ(p.position.x.id, again.position.x.id);
    EXPECT_EQ(p.weight.id, again.weight.id);
    std::set<int> ids;
    for (Point<Graph> const& q : {patch[1], patch[2], other[2]})
        for (Graph const& s : {q.position.x, q.position.y, q.position.z, q.weight})
            ids.insert(s.id);
    EXPECT_EQ(ids.size(), 12u);
    EXPECT_EQ(g.loads(), 3u);
    EXPECT_EQ(g.written(), FlopCount{});
}

TEST(GraphMemory, AVectorIsTheSameNodesAloneAndInItsRecord)
{
    ExpressionGraph g;
    ControlPoints<Pair<Graph>> const sectors(g, 4);
    float3<Graph> const v = sectors.vector(3, 1);
    EXPECT_EQ(g.loads(), 1u);
    EXPECT_EQ(g.nodes()[std::size_t(v.z.id)],
              (ExpressionGraph::Node{Op::Fetch, 0, 3 * 2 + 1, 2})); // vector 7 of view 0, z
    EXPECT_EQ(v.z.id, sectors[3].vectors[1].z.id);
    EXPECT_EQ(g.loads(), 2u);
    EXPECT_NE(v.x.id, sectors.vector(3, 0).x.id);
    EXPECT_NE(v.x.id, sectors.vector(2, 1).x.id);
    EXPECT_EQ(g.loads(), 3u);
}

TEST(GraphMemory, ALoadIsKnownByItsSlotAndIndex)
{
    ExpressionGraph g;
    std::vector<float> const table{1, 1, 1};
    Buffer<float> const a(table, 0, "a", &g), b(table, 1, "b", &g);
    EXPECT_EQ(load<Graph>(a, 1).id, load<Graph>(a, 1).id);
    EXPECT_NE(load<Graph>(a, 1).id, load<Graph>(a, 2).id);
    EXPECT_NE(load<Graph>(a, 1).id, load<Graph>(b, 1).id);
    EXPECT_EQ(g.loads(), 3u);
}

TEST(GraphMemory, AnIntegerIsRecordedAndFollowed)
{
    ExpressionGraph g;
    std::vector<std::uint32_t> const starts{5, 7};
    Buffer<std::uint32_t> const buffer(starts, 0, "starts", &g);
    EXPECT_EQ(load<Graph>(buffer, 1), 7);
    EXPECT_EQ(load<Graph>(buffer, 1), 7);
    EXPECT_EQ(g.loads(), 1u);
}

TEST(GraphMemory, AConstantBuffersConstantIsOneNodeAndNoLoad)
{
    ExpressionGraph g;
    std::vector<float> const first{1, 2, 3}, second{1, 2, 3};
    ConstantBuffer<float> const a(first, &g), again(first, &g), b(second, &g);
    Graph const one = load<Graph>(a, 1);
    EXPECT_EQ(g.nodes()[std::size_t(one.id)], (ExpressionGraph::Node{Op::Uniform, 0, 1}));
    EXPECT_EQ(one.id, load<Graph>(again, 1).id);
    EXPECT_NE(one.id, load<Graph>(a, 2).id);
    EXPECT_NE(one.id, load<Graph>(b, 1).id);
    EXPECT_EQ(g.nodes().size(), 3u);
    EXPECT_EQ(g.loads(), 0u);
    EXPECT_EQ(g.written(), FlopCount{});
}

TEST(GraphMemory, ATexelIsOneLoadOfFourNodesWhoseOperandsAreThePoint)
{
    ExpressionGraph g;
    Texture2D const a(std::span<float const>(), 4, 4, 2, "a", 1, 1, &g),
        b(std::span<std::byte const>(), Format::R32_FLOAT, 4, 4, 4, 3, "b", &g);
    Graph const x = Graph::input(g), y = Graph::input(g);
    float4<Graph> const t = fetch_texel<Graph>(a, {x, y + x});
    std::set<int> const ids{t.x.id, t.y.id, t.z.id, t.w.id};
    EXPECT_EQ(ids.size(), 4u);
    auto const& n = g.nodes()[std::size_t(t.z.id)];
    EXPECT_EQ(n.op, Op::Texel);
    EXPECT_EQ(n.a, x.id);
    EXPECT_EQ(n.c, 2);
    EXPECT_EQ(g.nodes()[std::size_t(n.b)].op, Op::Add);
    EXPECT_EQ(g.loads(), 1u);
    EXPECT_EQ(fetch_texel<Graph>(a, {x, y + x}).w.id, t.w.id);
    EXPECT_EQ(g.loads(), 1u);
    EXPECT_NE(fetch_texel<Graph>(b, {x, y + x}).w.id, t.w.id);
    EXPECT_NE(fetch_texel<Graph>(a, {y + x, x}).w.id, t.w.id);
    EXPECT_EQ(g.loads(), 3u);
    // Load by number is a texel at a constant point.
    float4<Graph> const l = load<Graph>(a, 1, 2);
    auto const& m = g.nodes()[std::size_t(l.x.id)];
    EXPECT_EQ(g.nodes()[std::size_t(m.a)].constant(), 1.0f);
    EXPECT_EQ(g.nodes()[std::size_t(m.b)].constant(), 2.0f);
    EXPECT_NE(load<Graph>(a, 1, 2, 1).x.id, l.x.id);
    EXPECT_NE(load<Graph>(a, 1, 2, 0, 1).x.id, l.x.id);
    // A product that a texel's point takes as well is not fused.
    Graph const p = x * y;
    (void)fetch_texel<Graph>(a, {p, y});
    (void)(p + x);
    EXPECT_EQ(g.fused(), (FlopCount{.add = 2, .mul = 1}));
}

TEST(GraphMemory, WithoutARecordingMemoryHoldsConstants)
{
    std::vector<float> const colors{5, 6, 7, 8};
    EXPECT_EQ(
        fetch_texel<Graph>(Texture2D(colors, 1, 1, 0, "t"), {Graph(0.5f), Graph(0.5f)}).z.constant,
        7);
    EXPECT_EQ(load<Graph>(ConstantBuffer<float>(colors), 3).constant, 8);
    EXPECT_EQ(load<Graph>(ConstantBuffer<float>(colors), 4).constant, 0); // R141
    std::vector<float> const numbers{1, 2, 3, 4};
    Buffer<float> const buffer(numbers, 0, "numbers");
    EXPECT_EQ(load<Graph>(buffer, 2).graph, nullptr);
    EXPECT_EQ(load<Graph>(buffer, 2).constant, 3);
    EXPECT_EQ(load<Graph>(buffer, 9).constant, 0); // R142
    ControlPoints<Point<Graph>> const patch(numbers.data(), 1);
    EXPECT_EQ(patch[0].weight.graph, nullptr);
    EXPECT_EQ(patch[0].weight.constant, 4);
}

// A row of a table of weights times the control points.
struct TableSum {
    Buffer<float> weights;
    Buffer<std::uint32_t> starts;

    template <class T> float3<T> operator()(ControlPoints<float3<T>> const& points, int row) const
    {
        std::int32_t const first = load<T>(starts, row);
        float3<T> sum = load<T>(weights, first) * points[0];
        for (int i : loop<T>(points.size() - 1))
            sum = sum + load<T>(weights, first + i + 1) * points[i + 1];
        return sum;
    }
};

TEST(GraphMemory, ASumOverATableLoadsEachWeightAndPointOnceAndFusesAllProductsButTheFirst)
{
    for (int n : {1, 2, 9, 14}) {
        std::vector<float> weights(std::size_t(n + 3));
        std::iota(weights.begin(), weights.end(), 1.0f);
        std::vector<float> const points(std::size_t(3 * n), 0.25f);
        std::vector<std::uint32_t> const starts{0, 3};

        ExpressionGraph g;
        TableSum const recorded{{weights, 0, "w", &g}, {starts, 1, "s", &g}};
        ControlPoints<float3<Graph>> const control(g, n);
        float3<Graph> const sum = recorded.operator()<Graph>(control, 1);
        auto const N = std::uint64_t(n);
        EXPECT_EQ(g.loads(), 2 * N + 1); // and where the row starts
        EXPECT_EQ(g.written(), (FlopCount{.add = 3 * (N - 1), .mul = 3 * N}));
        EXPECT_EQ(g.shared(), g.written());
        // Each of the n - 1 sums of a component takes one product; the first has two to choose
        // from, so one product stays.
        EXPECT_EQ(g.fused(), (FlopCount{.mul = 3, .mad = 3 * (N - 1)}));

        TableSum const plain{{weights, 0, "w"}, {starts, 1, "s"}};
        EXPECT_EQ(tally([&](FlopCount* sink) {
                      (void)plain.operator()<Tally>(ControlPoints<float3<Tally>>(sink, n), 1);
                  }),
                  g.written());
        execution = {};
        using T = Counted<float>;
        (void)plain.operator()<T>(ControlPoints<float3<T>>(points.data(), n), 1);
        EXPECT_EQ(execution.take(), g.written());

        // The same row again, and another that overlaps it.
        EXPECT_EQ(recorded.operator()<Graph>(control, 1).y.id, sum.y.id);
        EXPECT_EQ(g.shared(), (FlopCount{.add = 3 * (N - 1), .mul = 3 * N}));
        (void)recorded.operator()<Graph>(control, 0);
        EXPECT_EQ(g.loads(), 2 * N + 2 + std::min(N, std::uint64_t(3)));
    }
}

} // namespace
} // namespace tessemu
