// Topology of a control mesh: rings, two-rings, sectors, and what is wrong with it.
//
// A ring lists the faces around a vertex counter-clockwise; face j lies between edge j and edge j+1
// (docs/math/loop09.md, 1). An interior ring starts at the edge to the smallest neighbour, a
// boundary ring at the edge that has a face only on its left.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"
#include "pipeline/mesh/mesh.h"

namespace tessemu {

/// The mesh is not an oriented manifold; what() names the vertices and faces, counted from 1.
struct MeshError : Error {
    MeshError(std::uint32_t face_, std::string const& what) : Error(what), face(face_) {}
    std::uint32_t face; ///< one of the faces concerned, from 0
};

/// A corner of a face: half-edge number, the position in ControlMesh::face_vertices.
using HalfEdge = std::uint32_t;

class Topology {
public:
    /// Builds rings in time linear in the corners (times the log of the valence). Throws MeshError
    /// for a face with fewer than 3 or with repeated vertices, an edge with more than two faces or
    /// with faces of opposite orientation, and a vertex whose faces form more than one fan.
    explicit Topology(ControlMesh const& mesh);

    ControlMesh const& mesh() const { return *mesh_; }

    std::uint32_t face_of(HalfEdge h) const { return half_edge_face_[h]; }
    std::uint32_t vertex_of(HalfEdge h) const { return mesh_->face_vertices[h]; }
    HalfEdge next(HalfEdge h) const;
    HalfEdge previous(HalfEdge h) const;

    /// The ring of a vertex: half-edge j starts at the vertex and runs along edge j, in face j.
    std::span<HalfEdge const> ring(std::uint32_t vertex) const
    {
        return std::span(ring_).subspan(ring_start_[vertex],
                                        ring_start_[vertex + 1] - ring_start_[vertex]);
    }
    bool is_boundary(std::uint32_t vertex) const { return boundary_[vertex]; }
    /// Edges at a vertex: its faces, and one more on the boundary.
    std::uint32_t valence(std::uint32_t vertex) const
    {
        return std::uint32_t(ring(vertex).size()) + (boundary_[vertex] ? 1 : 0);
    }
    /// Which face of its vertex's ring a corner belongs to.
    std::uint32_t ring_index(HalfEdge h) const { return ring_index_[h]; }
    /// The half-edge on the other side; none on the boundary.
    static constexpr HalfEdge kNone = 0xffffffffu;
    HalfEdge twin(HalfEdge h) const;
    /// A half-edge between two vertices, in either direction; none if they share no edge. \cost  of
    /// the smaller ring
    HalfEdge find_edge(std::uint32_t a, std::uint32_t b) const;

    /// Vertices of a face and of all faces that touch it, ascending.
    std::vector<std::uint32_t> two_ring(std::uint32_t face) const;

    /// A run of a vertex's ring between two tagged edges (creases or boundary).
    struct Sector {
        std::uint32_t first_face, faces; ///< ring positions first_face, ..., cyclic
        bool closed;                     ///< no tagged edge at all: the whole ring
    };
    /// Sectors of a vertex: its ring cut at the given creases and at the boundary.
    std::vector<Sector> sectors(std::uint32_t vertex,
                                std::vector<ControlMesh::Crease> const& creases) const;

private:
    ControlMesh const* mesh_;
    std::vector<std::uint32_t> half_edge_face_, ring_start_, ring_index_;
    std::vector<HalfEdge> ring_;
    std::vector<char> boundary_;
};

/// Figures of a mesh for `info`.
struct MeshSummary {
    std::size_t vertices = 0, faces = 0, edges = 0, boundary_edges = 0, components = 0;
    std::size_t unused_vertices = 0, regular_faces = 0;
    std::vector<std::pair<std::size_t, std::size_t>> faces_by_size;     ///< (sides, how many)
    std::vector<std::pair<std::size_t, std::size_t>> interior_valences; ///< (valence, how many)
    std::vector<std::pair<std::size_t, std::size_t>> boundary_valences;
};
MeshSummary summarize(Topology const& topology);

/// A quad whose vertices are interior with valence 4 and whose neighbours are all quads.
bool is_regular(Topology const& topology, std::uint32_t face);

} // namespace tessemu
