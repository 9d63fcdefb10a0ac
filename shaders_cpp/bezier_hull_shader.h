// Hull shader that turns a B-spline patch into a Bezier patch, LOOP10 4.1: a row of the change of
// basis from the left of the net, a row from its right.
//
//         | 1 4 1 0 |
//     M = | 0 4 2 0 | / 6       Bezier point (i, j) = sum over l of M[j][l] (sum over k of
//         | 0 2 4 0 |                                                   M[i][k] net(k, l))
//         | 0 1 4 1 |
//
// In: 16 control points in the order of RegularNet. Out: those of regular_quad.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bspline_quad.h"
#include "shaders_cpp/regular_quad.h"

namespace tessemu {

/// Row i of M, per lane: i is what tells the threads apart.
template <class T> struct BezierFromBspline {
    T weight[4];

    constexpr explicit BezierFromBspline(int_of<T> i)
    {
        using Int = int_of<T>;
        T const zero(0), sixth(1.0 / 6), third(1.0 / 3), two_thirds(2.0 / 3);
        mask_of<T> const first = i == Int(0), last = i == Int(3), lower = i < Int(2);
        weight[0] = select(first, sixth, zero);
        weight[1] = select(lower, two_thirds, select(last, sixth, third));
        weight[2] = select(lower, select(first, sixth, third), two_thirds);
        weight[3] = select(last, sixth, zero);
    }
};

struct BezierHullShader : NetHullShader<RegularNet> {
    /// Corner by corner p, e+, e-, f: of corner 0 Bezier points (0,0), (1,0), (0,1), (1,1), of the
    /// others these turned by so many quarters.
    ///
    /// \cost  60 mul: 48 for the row and the net, 12 for the rest; zeros are multiplied too
    template <class T>
    ControlVertex<T> control_point(PatchInput, Points<T> const& in, int_of<T> id) const
    {
        using Int = int_of<T>;
        Routine<T> const here("bezier_from_bspline");
        Int const corner = id & Int(3), x = (id >> Int(2)) & Int(1), y = id >> Int(3);
        auto const turned = [&](Int a, Int b, Int c, Int d) {
            return select(corner < Int(2), select(corner == Int(0), a, b),
                          select(corner == Int(2), c, d));
        };
        BezierFromBspline<T> const u(turned(x, Int(3) - y, Int(3) - x, y));
        BezierFromBspline<T> const v(turned(y, x, Int(3) - y, Int(3) - x));
        auto const sum = [](T const(&w)[4], float3<T> const& a, float3<T> const& b,
                            float3<T> const& c, float3<T> const& d) -> float3<T> {
            return w[0] * a + w[1] * b + w[2] * c + w[3] * d;
        };
        float3<T> column[4];
        unrolled<4>([&](auto l) {
            float3<T> const p0 = in[RegularNet::at(0, l)].position,
                            p1 = in[RegularNet::at(1, l)].position,
                            p2 = in[RegularNet::at(2, l)].position,
                            p3 = in[RegularNet::at(3, l)].position;
            column[l] = sum(u.weight, p0, p1, p2, p3);
        });
        return {sum(v.weight, column[0], column[1], column[2], column[3])};
    }
};

using BezierQuadDomainShader = PlainPatch<RegularQuadInside>;

} // namespace tessemu
