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
    /// [input][row] from first_weight on; 0 of inputs that are not in the row.
    Buffer<float> const& weights;
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
    /// rows among N neighbours by a load and a permutation, pairs of neighbours two by two.
    ///
    /// \param more  floats that there are behind p[high]
    template <class Work>
    [[gnu::always_inline]] auto with_loader(std::int64_t more, Work const& work) const
    {
        using Int = IntLanes<N>;
        if (is_run) return work([this](float const* p) { return Lanes<N>::load(p + low); });
        if (high - low < N && low + (N - 1) <= high + more)
            return work([this, at = row - Int(low)](float const* p) {
                return permute(Lanes<N>::load(p + low), at);
            });
        Int const odd = Int::iota() & Int(1);
        if (all(row == permute(row, Int::iota() - odd) + odd))
            return work([this](float const* p) { return load_pairs<N>(p, row); });
        return work([this](float const* p) { return gather<N>(p, row); });
    }
};

/// Bit i is set where `order` names input i, if it names each of n once; 0 otherwise. N more bytes
/// than n, at most, are read.
template <int N>
[[gnu::always_inline]] inline std::uint32_t inputs_named(std::uint8_t const* order, int n)
{
    using Int = IntLanes<N>;
    Int named(0);
    for (int k = 0; k < n; k += N) {
        Int const i = load_bytes<N>(order + k);
        Mask<N> const counts = Mask<N>::first(n - k) & (i < Int(32));
        named = named | select(counts, Int(1) << (i & Int(31)), Int(0));
    }
    for (int half = N / 2; half > 0; half /= 2)
        named = named | permute(named, Int::iota() ^ Int(half));
    auto const bits = std::uint32_t(named.raw[0]);
    return bits == ~0u >> (32 - n) ? bits : 0;
}

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

    std::uint8_t const* order = orders.data() + t.first_order;
    std::uint8_t last_order[32 + N];
    if (std::size_t(t.first_order) + std::size_t(n + N) > orders.size())
        order = std::copy_n(order, n, last_order) - n;
    std::uint32_t const named = detail::inputs_named<N>(order, n);
    if (named == 0) return {};

    Int const at_mask = Int(t.first_mask) + row;
    Int const mask = load<Lanes<N>>(t.masks, at_mask);
    float const *const points = in.memory(), *const first = weights.data() + t.first_weight;
    auto const sum_by = [&](auto const& loaded) -> float3<T> {
        Lanes<N> x, y, z;
        auto const sum_all = [&](auto const& sum_of) {
            x = y = z = Lanes<N>(0.0f);
            for (int k = 0; k < n; ++k) {
                int const i = order[k];
                Lanes<N> const weight = loaded(first + std::ptrdiff_t(i) * t.rows);
                float const* const p = points + 3 * i;
                x = sum_of(i, x, weight * Lanes<N>(p[0]));
                y = sum_of(i, y, weight * Lanes<N>(p[1]));
                z = sum_of(i, z, weight * Lanes<N>(p[2]));
            }
        };
        // A term of weight 0 changes no sum, unless its input is no finite number; but it can turn -0,
        // which a sum becomes where a denormal was flushed, into +0.
        sum_all([](int, Lanes<N> sum, Lanes<N> term) { return sum + term; });
        Lanes<N> const zero(0.0f), product = x * y * z * zero;
        if (!all((product == zero) & (x != zero) & (y != zero) & (z != zero)))
            sum_all([&](int i, Lanes<N> sum, Lanes<N> term) {
                return select((mask << Int(31 - i)) < Int(0), sum + term, sum);
            });
        return {T(x), T(y), T(z)};
    };
    float3<T> const sum = span.with_loader(std::int64_t(weights.size()) - 1 - last, sum_by);

    Int const counted = mask & Int(Mask<N>::of(active).raw) & Int(std::int32_t(named));
    std::uint64_t pairs[N / 2], terms = 0, either = 0;
    static_assert(sizeof pairs == sizeof counted.raw);
    __builtin_memcpy(pairs, &counted.raw, sizeof pairs);
    for (std::uint64_t bits : pairs) {
        terms += std::uint64_t(std::popcount(bits));
        either |= bits;
    }
    auto const inputs = std::uint32_t(either | either >> 32);
    execution.features |= kBranches | kFetches;
    execution.flops.mul += 3 * terms;
    execution.flops.add += 3 * terms;
    in.count(terms, inputs);
    bool fresh = true;
    if (FetchSlot* const s = detail::bound_slot(t.masks.slot())) {
        s->count += execution.active_lanes;
        // Whoever marks a mask marks the row's weights as well.
        fresh = !s->touched || (detail::is_run(at_mask, t.masks.elements().size())
                                    ? s->touched->mark_run(std::size_t(at_mask.raw[0]), active)
                                    : s->touched->mark_each(at_mask, active));
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
