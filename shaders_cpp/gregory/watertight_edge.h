// Patch edges with equal bits from both sides: LOOP09 section 4.5, worked out for positions and
// normals.
//
// Both patches evaluate the same cubic (p, e, e, p) of shared control points and the same normal
// field N(t) = u(t) x W(t), in the edge's canonical direction (from the smaller to the larger
// vertex id), by the same routine. W is the mean of the two inward transversal fields, a cubic of
// vertex data only.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bezier.h"

namespace tessemu {

/// A register of the patch constants.
///
/// Registers 4k + m, m = 0..3, hold the transversal field W of edge k (corner k to k+1) in
/// canonical direction; after those of all edges, registers 2i and 2i + 1 hold two tangents of
/// corner i.
template <class T> struct EdgeRegister {
    float3<T> vector;
    T reversed; ///< of the edge: 1 if its canonical direction runs from corner k+1 to k, else 0
    static constexpr auto signature()
    {
        return std::tuple{&EdgeRegister::vector, &EdgeRegister::reversed};
    }
};

/// Point and normal direction of a shared edge.
///
/// \param pa, ea, eb, pb  the edge's cubic in canonical direction
/// \param W               transversal field, cubic
/// \param t               parameter in canonical direction; 1-t must be exact
/// \cost                  51 mul, 42 add
template <class T>
constexpr SurfacePoint<T> edge_point(float3<T> const& pa, float3<T> const& ea, float3<T> const& eb,
                                     float3<T> const& pb, float3<T> const (&W)[4], T t)
{
    Routine<T> const here("edge_point");
    T const s = T(1) - t;
    T const ss = s * s, tt = t * t, st = s * t;
    T const st2 = T(2) * st;
    T const b0 = ss * s, b1 = T(3) * T(ss * t), b2 = T(3) * T(tt * s), b3 = tt * t;
    SurfacePoint<T> r;
    r.position = b0 * pa + b1 * ea + b2 * eb + b3 * pb;
    float3<T> const along =
        ss * float3<T>(ea - pa) + st2 * float3<T>(eb - ea) + tt * float3<T>(pb - eb);
    float3<T> const across = b0 * W[0] + b1 * W[1] + b2 * W[2] + b3 * W[3];
    r.normal = cross(along, across);
    return r;
}

/// Boundary of an N-sided patch: edges through edge_point, corners from vertex data.
///
/// \param on  on[k]: the point lies on edge k
/// \param t   t[k]: its parameter from corner k to corner k+1
template <int N, class T>
constexpr SurfacePoint<T> boundary_point(ControlPoints<ControlVertex<T>> const& patch,
                                         ControlPoints<EdgeRegister<T>> const& registers,
                                         mask_of<T> const (&on)[N], T const (&t)[N])
{
    float3<T> const zero(T(0), T(0), T(0));
    SurfacePoint<T> s{zero, zero};
    for (int k : loop<T>(N)) {
        int const next = (k + 1) % N, previous = (k + N - 1) % N;
        auto const inside_edge = on[k] & !(on[next] | on[previous]);
        s = when(
            inside_edge,
            [&] {
                EdgeRegister<T> const first = registers[4 * k];
                float3<T> const W[4] = {first.vector, registers[4 * k + 1].vector,
                                        registers[4 * k + 2].vector, registers[4 * k + 3].vector};
                // p, e+ of corner k and e-, p of corner k+1
                float3<T> const p0 = patch[k].position, e0 = patch[N + k].position,
                                e1 = patch[2 * N + next].position, p1 = patch[next].position;
                auto const reversed = first.reversed > T(0);
                return edge_point<T>(select(reversed, p1, p0), select(reversed, e1, e0),
                                     select(reversed, e0, e1), select(reversed, p0, p1), W,
                                     select(reversed, T(1) - t[k], t[k]));
            },
            s);
        s = when(
            on[k] & on[previous],
            [&] {
                float3<T> const a = registers[4 * N + 2 * k].vector;
                float3<T> const b = registers[4 * N + 2 * k + 1].vector;
                return SurfacePoint<T>{patch[k].position, cross(a, b)};
            },
            s);
    }
    return s;
}

} // namespace tessemu
