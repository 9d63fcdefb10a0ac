// Rows of a table of weights over a patch's control points, a row a lane, summed at once.
//
//     row = sum over k of weights[first + order[k] * rows + row] * in[order[k]]
//
// over the inputs in the row's mask, in the order's order. A shader says that sum term by term, as
// any machine runs it; this is what the fast machine does instead, with the same operations in the
// same order, hence the same bits. Its counts are those of the text: they follow from the masks.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/memory.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace tessemu {

/// Where rows of a patch lie, in buffers of floats, masks and indices. An order names each input
/// once.
template <int N> struct TableRows {
    Buffer<float> const& weights; ///< [input][row] from first_weight on
    std::int32_t first_weight;
    std::int32_t rows;                  ///< from input to input
    Buffer<std::uint32_t> const& masks; ///< [row] from first_mask on: bit i, input i is in it
    std::int32_t first_mask;
    Buffer<std::uint8_t> const& order; ///< [k] from first_order on
    std::int32_t first_order;
    IntLanes<N> row;
};

namespace detail {

/// Rows of the lanes, those that do not run on the row of one that does, and how far they span.
template <int N> struct RowSpan {
    IntLanes<N> row;
    std::int32_t low, high;
    bool is_run; ///< neighbours

    RowSpan(IntLanes<N> of, std::uint32_t active)
        : row(of),
          low(of.raw[0]),
          high(of.raw[N - 1]),
          is_run(low <= high && all(of == IntLanes<N>::iota() + IntLanes<N>(low)))
    {
        if (is_run) return;
        row = only(of, active);
        LaneRange<N> const range(row);
        low = range.low, high = range.high;
    }

    /// work(loaded), where loaded(p) are the floats p[row[l]] of lanes l: neighbours by one load,
    /// rows among N neighbours by a load and a permutation.
    ///
    /// \param more  floats that there are behind p[high]
    template <class Work> auto with_loader(std::int64_t more, Work const& work) const
    {
        if (is_run) return work([this](float const* p) { return Lanes<N>::load(p + low); });
        if (high - low < N && low + (N - 1) <= high + more)
            return work([this, at = row - IntLanes<N>(low)](float const* p) {
                return permute(Lanes<N>::load(p + low), at);
            });
        return work([this](float const* p) { return gather<N>(p, row); });
    }
};

} // namespace detail

/// The sums; nothing where an index is out of range or an order does not name each input once: the
/// shader's text knows what then.
///
/// \tparam P  record of three floats
/// \cost     counted as one fetch of a mask, and for each input one of its order; for each that is
///           in the row's mask one of a weight and of a control point, 3 mul, 3 add
template <int N, class P>
std::optional<float3<Counted<Lanes<N>>>> sum_table_rows(ControlPoints<P> const& in,
                                                        TableRows<N> const& t)
{
    static_assert(ControlPoints<P>::kScalars == 3);
    using T = Counted<Lanes<N>>;
    using Int = IntLanes<N>;
    int const n = in.size();
    std::span<float const> const weights = t.weights.elements();
    std::span<std::uint8_t const> const orders = t.order.elements();
    std::uint32_t const active = execution.active_bits;
    detail::RowSpan<N> const span(t.row, active);
    Int const row = span.row;
    std::int64_t const last =
        std::int64_t(t.first_weight) + std::int64_t(n - 1) * t.rows + span.high;
    if (n < 1 || n > 32 || std::min({t.first_weight, t.rows, t.first_order, span.low}) < 0 ||
        last >= std::int64_t(weights.size()) ||
        std::size_t(t.first_order) + std::size_t(n) > orders.size())
        return {};

    Int const at_mask = Int(t.first_mask) + row;
    Int const mask = load<Lanes<N>>(t.masks, at_mask);
    std::uint32_t named = 0;
    int total = 0;
    auto const sum_by = [&](auto const& loaded) -> float3<T> {
        std::uint8_t const* const order = orders.data() + t.first_order;
        float const *const points = in.memory(), *const first = weights.data() + t.first_weight;
        std::ptrdiff_t const rows = t.rows;
        Lanes<N> x(0.0f), y(0.0f), z(0.0f);
        std::uint32_t seen = 0;
        int all = 0;
        for (int k = 0; k < n; ++k) {
            int const i = std::min<int>(order[k], n - 1);
            seen |= 1u << i;
            all += order[k];
            Mask<N> const here = (mask << Int(31 - i)) < Int(0);
            Lanes<N> const weight = loaded(first + i * rows);
            float const* const p = points + 3 * i;
            x = select(here, x + weight * Lanes<N>(p[0]), x);
            y = select(here, y + weight * Lanes<N>(p[1]), y);
            z = select(here, z + weight * Lanes<N>(p[2]), z);
        }
        named = seen, total = all;
        return {T(x), T(y), T(z)};
    };
    float3<T> const sum = span.with_loader(std::int64_t(weights.size()) - 1 - last, sum_by);
    if (named != ~0u >> (32 - n) || total != n * (n - 1) / 2) return {}; // else some was too large

    std::uint64_t terms = 0;
    std::uint32_t inputs = 0;
    Int const counted = mask & Int(Mask<N>::of(active).raw) & Int(std::int32_t(named));
    for (int l = 0; l < N; ++l) {
        auto const bits = std::uint32_t(counted.raw[l]);
        terms += std::uint64_t(std::popcount(bits));
        inputs |= bits;
    }
    execution.features |= kBranches | kFetches;
    execution.flops.mul += 3 * terms;
    execution.flops.add += 3 * terms;
    in.count(terms, inputs);
    bool fresh = true;
    if (FetchSlot* const s = detail::bound_slot(t.masks.slot())) {
        s->count += execution.active_lanes;
        // Whoever marks a mask marks the row's weights as well.
        fresh = !s->touched || s->touched->mark_each(at_mask, active);
    }
    if (FetchSlot* const s = detail::bound_slot(t.order.slot())) {
        s->count += std::uint64_t(n) * execution.active_lanes;
        if (s->touched) s->touched->mark_own_run(std::size_t(t.first_order), std::size_t(n));
    }
    if (FetchSlot* const s = detail::bound_slot(t.weights.slot())) {
        s->count += terms;
        if (s->touched && fresh)
            for (int i = 0; i < n; ++i)
                s->touched->mark_each(Int(t.first_weight + i * t.rows) + row,
                                      ((counted << Int(31 - i)) < Int(0)).bits());
    }
    return sum;
}

} // namespace tessemu
