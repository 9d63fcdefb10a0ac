// Tess factors of a patch: uniform, by the edges' projected length, or by their distance.
//
// An edge's factor is computed from a polygon of four points along it alone, in the edge's
// canonical direction, so both patches at it get the same bits and the tessellator gives them the
// same points. The polygon is a cubic's control polygon, or any other that both patches have.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/tessellator.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// Four points along an edge, from corner k to corner k+1.
template <class T> struct EdgePolygon {
    float3<T> p0, p1, p2, p3;
};

/// Of an edge that is a straight line: thirds of it, the same bits from either end: sums of two
/// rounded products do not depend on their order.
template <class T> constexpr EdgePolygon<T> straight_edge(float3<T> const& a, float3<T> const& b)
{
    T const third(1.0 / 3), two_thirds(2.0 / 3);
    float3<T> const a1 = third * a, a2 = two_thirds * a, b1 = third * b, b2 = two_thirds * b;
    return {a, float3<T>(a2 + b1), float3<T>(a1 + b2), b};
}

struct TessFactorRule {
    enum class Kind { Uniform, ProjectedLength, Distance };
    Kind kind = Kind::Uniform;
    float uniform = 1;          ///< Uniform: every edge and the inside
    std::array<float, 3> eye{}; ///< object space
    float scale = 1;            ///< ProjectedLength: times length / distance; Distance: over it

    /// \param edge      edge(k): the edge's polygon, or a curve with such points
    /// \param reversed  reversed(k): whether its canonical direction is the other one
    /// \returns         in the tessellator's order, at least 1; the inside follows the larger of
    ///                  the edges that it runs along
    template <TessellatorDomain kDomain, class T>
    std::array<T, 6> factors(auto const& edge, auto const& reversed) const
    {
        if (kind == Kind::Uniform) {
            T const f(uniform);
            return {f, f, f, f, f, f};
        }
        constexpr int N = kDomain == TessellatorDomain::Quad ? 4 : 3;
        T f[N];
        for (int k = 0; k < N; ++k) {
            auto const e = edge(k);
            auto const back = reversed(k);
            f[k] = edge_factor<T>(select(back, e.p3, e.p0), select(back, e.p2, e.p1),
                                  select(back, e.p1, e.p2), select(back, e.p0, e.p3));
        }
        if constexpr (N == 4)
            return {f[3], f[0], f[1], f[2], max(f[0], f[2]), max(f[1], f[3])};
        else
            return {f[1], f[2], f[0], max(max(f[0], f[1]), f[2]), T(1), T(1)};
    }

    /// The length of a cubic's control polygon stands for its own, the distance is that of its
    /// middle. \cost 19 mul, 1 div, 4 sqrt
    template <class T>
    T edge_factor(float3<T> const& p0, float3<T> const& p1, float3<T> const& p2,
                  float3<T> const& p3) const
    {
        using V = float3<T>;
        Routine<T> const here("edge_factor");
        auto const length = [](V const& v) -> T { return sqrt(T(dot(v, v))); };
        V const middle_sum = p0 + T(3) * V(p1 + p2) + p3;
        V const to_eye = T(0.125) * middle_sum - V(T(eye[0]), T(eye[1]), T(eye[2]));
        T const distance = max(length(to_eye), T(1e-30));
        if (kind == Kind::Distance) return max(T(T(scale) / distance), T(1));
        T const polygon = length(V(p1 - p0)) + length(V(p2 - p1)) + length(V(p3 - p2));
        return max(T(T(T(scale) * polygon) / distance), T(1));
    }
};

} // namespace tessemu
