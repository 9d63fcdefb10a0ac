// A vertex and its ring, split by any scheme's masks.
//
// A scheme is a traits class, Masks (see catmull_clark.h):
//
//     kKeepsTriangles           triangles are split in four triangles; any other face, or each, in
//                               quads around a point of its own
//     kSectorRules              Biermann's rules are known, and all that limit.h and flatness.h
//                               ask for them
//     face(sum, sides)          of the sum of a face's vertices its point, or what stands for it in
//                               the points of edges and vertices
//     edge(a, b, left, right, triangles)  of a smooth edge and the points of its faces, so many of
//                               them triangles to be smoothed (`smoothtriangles smooth`)
//     vertex(n, v, edges, faces)  of a smooth vertex, the sums of its edges' far ends and of its
//                               faces' points
//     crease_edge(a, b), crease_vertex(a, v, b)  along a crease or boundary
//     lean(cos_theta)           what part of a smooth edge its point moves towards its sharp end by
//                               Biermann's rules (docs/math/subdivision.md, 5.2)
//
// Masks whose points do not depend on sums around an edge or a vertex alone, but on what faces are
// there or on points beyond them, are WideMasks (wide_masks.h).
//
// Points are of any type X that can be added, and multiplied and divided by a number: positions,
// or rows of weights. A triangle's third vertex is F - a - b of the sum F of all, so Loop's edge
// points are edge(a, b, F, F', 0) too. Where sharpness blends rules: docs/math/subdivision.md, 1.7.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/sharpness.h"

namespace tessemu {

/// Moves the point of a smooth edge to the end where something is sharp.
template <class Masks, class X> void lean(X& point, Lean const& by, X const& end_0, X const& end_1)
{
    if (by.end < 0) return;
    double const w = Masks::lean(by.cos_theta);
    point += (by.end == 0 ? end_0 : end_1) * w;
    point += (by.end == 0 ? end_1 : end_0) * -w;
}

/// Whether a vertex's new point lies between the points of two rules (vertex_point).
inline bool is_blended(RingSharpness const& now)
{
    VertexRule const rule = now.rule();
    return rule != VertexRule::Smooth && rule != VertexRule::Dart && now.is_semi_sharp() &&
           now.after_step().rule() != rule;
}

/// The new point of a vertex.
///
/// \param edge  far end of edge j
/// \param face  point of face j
/// \param n     faces around
template <class Masks, class X, class Edge, class Face>
X vertex_point(RingSharpness const& now, std::size_t n, X const& v, Edge const& edge,
               Face const& face)
{
    auto const by_rule_of = [&](VertexRule rule, RingSharpness const& sharp) -> X {
        if (rule == VertexRule::Corner) return v;
        if (rule == VertexRule::Crease) {
            auto const [a, b] = sharp.crease();
            return Masks::crease_vertex(edge(a), v, edge(b));
        }
        X edges = edge(0), faces = face(0);
        for (std::size_t j = 1; j < n; ++j) {
            edges += edge(j);
            faces += face(j);
        }
        return Masks::vertex(int(n), v, edges, faces);
    };
    if (!is_blended(now)) return by_rule_of(now.rule(), now);
    RingSharpness const after = now.after_step();
    double const w = fractional_weight(now, after);
    return by_rule_of(after.rule(), after) * (1 - w) + by_rule_of(now.rule(), now) * w;
}

/// A vertex, its edges' far ends and, where its faces are quads, their opposite vertices; edges and
/// faces as in RingSharpness. Of triangles `face` is empty.
template <class X> struct Ring {
    X vertex;
    std::vector<X> edge, face;

    std::size_t faces() const { return face.size(); } ///< of quads
    /// The vertex, the edges' far ends, the faces' opposite vertices.
    X& point(std::size_t i)
    {
        return i == 0 ? vertex : i <= edge.size() ? edge[i - 1] : face[i - 1 - edge.size()];
    }
    X const& edge_after(std::size_t face_index) const
    {
        return edge[face_index + 1 < edge.size() ? face_index + 1 : 0];
    }
};

/// The ring of the same vertex after a step, not flattened.
template <class Masks, class X> Ring<X> split_ring(Ring<X> const& ring, RingSharpness const& sharp)
{
    std::size_t const n = sharp.faces();
    std::vector<X> face_point;
    for (std::size_t j = 0; j < n; ++j) {
        X sum = ring.vertex;
        sum += ring.edge[j];
        if constexpr (!Masks::kKeepsTriangles) sum += ring.face[j];
        sum += ring.edge_after(j);
        face_point.push_back(Masks::face(sum, Masks::kKeepsTriangles ? 3 : 4));
    }
    auto const edge = [&](std::size_t j) -> X const& { return ring.edge[j]; };
    auto const face = [&](std::size_t j) -> X const& { return face_point[j]; };
    Ring<X> out{vertex_point<Masks>(sharp, n, ring.vertex, edge, face), {}, {}};
    std::vector<Lean> const leans = sharp.leans();
    for (std::size_t j = 0; j < ring.edge.size(); ++j) {
        float const s = sharp.edge[j];
        double const w = s > 0 ? crease_weight(s, sharp.halves(j)) : 0;
        X const middle = Masks::crease_edge(ring.vertex, ring.edge[j]);
        if (w == 1) {
            out.edge.push_back(middle);
            continue;
        }
        X smooth = Masks::edge(ring.vertex, ring.edge[j], face_point[j],
                               face_point[(j == 0 ? n : j) - 1], 0);
        if (!leans.empty()) lean<Masks>(smooth, leans[j], ring.vertex, ring.edge[j]);
        out.edge.push_back(w == 0 ? smooth : smooth * (1 - w) + middle * w);
    }
    if constexpr (!Masks::kKeepsTriangles) out.face = std::move(face_point);
    return out;
}

} // namespace tessemu
