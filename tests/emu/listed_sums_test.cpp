// sum_listed() is what a shader's text says term by term: the same bits, the same counts.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/listed_sums.h"
#include "emu/machine.h"
#include "emu/statistics.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <numeric>

namespace tessemu {
namespace {

constexpr int N = kNativeLanes, K = 3;
using T = FastLanes<N>;
using Sums = std::array<Lanes<N>, K>;

// As a shader has it.
template <int n> Sums text(ListedSums<N, n> const& s)
{
    std::array<T, K> sum;
    sum.fill(T(0));
    for (int k = 0; k < s.count; ++k) {
        std::int32_t const record = load<T>(s.lists, 2 * (s.first + k)),
                           column = load<T>(s.lists, 2 * (s.first + k) + 1);
        auto const at = [&](int i) -> T {
            return load<T>(s.tables, IntLanes<N>(s.table + column * s.samples) + s.sample[i]);
        };
        T w = at(0);
        if constexpr (n > 1) {
            w = T(s.weight[0]) * w;
            for (int i = 1; i < n; ++i) w = w + T(s.weight[i]) * at(i);
        }
        for (std::size_t c = 0; c < K; ++c)
            sum[c] = sum[c] + w * load<T>(s.records, record * K + int(c));
    }
    Sums out;
    for (std::size_t c = 0; c < K; ++c) out[c] = sum[c].value;
    return out;
}

// Two tables of the same columns, two lists of each, the second in another order.
struct Scene {
    int columns = 0, samples = 0;
    std::vector<float> tables, records;
    std::vector<std::uint32_t> lists;
};

struct Result {
    std::vector<float> sums; // of the lanes that run
    StageStatistics statistics;
};

template <int n, class Sum>
std::optional<Result> run(std::vector<ListedSums<N, n>> const& groups, std::uint32_t active,
                          Sum const& sum)
{
    StageBuffers const buffers(
        {groups[0].lists.info(), groups[0].tables.info(), groups[0].records.info()});
    StageCounters counters;
    Result out;
    for (ListedSums<N, n> const& g : groups) {
        StageScope const scope(counters, buffers);
        begin_group<T>(active);
        std::optional<Sums> const v = sum(g);
        if (!v) return {};
        for (int l = 0; l < N; ++l)
            if (active >> l & 1)
                for (Lanes<N> const& x : *v) out.sums.push_back(x.raw[l]);
    }
    out.statistics.flops = counters.flops;
    buffers.report(counters, out.statistics);
    EXPECT_EQ(counters.features, std::uint32_t(kFetches));
    return out;
}

template <int n> void check_random_sums()
{
    Scene s;
    s.columns = *rc::gen::inRange(1, 20);
    s.samples = *rc::gen::inRange(1, 2 * N);
    auto const floats = [](int size) {
        return *rc::gen::container<std::vector<float>>(
            std::size_t(size),
            rc::gen::map(rc::gen::inRange(-999, 1000), [](int i) { return float(i) / 7; }));
    };
    int const records = *rc::gen::inRange(1, 30);
    s.tables = floats(2 * s.columns * s.samples + 1);
    s.records = floats(K * records);
    std::vector<std::uint32_t> columns(static_cast<std::size_t>(s.columns));
    std::iota(columns.begin(), columns.end(), 0u);
    for (int list = 0; list < 4; ++list) {
        std::rotate(columns.begin(), columns.begin() + *rc::gen::inRange(0, s.columns),
                    columns.end());
        for (std::uint32_t c : columns) {
            s.lists.push_back(std::uint32_t(*rc::gen::inRange(0, records)));
            s.lists.push_back(c);
        }
    }
    Buffer<std::uint32_t> const lists(s.lists, 0, "lists");
    Buffer<float> const tables(s.tables, 1, "tables"), rows(s.records, 2, "records");
    auto const active = *rc::gen::oneOf(rc::gen::just(all_lanes<N>()),
                                        rc::gen::inRange<std::uint32_t>(1, all_lanes<N>()));
    std::vector<ListedSums<N, n>> groups;
    for (int turn = 0; turn < 3; ++turn)
        for (int list = 0; list < 4; ++list) {
            ListedSums<N, n> g{lists,
                               list * s.columns,
                               s.columns,
                               tables,
                               list / 2 * s.columns * s.samples,
                               s.samples,
                               rows,
                               {},
                               {}};
            for (int i = 0; i < n; ++i)
                for (int l = 0; l < N; ++l) {
                    // Lanes that do not run may be anywhere.
                    g.sample[i].raw[l] =
                        active >> l & 1 ? *rc::gen::inRange(0, s.samples + 1) : 1 << 30;
                    g.weight[i].raw[l] = float(*rc::gen::inRange(-8, 9)) / 3;
                }
            groups.push_back(g);
        }
    auto const expected =
        run<n>(groups, active, [](ListedSums<N, n> const& g) { return std::optional(text<n>(g)); });
    auto const at_once =
        run<n>(groups, active, [](ListedSums<N, n> const& g) { return sum_listed<K>(g); });
    RC_ASSERT(at_once.has_value());
    RC_ASSERT(at_once->sums.size() == expected->sums.size());
    for (std::size_t i = 0; i < expected->sums.size(); ++i)
        RC_ASSERT(std::bit_cast<std::uint32_t>(at_once->sums[i]) ==
                  std::bit_cast<std::uint32_t>(expected->sums[i]));
    RC_ASSERT(at_once->statistics == expected->statistics);
}

RC_GTEST_PROP(ListedSums, AreWhatTheTextSays, ())
{
    check_random_sums<1>();
    check_random_sums<3>();
    check_random_sums<4>();
}

// Reads out of range give 0 one by one: the text's business.
TEST(ListedSums, LeaveTheRestToTheText)
{
    std::vector<std::uint32_t> const words{0, 0, 1, 1};
    std::vector<float> const weights(8, 1.0f), points(6, 1.0f);
    Buffer<std::uint32_t> const lists(words, 0, "lists");
    Buffer<float> const tables(weights, 1, "tables"), records(points, 2, "records");
    ListedSums<N, 1> const good{lists, 0, 2, tables, 0, 4, records, {IntLanes<N>(3)}, {}};
    auto const done = [](ListedSums<N, 1> const& s) {
        begin_group<T>(all_lanes<N>());
        return sum_listed<K>(s).has_value();
    };
    EXPECT_TRUE(done(good));
    auto const with = [&](auto const& change) {
        ListedSums<N, 1> s = good;
        change(s);
        return done(s);
    };
    EXPECT_FALSE(with([](auto& s) { s.first = 1; }));
    EXPECT_FALSE(with([](auto& s) { s.first = -1; }));
    EXPECT_FALSE(with([](auto& s) { s.count = 0; }));
    EXPECT_FALSE(with([](auto& s) { s.table = 1; }));
    EXPECT_FALSE(with([](auto& s) { s.table = -4; }));
    EXPECT_FALSE(with([](auto& s) { s.samples = 5; }));
    EXPECT_FALSE(with([](auto& s) { s.sample[0].raw[1] = 4; }));
    EXPECT_FALSE(with([](auto& s) { s.sample[0].raw[1] = -1; }));
    EXPECT_FALSE(with([](auto& s) { s.sample[0].raw[1] = std::numeric_limits<int>::min(); }));
    std::vector<float> const few(5, 1.0f);
    Buffer<float> const short_records(few, 2, "records");
    EXPECT_FALSE(done({lists, 0, 2, tables, 0, 4, short_records, {IntLanes<N>(3)}, {}}));
}

} // namespace
} // namespace tessemu
