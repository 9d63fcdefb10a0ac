// Subdivision by any scheme's masks: new points of a mesh, and of one vertex's ring as often as its
// limit needs.
//
// Masks: see ring.h; limit.h and flatness.h for Biermann's rules (docs/math/subdivision.md, 5.2).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/flatness.h"
#include "pipeline/mesh/wide_masks.h"

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

/// The points of a step by number: of the faces that have one, in their order, then edges, then
/// vertices.
class PointNumbers {
public:
    /// \param keeps_triangles  a triangle has no point of its own
    PointNumbers(Topology const& topology, bool keeps_triangles);

    std::uint32_t face(std::uint32_t f) const { return faces_.empty() ? f : faces_[f]; }
    std::uint32_t edge(HalfEdge h) const { return first_edge_ + edges_[h]; }
    std::uint32_t vertex(std::uint32_t v) const
    {
        return first_edge_ + std::uint32_t(edges_.size()) + v;
    }
    EdgeNumbers const& edges() const { return edges_; }

private:
    EdgeNumbers edges_;
    std::vector<std::uint32_t> faces_; // empty: all have one
    std::uint32_t first_edge_;
};

/// How many of an edge's faces are triangles to be smoothed.
inline int triangles_to_smooth(Topology const& t, std::uint32_t face, std::uint32_t other)
{
    ControlMesh const& mesh = t.mesh();
    if (!mesh.rules.smooth_triangles) return 0;
    return (mesh.face(face).size() == 3) + (mesh.face(other).size() == 3);
}

/// Calls f(flat, id) for each vertex whose ring a step flattens, by ascending vertex: id(i) is the
/// number of the ring's point i among the new points.
template <class Masks, class F>
void each_flat_ring(Topology const& topology, Sharpness const& sharpness, EdgeNumbers const& edges,
                    F const& f)
{
    ControlMesh const& mesh = topology.mesh();
    SubdivisionRules const& rules = mesh.rules;
    if (rules.sectors != SectorRules::Biermann) return;
    if (rules.flatness ? *rules.flatness == 0 : mesh.concave.empty()) return;
    Limits<Masks> limits;
    RingSharpness sharp;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        auto const ring = topology.ring(v);
        if (ring.empty() || (!rules.flatness && sharpness.is_plain(v)) || sharpness.is_cut(v))
            continue;
        sharpness.around(v, sharp);
        if (!is_flattened(sharp, ring.size())) continue;
        auto const id = [&](std::size_t i) -> std::size_t {
            if (i == 0) return mesh.faces() + edges.size() + v;
            if (i <= ring.size()) return mesh.faces() + edges[ring[i - 1]];
            if (i <= sharp.edge.size()) return mesh.faces() + edges[topology.previous(ring.back())];
            return topology.face_of(ring[i - 1 - sharp.edge.size()]);
        };
        f(flat_ring<Masks>(sharp, ring.size(), limits), id);
    }
}

/// The points after a step.
///
/// \param x  of the mesh's vertices
/// \returns  by PointNumbers
/// \cost     linear in the corners of faces
template <class Masks, class X>
requires(!WideMasks<Masks>) std::vector<X> refined_points(Topology const& topology,
                                                          Sharpness const& sharpness,
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
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
        if (!Masks::kKeepsTriangles || mesh.face(f).size() != 3) out.push_back(face_point[f]);
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
        X smooth =
            Masks::edge(a, b, face_point[f], face_point[g], triangles_to_smooth(topology, f, g));
        lean<Masks>(smooth, sharpness.lean(h), b, a);
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
    if constexpr (Masks::kSectorRules) {
        std::vector<std::pair<std::size_t, X>> moves; // all of the points as they are
        each_flat_ring<Masks>(
            topology, sharpness, edges, [&](FlatRing const& flat, auto const& id) {
                flat.moves([&](std::size_t i) -> X const& { return out[id(i)]; },
                           [&](std::size_t i, X by) { moves.emplace_back(id(i), std::move(by)); });
            });
        for (auto const& [i, by] : moves) out[i] += by;
    }
    return out;
}

template <class Masks, class X>
requires WideMasks<Masks> std::vector<X> refined_points(Topology const& topology, Sharpness const&,
                                                        std::span<X const> x)
{
    ControlMesh const& mesh = topology.mesh();
    EdgeNumbers const edges(topology);
    std::vector<X> out;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        if (Masks::kKeepsTriangles && face.size() == 3) continue;
        X sum = x[face[0]];
        for (std::size_t i = 1; i < face.size(); ++i) sum += x[face[i]];
        out.push_back(Masks::face(sum, int(face.size())));
    }
    for (std::size_t e = 0; e < edges.size(); ++e)
        out.push_back(Masks::edge_point(topology, edges.first(e), x));
    for (std::uint32_t v = 0; v < x.size(); ++v)
        out.push_back(topology.ring(v).empty() ? x[v] : Masks::vertex_point(topology, v, x));
    return out;
}

/// The ring of the same vertex after a step: it depends on nothing further away.
///
/// By Biermann's rules, on a ring as a step leaves it: where nothing else that is flattened shares
/// a face with the vertex.
template <class Masks, class X>
Ring<X> refined_ring(Ring<X> const& ring, RingSharpness const& sharp)
{
    Ring<X> out = split_ring<Masks>(ring, sharp);
    if (!is_flattened(sharp, ring.faces())) return out;
    Limits<Masks> limits;
    std::vector<std::pair<std::size_t, X>> moves;
    flat_ring<Masks>(sharp, ring.faces(), limits)
        .moves([&](std::size_t i) -> X const& { return out.point(i); },
               [&](std::size_t i, X by) { moves.emplace_back(i, std::move(by)); });
    for (auto const& [i, by] : moves) out.point(i) += by;
    return out;
}

} // namespace tessemu
