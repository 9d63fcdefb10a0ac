// A vertex of Gregory patches in the two-stage form, LOOP09 section 4.1: from a vertex and its
// one-ring to all that the patches around it need of the vertex.
//
// Connectivity and positions come from textures (figure 7). A vertex is a pure function of its
// number, so runs after a cache miss and patches on all sides get the same bits. The vectors of a
// vertex: p, the normal A x B, edge points e_j, transversal vectors r_j (docs/math/loop09.md, 2).
// One text for the vertex shader, which hands all edges on, and for the dispatch of vertices with
// more edges than output registers, which keeps those that a patch needs.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/two_stage_form/ring_vertex.h"

namespace tessemu {

/// Numbers that depend on a vertex's valence alone: a table in memory, a row of kRow floats for
/// each valence (RingRows).
///
/// The limit tangents are two sums over the ring, q_j = cos(2pi j/n) A + sin(2pi j/n) B, so that a
/// vertex needs only A and B and each edge only two cosines. What a row holds, by where it is used:
///
///     interior, n faces (LOOP09 3.3)             boundary, k faces (LOOP09 4.6)
///     [0], [1]  p = [0] v + [1] sum (m_j + c_j)  B = [0] v + [1] (d_0 + d_k) + ...
///     then six for each edge j:
///     [0]       A += [0] m_j                     -
///     [1]       B += [1] m_j                     ... + [1] d_j
///     [2]       A += [2] c_j                     -
///     [3]       B += [3] c_j                     ... + [3] x_j
///     [4], [5]  e_j = p + [4] A + [5] B          the same, A along the boundary, B across it
///
/// m_j: midpoint of edge j. c_j: centroid of face j. d_j: far end of edge j. x_j: vertex opposite
/// in face j. With one face A and B are its two edges and only [4] and [5] are used.
struct RingConstants {
    static constexpr int kEach = 6;
    static constexpr int kRow = 2 + kEach * RingLayout::kEdges;
};

/// \tparam kMost   edges that the registers hold
/// \tparam Weight  float; double in tests of the formulas
template <int kMost, class Weight> struct GregoryRing : RingTextures {
    Buffer<Weight> constants;    ///< RingConstants
    float r_scale = 1;           ///< multiplies r
    bool smooth_corners = false; ///< a boundary vertex with one face is not interpolated

    std::vector<ResourceInfo> resources() const
    {
        return {rings.info(), entries.info(), positions.info(), constants.info()};
    }

    /// \param v      the vertex
    /// \param row    where its constants begin
    /// \param turns  of the loops over edges, at least the edges of any lane's ring
    /// \param place  puts an edge's vectors into Out: place.edge(out, j, e_j), place.second(...)
    /// \cost  interior, n faces: 30n + 6 mul and the normal's 6; reads 2n entries, n + quads
    ///        positions, 6n + 2 constants
    template <class Out, class T>
    Out vertex(RingTextures::Ring<T> const& at, float3<T> const& v, int_of<T> row, auto turns,
               auto const& place) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        V const zero(T(0), T(0), T(0));
        Int const n = at.n, edges = at.edges;
        // Far ends, and centroids c_j of the faces; `end` is the last far end.
        V d[kMost + 1], c[kMost + 1], end = zero;
        for (int j : loop<T>(turns)) {
            d[j] = when(
                Int(j) < edges, [&]() -> V { return far_end<T>(at, j); }, zero);
            end = select(Int(j) == edges - Int(1), d[j], end);
        }
        d[turns] = zero;
        for (int j : loop<T>(turns))
            c[j] = when(
                Int(j) < n,
                [&]() -> V {
                    Int const across = diagonal<T>(at, j);
                    auto const quad = across != Int(-1);
                    V const x = when(
                        quad, [&]() -> V { return position<T>(across); }, zero);
                    V const next = select(Int(j + 1) == edges, d[0], d[j + 1]);
                    V const sum = v + d[j] + next + x;
                    return select(quad, T(0.25), T(1.0 / 3)) * sum;
                },
                zero);
        c[turns] = zero;

        Faces<T> const ring{v, n, edges, row, d, c, end};
        Out none;
        none.vectors.fill(zero);
        Out const inside = when(
            !at.boundary, [&] { return interior_vertex<Out>(ring, none, turns, place); }, none);
        return when(
            at.boundary, [&] { return boundary_vertex<Out>(ring, none, turns, place); }, inside);
    }

private:
    template <class T> struct Faces {
        float3<T> const& v;
        int_of<T> n, edges, row;
        float3<T> const (&d)[kMost + 1];
        float3<T> const (&c)[kMost + 1];
        float3<T> const& end;
    };
    template <class T> struct Sums {
        float3<T> A, B, S;
        static constexpr auto signature() { return std::tuple{&Sums::A, &Sums::B, &Sums::S}; }
    };
    template <class T> T constant(Faces<T> const& ring, int i) const
    {
        return load<T>(constants, ring.row + int_of<T>(i));
    }
    template <class T> T of_edge(Faces<T> const& ring, int j, int k) const
    {
        return constant<T>(ring, 2 + RingConstants::kEach * j + k);
    }

    // LOOP09 3.3, 3.4; q_j = cos(2pi j/n) A + sin(2pi j/n) B.
    template <class Out, class T>
    Out interior_vertex(Faces<T> const& ring, Out const& none, auto turns, auto const& place) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        Out out = none;
        V const zero(T(0), T(0), T(0));
        V m[kMost + 1], last_m = zero, last_c = zero;
        Sums<T> s{zero, zero, zero};
        for (int j : loop<T>(turns)) {
            auto const here = Int(j) < ring.n;
            m[j] = when(
                here, [&]() -> V { return T(0.5) * V(ring.v + ring.d[j]); }, zero);
            s = when(
                here,
                [&] {
                    T const am = of_edge<T>(ring, j, 0), bm = of_edge<T>(ring, j, 1),
                            ac = of_edge<T>(ring, j, 2), bc = of_edge<T>(ring, j, 3);
                    return Sums<T>{V(s.A + am * m[j] + ac * ring.c[j]),
                                   V(s.B + bm * m[j] + bc * ring.c[j]), V(s.S + m[j] + ring.c[j])};
                },
                s);
            auto const last = Int(j) == ring.n - Int(1);
            last_m = select(last, m[j], last_m);
            last_c = select(last, ring.c[j], last_c);
        }
        m[turns] = zero;
        V const p = constant<T>(ring, 0) * ring.v + constant<T>(ring, 1) * s.S;
        out.vectors[Out::kP] = p;
        out.vectors[Out::kNormal] = cross(s.A, s.B);
        T const third(double(r_scale) / 3), two_thirds(2 * double(r_scale) / 3);
        for (int j : loop<T>(turns)) {
            auto const here = Int(j) < ring.n;
            place.edge(out, j,
                       V(when(
                           here,
                           [&]() -> V {
                               return p + of_edge<T>(ring, j, 4) * s.A +
                                      of_edge<T>(ring, j, 5) * s.B;
                           },
                           zero)));
            place.second(out, j,
                         V(when(
                             here,
                             [&]() -> V {
                                 V const next = select(Int(j + 1) == ring.n, m[0], m[j + 1]);
                                 V const previous = j == 0 ? last_m : m[j == 0 ? 0 : j - 1];
                                 V const c_previous = j == 0 ? last_c : ring.c[j == 0 ? 0 : j - 1];
                                 return third * V(next - previous) +
                                        two_thirds * V(ring.c[j] - c_previous);
                             },
                             zero)));
        }
        return out;
    }

    // LOOP09 4.6 (docs/math/loop09.md, 4).
    template <class Out, class T>
    Out boundary_vertex(Faces<T> const& ring, Out const& none, auto turns, auto const& place) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        Out out = none;
        V const zero(T(0), T(0), T(0)), &v = ring.v, &d0 = ring.d[0], &dk = ring.end;
        auto const corner = ring.n == Int(1);
        V const smooth = T(1.0 / 6) * V(d0 + dk + T(4) * v);
        V const p = smooth_corners ? smooth : select(corner, v, smooth);
        V const A = select(corner, V(d0 - v), V(T(0.5) * V(d0 - dk)));
        V b = constant<T>(ring, 0) * v + constant<T>(ring, 1) * V(d0 + dk);
        for (int j : loop<T>(turns)) {
            b = when(
                Int(j) < ring.n,
                [&]() -> V {
                    V const x = T(4) * ring.c[j] - v - ring.d[j] - ring.d[j + 1];
                    return b + of_edge<T>(ring, j, 1) * ring.d[j] + of_edge<T>(ring, j, 3) * x;
                },
                b);
        }
        V const B = select(corner, V(dk - v), b);
        out.vectors[Out::kP] = p;
        out.vectors[Out::kNormal] = cross(A, B);
        V const base = select(corner, v, p);
        T const third(double(r_scale) / 3), two_thirds(2 * double(r_scale) / 3),
            four_thirds(4 * double(r_scale) / 3);
        auto const middle = [&](V const& d) -> V { return T(0.5) * V(v + d); };
        for (int j : loop<T>(turns)) {
            auto const here = Int(j) < ring.edges;
            place.edge(out, j,
                       V(when(
                           here,
                           [&]() -> V {
                               return base + of_edge<T>(ring, j, 4) * A +
                                      of_edge<T>(ring, j, 5) * B;
                           },
                           zero)));
            // The first and the last are reflected across the boundary.
            place.second(out, j,
                         V(when(
                             here,
                             [&]() -> V {
                                 int const before = j == 0 ? 0 : j - 1;
                                 V const m = middle(ring.d[j]), m_next = middle(ring.d[j + 1]),
                                         m_previous = middle(ring.d[before]);
                                 V const inner = third * V(m_next - m_previous) +
                                                 two_thirds * V(ring.c[j] - ring.c[before]);
                                 V const first =
                                     two_thirds * V(m_next - v) + four_thirds * V(ring.c[j] - m);
                                 V const last = two_thirds * V(v - m_previous) +
                                                four_thirds * V(m - ring.c[before]);
                                 return j == 0 ? first : select(Int(j) == ring.n, last, inner);
                             },
                             zero)));
        }
        return out;
    }
};

} // namespace tessemu
