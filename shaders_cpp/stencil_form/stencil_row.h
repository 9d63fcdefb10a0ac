// A row of a stencil, the sum that every control point of the stencil form is (LOOP09 4.3): one
// text for the hull shader that sums its own inputs and for the dispatch that sums rows of any
// length, so that a point which patches of both ways share has equal bits in both.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/control_flow.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// A term of a row: `weight()` times `position()` in the lanes of `present`.
template <class Mask, class Weight, class Position> struct StencilTerm {
    Mask present;
    Weight weight;
    Position position;
};
template <class Mask, class Weight, class Position> // clang 14 deduces no aggregates
StencilTerm(Mask, Weight, Position) -> StencilTerm<Mask, Weight, Position>;

/// The sum over k = 0, ..., count - 1, in this order, of term(k), a StencilTerm.
///
/// \cost  3 mul, 3 add for each term that is present
template <class T, class Terms> float3<T> stencil_row(int count, Terms const& term)
{
    Routine<T> const here("stencil_row");
    float3<T> sum(T(0), T(0), T(0));
    for (int k : loop<T>(count)) {
        auto const t = term(k);
        sum = when(
            t.present,
            [&]() -> float3<T> {
                T const w = t.weight();
                return sum + w * t.position();
            },
            sum);
    }
    return sum;
}

} // namespace tessemu
