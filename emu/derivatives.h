// ddx and ddy of a pixel shader: differences inside the 2x2 quad (R123).
//
// Quads lie at even pixel coordinates; coarse derivatives take the top row and the left column
// (choice I-14). Four neighbouring lanes are a quad: left top, right top, left bottom, right
// bottom.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/contracted.h"

namespace tessemu {

namespace detail {
/// value[quad + b(l)] - value[quad + a(l)], counted as one addition.
template <class T, class Pick> T quad_difference(T const& value, Pick pick)
{
    static_assert(lanes_of<T> >= 4, "derivatives need a quad of lanes");
    constexpr int N = lanes_of<T>;
    execution.features |= kDerivatives;
    Lanes<N> const v = lanes_value(value);
    Lanes<N> from, to;
    for (int l = 0; l < N; ++l) {
        auto const [a, b] = pick(l & 3);
        from.raw[l] = v.raw[(l & ~3) + a];
        to.raw[l] = v.raw[(l & ~3) + b];
    }
    return T(T(to) - T(from));
}
} // namespace detail

template <class T> T ddx_fine(T const& v)
{
    return detail::quad_difference(v, [](int l) { return std::pair(l & 2, (l & 2) + 1); });
}
template <class T> T ddy_fine(T const& v)
{
    return detail::quad_difference(v, [](int l) { return std::pair(l & 1, (l & 1) + 2); });
}
template <class T> T ddx(T const& v)
{
    return detail::quad_difference(v, [](int) { return std::pair(0, 1); });
}
template <class T> T ddy(T const& v)
{
    return detail::quad_difference(v, [](int) { return std::pair(0, 2); });
}

} // namespace tessemu
