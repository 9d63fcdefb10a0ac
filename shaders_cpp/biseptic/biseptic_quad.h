// Patch of degree 7 by 7, LOOP10 4.3 (docs/biseptic.md): 8 x 8 Bezier points.
//
//     S(u,v) = sum over i, j of B^7_i(u) B^7_j(v) b_ij
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bernstein.h"
#include "shaders_cpp/bezier.h"

namespace tessemu {

inline constexpr int kBisepticDegree = 7, kBisepticSide = kBisepticDegree + 1;

/// \param net  net(i, j): point i along u, j along v; asked for once each
/// \returns    position and a seventh of the derivatives along u and v
/// \cost       568 mul: twice 56 for a basis, 384 for the rows, 72 for their sums; as LOOP10
///             counts (574 with the cross product)
template <class T, class Net> constexpr TangentFrame<T> biseptic_quad(Net const& net, T u, T v)
{
    Routine<T> const here("biseptic_quad");
    return tensor_product<T, BernsteinBasis<kBisepticDegree, T>>(net, u, v);
}

/// The same with second derivatives, all by u and v themselves.
template <class T, class Net>
constexpr SecondOrderFrame<T> biseptic_second_order(Net const& net, T u, T v)
{
    Routine<T> const here("biseptic_second_order");
    SecondOrderFrame<T> s =
        tensor_product<T, SecondOrderBernsteinBasis<kBisepticDegree, T>>(net, u, v);
    T const first(kBisepticDegree), both(kBisepticDegree * kBisepticDegree),
        second(kBisepticDegree * (kBisepticDegree - 1));
    s.du = first * s.du, s.dv = first * s.dv;
    s.duu = second * s.duu, s.duv = both * s.duv, s.dvv = second * s.dvv;
    return s;
}

/// A spoke, and the normal's direction there.
///
/// \param point   point(i): b_i0 of the patch whose edge v = 0 the spoke is
/// \param across  across(i): b_i1 - b_i0 of the same patch
/// \param t       from the extraordinary vertex
/// \cost          134 mul
template <class T, class Point, class Across>
constexpr SurfacePoint<T> biseptic_spoke(Point const& point, Across const& across, T t)
{
    Routine<T> const here("biseptic_spoke");
    BernsteinBasis<kBisepticDegree, T> const B(t);
    float3<T> const zero(T(0), T(0), T(0));
    TangentFrame<T> s{zero, zero, zero};
    for (int i : loop<T>(kBisepticSide)) {
        float3<T> const b = point(i);
        s.position = s.position + B.b[i] * b;
        s.du = s.du + B.d[i] * b;
        s.dv = s.dv + B.b[i] * across(i);
    }
    return {s.position, cross(s.du, s.dv)};
}

} // namespace tessemu
