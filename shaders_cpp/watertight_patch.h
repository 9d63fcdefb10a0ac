// Patches whose edges have equal bits from both sides: LOOP09 section 4.5, worked out for positions
// and normals.
//
// Both patches evaluate the same cubic (p, e, e, p) of shared control points and the same normal
// field N(t) = u(t) x W(t), in the edge's canonical direction (from the smaller to the larger
// vertex id), by the same routine. W is the mean of the two inward transversal fields, a cubic of
// vertex data only. A scheme says how its inside is evaluated and what its edges' curves are.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/bezier.h"

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
};

/// The edge of a patch whose control points begin with p, e+, e- (N each).
template <int N, class Patch> constexpr auto cubic_edge(Patch const& patch, int k)
{
    int const next = (k + 1) % N;
    auto const p0 = patch[k].position, p1 = patch[N + k].position;
    auto const p2 = patch[2 * N + next].position, p3 = patch[next].position;
    using T = std::remove_cvref_t<decltype(p0.x)>;
    return EdgeCurve<T>{p0, p1, p2, p3, float3<T>(p1 - p0), float3<T>(p3 - p2)};
}

/// Corners' registers are pairs of tangents, 2i and 2i + 1.
template <int N> struct TangentPairCorners {
    template <class T>
    static constexpr float3<T> corner_normal(ControlPoints<EdgeRegister<T>> const& registers, int i)
    {
        float3<T> const a = registers[4 * N + 2 * i].vector;
        float3<T> const b = registers[4 * N + 2 * i + 1].vector;
        return cross(a, b);
    }
};

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

/// Mistakes at patch edges, planted for checkers to find; each breaks a step of the recipe.
struct EdgeMistakes {
    bool own_direction = false; ///< each patch walks its edge from its own corner k to k+1
    bool mirror_pairs = false;  ///< and sums (b0 p0 + b3 p3) + (b1 p1 + b2 p2), which a contracted
                                ///< multiply-add makes unsymmetric
    bool own_normals = false;   ///< the patch's own cross product on edges and at corners
};

/// Domain shader of a patch.
///
///     struct Inside {
///         static constexpr TessellatorDomain kDomain;       // Quad or Tri
///         static constexpr int kControlPoints;
///         template <class T> using ControlPoint = ...;
///         template <class T> static TangentFrame<T> evaluate(
///             ControlPoints<ControlPoint<T>> const&, DomainInput<T> const&, bool true_normals);
///             // or (ControlPoints<...> const&, ControlPoints<EdgeRegister<T>> const&,
///             //     DomainInput<T> const&), where the scheme keeps registers behind the corners'
///         template <class T> static EdgeCurve<T> edge(
///             ControlPoints<ControlPoint<T>> const&, int k);   // from corner k to corner k+1
///         template <class T> static float3<T> corner(
///             ControlPoints<ControlPoint<T>> const&, int i);
///         template <class T> static float3<T> corner_normal(
///             ControlPoints<EdgeRegister<T>> const&, int i);
///     };
///
/// Quad domain: corners p0 (0,0), p1 (1,0), p2 (1,1), p3 (0,1). Tri domain: u = 1 at p0, v = 1 at
/// p1, w = 1 at p2.
template <class Inside> struct WatertightPatch {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kSides = kDomain == TessellatorDomain::Quad ? 4 : 3;
    static constexpr int kControlPoints = Inside::kControlPoints;
    template <class T> using ControlPoint = typename Inside::template ControlPoint<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;
    template <class T> using Output = SurfacePoint<T>;
    template <class T> using Patch = ControlPoints<ControlPoint<T>>;
    template <class T> using Registers = ControlPoints<EdgeRegister<T>>;

    bool true_normals = false; ///< of interior points, where the scheme tells them from its own
    EdgeMistakes mistakes = {};

    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in, Patch<T> const& patch,
                                         Registers<T> const& registers) const
    {
        SurfacePoint<T> s;
        if constexpr (kSides == 4) {
            mask_of<T> const on[4] = {in.v == T(0), in.u == T(1), in.v == T(1), in.u == T(0)};
            T const t[4] = {in.u, in.v, T(1) - in.u, T(1) - in.v};
            s = inside_or_boundary<T>(in, patch, registers, on, t);
        } else {
            mask_of<T> const on[3] = {in.w == T(0), in.u == T(0), in.v == T(0)};
            T const t[3] = {in.v, in.w, in.u};
            s = inside_or_boundary<T>(in, patch, registers, on, t);
        }
        s.normal = unit_or_zero(s.normal);
        return s;
    }

private:
    template <class T>
    constexpr TangentFrame<T> evaluate(DomainInput<T> const& in, Patch<T> const& patch,
                                       Registers<T> const& registers) const
    {
        if constexpr (requires { Inside::template evaluate<T>(patch, registers, in); })
            return Inside::template evaluate<T>(patch, registers, in);
        else
            return Inside::template evaluate<T>(patch, in, true_normals);
    }

    template <class T>
    constexpr SurfacePoint<T> inside_or_boundary(DomainInput<T> const& in, Patch<T> const& patch,
                                                 Registers<T> const& registers,
                                                 mask_of<T> const (&on)[kSides],
                                                 T const (&t)[kSides]) const
    {
        auto boundary = on[0] | on[1] | on[2];
        if constexpr (kSides == 4) boundary = boundary | on[3];
        float3<T> const zero(T(0), T(0), T(0));
        auto const evaluated = mistakes.own_normals ? (boundary | !boundary) : !boundary;
        SurfacePoint<T> const inside = when(
            evaluated,
            [&] {
                TangentFrame<T> const frame = evaluate<T>(in, patch, registers);
                return SurfacePoint<T>{frame.position, cross(frame.du, frame.dv)};
            },
            SurfacePoint<T>{zero, zero});
        SurfacePoint<T> s = when(
            boundary, [&] { return boundary_point<T>(patch, registers, on, t); }, inside);
        if (mistakes.own_normals) s.normal = inside.normal;
        return s;
    }

    /// Edges through edge_point, corners from vertex data.
    ///
    /// \param on  on[k]: the point lies on edge k
    /// \param t   t[k]: its parameter from corner k to corner k+1
    template <class T>
    constexpr SurfacePoint<T> boundary_point(Patch<T> const& patch, Registers<T> const& registers,
                                             mask_of<T> const (&on)[kSides],
                                             T const (&t)[kSides]) const
    {
        constexpr int N = kSides;
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
                                            registers[4 * k + 2].vector,
                                            registers[4 * k + 3].vector};
                    EdgeCurve<T> const e = Inside::template edge<T>(patch, k);
                    auto const back = first.reversed > T(0);
                    EdgeCurve<T> const canonical{
                        select(back, e.p3, e.p0),       select(back, e.p2, e.p1),
                        select(back, e.p1, e.p2),       select(back, e.p0, e.p3),
                        select(back, -e.last, e.first), select(back, -e.first, e.last)};
                    SurfacePoint<T> point =
                        edge_point<T>(canonical, W, select(back, T(1) - t[k], t[k]));
                    if (mistakes.own_direction) point = own_edge_point<T>(e, W, back, t[k]);
                    if (mistakes.mirror_pairs) point.position = mirror_pairs<T>(e, t[k]);
                    return point;
                },
                s);
            s = when(
                on[k] & on[previous],
                [&] {
                    return SurfacePoint<T>{Inside::template corner<T>(patch, k),
                                           Inside::template corner_normal<T>(registers, k)};
                },
                s);
        }
        return s;
    }

    /// A mistake: the edge in the patch's own direction. Along it W is -W, backwards.
    template <class T>
    static constexpr SurfacePoint<T> own_edge_point(EdgeCurve<T> const& e, float3<T> const (&W)[4],
                                                    mask_of<T> const& back, T t)
    {
        float3<T> own[4];
        for (int i = 0; i < 4; ++i) own[i] = select(back, float3<T>(-W[3 - i]), W[i]);
        return edge_point<T>(e, own, t);
    }

    /// A mistake where products may be fused: the sum looks symmetric and is not.
    template <class T> static constexpr float3<T> mirror_pairs(EdgeCurve<T> const& e, T t)
    {
        T const s = T(1) - t, ss = s * s, tt = t * t, m = T(3) * T(s * t);
        T const b0 = ss * s, b1 = m * s, b2 = m * t, b3 = tt * t;
        return (b0 * e.p0 + b3 * e.p3) + (b1 * e.p1 + b2 * e.p2);
    }
};

} // namespace tessemu
