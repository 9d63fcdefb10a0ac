// Regular patch: a bicubic Bezier patch of 16 control points.
//
// Control points: p 0..3, e+ 4..7, e- 8..11, f 12..15: a Gregory quad whose f+ and f- coincide
// (LOOP09 section 3; sheet section 2), so that p and e come from the same routine as everywhere.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/gregory_quad.h"

namespace tessemu {

/// Bicubic patch at (u,v).
///
/// \param patch  16 control points, object space; each is fetched once
/// \returns      position and derivatives along u and v
/// \cost         156 mul (162 with the cross product)
template <class T> constexpr TangentFrame<T> regular_quad(auto const& patch, T u, T v)
{
    using L = GregoryLayout<4>;
    Routine<T> const here("regular_quad");
    constexpr int net[4][4] = {
        {L::p(0), L::e_minus(0), L::e_plus(3), L::p(3)},
        {L::e_plus(0), L::f_plus(0), L::f_plus(3), L::e_minus(3)},
        {L::e_minus(1), L::f_plus(1), L::f_plus(2), L::e_plus(2)},
        {L::p(1), L::e_plus(1), L::e_minus(2), L::p(2)},
    };
    return bicubic<T>([&](int i, int j) { return patch[net[i][j]].position; }, u, v);
}

} // namespace tessemu
