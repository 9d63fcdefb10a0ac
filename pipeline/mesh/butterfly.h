// Modified Butterfly subdivision (Zorin, Schroeder, Sweldens 1996): interpolating, on triangles.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit_constants.h"
#include "pipeline/mesh/refined_step.h"

namespace tessemu {

/// Old vertices stay. Of an edge from a to b with opposite vertices c, d and four wings beyond
/// (docs/math/subdivision.md, 6.4):
///
///     both ends regular   (a + b)/2 + (c + d)/8 - (sum of the wings)/16
///     an end of K edges   3/4 a + sum s_j e_j, e_0 = b; s = 5/12, -1/12, -1/12 for K = 3;
///                         3/8, 0, -1/8, 0 for K = 4; (1/4 + cos(2 pi j/K) + cos(4 pi j/K)/2)/K
///     both such           the mean
///     at a boundary       9/16 (a + b) - 1/16 of those before and behind along it
///
/// A wing beyond a boundary edge is the reflection a + b - c of the triangle's vertex c. Vertices at
/// the boundary count as regular. No tags are known.
struct Butterfly {
    static constexpr bool kKeepsTriangles = true, kSectorRules = false;
    static constexpr int kRings = 2;

    template <class X> static X face(X const& sum, int) { return sum; } // none has a point
    template <class X> static X vertex_point(Topology const&, std::uint32_t v, std::span<X const> x)
    {
        return x[v];
    }
    template <class X> static X limit_point(Topology const&, std::uint32_t v, std::span<X const> x)
    {
        return x[v];
    }
    template <class X> static X edge_point(Topology const& t, HalfEdge h, std::span<X const> x)
    {
        HalfEdge const twin = t.twin(h);
        if (twin == Topology::kNone) return at_boundary(t, h, x);
        bool const irregular = is_irregular(t, t.vertex_of(h)),
                   irregular_end = is_irregular(t, t.vertex_of(twin));
        if (irregular && irregular_end) return (around(t, h, x) + around(t, twin, x)) / 2.0;
        if (irregular) return around(t, h, x);
        if (irregular_end) return around(t, twin, x);
        X out = (x[t.vertex_of(h)] + x[t.vertex_of(twin)]) / 2.0;
        for (HalfEdge side : {h, twin}) {
            out += x[t.vertex_of(t.previous(side))] / 8.0;
            out -= wing(t, t.next(side), x) / 16.0;
            out -= wing(t, t.previous(side), x) / 16.0;
        }
        return out;
    }

private:
    static bool is_irregular(Topology const& t, std::uint32_t v)
    {
        return !t.is_boundary(v) && t.ring(v).size() != 6;
    }
    /// The vertex beyond an edge of a triangle.
    template <class X> static X wing(Topology const& t, HalfEdge edge, std::span<X const> x)
    {
        HalfEdge const twin = t.twin(edge);
        if (twin != Topology::kNone) return x[t.vertex_of(t.previous(twin))];
        return x[t.vertex_of(edge)] + x[t.vertex_of(t.next(edge))] -
               x[t.vertex_of(t.previous(edge))];
    }
    /// By the ring of the edge's first vertex.
    template <class X> static X around(Topology const& t, HalfEdge edge, std::span<X const> x)
    {
        int const n = int(t.ring(t.vertex_of(edge)).size());
        X out = 0.75 * x[t.vertex_of(edge)];
        HalfEdge h = edge;
        for (int j = 0; j < n; ++j, h = t.twin(t.previous(h)))
            if (double const s = weight(n, j); s != 0) out += s * x[t.vertex_of(t.next(h))];
        return out;
    }
    static double weight(int n, int j)
    {
        if (n == 3) return j == 0 ? 5.0 / 12 : -1.0 / 12;
        if (n == 4) return j == 0 ? 3.0 / 8 : j == 2 ? -1.0 / 8 : 0;
        return (0.25 + cos_pi(2 * j, n) + cos_pi(4 * j, n) / 2) / n;
    }
    template <class X> static X at_boundary(Topology const& t, HalfEdge h, std::span<X const> x)
    {
        std::uint32_t const a = t.vertex_of(h), b = t.vertex_of(t.next(h));
        // The boundary edge that ends in a, and the one that begins in b.
        std::uint32_t const before = t.vertex_of(t.previous(t.ring(a).back())),
                            behind = t.vertex_of(t.next(t.ring(b).front()));
        return 9.0 / 16 * (x[a] + x[b]) - (x[before] + x[behind]) / 16.0;
    }
};

/// Of a mesh of triangles; the new mesh has no tags. See take_weighted_step().
RefinedStep take_butterfly_step(Topology const& topology, std::uint32_t first);
extern LimitRules const butterfly_limits;
inline constexpr RefinementStep butterfly_step{take_butterfly_step, true, "Butterfly",
                                               &butterfly_limits};

} // namespace tessemu
