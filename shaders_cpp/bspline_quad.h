// Regular patch as a bicubic uniform B-spline of the cage's own vertices, LOOP10 4.1: no change of
// basis in the hull shader, and a dearer basis in the domain shader.
//
//     3   7  11  15     v     Control points: point 4i + j of the net is column i along u, row j
//     2   6  10  14     |     along v. The patch covers the middle face: corners 5 (0,0), 9 (1,0),
//     1   5   9  13     +-u   10 (1,1), 6 (0,1).
//     0   4   8  12
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bezier.h"
#include "shaders_cpp/plain_patch.h"

namespace tessemu {

struct RegularNet {
    static constexpr int kPoints = 16;
    static constexpr int kCorners[4] = {5, 9, 10, 6};
    static constexpr int at(int i, int j) { return 4 * i + j; }
};

/// Cubic uniform B-splines and their derivatives at t: Bernstein's polynomials and the change of
/// basis that BezierHullShader makes to points, made to the functions instead.
///
/// LOOP10's difference to Bezier's patch, 24 for both parameters, is that of this formula; that of
/// Cox and de Boor has it too, whose 12 products of a parameter are divided by 12 differences of
/// knots. Powers of t and 1-t by Horner's rule would need 14 mul, a difference of 4.
///
/// \cost  24 mul, 15 add
template <class T> struct BsplineBasis {
    T b[4], d[4];

    constexpr explicit BsplineBasis(T t)
    {
        CubicBasis<T> const bernstein(t);
        set(b, bernstein.b);
        set(d, bernstein.d);
    }

private:
    /// \cost  6 mul, 6 add
    static constexpr void set(T (&bspline)[4], T const (&bernstein)[4])
    {
        T const sixth(1.0 / 6), third(1.0 / 3), two_thirds(2.0 / 3);
        T const first = two_thirds * T(bernstein[0] + bernstein[1]);
        T const last = two_thirds * T(bernstein[2] + bernstein[3]);
        T const second = third * bernstein[1], third_part = third * bernstein[2];
        bspline[0] = sixth * bernstein[0];
        bspline[3] = sixth * bernstein[3];
        bspline[1] = first + third_part + bspline[3];
        bspline[2] = bspline[0] + second + last;
    }
};

/// The same with second derivatives.
template <class T> struct SecondOrderBsplineBasis : BsplineBasis<T> {
    T dd[4];

    constexpr explicit SecondOrderBsplineBasis(T t) : BsplineBasis<T>(t)
    {
        T const s = T(1) - t;
        dd[0] = s;
        dd[1] = t - T(2) * s;
        dd[2] = s - T(2) * t;
        dd[3] = t;
    }
};

/// \param patch  16 control points in the order of RegularNet, object space; each is fetched once
/// \returns      position and derivatives along u and v, see tensor_product
/// \cost         180 mul (186 with the cross product, LOOP10's 162 + 24)
template <class T, class Basis = BsplineBasis<T>>
constexpr FrameOn<T, Basis> bspline_quad(auto const& patch, T u, T v)
{
    Routine<T> const here("bspline_quad");
    return tensor_product<T, Basis>(
        [&](int i, int j) { return patch[RegularNet::at(i, j)].position; }, u, v);
}

struct BsplineQuadInside {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = RegularNet::kPoints;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in, bool)
    {
        return bspline_quad<T>(patch, in.u, in.v);
    }
    template <class T>
    static constexpr SecondOrderFrame<T> second_order(auto const& patch, DomainInput<T> const& in)
    {
        return second_order_of<T>(patch, [&](auto const& near) {
            return bspline_quad<T, SecondOrderBsplineBasis<T>>(near, in.u, in.v);
        });
    }
};

using BsplineQuadHullShader = NetHullShader<RegularNet>;
using BsplineQuadDomainShader = PlainPatch<BsplineQuadInside>;

} // namespace tessemu
