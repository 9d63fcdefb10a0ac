// Stam's exact evaluation of a Catmull-Clark surface at an extraordinary vertex, LOOP10 4.2
// (docs/stam.md).
//
//     S(u,v) = sum over i of lambda_i^k phi_i(u', v') C^_i,     k = floor(-log2(max(u, v)))
//
//     +-------+-------+  1       The patch's quarter at the vertex (0,0) is the patch again, a step
//     |       |       |          of subdivision later, at half the size. So (u,v) lies in ring k,
//     |   2   |   1   |          and (2^k u, 2^k v) in one of three bicubic B-spline patches, where
//     |       |       |          each of the 2n + 8 eigen functions phi_i is evaluated.
//     +---+---+-------+  1/2
//     | 2 | 1 |       |          The net in eigen space, C^ = V^-1 C, is the hull shader's.
//     +-+-+---+   0   |
//     +-+-+ 0 |       |
//     +-+-+---+-------+
//     0      1/2      1
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/bspline_quad.h"

namespace tessemu {

/// Domain points are multiples of 2^-16: k is at most 16, and powers are a table, never made by
/// logarithms, for valence 3 has an eigenvalue that is 0.
inline constexpr int kStamRings = 17;

/// Of a valence.
template <class Weight = float> struct StamTables {
    int functions = 0;      ///< 2n + 8
    Buffer<Weight> splines; ///< [sub-patch][function][4 column + row]: the eigen functions
    Buffer<Weight> powers;  ///< [k][function]: lambda^k, rounded once

    void add_to(std::vector<ResourceInfo>& resources) const
    {
        resources.push_back(splines.info());
        resources.push_back(powers.info());
    }
};

/// Ring and sub-patch of a domain point that is not (0,0).
template <class T> struct StamRing {
    int_of<T> k, sub_patch; ///< sub_patch: 0 to 2
    T scale;                ///< 2^(k+1): how many sub-patches are as wide as the patch
    T a, b;                 ///< in the sub-patch, each in [0,1]; exact

    /// \cost  7 mul
    constexpr StamRing(T u, T v)
    {
        using Int = int_of<T>;
        // The largest k with 2^k max(u,v) <= 1, by powers of two, which are exact. On a line
        // between rings both have the point.
        T m = max(u, v);
        k = Int(0);
        for (int step : {16, 8, 4, 2, 1}) {
            T const larger = T(float(1 << step)) * m;
            auto const fits = larger <= T(1);
            m = select(fits, larger, m);
            k = select(fits, k + Int(step), k);
        }
        scale = T(Int(2) << k);
        T const zero(0), one(1), half(0.5), ring(Int(1) << k);
        u = ring * u;
        v = ring * v;
        auto const right = u > half, top = v > half;
        sub_patch = select(top, select(right, Int(1), Int(2)), Int(0));
        a = u + u - select(right, one, zero);
        b = v + v - select(top, one, zero);
    }
};

/// A TangentFrame as a record.
template <class T> struct StamFrame {
    float3<T> position, du, dv;
    static constexpr auto signature()
    {
        return std::tuple{&StamFrame::position, &StamFrame::du, &StamFrame::dv};
    }
};

/// Position and derivatives at (u,v), which is not (0,0).
///
/// The weight lambda^k of a function takes 3 multiplications, of its value and its two derivatives;
/// 2 of them are won back, because B-splines add up to 1: a sum q = B . (q0, q1, q2, q3) is q1 and
/// three products.
///
/// \tparam Basis  of the sub-patches; second derivatives are made where it has them
/// \param point   point(i): C^_i, asked for once each
/// \cost          see stam_quad
template <class T, class Basis, class Weight, class Point>
constexpr auto stam_ring_sum(StamTables<Weight> const& tables, Point const& point, T u, T v)
{
    using Int = int_of<T>;
    constexpr bool kSecond = SecondOrderBasis<Basis>;
    using Derivatives = std::conditional_t<kSecond, SecondOrderFrame<T>, StamFrame<T>>;
    float3<T> const zero(T(0), T(0), T(0));
    auto const nothing = [&] {
        if constexpr (kSecond)
            return Derivatives{zero, zero, zero, zero, zero, zero};
        else
            return Derivatives{zero, zero, zero};
    };
    StamRing<T> const at(u, v);
    Basis const A(at.a), B(at.b);
    Int const first_power = at.k * Int(tables.functions);
    Derivatives sum = nothing();
    for (int sub : loop<T>(3))
        sum = when(
            at.sub_patch == Int(sub),
            [&] {
                Derivatives r = nothing();
                // From the small ones to the constant one, which is the limit position: so the sums
                // of the others do not round in its units.
                for (int turn : loop<T>(tables.functions)) {
                    int const i = tables.functions - 1 - turn;
                    if constexpr (kSecond) { // or its rounding would be a derivative, times 4^(k+1)
                        if (i == 0) {
                            r.position = r.position + point(i);
                            break;
                        }
                    }
                    int const first = (sub * tables.functions + i) * 16;
                    T q[4], dq[4], ddq[4];
                    unrolled<4>([&](auto c) {
                        T const x0 = load<T>(tables.splines, first + 4 * c),
                                x1 = load<T>(tables.splines, first + 4 * c + 1),
                                x2 = load<T>(tables.splines, first + 4 * c + 2),
                                x3 = load<T>(tables.splines, first + 4 * c + 3);
                        q[c] = B.b[0] * x0 + B.b[1] * x1 + B.b[2] * x2 + B.b[3] * x3;
                        dq[c] = B.d[0] * x0 + B.d[1] * x1 + B.d[2] * x2 + B.d[3] * x3;
                        if constexpr (kSecond)
                            ddq[c] = B.dd[0] * x0 + B.dd[1] * x1 + B.dd[2] * x2 + B.dd[3] * x3;
                    });
                    auto const along = [&](T const(&x)[4]) -> T {
                        return x[1] + A.b[0] * T(x[0] - x[1]) + A.b[2] * T(x[2] - x[1]) +
                               A.b[3] * T(x[3] - x[1]);
                    };
                    T const power = load<T>(tables.powers, first_power + Int(i));
                    T const phi = power * along(q), phi_v = power * along(dq);
                    T const sum_u = A.d[0] * q[0] + A.d[1] * q[1] + A.d[2] * q[2] + A.d[3] * q[3];
                    T const phi_u = power * sum_u;
                    float3<T> const C = point(i);
                    r.position = r.position + phi * C;
                    r.du = r.du + phi_u * C;
                    r.dv = r.dv + phi_v * C;
                    if constexpr (kSecond) {
                        auto const sum_of = [](T const(&d)[4], T const(&x)[4]) -> T {
                            return d[0] * x[0] + d[1] * x[1] + d[2] * x[2] + d[3] * x[3];
                        };
                        T const phi_uu = power * sum_of(A.dd, q), phi_uv = power * sum_of(A.d, dq),
                                phi_vv = power * along(ddq);
                        r.duu = r.duu + phi_uu * C;
                        r.duv = r.duv + phi_uv * C;
                        r.dvv = r.dvv + phi_vv * C;
                    }
                }
                return r;
            },
            sum);
    Derivatives scaled = nothing();
    scaled.position = sum.position;
    scaled.du = at.scale * sum.du;
    scaled.dv = at.scale * sum.dv;
    if constexpr (kSecond) {
        T const squared = at.scale * at.scale;
        scaled.duu = squared * sum.duu;
        scaled.duv = squared * sum.duv;
        scaled.dvv = squared * sum.dvv;
    }
    return scaled;
}

/// Position and derivatives at (u,v); at (0,0), where these are zero or infinite, the limit
/// position and two tangents that span the tangent plane.
///
/// \param point  point(i): C^_i, asked for once each
/// \cost         away from (0,0) 54 mul a function (LOOP10's 54 of 108n + 534), and 61 beside them
///               (67 with the cross product)
template <class T, class Weight, class Point>
constexpr TangentFrame<T> stam_quad(StamTables<Weight> const& tables, Point const& point, T u, T v)
{
    Routine<T> const here("stam_quad");
    float3<T> const zero(T(0), T(0), T(0));
    StamFrame<T> s{zero, zero, zero};
    mask_of<T> const first_u = u == T(0), first_v = v == T(0), corner = first_u & first_v;
    s = when(
        corner,
        [&] {
            return StamFrame<T>{point(0), point(1), point(2)};
        },
        s);
    s = when(
        !corner, [&] { return stam_ring_sum<T, BsplineBasis<T>>(tables, point, u, v); }, s);
    return {s.position, s.du, s.dv};
}

/// The same with second derivatives; at (0,0), where these are infinite for most valences, those of
/// the nearest domain point, (2^-16, 2^-16).
template <class T, class Weight, class Point>
constexpr SecondOrderFrame<T> stam_second_order(StamTables<Weight> const& tables,
                                                Point const& point, T u, T v)
{
    Routine<T> const here("stam_second_order");
    T const zero(0), nearest(0x1p-16f);
    mask_of<T> const first_u = u == zero, first_v = v == zero, corner = first_u & first_v;
    return stam_ring_sum<T, SecondOrderBsplineBasis<T>>(tables, point, select(corner, nearest, u),
                                                        select(corner, nearest, v));
}

} // namespace tessemu
