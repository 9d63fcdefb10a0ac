// Tess factors of a patch: uniform, by the edges' projected length, or by their distance.
//
// An edge's factor is computed from the edge's cubic alone, in its canonical direction, so both
// patches at it get the same bits and the tessellator gives them the same points.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/tessellator.h"
#include "shaders_cpp/watertight_patch.h"

namespace tessemu {

struct TessFactorRule {
    enum class Kind { Uniform, ProjectedLength, Distance };
    Kind kind = Kind::Uniform;
    float uniform = 1;          ///< Uniform: every edge and the inside
    std::array<float, 3> eye{}; ///< object space
    float scale = 1;            ///< ProjectedLength: times length / distance; Distance: over it

    /// \param edge      edge(k): the edge from corner k to corner k+1
    /// \param reversed  reversed(k): whether its canonical direction is the other one
    /// \returns         in the tessellator's order, at least 1; the inside follows the larger of
    /// the
    ///                  edges that it runs along
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
            EdgeCurve<T> const e = edge(k);
            auto const back = reversed(k);
            f[k] = edge_factor<T>(select(back, e.p3, e.p0), select(back, e.p2, e.p1),
                                  select(back, e.p1, e.p2), select(back, e.p0, e.p3));
        }
        if constexpr (N == 4)
            return {f[3], f[0], f[1], f[2], max(f[0], f[2]), max(f[1], f[3])};
        else
            return {f[1], f[2], f[0], max(max(f[0], f[1]), f[2]), T(1), T(1)};
    }

    /// Of a cubic: the length of its control polygon stands for its own, the distance is that of
    /// its middle. \cost 19 mul, 1 div, 4 sqrt
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
