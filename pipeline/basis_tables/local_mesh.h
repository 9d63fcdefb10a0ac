// The type of a patch for any scheme: the face and those around it as a mesh of their own.
//
// Two patches whose local meshes are equal have the same tables. Nothing is asked of a face's
// vertices: those of a mesh that a step has made are regular but for one, which keeps types few
// (HOLL10 2A), and no more.
//
// Where infinitely sharp edges cut a vertex's faces into sectors that have no influence on each
// other, only the patch's own is there, and the edges are its boundary: a crease and a boundary are
// one type.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/sharpness.h"

#include <compare>
#include <vector>

namespace tessemu {

struct LocalMesh {
    static constexpr std::uint32_t kMostEdges = 1024; ///< at a vertex
    struct Crease {
        std::uint16_t a, b;
        float sharpness;
        auto operator<=>(Crease const&) const = default;
    };
    struct Corner {
        std::uint16_t vertex;
        float sharpness;
        auto operator<=>(Corner const&) const = default;
    };

    std::vector<std::uint16_t> face_start{0}; ///< faces + 1 offsets into face_vertices
    /// Face 0 is the patch, corner 0 first. A vertex at which faces meet in two fans is two.
    std::vector<std::uint16_t> face_vertices;
    std::vector<std::uint16_t> point_of; ///< by vertex: its control point
    std::uint16_t points = 0;            ///< vertices of the mesh itself, by first occurrence
    std::vector<Crease> creases;         ///< at the patch's vertices; ascending
    std::vector<Corner> corners;         ///< of them
    CreaseMethod crease_method = CreaseMethod::Normal;

    auto operator<=>(LocalMesh const&) const = default;

    int sides() const { return face_start[1]; }
    ControlMesh mesh() const; ///< its positions are 0
};

/// Where a type was found.
struct FoundLocalMesh {
    LocalMesh type;
    int rotation = 0;                  ///< the patch's corner 0 is the face's corner `rotation`
    std::vector<HalfEdge> corners;     ///< of the mesh, by corner of the type's faces
    std::vector<std::uint32_t> points; ///< of each control point the vertex
};

/// Some faces of a mesh as a mesh of their own: a vertex for each fan of them.
struct SubMesh {
    std::vector<std::uint32_t> face_vertices; ///< by corner, face after face
    std::vector<std::uint32_t> vertices;      ///< of the whole mesh
};

class SubMeshes {
public:
    explicit SubMeshes(Topology const& topology)
        : t_(topology),
          place_(topology.mesh().faces(), kNone)
    {
    }
    /// \param cuts  cuts(h): faces beside this edge do not hang together
    template <class Cuts> SubMesh of(std::span<std::uint32_t const> faces, Cuts const& cuts);

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;
    Topology const& t_;
    std::vector<std::uint32_t> place_; // by face: where its corners begin; kNone but while in use
};

/// Finds types.
class LocalMeshFinder {
public:
    /// \param topology  outlives this
    /// \param rings     of faces around a patch: 1 for schemes whose masks reach no further than the
    ///                  faces around a vertex; with Chaikin's creases 2
    LocalMeshFinder(Topology const& topology, int rings);

    /// Of the patch on a face; begun at the corner that makes the type the least.
    /// \cost  linear in the faces around
    FoundLocalMesh at(std::uint32_t face);

    /// Infinitely sharp edges, boundary or not, end a sector.
    bool is_cut(HalfEdge h) const { return sharpness_.edge(h) >= kInfinitelySharp; }

private:
    FoundLocalMesh begun_at(HalfEdge corner, bool in_sectors);
    bool has_sectors(std::uint32_t vertex);
    void add_faces_around(HalfEdge corner, bool in_sectors);

    Topology const& t_;
    Sharpness sharpness_;
    int rings_;
    SubMeshes sub_meshes_;
    RingSharpness ring_;
    std::vector<std::uint32_t> faces_;
    std::vector<std::uint32_t> begins_; // [of faces_]: the corner where it is begun
    std::vector<char> is_taken_;        // by face
};

template <class Cuts> SubMesh SubMeshes::of(std::span<std::uint32_t const> faces, Cuts const& cuts)
{
    ControlMesh const& mesh = t_.mesh();
    SubMesh out;
    std::uint32_t corners = 0;
    for (std::uint32_t f : faces) {
        place_[f] = corners;
        corners += std::uint32_t(mesh.face(f).size());
    }
    out.face_vertices.assign(corners, kNone);
    auto const corner_of = [&](HalfEdge h) -> std::uint32_t* {
        std::uint32_t const f = t_.face_of(h);
        return place_[f] == kNone ? nullptr
                                  : &out.face_vertices[place_[f] + h - mesh.face_start[f]];
    };
    for (std::uint32_t f : faces)
        for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h) {
            if (*corner_of(h) != kNone) continue;
            auto const number = std::uint32_t(out.vertices.size());
            out.vertices.push_back(t_.vertex_of(h));
            *corner_of(h) = number;
            // Around the vertex, both ways, as far as the fan goes.
            for (bool left : {true, false})
                for (HalfEdge k = h;;) {
                    HalfEdge const edge = left ? t_.previous(k) : k, twin = t_.twin(edge);
                    if (twin == Topology::kNone || cuts(edge)) break;
                    k = left ? twin : t_.next(twin);
                    std::uint32_t* const corner = corner_of(k);
                    if (!corner || *corner != kNone) break;
                    *corner = number;
                }
        }
    for (std::uint32_t f : faces) place_[f] = kNone;
    return out;
}

} // namespace tessemu
