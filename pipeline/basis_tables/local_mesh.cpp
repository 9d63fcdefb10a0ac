// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/local_mesh.h"

#include <algorithm>
#include <map>

namespace tessemu {

ControlMesh LocalMesh::mesh() const
{
    ControlMesh out;
    out.positions.resize(point_of.size());
    out.face_start.assign(face_start.begin(), face_start.end());
    out.face_vertices.assign(face_vertices.begin(), face_vertices.end());
    for (Crease const& c : creases) out.creases.push_back({c.a, c.b, c.sharpness});
    for (Corner const& c : corners) out.corners.push_back({c.vertex, c.sharpness});
    out.rules.crease_method = crease_method;
    // No vertex is sharp because one face of it is here.
    out.rules.boundary = BoundaryRule::EdgeOnly;
    return out;
}

LocalMeshFinder::LocalMeshFinder(Topology const& topology, int rings)
    : t_(topology),
      sharpness_(topology),
      rings_(rings),
      sub_meshes_(topology),
      is_taken_(topology.mesh().faces(), 0)
{
}

// Two infinitely sharp edges at least, and nothing that ends: sharpness that is left would make
// faces beyond them count.
bool LocalMeshFinder::has_sectors(std::uint32_t v)
{
    if (sharpness_.is_plain(v)) return false;
    sharpness_.around(v, ring_);
    return !ring_.is_semi_sharp() &&
           std::count_if(ring_.edge.begin(), ring_.edge.end(),
                         [](float s) { return s >= kInfinitelySharp; }) > 1;
}

FoundLocalMesh LocalMeshFinder::at(std::uint32_t face)
{
    ControlMesh const& mesh = t_.mesh();
    // Where sharp edges end in one vertex of the patch, both their sides count at the others too.
    bool in_sectors = true;
    for (std::uint32_t v : mesh.face(face)) {
        if (sharpness_.is_plain(v) || has_sectors(v)) continue;
        bool const any =
            std::any_of(ring_.edge.begin(), ring_.edge.end(), [](float s) { return s > 0; });
        in_sectors = in_sectors && !any;
    }
    FoundLocalMesh out;
    for (HalfEdge h = mesh.face_start[face]; h < mesh.face_start[face + 1]; ++h) {
        FoundLocalMesh found = begun_at(h, in_sectors);
        if (out.points.empty() || found.type < out.type) out = std::move(found);
    }
    return out;
}

void LocalMeshFinder::add_faces_around(HalfEdge corner, bool in_sectors)
{
    auto const add = [&](HalfEdge h) {
        std::uint32_t const f = t_.face_of(h);
        if (is_taken_[f]) return;
        is_taken_[f] = 1;
        faces_.push_back(f);
        begins_.push_back(h - t_.mesh().face_start[f]);
    };
    std::size_t const n = t_.ring(t_.vertex_of(corner)).size();
    HalfEdge h = corner; // back to where the sector begins
    for (std::size_t i = 0; i < n; ++i) {
        if (in_sectors ? is_cut(h) : t_.twin(h) == Topology::kNone) break;
        h = t_.next(t_.twin(h));
    }
    for (std::size_t i = 0; i < n; ++i) {
        add(h);
        HalfEdge const edge = t_.previous(h);
        if (in_sectors ? is_cut(edge) : t_.twin(edge) == Topology::kNone) break;
        h = t_.twin(edge);
    }
}

FoundLocalMesh LocalMeshFinder::begun_at(HalfEdge corner, bool in_sectors)
{
    ControlMesh const& mesh = t_.mesh();
    std::uint32_t const face = t_.face_of(corner);
    std::size_t const sides = mesh.face(face).size();
    faces_ = {face};
    begins_ = {corner - mesh.face_start[face]};
    is_taken_[face] = 1;
    HalfEdge h = corner;
    for (std::size_t k = 0; k < sides; ++k, h = t_.next(h)) add_faces_around(h, in_sectors);
    for (int ring = 1; ring < rings_; ++ring)
        for (std::size_t i = 0, count = faces_.size(); i < count; ++i)
            for (HalfEdge k = mesh.face_start[faces_[i]]; k < mesh.face_start[faces_[i] + 1]; ++k)
                add_faces_around(k, in_sectors);
    for (std::uint32_t f : faces_) is_taken_[f] = 0;

    SubMesh const piece =
        sub_meshes_.of(faces_, [&](HalfEdge edge) { return in_sectors && is_cut(edge); });
    FoundLocalMesh out;
    LocalMesh& type = out.type;
    out.rotation = int(corner - mesh.face_start[face]);
    // Vertices by first occurrence, the patch's from its corner 0 on.
    std::vector<std::uint16_t> number(piece.vertices.size(), 0xffff);
    std::map<std::uint32_t, std::uint16_t> point;
    std::size_t at = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        std::size_t const n = mesh.face(faces_[i]).size(), turn = begins_[i];
        for (std::size_t k = 0; k < n; ++k) {
            std::size_t const c = (k + turn) % n;
            std::uint32_t const v = piece.face_vertices[at + c];
            if (number[v] == 0xffff) {
                number[v] = std::uint16_t(type.point_of.size());
                auto const [found, is_new] =
                    point.try_emplace(piece.vertices[v], std::uint16_t(out.points.size()));
                if (is_new) out.points.push_back(piece.vertices[v]);
                type.point_of.push_back(found->second);
            }
            type.face_vertices.push_back(number[v]);
            out.corners.push_back(mesh.face_start[faces_[i]] + HalfEdge(c));
        }
        type.face_start.push_back(std::uint16_t(type.face_vertices.size()));
        at += n;
    }
    type.points = std::uint16_t(out.points.size());
    if (point.size() > 0xfff0)
        throw LimitError("vertices around face " + std::to_string(face + 1), point.size(), 0xfff0);

    // Tags where they count: at the patch, and with Chaikin's rule at its edges' far ends.
    for (std::size_t c = 0; c < out.corners.size(); ++c) {
        std::uint16_t const v = type.face_vertices[c];
        HalfEdge const edge = out.corners[c], twin = t_.twin(edge);
        if (v < sides && c < sides) {
            std::uint32_t const vertex = t_.vertex_of(edge);
            if (!sharpness_.is_plain(vertex)) {
                sharpness_.around(vertex, ring_);
                bool const is_corner =
                    in_sectors ? ring_.rule() == VertexRule::Corner : ring_.vertex > 0;
                if (is_corner)
                    type.corners.push_back({v, in_sectors && !ring_.is_semi_sharp()
                                                   ? kInfinitelySharp
                                                   : std::min(ring_.vertex, kInfinitelySharp)});
            }
        }
        if (twin == Topology::kNone || (in_sectors && is_cut(edge))) continue;
        float const s = std::min(sharpness_.edge(edge), kInfinitelySharp);
        if (s <= 0) continue;
        std::size_t const f =
            std::size_t(std::upper_bound(type.face_start.begin(), type.face_start.end(), c) -
                        type.face_start.begin() - 1);
        std::size_t const next = c + 1 < type.face_start[f + 1] ? c + 1 : type.face_start[f];
        std::uint16_t const w = type.face_vertices[next];
        if (std::min(v, w) >= sides && rings_ == 1) continue;
        type.creases.push_back({std::min(v, w), std::max(v, w), s});
    }
    std::sort(type.creases.begin(), type.creases.end());
    type.creases.erase(std::unique(type.creases.begin(), type.creases.end()), type.creases.end());
    if (!type.creases.empty()) type.crease_method = mesh.rules.crease_method;
    return out;
}

} // namespace tessemu
