// Weighted sums of listed records, a point a lane, all terms at once.
//
//     sum = sum over k of w[k] * record[list[k]],
//     w[k] = sum over i of weight[i] * table[column[k]][sample[i]]
//
// A shader says that term by term, as any machine runs it; this is what the fast machine does
// instead, with the same operations in the same order, hence the same bits. Its counts are those of
// the text.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/memory.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace tessemu {

/// What is summed. Two lists share no entry; lists that are summed by one table name the same
/// columns. A sample is one of the column's, or the one behind them: the next column's first, whose
/// weight is 0.
///
/// \tparam n  samples of a point; of a single one the weight is 1 and not multiplied
template <int N, int n> struct ListedSums {
    Buffer<std::uint32_t> const& lists; ///< [entry][2]: a record, and its column of the table
    std::int32_t first, count;          ///< entries of the list
    Buffer<float> const& tables;        ///< [column][sample] from `table` on
    std::int32_t table, samples;
    Buffer<float> const& records; ///< [record][K]
    IntLanes<N> sample[n];
    Lanes<N> weight[n];
};

/// The K sums; nothing where an index is out of range, or further behind a column: the shader's
/// text knows what then.
///
/// \cost  counted for each entry of the list as two fetches of it, n of the table and K of the
///        record, K mul, K add; and n mul, n - 1 add where n > 1
template <int K, int N, int n>
std::optional<std::array<Lanes<N>, K>> sum_listed(ListedSums<N, n> const& s)
{
    using Int = IntLanes<N>;
    std::span<std::uint32_t const> const lists = s.lists.elements();
    std::span<float const> const tables = s.tables.elements(), records = s.records.elements();
    if (s.count < 1 || s.first < 0 || s.samples < 0 ||
        2 * (std::int64_t(s.first) + s.count) > std::int64_t(lists.size()))
        return {};
    std::uint32_t const* const list = lists.data() + 2 * std::ptrdiff_t(s.first);
    std::uint32_t last_record = 0, last_column = 0;
    for (std::int32_t k = 0; k < s.count; ++k) {
        last_record = std::max(last_record, list[2 * k]);
        last_column = std::max(last_column, list[2 * k + 1]);
    }
    // Lanes that do not run read what one that does reads.
    std::uint32_t const active = execution.active_bits;
    Int sample[n], least(std::numeric_limits<std::int32_t>::max()), most(-1);
    for (int i = 0; i < n; ++i) {
        sample[i] = only(s.sample[i], active);
        least = min(least, sample[i]), most = max(most, sample[i]);
    }
    LaneRange<N> const range(least, most);
    if (s.table < 0 || range.low < 0 || range.high > s.samples ||
        s.table + std::int64_t(last_column) * s.samples + range.high >=
            std::int64_t(tables.size()) ||
        (std::int64_t(last_record) + 1) * K > std::int64_t(records.size()))
        return {};

    std::array<Lanes<N>, K> sum;
    sum.fill(Lanes<N>(0.0f));
    for (std::int32_t k = 0; k < s.count; ++k) {
        float const* const table =
            tables.data() + s.table + std::ptrdiff_t(list[2 * k + 1]) * s.samples;
        Lanes<N> w = gather<N>(table, sample[0]);
        if constexpr (n > 1) {
            w = s.weight[0] * w;
            for (int i = 1; i < n; ++i) w = w + s.weight[i] * gather<N>(table, sample[i]);
        }
        float const* const record = records.data() + std::size_t(list[2 * k]) * K;
        for (std::size_t c = 0; c < K; ++c) sum[c] = sum[c] + w * Lanes<N>(record[c]);
    }

    std::uint64_t const terms = std::uint64_t(s.count) * execution.active_lanes;
    execution.features |= kFetches;
    execution.flops.mul += terms * (K + (n > 1 ? n : 0));
    execution.flops.add += terms * (K + n - 1);
    bool fresh = true;
    if (FetchSlot* const slot = detail::bound_slot(s.lists.slot())) {
        slot->count += 2 * terms;
        fresh = !slot->touched ||
                slot->touched->mark_own_run(2 * std::size_t(s.first), 2 * std::size_t(s.count));
    }
    if (FetchSlot* const slot = detail::bound_slot(s.records.slot())) {
        slot->count += K * terms;
        if (slot->touched && fresh) // whoever marks a list marks its records as well
            for (std::int32_t k = 0; k < s.count; ++k)
                slot->touched->mark_all(std::size_t(list[2 * k]) * K, K);
    }
    if (FetchSlot* const slot = detail::bound_slot(s.tables.slot())) {
        slot->count += n * terms;
        // And whoever marks a sample of a column marks it of all; but for first ones, which are also
        // those behind the columns before.
        bool unsure = range.low == 0 || range.high >= s.samples;
        for (std::int32_t k = 0; slot->touched && (k == 0 || (unsure && k < s.count)); ++k)
            for (int i = 0; i < n; ++i) {
                Int const at = Int(s.table + std::int32_t(list[2 * k + 1]) * s.samples) + sample[i];
                unsure |= slot->touched->mark_each(at, active);
            }
    }
    return sum;
}

} // namespace tessemu
