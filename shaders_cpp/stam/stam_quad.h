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

/// Position and derivatives at (u,v); at (0,0), where these are zero or infinite, the limit
/// position and two tangents that span the tangent plane.
///
/// The weight lambda^k of a function takes 3 multiplications, of its value and its two derivatives;
/// 2 of them are won back, because B-splines add up to 1: a sum q = B . (q0, q1, q2, q3) is q1 and
/// three products.
///
/// \param point  point(i): C^_i, asked for once each
/// \cost         away from (0,0) 54 mul a function (LOOP10's 54 of 108n + 534), and 61 beside them
///               (67 with the cross product)
template <class T, class Weight, class Point>
constexpr TangentFrame<T> stam_quad(StamTables<Weight> const& tables, Point const& point, T u, T v)
{
    using Int = int_of<T>;
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
        !corner,
        [&] {
            StamRing<T> const at(u, v);
            BsplineBasis<T> const A(at.a), B(at.b);
            Int const first_power = at.k * Int(tables.functions);
            StamFrame<T> sum{zero, zero, zero};
            for (int sub : loop<T>(3))
                sum = when(
                    at.sub_patch == Int(sub),
                    [&] {
                        StamFrame<T> r{zero, zero, zero};
                        // From the small ones to the constant one, which is the limit position:
                        // so the sums of the others do not round in its units.
                        for (int turn : loop<T>(tables.functions)) {
                            int const i = tables.functions - 1 - turn;
                            int const first = (sub * tables.functions + i) * 16;
                            T q[4], dq[4];
                            unrolled<4>([&](auto c) {
                                T const x0 = load<T>(tables.splines, first + 4 * c),
                                        x1 = load<T>(tables.splines, first + 4 * c + 1),
                                        x2 = load<T>(tables.splines, first + 4 * c + 2),
                                        x3 = load<T>(tables.splines, first + 4 * c + 3);
                                q[c] = B.b[0] * x0 + B.b[1] * x1 + B.b[2] * x2 + B.b[3] * x3;
                                dq[c] = B.d[0] * x0 + B.d[1] * x1 + B.d[2] * x2 + B.d[3] * x3;
                            });
                            auto const along = [&](T const(&x)[4]) -> T {
                                return x[1] + A.b[0] * T(x[0] - x[1]) + A.b[2] * T(x[2] - x[1]) +
                                       A.b[3] * T(x[3] - x[1]);
                            };
                            T const power = load<T>(tables.powers, first_power + Int(i));
                            T const phi = power * along(q), phi_v = power * along(dq);
                            T const sum_u =
                                A.d[0] * q[0] + A.d[1] * q[1] + A.d[2] * q[2] + A.d[3] * q[3];
                            T const phi_u = power * sum_u;
                            float3<T> const C = point(i);
                            r.position = r.position + phi * C;
                            r.du = r.du + phi_u * C;
                            r.dv = r.dv + phi_v * C;
                        }
                        return r;
                    },
                    sum);
            return StamFrame<T>{sum.position, at.scale * sum.du, at.scale * sum.dv};
        },
        s);
    return {s.position, s.du, s.dv};
}

} // namespace tessemu
