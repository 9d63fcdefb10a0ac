// Bezier curves and tensor-product patches.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/records.h"

#include <utility>

namespace tessemu {

/// Cubic Bernstein polynomials and their derivatives at t.
///
/// \cost  basis 8 mul, 1 add; derivatives 4 mul, 2 add
template <class T> struct CubicBasis {
    T b[4], d[4];

    constexpr explicit CubicBasis(T t)
    {
        T const s = T(1) - t;
        T const ss = s * s, tt = t * t;
        T const sst = ss * t, tts = tt * s;
        b[0] = ss * s;
        b[1] = T(3) * sst;
        b[2] = T(3) * tts;
        b[3] = tt * t;
        T const ss3 = T(3) * ss, tt3 = T(3) * tt;
        T const st = s * t;
        T const st6 = T(6) * st;
        d[0] = -ss3;
        d[1] = ss3 - st6;
        d[2] = st6 - tt3;
        d[3] = tt3;
    }
};

/// The same with second derivatives.
template <class T> struct SecondOrderCubicBasis : CubicBasis<T> {
    T dd[4];

    constexpr explicit SecondOrderCubicBasis(T t) : CubicBasis<T>(t)
    {
        T const s6 = T(6) * T(T(1) - t), t6 = T(6) * t;
        dd[0] = s6;
        dd[1] = t6 - T(2) * s6;
        dd[2] = s6 - T(2) * t6;
        dd[3] = t6;
    }
};

/// Whether a basis has second derivatives.
template <class Basis>
concept SecondOrderBasis = requires(Basis b)
{
    b.dd;
};
/// What is evaluated on a basis.
template <class T, class Basis>
using FrameOn = std::conditional_t<SecondOrderBasis<Basis>, SecondOrderFrame<T>, TangentFrame<T>>;

/// Tensor-product patch S = B(u) b B(v) of N functions along each parameter.
///
/// \tparam Basis  b[N], their derivatives d[N], and dd[N] where second derivatives are asked for;
///                Bernstein's polynomials or others
/// \param net     net(i, j): control point i along u, j along v; asked for once each
/// \returns       position and the derivatives along u and v in the basis's units, second ones too
///                where the basis has them
/// \cost          6 N^2 + 9 N mul and twice the basis: 156 mul of cubic Bernstein polynomials
///                (LOOP10's 162 with the cross product)
template <class T, class Basis = CubicBasis<T>, class Net>
constexpr FrameOn<T, Basis> tensor_product(Net const& net, T u, T v)
{
    constexpr int N = int(std::extent_v<decltype(Basis::b)>);
    Basis const U(u), V(v);
    FrameOn<T, Basis> s;
    unrolled<N>([&](auto i) {
        float3<T> b[N];
        unrolled<N>([&](auto j) { b[j] = net(i, j); });
        components([&](auto of) {
            auto const sum = [&](T const(&weight)[N]) -> T {
                return [&]<int... j>(std::integer_sequence<int, j...>)->T
                {
                    return (... + (weight[j] * of(b[j])));
                }
                (std::make_integer_sequence<int, N>());
            };
            T const row = sum(V.b);
            T const row_dv = sum(V.d);
            if constexpr (i == 0) {
                of(s.position) = U.b[0] * row;
                of(s.du) = U.d[0] * row;
                of(s.dv) = U.b[0] * row_dv;
            } else {
                of(s.position) = of(s.position) + U.b[i] * row;
                of(s.du) = of(s.du) + U.d[i] * row;
                of(s.dv) = of(s.dv) + U.b[i] * row_dv;
            }
            if constexpr (SecondOrderBasis<Basis>) {
                T const row_dvv = sum(V.dd);
                T const zero(0);
                of(s.duu) = (i == 0 ? zero : of(s.duu)) + U.dd[i] * row;
                of(s.duv) = (i == 0 ? zero : of(s.duv)) + U.d[i] * row_dv;
                of(s.dvv) = (i == 0 ? zero : of(s.dvv)) + U.b[i] * row_dvv;
            }
        });
    });
    return s;
}

/// A patch as seen from its first control point: what is a difference does not round in the units
/// of where the patch lies.
template <class T, class Patch> class FromFirstPoint {
public:
    constexpr explicit FromFirstPoint(Patch const& patch) : origin(patch[0].position), patch_(patch)
    {
    }
    constexpr ControlVertex<T> operator[](int i) const
    {
        return {float3<T>(patch_[i].position - origin)};
    }
    float3<T> const origin;

private:
    Patch const& patch_;
};

/// evaluate(patch) of a patch seen from its first control point, moved back.
template <class T, class Patch, class Evaluate>
constexpr SecondOrderFrame<T> second_order_of(Patch const& patch, Evaluate const& evaluate)
{
    FromFirstPoint<T, Patch> const near(patch);
    SecondOrderFrame<T> s = evaluate(near);
    s.position = near.origin + s.position;
    return s;
}

/// Quartic Bezier triangle by de Casteljau's algorithm.
///
/// \param b        15 points: b[row][k], row = 4 - (first index), k = (third index), so
///                 b[0] = {b400}, b[1] = {b310, b301}, b[2] = {b220, b211, b202}, ...
/// \param u, v, w  barycentric, w = 1-u-v, weights of corners b400, b040, b004
/// \returns        position, and a quarter of the derivatives along (1,0,-1) and (0,1,-1)
/// \cost           180 mul
template <class T>
constexpr TangentFrame<T> quartic_triangle(float3<T> const (&b)[5][5], T u, T v, T w)
{
    float3<T> q[5][5];
    unrolled<5>([&](auto r) { unrolled<r + 1>([&](auto k) { q[r][k] = b[r][k]; }); });
    unrolled<3>([&](auto step) {
        unrolled<4 - step>([&](auto r) {
            unrolled<r + 1>(
                [&](auto k) { q[r][k] = u * q[r][k] + v * q[r + 1][k] + w * q[r + 1][k + 1]; });
        });
    });
    TangentFrame<T> s;
    s.position = u * q[0][0] + v * q[1][0] + w * q[1][1];
    s.du = q[0][0] - q[1][1];
    s.dv = q[1][0] - q[1][1];
    return s;
}

} // namespace tessemu
