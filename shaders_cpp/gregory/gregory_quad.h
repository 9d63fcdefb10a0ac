// Gregory quad patch, LOOP09 section 3 (docs/math/loop09.md, 3): 20 control points, a bicubic whose
// four interior points depend on (u,v).
//
//     p3 --e3-- . --e2+-- p2        v
//     |   f3-  f3+ f2- f2+ |        |
//    e3+   F3       F2   e2-        +-- u
//    e0-   F0       F1   e1+
//     |   f0-  f0+ f1- f1+ |
//     p0 --e0+- . --e1--- p1
//
// Control points: p 0..3, e+ 4..7, e- 8..11, f+ 12..15, f- 16..19; corner i's "+" belongs to the
// edge to corner i+1, its "-" to the edge to corner i-1.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bezier.h"

namespace tessemu {

/// Control points of an N-sided Gregory patch by the paper's letters.
template <int N> struct GregoryLayout {
    static constexpr int p(int i) { return i % N; }
    static constexpr int e_plus(int i) { return N + i % N; }
    static constexpr int e_minus(int i) { return 2 * N + i % N; }
    static constexpr int f_plus(int i) { return 3 * N + i % N; }
    static constexpr int f_minus(int i) { return 4 * N + i % N; }
    static constexpr int kPoints = 5 * N;
};

/// A rational face point F = (a X + b Y) / (a + b), and what its derivatives need.
template <class T> struct BlendedFacePoint {
    float3<T> point, difference; ///< F, X - Y
    T a, b, reciprocal;          ///< 1 / (a + b)

    constexpr BlendedFacePoint() = default;
    /// At the patch's corner a + b is 0 and so is F's Bernstein factor: any finite F will do.
    constexpr BlendedFacePoint(T a_, float3<T> const& X, T b_, float3<T> const& Y) : a(a_), b(b_)
    {
        T const sum = a + b;
        reciprocal = T(1) / select(sum == T(0), T(1), sum);
        T const wa = a * reciprocal, wb = b * reciprocal;
        point = wa * X + wb * Y;
        difference = X - Y;
    }
    /// (b da - a db) (X - Y) / (a + b)^2
    constexpr float3<T> derivative(T da, T db) const
    {
        T const numerator = b * da - a * db;
        T const scale = numerator * reciprocal;
        T const scale2 = scale * reciprocal;
        return scale2 * difference;
    }
};

/// Gregory quad patch at (u,v): Q = B3(u) G B3(v).
///
/// \param patch         20 control points, object space; each is fetched once
/// \param true_normals  tangents of the rational surface; otherwise those of the Bezier patch whose
///                      F are frozen at (u,v) (LOOP09 4.4), equal to them on the edges
/// \returns             position and derivatives along u and v
/// \cost                frozen: 188 mul, 4 div (with the cross product 194 + 4 = 198)
template <class T>
constexpr TangentFrame<T> gregory_quad(auto const& patch, T u, T v, bool true_normals = false)
{
    using L = GregoryLayout<4>;
    Routine<T> const here("gregory_quad");
    T const U = T(1) - u, V = T(1) - v;
    auto const at = [&](int i) { return patch[i].position; };
    BlendedFacePoint<T> F0, F1, F2, F3;

    // Each face point is made when its row asks for it, which keeps few values alive at a time.
    constexpr int net[4][4] = {{L::p(0), L::e_minus(0), L::e_plus(3), L::p(3)},
                               {L::e_plus(0), -1, -1, L::e_minus(3)},
                               {L::e_minus(1), -1, -1, L::e_plus(2)},
                               {L::p(1), L::e_plus(1), L::e_minus(2), L::p(2)}};
    auto const point = [&](int i, int j) -> float3<T> {
        if (i == 1 && j == 1) return (F0 = {u, at(L::f_plus(0)), v, at(L::f_minus(0))}).point;
        if (i == 2 && j == 1) return (F1 = {U, at(L::f_minus(1)), v, at(L::f_plus(1))}).point;
        if (i == 2 && j == 2) return (F2 = {U, at(L::f_plus(2)), V, at(L::f_minus(2))}).point;
        if (i == 1 && j == 2) return (F3 = {u, at(L::f_minus(3)), V, at(L::f_plus(3))}).point;
        return at(net[i][j]);
    };
    TangentFrame<T> s = tensor_product<T>(point, u, v);
    if (true_normals) {
        CubicBasis<T> const Bu(u), Bv(v);
        T const zero(0), one(1);
        T const w0 = Bu.b[1] * Bv.b[1], w1 = Bu.b[2] * Bv.b[1], w2 = Bu.b[2] * Bv.b[2],
                w3 = Bu.b[1] * Bv.b[2];
        s.du = s.du + w0 * F0.derivative(one, zero) + w1 * F1.derivative(-one, zero) +
               w2 * F2.derivative(-one, zero) + w3 * F3.derivative(one, zero);
        s.dv = s.dv + w0 * F0.derivative(zero, one) + w1 * F1.derivative(zero, one) +
               w2 * F2.derivative(zero, -one) + w3 * F3.derivative(zero, -one);
    }
    return s;
}

} // namespace tessemu
