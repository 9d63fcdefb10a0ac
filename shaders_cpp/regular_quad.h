// Regular patch: a bicubic Bezier patch of 16 control points.
//
//     3--11-- 6-- 2     v     Control points: p 0..3, e+ 4..7, e- 8..11, f 12..15, corner by
//     7  15  14  10     |     corner: those of an irregular quad whose f+ and f- coincide (LOOP09
//     8  12  13   5     +-u   section 3; docs/math/loop09.md, 7), so that p and e come from the
//     0-- 4-- 9-- 1           same routine as everywhere.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bezier.h"
#include "shaders_cpp/cubic_edges.h"

namespace tessemu {

/// Bicubic patch at (u,v).
///
/// \param patch  16 control points, object space; each is fetched once
/// \returns      position and derivatives along u and v, see tensor_product
/// \cost         156 mul (162 with the cross product)
template <class T, class Basis = CubicBasis<T>>
constexpr FrameOn<T, Basis> regular_quad(auto const& patch, T u, T v)
{
    Routine<T> const here("regular_quad");
    constexpr int net[4][4] = {{0, 8, 7, 3}, {4, 12, 15, 11}, {9, 13, 14, 6}, {1, 5, 10, 2}};
    return tensor_product<T, Basis>([&](int i, int j) { return patch[net[i][j]].position; }, u, v);
}

struct RegularQuadInside : CubicEdges<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 16;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in, bool)
    {
        return regular_quad<T>(patch, in.u, in.v);
    }
    template <class T>
    static constexpr SecondOrderFrame<T> second_order(auto const& patch, DomainInput<T> const& in)
    {
        return second_order_of<T>(patch, [&](auto const& near) {
            return regular_quad<T, SecondOrderCubicBasis<T>>(near, in.u, in.v);
        });
    }
};

using RegularQuadDomainShader = WatertightPatch<RegularQuadInside>;

} // namespace tessemu
