// Loop subdivision (Loop 1987): masks, limits, and the step that splits a triangle in four.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit_constants.h"
#include "pipeline/mesh/refined_step.h"

#include <array>

namespace tessemu {

/// E = 3/8 (a + b) + 1/8 (c + d), V = (1 - n beta) v + beta sum e (docs/math/subdivision.md, 6.2);
/// along a boundary or crease midpoints and (1,6,1)/8.
struct Loop {
    static constexpr bool kKeepsTriangles = true, kSectorRules = false;

    /// (5/8 - (3/8 + cos(2 pi/n)/4)^2) / n
    static double beta(int n)
    {
        double const c = 0.375 + cos_pi(2, n) / 4;
        return (0.625 - c * c) / n;
    }
    /// The sum itself: F = a + b + c.
    template <class X> static X face(X const& sum, int) { return sum; }
    /// (a + b + F + F') / 8
    template <class X>
    static X edge(X const& a, X const& b, X const& left, X const& right, int /*triangles*/)
    {
        return (a + b + left + right) / 8.0;
    }
    template <class X> static X vertex(int n, X const& v, X const& edges, X const& /*faces*/)
    {
        double const b = beta(n);
        return (1 - n * b) * v + b * edges;
    }
    template <class X> static X crease_edge(X const& a, X const& b) { return (a + b) / 2.0; }
    template <class X> static X crease_vertex(X const& a, X const& v, X const& b)
    {
        return (a + 6.0 * v + b) / 8.0;
    }
    static double lean(double) { return 0; }

    /// (1 - n chi) v + chi sum e, chi = 1 / (3 / (8 beta) + n); tangents sum cos(2 pi j/n) e_j and
    /// sum sin(2 pi j/n) e_j.
    template <class X, class Edge, class Face>
    static std::array<X, 3> limit(int n, X const& v, Edge const& edge, Face const&)
    {
        double const chi = 1 / (3 / (8 * beta(n)) + n);
        X p = (1 - n * chi) * v, a = 0.0 * v, b = a;
        for (int j = 0; j < n; ++j) {
            X const& e = edge(std::size_t(j));
            p += chi * e;
            a += cos_pi(2 * j, n) * e;
            b += sin_pi(2 * j, n) * e;
        }
        return {p, a, b};
    }
    template <class X> static X crease_limit(X const& a, X const& v, X const& b)
    {
        return (a + 4.0 * v + b) / 6.0;
    }
    /// The left eigenvector of l = 3/8 + cos(theta)/4, theta = pi/k, k > 1: sin(j theta) on inner
    /// edges, w_e on both sharp ones and w_v on the vertex, where
    ///
    ///     (l - 1/2) w_e - w_v / 8 = sin(theta) / 8,   (l - 3/4) w_v - w_e = 3/8 sum sin(j theta)
    ///
    /// The often quoted mask with sin(theta) (e_0 + e_k) is none for k > 2.
    template <class X, class Edge, class Face>
    static X crease_across(int k, X const& v, Edge const& edge, Face const&)
    {
        double const l = 0.375 + cos_pi(1, k) / 4;
        double sum = 0;
        X out = 0.0 * v;
        for (int j = 1; j < k; ++j) {
            sum += sin_pi(j, k);
            out += sin_pi(j, k) * edge(std::size_t(j));
        }
        double const a = sin_pi(1, k) / 8, b = 0.375 * sum,
                     determinant = (l - 0.5) * (l - 0.75) - 0.125,
                     on_end = ((l - 0.75) * a + b / 8) / determinant,
                     on_vertex = ((l - 0.5) * b + a) / determinant;
        out += on_end * (edge(0) + edge(std::size_t(k)));
        out += on_vertex * v;
        return out;
    }
};

/// Of a mesh of triangles, with its creases, corners and boundary rule; see take_weighted_step().
RefinedStep take_loop_step(Topology const& topology, std::uint32_t first);
extern LimitRules const loop_limits;
inline constexpr RefinementStep loop_step{take_loop_step, true, "Loop", &loop_limits};

} // namespace tessemu
