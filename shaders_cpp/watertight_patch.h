// Patches whose edges have equal bits from both sides: LOOP09 section 4.5, worked out for positions
// and normals (docs/math/loop09.md, 9).
//
// Both patches evaluate the same cubic (p, e, e, p) of shared control points and the same normal
// field N(t) = u(t) x W(t), in the edge's canonical direction (from the smaller to the larger
// vertex id), by the same routine. W is the mean of the two inward transversal fields, a cubic of
// vertex data only. A scheme says how its inside is evaluated and what its edges' curves are.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bezier.h"
#include "shaders_cpp/domain_edges.h"

namespace tessemu {

/// A register of the patch constants.
///
/// Registers 4k + m, m = 0..3, hold the transversal field W of edge k (corner k to k+1) in
/// canonical direction; after those of all edges come the corners' normals, or two tangents for
/// each.
template <class T> struct EdgeRegister {
    float3<T> vector;
    T reversed; ///< of the edge: 1 if its canonical direction runs from corner k+1 to k, else 0
    static constexpr auto signature()
    {
        return std::tuple{&EdgeRegister::vector, &EdgeRegister::reversed};
    }
};

/// A patch's edge: a cubic, and the field u(t) along it that the scheme's edge condition is about,
/// B2[first, p2 - p1, last] but for a common factor. The cubic's own derivative has first = p1 - p0
/// and last = p3 - p2.
template <class T> struct EdgeCurve {
    float3<T> p0, p1, p2, p3, first, last;
    static constexpr auto signature()
    {
        return std::tuple{&EdgeCurve::p0, &EdgeCurve::p1,    &EdgeCurve::p2,
                          &EdgeCurve::p3, &EdgeCurve::first, &EdgeCurve::last};
    }
};

/// The same curve from its other end.
template <class T> constexpr EdgeCurve<T> reversed(EdgeCurve<T> const& e)
{
    return {e.p3, e.p2, e.p1, e.p0, -e.last, -e.first};
}
template <class M, class T>
constexpr EdgeCurve<T> select(M mask, EdgeCurve<T> const& a, EdgeCurve<T> const& b)
{
    return select_record(mask, a, b);
}

/// Point and normal direction of a shared edge.
///
/// \param edge  in canonical direction
/// \param W     transversal field, cubic
/// \param t     parameter in canonical direction; 1-t must be exact
/// \cost        51 mul, 36 add
template <class T>
constexpr SurfacePoint<T> edge_point(EdgeCurve<T> const& edge, float3<T> const (&W)[4], T t)
{
    Routine<T> const here("edge_point");
    T const s = T(1) - t;
    T const ss = s * s, tt = t * t, st = s * t;
    T const st2 = T(2) * st;
    T const b0 = ss * s, b1 = T(3) * T(ss * t), b2 = T(3) * T(tt * s), b3 = tt * t;
    SurfacePoint<T> r;
    r.position = b0 * edge.p0 + b1 * edge.p1 + b2 * edge.p2 + b3 * edge.p3;
    float3<T> const along = ss * edge.first + st2 * float3<T>(edge.p2 - edge.p1) + tt * edge.last;
    float3<T> const across = b0 * W[0] + b1 * W[1] + b2 * W[2] + b3 * W[3];
    r.normal = cross(along, across);
    return r;
}

/// Domain shader of a patch.
///
///     struct Inside {
///         static constexpr TessellatorDomain kDomain;       // Quad or Tri
///         static constexpr int kControlPoints;
///         template <class T> using ControlPoint = ...;
///         template <class T> TangentFrame<T> evaluate(ControlPoints<ControlPoint<T>> const&,
///             DomainInput<T> const&, bool true_normals) const;
///             // or (ControlPoints<...> const&, ControlPoints<EdgeRegister<T>> const&,
///             //     DomainInput<T> const&), where the scheme keeps registers behind the corners'
///         template <class T> static EdgeCurve<T> edge(
///             ControlPoints<ControlPoint<T>> const&, int k);   // from corner k to corner k+1
///         template <class T> static float3<T> corner(
///             ControlPoints<ControlPoint<T>> const&, int i);
///         template <class T> static float3<T> corner_normal(
///             ControlPoints<EdgeRegister<T>> const&, int i);
///         // Optional: edges that are no cubics, by the same routine from both sides; t runs from
///         // corner k. Point and normal direction, which does not count where the edge's registers
///         // are 0: it is collapsed there.
///         static bool has_own_edge(int k);
///         template <class T> SurfacePoint<T> own_edge(ControlPoints<ControlPoint<T>> const&,
///             DomainInput<T> const&, int k, T t) const;
///         template <class T> SecondOrderFrame<T> second_order( // optional: see curvature.h
///             ControlPoints<ControlPoint<T>> const&, DomainInput<T> const&) const;
///         std::vector<ResourceInfo> resources() const; // optional
///     };
///
/// Quad domain: corners p0 (0,0), p1 (1,0), p2 (1,1), p3 (0,1). Tri domain: u = 1 at p0, v = 1 at
/// p1, w = 1 at p2.
template <class Inside> struct WatertightPatch {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kSides = sides_of(kDomain);
    static constexpr int kControlPoints = Inside::kControlPoints;
    template <class T> using ControlPoint = typename Inside::template ControlPoint<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;
    template <class T> using Output = SurfacePoint<T>;
    template <class T> using Patch = ControlPoints<ControlPoint<T>>;
    template <class T> using Registers = ControlPoints<EdgeRegister<T>>;

    bool true_normals = false; ///< of interior points, where the scheme tells them from its own
    Inside inside = {};

    std::vector<ResourceInfo> resources() const requires(requires(Inside i) { i.resources(); })
    {
        return inside.resources();
    }
    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in, Patch<T> const& patch,
                                         Registers<T> const& registers) const
    {
        DomainEdges<kSides, T> const at = domain_edges<kDomain>(in);
        auto boundary = at.on[0] | at.on[1] | at.on[2];
        if constexpr (kSides == 4) boundary = boundary | at.on[3];
        float3<T> const zero(T(0), T(0), T(0));
        SurfacePoint<T> const interior = when(
            !boundary,
            [&] {
                TangentFrame<T> const frame = evaluate<T>(in, patch, registers);
                return SurfacePoint<T>{frame.position, cross(frame.du, frame.dv)};
            },
            SurfacePoint<T>{zero, zero});
        SurfacePoint<T> s = when(
            boundary, [&] { return boundary_point<T>(in, patch, registers, at); }, interior);
        s.normal = unit_or(s.normal, [&] { return nearest_corner_normal<T>(registers, in); });
        return s;
    }
    /// Of the inside, on edges too.
    template <class T>
    constexpr auto second_order(Patch<T> const& patch, DomainInput<T> const& in) const
        requires(requires { this->inside.template second_order<T>(patch, in); })
    {
        return inside.template second_order<T>(patch, in);
    }

private:
    template <class T>
    constexpr TangentFrame<T> evaluate(DomainInput<T> const& in, Patch<T> const& patch,
                                       Registers<T> const& registers) const
    {
        if constexpr (requires { inside.template evaluate<T>(patch, registers, in); })
            return inside.template evaluate<T>(patch, registers, in);
        else
            return inside.template evaluate<T>(patch, in, true_normals);
    }

    /// Edges through edge_point in canonical direction, corners from vertex data.
    template <class T>
    constexpr SurfacePoint<T> boundary_point(DomainInput<T> const& in, Patch<T> const& patch,
                                             Registers<T> const& registers,
                                             DomainEdges<kSides, T> const& at) const
    {
        constexpr int N = kSides;
        float3<T> const zero(T(0), T(0), T(0));
        SurfacePoint<T> s{zero, zero};
        for (int k : loop<T>(N)) {
            int const next = (k + 1) % N, previous = (k + N - 1) % N;
            auto const inside_edge = at.on[k] & !(at.on[next] | at.on[previous]);
            s = when(
                inside_edge,
                [&] {
                    EdgeRegister<T> const first = registers[4 * k];
                    float3<T> const W[4] = {first.vector, registers[4 * k + 1].vector,
                                            registers[4 * k + 2].vector,
                                            registers[4 * k + 3].vector};
                    if constexpr (requires { Inside::has_own_edge(k); })
                        if (Inside::has_own_edge(k))
                            return own_edge_point<T>(in, patch, W, k, at.t[k]);
                    EdgeCurve<T> const e = Inside::template edge<T>(patch, k);
                    auto const back = first.reversed > T(0);
                    T const t = select(back, T(1) - at.t[k], at.t[k]);
                    return edge_point<T>(select(back, reversed(e), e), W, t);
                },
                s);
            s = when(
                at.on[k] & at.on[previous],
                [&] {
                    return SurfacePoint<T>{Inside::template corner<T>(patch, k),
                                           Inside::template corner_normal<T>(registers, k)};
                },
                s);
        }
        return s;
    }

    /// Without a normal where the edge is collapsed.
    template <class T>
    constexpr SurfacePoint<T> own_edge_point(DomainInput<T> const& in, Patch<T> const& patch,
                                             float3<T> const (&W)[4], int k, T t) const
    {
        SurfacePoint<T> s = inside.template own_edge<T>(patch, in, k, t);
        T const size = dot(W[0], W[0]) + dot(W[1], W[1]) + dot(W[2], W[2]) + dot(W[3], W[3]);
        s.normal = select(size > T(0), s.normal, float3<T>(T(0), T(0), T(0)));
        return s;
    }

    /// Where the point has no normal of its own: that of the corner at the nearer end of its edge,
    /// the end that comes first in canonical direction where both are as near; inside, of corner 0;
    /// z where that has none. Out of line: few points need it.
    template <class T>
    [[gnu::noinline]] static constexpr float3<T>
    nearest_corner_normal(Registers<T> const& registers, DomainInput<T> const& in)
    {
        DomainEdges<kSides, T> const at = domain_edges<kDomain>(in);
        float3<T> n = Inside::template corner_normal<T>(registers, 0);
        for (int k : loop<T>(kSides))
            n = when(
                at.on[k],
                [&] {
                    auto const back = registers[4 * k].reversed > T(0);
                    T const t = select(back, T(1) - at.t[k], at.t[k]); // canonical
                    float3<T> const a = Inside::template corner_normal<T>(registers, k);
                    float3<T> const b =
                        Inside::template corner_normal<T>(registers, (k + 1) % kSides);
                    return select(t <= T(0.5), select(back, b, a), select(back, a, b));
                },
                n);
        return unit_or(n, [] { return float3<T>(T(0), T(0), T(1)); });
    }
};

} // namespace tessemu
