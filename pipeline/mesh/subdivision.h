// Subdivision by any scheme's masks: new points of a mesh, and of one vertex's ring as often as its
// limit needs.
//
// A scheme is a traits class, Masks (see catmull_clark.h):
//
//     kFacePoints               whether faces' points are vertices of the refined mesh
//     face(sum, sides)          point of a face, of the sum of its vertices
//     edge(a, b, left, right, triangles)  of a smooth edge and the points of its faces, so many of
//                               them triangles to be smoothed (`smoothtriangles smooth`)
//     vertex(n, v, edges, faces)  of a smooth vertex, the sums of its edges' far ends and of its
//                               faces' points
//     crease_edge(a, b), crease_vertex(a, v, b)  along a crease or boundary
//
// Points are of any type X that can be added, and multiplied and divided by a number: positions,
// or rows of weights. A triangle's third vertex is 3 F - a - b of its mean F, so Loop's edge points
// are edge(a, b, F, F', 0) too. Where sharpness blends rules: docs/math/subdivision.md, 1.7.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/sharpness.h"

namespace tessemu {

/// Edges numbered as LOOP10's tables have them: faces in order, at corner k the edge to corner k-1,
/// when it is first met.
class EdgeNumbers {
public:
    /// \cost  linear in the corners of faces
    explicit EdgeNumbers(Topology const& topology);
    std::size_t size() const { return first_.size(); }
    std::uint32_t operator[](HalfEdge h) const { return number_[h]; }
    /// The half-edge that an edge was first met as: it ends at the face's corner k.
    HalfEdge first(std::size_t edge) const { return first_[edge]; }

private:
    std::vector<std::uint32_t> number_;
    std::vector<HalfEdge> first_;
};

/// How many of an edge's faces are triangles to be smoothed.
inline int triangles_to_smooth(Topology const& t, std::uint32_t face, std::uint32_t other)
{
    ControlMesh const& mesh = t.mesh();
    if (!mesh.rules.smooth_triangles) return 0;
    return (mesh.face(face).size() == 3) + (mesh.face(other).size() == 3);
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

/// The points after a step.
///
/// \param x  of the mesh's vertices
/// \returns  the faces' points, if it has them, then edges' by their EdgeNumbers, then vertices'
/// \cost     linear in the corners of faces
template <class Masks, class X>
std::vector<X> refined_points(Topology const& topology, Sharpness const& sharpness,
                              std::span<X const> x)
{
    ControlMesh const& mesh = topology.mesh();
    std::vector<X> face_point;
    face_point.reserve(mesh.faces());
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        X sum = x[face[0]];
        for (std::size_t i = 1; i < face.size(); ++i) sum += x[face[i]];
        face_point.push_back(Masks::face(sum, int(face.size())));
    }
    EdgeNumbers const edges(topology);
    std::vector<X> out;
    out.reserve(mesh.faces() + edges.size() + x.size());
    if constexpr (Masks::kFacePoints) out = face_point;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        HalfEdge const h = edges.first(e), other = topology.twin(h);
        X const &a = x[topology.vertex_of(topology.next(h))], &b = x[topology.vertex_of(h)];
        float const s = sharpness.edge(h);
        double const w = s > 0 ? crease_weight(s, sharpness.halves(h)) : 0;
        if (w == 1) {
            out.push_back(Masks::crease_edge(a, b));
            continue;
        }
        std::uint32_t const f = topology.face_of(h), g = topology.face_of(other);
        X const smooth =
            Masks::edge(a, b, face_point[f], face_point[g], triangles_to_smooth(topology, f, g));
        out.push_back(w == 0 ? smooth : smooth * (1 - w) + Masks::crease_edge(a, b) * w);
    }
    RingSharpness plain, sharp;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        auto const ring = topology.ring(v);
        if (ring.empty()) {
            out.push_back(x[v]);
            continue;
        }
        auto const edge = [&](std::size_t j) -> X const& {
            return x[j < ring.size() ? topology.vertex_of(topology.next(ring[j]))
                                     : topology.vertex_of(topology.previous(ring.back()))];
        };
        auto const face = [&](std::size_t j) -> X const& {
            return face_point[topology.face_of(ring[j])];
        };
        bool const is_plain = sharpness.is_plain(v);
        if (!is_plain) sharpness.around(v, sharp);
        out.push_back(vertex_point<Masks>(is_plain ? plain : sharp, ring.size(), x[v], edge, face));
    }
    return out;
}

/// A vertex, its edges' far ends and, where its faces are quads, their opposite vertices; edges and
/// faces as in RingSharpness.
template <class X> struct Ring {
    X vertex;
    std::vector<X> edge, face;

    std::size_t faces() const { return face.size(); }
    X const& edge_after(std::size_t face_index) const
    {
        return edge[face_index + 1 < edge.size() ? face_index + 1 : 0];
    }
    std::size_t face_before(std::size_t edge_index) const
    {
        return (edge_index == 0 ? face.size() : edge_index) - 1;
    }
};

/// The ring of the same vertex after a step: it depends on nothing further away.
template <class Masks, class X>
Ring<X> refined_ring(Ring<X> const& ring, RingSharpness const& sharp)
{
    std::vector<X> face_point;
    for (std::size_t j = 0; j < ring.faces(); ++j) {
        X sum = ring.vertex;
        sum += ring.edge[j];
        sum += ring.face[j];
        sum += ring.edge_after(j);
        face_point.push_back(Masks::face(sum, 4));
    }
    auto const edge = [&](std::size_t j) -> X const& { return ring.edge[j]; };
    auto const face = [&](std::size_t j) -> X const& { return face_point[j]; };
    Ring<X> out{vertex_point<Masks>(sharp, ring.faces(), ring.vertex, edge, face), {}, {}};
    for (std::size_t j = 0; j < ring.edge.size(); ++j) {
        float const s = sharp.edge[j];
        double const w = s > 0 ? crease_weight(s, sharp.halves(j)) : 0;
        X const middle = Masks::crease_edge(ring.vertex, ring.edge[j]);
        if (w == 1) {
            out.edge.push_back(middle);
            continue;
        }
        X const smooth = Masks::edge(ring.vertex, ring.edge[j], face_point[j],
                                     face_point[ring.face_before(j)], 0);
        out.edge.push_back(w == 0 ? smooth : smooth * (1 - w) + middle * w);
    }
    out.face = std::move(face_point);
    return out;
}

} // namespace tessemu
