// Approximate Catmull-Clark patch (ACC, Loop and Schaefer 2008): a bicubic for the position and two
// tangent patches for the normal; docs/math/loop09.md, 5.
//
//     b03--b13--b23--b33     v     Control points corner by corner, p 0..3, e+ 4..7, e- 8..11,
//      |    |    |    |      |     inner 12..15 by corner; then the corners' tangents towards the
//     b02--b12--b22--b32     +-u   next corner, t+ 16..19, and towards the previous, t- 20..23;
//      |    |    |    |            24 holds the corners' cosines divided by 3.
//     b01--b11--b21--b31
//      |    |    |    |
//     b00--b10--b20--b30
//
// LOOP09 counts 25 control points and does not itemise them. These 25 are what is needed and
// sufficient: the other 16 tangent vectors are differences and the edge rule.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/cubic_edges.h"

namespace tessemu {

/// A register: a point or a vector (w unused), or the four cosines.
template <class T> struct AccControlPoint {
    float4<T> value;
    static constexpr auto signature() { return std::tuple{&AccControlPoint::value}; }
    constexpr float3<T> xyz() const { return {value.x, value.y, value.z}; }
};

struct AccLayout {
    static constexpr int p(int i) { return i % 4; }
    static constexpr int e_plus(int i) { return 4 + i % 4; }
    static constexpr int e_minus(int i) { return 8 + i % 4; }
    static constexpr int inner(int i) { return 12 + i % 4; }
    static constexpr int t_plus(int i) { return 16 + i % 4; }
    static constexpr int t_minus(int i) { return 20 + i % 4; }
    static constexpr int kCosines = 24;
    static constexpr int kPoints = 25;
};

/// The two vectors of an edge's inward field that ACC derives from the others.
///
/// \param c0, c1               cosines / 3 at the edge's ends
/// \param first, middle, last  the field along the edge, quadratic
/// \param across0, across1     inner minus edge control point at the two ends
/// \cost                       18 mul
template <class T>
constexpr std::array<float3<T>, 2> acc_edge_rule(T c0, T c1, float3<T> const& first,
                                                 float3<T> const& middle, float3<T> const& last,
                                                 float3<T> const& across0, float3<T> const& across1)
{
    T const three(3);
    return {float3<T>(T(c0 + c0) * middle - c1 * first + three * across0),
            float3<T>(c0 * last - T(c1 + c1) * middle + three * across1)};
}

/// ACC patch at (u,v).
///
/// \param patch  25 control points; each is fetched once
/// \returns      position, and the tangent fields U and W: dS/du and dS/dv where the patch is
///               regular
/// \cost         266 mul (272 with the cross product)
template <class T>
constexpr TangentFrame<T> acc_quad(ControlPoints<AccControlPoint<T>> const& patch, T u, T v)
{
    using L = AccLayout;
    using V = float3<T>;
    Routine<T> const here("acc_quad");
    auto const at = [&](int i) { return patch[i].xyz(); };
    V const p0 = at(L::p(0)), p1 = at(L::p(1)), p2 = at(L::p(2)), p3 = at(L::p(3));
    V const b[4][4] = {{p0, at(L::e_minus(0)), at(L::e_plus(3)), p3},
                       {at(L::e_plus(0)), at(L::inner(0)), at(L::inner(3)), at(L::e_minus(3))},
                       {at(L::e_minus(1)), at(L::inner(1)), at(L::inner(2)), at(L::e_plus(2))},
                       {p1, at(L::e_plus(1)), at(L::e_minus(2)), p2}};
    float4<T> const c = patch[L::kCosines].value;
    T const three(3);
    auto const du = [&](int j) -> V { return three * V(b[2][j] - b[1][j]); };
    auto const dv = [&](int i) -> V { return three * V(b[i][2] - b[i][1]); };

    // U (3x4) and W (4x3); each edge's inward field is completed by the edge rule.
    V const U00 = at(L::t_plus(0)), U20 = -at(L::t_minus(1)), U03 = at(L::t_minus(3)),
            U23 = -at(L::t_plus(2));
    V const W00 = at(L::t_minus(0)), W02 = -at(L::t_plus(3)), W30 = at(L::t_plus(1)),
            W32 = -at(L::t_minus(2));
    V const U10 = du(0), U11 = du(1), U12 = du(2), U13 = du(3);
    V const W01 = dv(0), W11 = dv(1), W21 = dv(2), W31 = dv(3);
    auto const bottom =
        acc_edge_rule<T>(c.x, c.y, U00, U10, U20, b[1][1] - b[1][0], b[2][1] - b[2][0]);
    auto const top =
        acc_edge_rule<T>(c.w, c.z, U03, U13, U23, b[1][2] - b[1][3], b[2][2] - b[2][3]);
    auto const left =
        acc_edge_rule<T>(c.x, c.w, W00, W01, W02, b[1][1] - b[0][1], b[1][2] - b[0][2]);
    auto const right =
        acc_edge_rule<T>(c.y, c.z, W30, W31, W32, b[2][1] - b[3][1], b[2][2] - b[3][2]);

    T const su = T(1) - u, sv = T(1) - v;
    T const uu = u * u, vv = v * v, suu = su * su, svv = sv * sv;
    T const usu = su * u, vsv = sv * v;
    T const Bu[4] = {suu * su, T(3) * T(suu * u), T(3) * T(uu * su), uu * u};
    T const Bv[4] = {svv * sv, T(3) * T(svv * v), T(3) * T(vv * sv), vv * v};
    T const Qu[3] = {suu, T(2) * usu, uu}, Qv[3] = {svv, T(2) * vsv, vv};
    auto const cubic = [](T const(&B)[4], V const& a0, V const& a1, V const& a2, V const& a3) -> V {
        return B[0] * a0 + B[1] * a1 + B[2] * a2 + B[3] * a3;
    };
    auto const quadratic = [](T const(&B)[3], V const& a0, V const& a1, V const& a2) -> V {
        return B[0] * a0 + B[1] * a1 + B[2] * a2;
    };
    // One after the other: in an argument list the order would be the compiler's.
    V const s0 = cubic(Bv, b[0][0], b[0][1], b[0][2], b[0][3]),
            s1 = cubic(Bv, b[1][0], b[1][1], b[1][2], b[1][3]),
            s2 = cubic(Bv, b[2][0], b[2][1], b[2][2], b[2][3]),
            s3 = cubic(Bv, b[3][0], b[3][1], b[3][2], b[3][3]);
    V const position = cubic(Bu, s0, s1, s2, s3);
    V const U0 = cubic(Bv, U00, left[0], left[1], U03), U1 = cubic(Bv, U10, U11, U12, U13),
            U2 = cubic(Bv, U20, -right[0], -right[1], U23);
    V const W0 = cubic(Bu, W00, bottom[0], bottom[1], W30), W1 = cubic(Bu, W01, W11, W21, W31),
            W2 = cubic(Bu, W02, -top[0], -top[1], W32);
    V const along_u = quadratic(Qu, U0, U1, U2);
    V const along_v = quadratic(Qv, W0, W1, W2);
    return {position, along_u, along_v};
}

struct AccQuadInside : TangentPairCorners<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = AccLayout::kPoints;
    template <class T> using ControlPoint = AccControlPoint<T>;

    template <class T>
    static constexpr TangentFrame<T> evaluate(ControlPoints<AccControlPoint<T>> const& patch,
                                              DomainInput<T> const& in, bool)
    {
        return acc_quad<T>(patch, in.u, in.v);
    }

    /// ACC's edge condition is about its tangent field, which begins and ends with the corners'
    /// tangents. Where a cosine is 0 the tangent is the cubic's derivative, and a regular patch on
    /// the other side knows only that: both take the difference.
    template <class T>
    static constexpr EdgeCurve<T> edge(ControlPoints<AccControlPoint<T>> const& patch, int k)
    {
        using L = AccLayout;
        using V = float3<T>;
        int const next = (k + 1) % 4;
        auto const at = [&](int i) { return patch[i].xyz(); };
        V const p0 = at(L::p(k)), p1 = at(L::e_plus(k)), p2 = at(L::e_minus(next)),
                p3 = at(L::p(next));
        V const first = at(L::t_plus(k)), last = -at(L::t_minus(next));
        float4<T> const cosines = patch[L::kCosines].value;
        T const c[4] = {cosines.x, cosines.y, cosines.z, cosines.w};
        T const third(1.0 / 3);
        return {p0,
                p1,
                p2,
                p3,
                select(c[k] == T(0), V(p1 - p0), V(third * first)),
                select(c[next] == T(0), V(p3 - p2), V(third * last))};
    }
    template <class T>
    static constexpr float3<T> corner(ControlPoints<AccControlPoint<T>> const& patch, int i)
    {
        return patch[AccLayout::p(i)].xyz();
    }
};

using AccQuadDomainShader = WatertightPatch<AccQuadInside>;

} // namespace tessemu
