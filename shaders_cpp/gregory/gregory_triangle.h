// Gregory triangle patch, LOOP09 section 3 (docs/math/loop09.md, 3): 15 control points, a quartic
// Bezier triangle whose three interior points depend on (u,v,w) and whose edges are cubics.
//
//            p2
//          e2+  e2-           corner weights: u at p0, v at p1, w at p2
//        e0-  f2  e1+
//       p0 e0+   e1- p1
//
// Control points: p 0..2, e+ 3..5, e- 6..8, f+ 9..11, f- 12..14.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/gregory_quad.h"

namespace tessemu {

/// Gregory triangle patch at (u,v,w).
///
/// \param patch         15 control points, object space; each is fetched once
/// \param true_normals  as for gregory_quad
/// \returns             position, and a quarter of the derivatives along (1,0,-1) and (0,1,-1)
/// \cost                frozen: 249 mul, 3 div (with the cross product 255 + 3 = 258)
template <class T>
constexpr TangentFrame<T> gregory_triangle(auto const& patch, T u, T v, T w,
                                           bool true_normals = false)
{
    using L = GregoryLayout<3>;
    Routine<T> const here("gregory_triangle");
    auto const at = [&](int i) { return patch[i].position; };
    BlendedFacePoint<T> const F211(w, at(L::f_minus(0)), v, at(L::f_plus(0)));
    BlendedFacePoint<T> const F121(u, at(L::f_minus(1)), w, at(L::f_plus(1)));
    BlendedFacePoint<T> const F112(v, at(L::f_minus(2)), u, at(L::f_plus(2)));

    float3<T> const p0 = at(L::p(0)), p1 = at(L::p(1)), p2 = at(L::p(2));
    float3<T> const e0p = at(L::e_plus(0)), e1p = at(L::e_plus(1)), e2p = at(L::e_plus(2));
    float3<T> const e0m = at(L::e_minus(0)), e1m = at(L::e_minus(1)), e2m = at(L::e_minus(2));

    // The cubic edges raised to degree four.
    auto const raised = [](float3<T> const& p, float3<T> const& e) -> float3<T> {
        float3<T> const sum = p + T(3) * e;
        return T(0.25) * sum;
    };
    auto const middle = [](float3<T> const& a, float3<T> const& b) -> float3<T> {
        float3<T> const sum = a + b;
        return T(0.5) * sum;
    };
    float3<T> const b[5][5] = {
        {p0},
        {raised(p0, e0p), raised(p0, e0m)},
        {middle(e0p, e1m), F211.point, middle(e2p, e0m)},
        {raised(p1, e1m), F121.point, F112.point, raised(p2, e2p)},
        {p1, raised(p1, e1p), middle(e1p, e2m), raised(p2, e2m), p2},
    };
    TangentFrame<T> s = quartic_triangle<T>(b, u, v, w);
    if (true_normals) {
        T const zero(0), one(1);
        T const vw = v * w;
        T const uvw = u * vw;
        T const k = T(3) * uvw;
        T const ku = k * u, kv = k * v, kw = k * w;
        s.du = s.du + ku * F211.derivative(-one, zero) + kv * F121.derivative(one, -one) +
               kw * F112.derivative(zero, one);
        s.dv = s.dv + ku * F211.derivative(-one, one) + kv * F121.derivative(zero, -one) +
               kw * F112.derivative(one, zero);
    }
    return s;
}

} // namespace tessemu
