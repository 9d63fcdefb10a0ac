// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/topology.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace tessemu {

HalfEdge Topology::next(HalfEdge h) const
{
    std::uint32_t const f = half_edge_face_[h];
    return h + 1 == mesh_->face_start[f + 1] ? mesh_->face_start[f] : h + 1;
}

HalfEdge Topology::previous(HalfEdge h) const
{
    std::uint32_t const f = half_edge_face_[h];
    return h == mesh_->face_start[f] ? mesh_->face_start[f + 1] - 1 : h - 1;
}

Topology::Topology(ControlMesh const& mesh) : mesh_(&mesh)
{
    auto const vertex_name = [&](std::uint32_t v) {
        return std::to_string(mesh.file_vertex(v) + 1);
    };
    auto const edge_name = [&](std::uint32_t a, std::uint32_t b) {
        return vertex_name(a) + "-" + vertex_name(b);
    };
    auto const corners = std::uint32_t(mesh.face_vertices.size());
    auto const vertices = std::uint32_t(mesh.positions.size());
    half_edge_face_.resize(corners);
    ring_start_.assign(vertices + 1, 0);
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        if (face.size() < 3)
            throw MeshError(f, "face " + std::to_string(f + 1) + " has " +
                                   std::to_string(face.size()) +
                                   " vertices, at least 3 are needed");
        for (std::uint32_t h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h) {
            half_edge_face_[h] = f;
            ++ring_start_[mesh.face_vertices[h] + 1];
        }
    }
    std::partial_sum(ring_start_.begin(), ring_start_.end(), ring_start_.begin());
    ring_.resize(corners);
    std::vector<std::uint32_t> fill(ring_start_.begin(), ring_start_.end() - 1);
    for (HalfEdge h = 0; h < corners; ++h) ring_[fill[mesh.face_vertices[h]]++] = h;

    ring_index_.resize(corners);
    boundary_.assign(vertices, 0);
    std::vector<std::pair<std::uint32_t, HalfEdge>> outgoing;      // (far end, half-edge), sorted
    std::vector<std::pair<std::uint32_t, std::uint32_t>> incoming; // (near end, face), sorted
    std::vector<HalfEdge> ordered;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        auto const ring =
            std::span(ring_).subspan(ring_start_[v], ring_start_[v + 1] - ring_start_[v]);
        if (ring.empty()) continue;
        outgoing.clear(), incoming.clear(), ordered.clear();
        for (HalfEdge h : ring) { // ascending as yet: a face's corners follow each other
            if (!outgoing.empty() && face_of(outgoing.back().second) == face_of(h))
                throw MeshError(face_of(h), "face " + std::to_string(face_of(h) + 1) +
                                                " names vertex " + vertex_name(v) + " twice");
            outgoing.emplace_back(vertex_of(next(h)), h);
            incoming.emplace_back(vertex_of(previous(h)), face_of(h));
        }
        std::sort(outgoing.begin(), outgoing.end());
        std::sort(incoming.begin(), incoming.end());
        for (std::size_t i = 0; i + 1 < outgoing.size(); ++i) {
            std::uint32_t const f = face_of(outgoing[i].second),
                                g = face_of(outgoing[i + 1].second);
            if (outgoing[i].first == outgoing[i + 1].first)
                throw MeshError(std::max(f, g),
                                "edge " + edge_name(v, outgoing[i].first) +
                                    " is used in the same direction by faces " +
                                    std::to_string(f + 1) + " and " + std::to_string(g + 1) +
                                    ": more than two faces meet there, or one is turned over");
        }
        for (std::size_t i = 0; i + 1 < incoming.size(); ++i)
            if (incoming[i].first == incoming[i + 1].first)
                throw MeshError(incoming[i + 1].second,
                                "edge " + edge_name(incoming[i].first, v) +
                                    " is used in the same direction by faces " +
                                    std::to_string(incoming[i].second + 1) + " and " +
                                    std::to_string(incoming[i + 1].second + 1) +
                                    ": more than two faces meet there, or one is turned over");

        HalfEdge start = outgoing.front().second; // interior: the smallest neighbour
        for (auto const& [far, h] : outgoing) {
            auto const it = std::lower_bound(incoming.begin(), incoming.end(), std::pair(far, 0u));
            if (it != incoming.end() && it->first == far && !mesh.is_slit(v, far)) continue;
            boundary_[v] = 1;
            start = h;
            break;
        }
        for (HalfEdge h = start;;) {
            ordered.push_back(h);
            std::uint32_t const wanted = vertex_of(previous(h));
            auto const it =
                std::lower_bound(outgoing.begin(), outgoing.end(), std::pair(wanted, HalfEdge(0)));
            if (it == outgoing.end() || it->first != wanted || it->second == start ||
                mesh.is_slit(v, wanted))
                break;
            h = it->second;
            if (ordered.size() > ring.size()) break;
        }
        if (ordered.size() != ring.size())
            throw MeshError(face_of(ring[0]), "the faces around vertex " + vertex_name(v) +
                                                  " form more than one fan (" +
                                                  std::to_string(ordered.size()) + " of " +
                                                  std::to_string(ring.size()) +
                                                  " faces are connected through edges)");
        for (std::uint32_t j = 0; j < ordered.size(); ++j) {
            ring[j] = ordered[j];
            ring_index_[ordered[j]] = j;
        }
    }
}

HalfEdge Topology::twin(HalfEdge h) const
{
    std::uint32_t const v = vertex_of(h);
    auto const faces = ring(v);
    std::uint32_t const j = ring_index_[h];
    if (j == 0 && boundary_[v]) return kNone;
    // The face clockwise of edge j ends with the half-edge that runs towards v.
    return previous(faces[j == 0 ? faces.size() - 1 : j - 1]);
}

HalfEdge Topology::find_edge(std::uint32_t a, std::uint32_t b) const
{
    if (ring(b).size() < ring(a).size()) std::swap(a, b);
    for (HalfEdge h : ring(a)) {
        if (vertex_of(next(h)) == b) return h;
        if (vertex_of(previous(h)) == b) return previous(h);
    }
    return kNone;
}

std::vector<std::uint32_t> Topology::two_ring(std::uint32_t face) const
{
    std::vector<std::uint32_t> out;
    for (std::uint32_t v : mesh_->face(face))
        for (HalfEdge h : ring(v)) {
            auto const f = mesh_->face(face_of(h));
            out.insert(out.end(), f.begin(), f.end());
        }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

std::vector<Topology::Sector>
Topology::sectors(std::uint32_t vertex, std::vector<ControlMesh::Crease> const& creases) const
{
    auto const faces = ring(vertex);
    auto const n = std::uint32_t(faces.size());
    std::vector<std::uint32_t> cuts; // edge j begins a sector
    for (std::uint32_t j = 0; j < n; ++j) {
        std::uint32_t const far = vertex_of(next(faces[j]));
        bool const tagged = std::any_of(creases.begin(), creases.end(), [&](auto const& c) {
            return c.sharpness > 0 &&
                   ((c.a == vertex && c.b == far) || (c.b == vertex && c.a == far));
        });
        if (tagged || (j == 0 && boundary_[vertex])) cuts.push_back(j);
    }
    if (n == 0) return {};
    if (cuts.empty()) return {{0, n, true}};
    std::vector<Sector> out;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        std::uint32_t const end = i + 1 < cuts.size() ? cuts[i + 1] : cuts[0] + n;
        out.push_back({cuts[i], end - cuts[i], false});
    }
    return out;
}

bool is_regular(Topology const& topology, std::uint32_t face)
{
    ControlMesh const& mesh = topology.mesh();
    if (mesh.face(face).size() != 4) return false;
    for (std::uint32_t v : mesh.face(face)) {
        if (topology.is_boundary(v) || topology.ring(v).size() != 4) return false;
        for (HalfEdge h : topology.ring(v))
            if (mesh.face(topology.face_of(h)).size() != 4) return false;
    }
    return true;
}

MeshSummary summarize(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    MeshSummary s;
    s.vertices = mesh.positions.size();
    s.faces = mesh.faces();
    std::map<std::size_t, std::size_t> sizes, interior, boundary;
    std::vector<std::uint32_t> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    auto const root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    std::size_t boundary_half_edges = 0;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        ++sizes[face.size()];
        if (is_regular(topology, f)) ++s.regular_faces;
        for (std::uint32_t v : face) parent[root(v)] = root(face[0]);
    }
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h)
        if (topology.twin(h) == Topology::kNone) ++boundary_half_edges;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (topology.ring(v).empty()) {
            ++s.unused_vertices;
            continue;
        }
        if (root(v) == v) ++s.components;
        ++(topology.is_boundary(v) ? boundary : interior)[topology.valence(v)];
    }
    s.boundary_edges = boundary_half_edges;
    s.edges = (mesh.face_vertices.size() + boundary_half_edges) / 2;
    s.faces_by_size.assign(sizes.begin(), sizes.end());
    s.interior_valences.assign(interior.begin(), interior.end());
    s.boundary_valences.assign(boundary.begin(), boundary.end());
    return s;
}

} // namespace tessemu
