// sum_table_rows() is what a shader's text says term by term: the same bits, the same counts.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/machine.h"
#include "emu/statistics.h"
#include "emu/table_rows.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <numeric>

namespace tessemu {
namespace {

template <class T> struct Point {
    float3<T> position;
    static constexpr auto signature() { return std::tuple{&Point::position}; }
};

constexpr int N = kNativeLanes;
using T = FastLanes<N>;

// As a shader has it.
float3<T> text(ControlPoints<Point<T>> const& in, TableRows<N> const& t)
{
    IntLanes<N> const mask = load<T>(t.masks, IntLanes<N>(t.first_mask) + t.row);
    float3<T> sum(T(0), T(0), T(0));
    for (int k = 0; k < in.size(); ++k) {
        std::int32_t const i = load<T>(t.order, t.first_order + k);
        sum = when(((mask >> IntLanes<N>(i)) & IntLanes<N>(1)) != IntLanes<N>(0),
                   [&]() -> float3<T> {
                       T const w =
                           load<T>(t.weights, IntLanes<N>(t.first_weight + i * t.rows) + t.row);
                       return sum + w * in[i].position;
                   },
                   sum);
    }
    return sum;
}

struct Result {
    std::vector<float> sums; // of the lanes that run
    StageStatistics statistics;
    std::uint64_t fetches, touched;
};

struct Tables {
    int inputs = 0, rows = 0;
    std::vector<float> weights, points;
    std::vector<std::uint32_t> masks;
    std::vector<std::uint8_t> order; // of two patches
};

// `sum` of some rows of two patches.
template <class Sum>
std::optional<Result> run(Tables const& t, std::vector<std::vector<int>> const& groups,
                          std::uint32_t active, Sum const& sum)
{
    Buffer<float> const weights(t.weights, 0, "weights");
    Buffer<std::uint32_t> const masks(t.masks, 1, "masks");
    Buffer<std::uint8_t> const order(t.order, 2, "order");
    StageBuffers const buffers({weights.info(), masks.info(), order.info()});
    StageCounters counters;
    Result out{};
    for (int patch = 0; patch < 2; ++patch) {
        StageScope const scope(counters, buffers);
        ControlPoints<Point<T>> const in(t.points.data(), t.inputs);
        for (std::vector<int> const& group : groups) {
            begin_group<T>(active);
            IntLanes<N> row;
            for (int l = 0; l < N; ++l) row.raw[l] = group[std::size_t(l)];
            std::optional<float3<T>> const v =
                sum(in, TableRows<N>{weights, 0, t.rows, masks, 0, order, patch * t.inputs, row});
            if (!v) return {};
            for (int l = 0; l < N; ++l)
                if (active >> l & 1)
                    for (T const& x : {v->x, v->y, v->z}) out.sums.push_back(x.value.raw[l]);
        }
        out.fetches += in.fetches();
        out.touched += in.touched();
    }
    out.statistics.flops = counters.flops;
    buffers.report(counters, out.statistics);
    EXPECT_EQ(counters.features, std::uint32_t(kBranches | kFetches));
    return out;
}

RC_GTEST_PROP(TableRows, AreWhatTheTextSays, ())
{
    Tables t;
    t.inputs = *rc::gen::inRange(1, 33);
    t.rows = *rc::gen::inRange(N, 3 * N);
    auto const floats = [](std::size_t n) {
        // Some that no masked lane may let through.
        return *rc::gen::container<std::vector<float>>(
            n, rc::gen::weightedOneOf<float>(
                   {{20, rc::gen::map(rc::gen::inRange(-999, 1000),
                                      [](int i) { return float(i) / 7; })},
                    {1, rc::gen::element(std::numeric_limits<float>::infinity(), -0.0f,
                                         std::numeric_limits<float>::quiet_NaN())}}));
    };
    t.masks = *rc::gen::container<std::vector<std::uint32_t>>(std::size_t(t.rows),
                                                              rc::gen::arbitrary<std::uint32_t>());
    t.weights = floats(std::size_t(t.inputs * t.rows));
    for (std::size_t i = 0; i < t.weights.size(); ++i)
        if (!(t.masks[i % std::size_t(t.rows)] >> (i / std::size_t(t.rows)) & 1))
            t.weights[i] = *rc::gen::element(0.0f, -0.0f);
    t.points = floats(std::size_t(3 * t.inputs));
    std::vector<std::uint8_t> order(static_cast<std::size_t>(t.inputs));
    std::iota(order.begin(), order.end(), std::uint8_t(0));
    t.order = order;
    std::rotate(order.begin(), order.begin() + *rc::gen::inRange(0, t.inputs), order.end());
    t.order.insert(t.order.end(), order.begin(), order.end());

    int const first = *rc::gen::inRange(0, t.rows - N + 1);
    std::vector<int> run_of_rows(N), among_n(N);
    std::iota(run_of_rows.begin(), run_of_rows.end(), first);
    for (int& r : among_n) r = first + *rc::gen::inRange(0, N);
    auto const anywhere = *rc::gen::container<std::vector<int>>(N, rc::gen::inRange(0, t.rows));
    auto const active = *rc::gen::oneOf(rc::gen::just(all_lanes<N>()),
                                        rc::gen::inRange<std::uint32_t>(1, all_lanes<N>()));
    std::vector<int> idle_elsewhere = anywhere; // lanes that do not run may have any row
    for (int l = 0; l < N; ++l)
        if (!(active >> l & 1)) idle_elsewhere[std::size_t(l)] = 1 << 30;
    std::vector<int> pairs = anywhere;
    for (std::size_t l = 0; l < N; l += 2) {
        pairs[l] = std::min(pairs[l], t.rows - 2);
        pairs[l + 1] = pairs[l] + 1;
    }
    std::vector<std::vector<int>> const groups{run_of_rows,    among_n, anywhere,
                                               idle_elsewhere, pairs,   run_of_rows};

    auto const expected = run(t, groups, active, [](auto const& in, TableRows<N> const& rows) {
        return std::optional(text(in, rows));
    });
    auto const at_once = run(t, groups, active, [](auto const& in, TableRows<N> const& rows) {
        return sum_table_rows<N>(in, rows);
    });
    RC_ASSERT(at_once.has_value());
    RC_ASSERT(at_once->sums.size() == expected->sums.size());
    for (std::size_t i = 0; i < expected->sums.size(); ++i) {
        float const x = at_once->sums[i], y = expected->sums[i];
        // Of two NaNs a sum has either: compilers exchange operands.
        RC_ASSERT(std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y) ||
                  (x != x && y != y));
    }
    RC_ASSERT(at_once->statistics == expected->statistics);
    RC_ASSERT(at_once->fetches == expected->fetches);
    RC_ASSERT(at_once->touched == expected->touched);
}

// What the text alone knows: reads out of range, orders with an input twice or one that is not there.
TEST(TableRows, LeaveTheRestToTheText)
{
    Tables good{2,
                N,
                std::vector<float>(2 * N, 1.0f),
                std::vector<float>(6, 1.0f),
                std::vector<std::uint32_t>(N, 3u),
                {0, 1, 1, 0}};
    std::vector<int> row(N);
    std::iota(row.begin(), row.end(), 0);
    auto const done = [&](Tables const& t, std::vector<int> const& rows) {
        return run(t, {rows}, all_lanes<N>(),
                   [](auto const& in, TableRows<N> const& r) { return sum_table_rows<N>(in, r); })
            .has_value();
    };
    EXPECT_TRUE(done(good, row));
    for (std::vector<std::uint8_t> const& order :
         {std::vector<std::uint8_t>{0, 0, 1, 0}, {0, 2, 1, 0}, {255, 1, 1, 0}, {0, 1, 1}}) {
        Tables t = good;
        t.order = order;
        EXPECT_FALSE(done(t, row));
    }
    Tables few = good;
    few.weights.pop_back();
    EXPECT_FALSE(done(few, row));
    for (int wrong : {-1, N, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
        std::vector<int> rows = row;
        rows[1] = wrong;
        EXPECT_FALSE(done(good, rows)) << wrong;
    }
}

} // namespace
} // namespace tessemu
