// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/catmull_clark.h"

namespace tessemu {

namespace {

using Vec = glm::dvec3;

std::vector<Vec> face_points(ControlMesh const& mesh, std::span<Vec const> x)
{
    std::vector<Vec> out(mesh.faces());
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        for (std::uint32_t v : mesh.face(f)) out[f] += x[v];
        out[f] /= double(mesh.face(f).size());
    }
    return out;
}

} // namespace

// Vertices first, then a point for each edge at its first half-edge, then the faces'.
std::vector<Vec> catmull_clark_points(Topology const& topology, std::span<Vec const> x)
{
    ControlMesh const& mesh = topology.mesh();
    std::vector<Vec> const face_point = face_points(mesh, x);
    std::vector<Vec> out;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        auto const ring = topology.ring(v);
        double const n = double(ring.size());
        if (ring.empty()) {
            out.push_back(x[v]);
        } else if (topology.is_boundary(v)) {
            Vec const first = x[topology.vertex_of(topology.next(ring.front()))];
            Vec const last = x[topology.vertex_of(topology.previous(ring.back()))];
            bool const fixed = ring.size() == 1 && !mesh.smooth_corners();
            out.push_back(fixed ? x[v] : (first + 6.0 * x[v] + last) / 8.0);
        } else {
            Vec edges(0), faces(0);
            for (HalfEdge h : ring) {
                edges += x[topology.vertex_of(topology.next(h))];
                faces += face_point[topology.face_of(h)];
            }
            out.push_back((n - 2) / n * x[v] + edges / (n * n) + faces / (n * n));
        }
    }
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const other = topology.twin(h);
        if (other != Topology::kNone && other < h) continue;
        Vec const a = x[topology.vertex_of(h)], b = x[topology.vertex_of(topology.next(h))];
        if (other == Topology::kNone)
            out.push_back((a + b) / 2.0);
        else
            out.push_back(
                (a + b + face_point[topology.face_of(h)] + face_point[topology.face_of(other)]) /
                4.0);
    }
    out.insert(out.end(), face_point.begin(), face_point.end());
    return out;
}

ControlMesh catmull_clark_step(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    std::vector<Vec> const x(mesh.positions.begin(), mesh.positions.end());
    ControlMesh out;
    out.name = mesh.name;
    out.boundary = mesh.boundary;
    for (Vec const& p : catmull_clark_points(topology, x)) out.positions.emplace_back(p);
    auto edges = std::uint32_t(mesh.positions.size());
    std::vector<std::uint32_t> edge_point(mesh.face_vertices.size());
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const other = topology.twin(h);
        if (other != Topology::kNone && other < h) {
            edge_point[h] = edge_point[other];
            continue;
        }
        edge_point[h] = edges++;
    }
    std::uint32_t const first_face_point = edges;

    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        std::uint32_t const quad[4] = {topology.vertex_of(h), edge_point[h],
                                       first_face_point + topology.face_of(h),
                                       edge_point[topology.previous(h)]};
        out.add_face(quad);
    }
    if (!mesh.face_coordinates.empty()) { // linear in the face
        auto const at = [&](HalfEdge h) { return mesh.coordinates[mesh.face_coordinates[h]]; };
        for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
            std::uint32_t const f = topology.face_of(h);
            glm::dvec2 center(0);
            for (HalfEdge k = mesh.face_start[f]; k < mesh.face_start[f + 1]; ++k) center += at(k);
            center /= double(mesh.face(f).size());
            for (glm::dvec2 c : {at(h), (at(h) + at(topology.next(h))) / 2.0, center,
                                 (at(topology.previous(h)) + at(h)) / 2.0}) {
                out.face_coordinates.push_back(std::uint32_t(out.coordinates.size()));
                out.coordinates.push_back(c);
            }
        }
    }
    for (std::uint32_t f : mesh.holes)
        for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
            out.holes.push_back(h);
    auto const softer = [](float sharpness) {
        return sharpness >= kInfinitelySharp ? sharpness : sharpness - 1;
    };
    for (auto const& c : mesh.corners)
        if (float const left = softer(c.sharpness); left > 0)
            out.corners.push_back({c.vertex, left});
    for (auto const& c : mesh.creases) {
        HalfEdge const h = topology.find_edge(c.a, c.b);
        float const left = softer(c.sharpness);
        if (left <= 0 || h == Topology::kNone) continue;
        out.creases.push_back({c.a, edge_point[h], left});
        out.creases.push_back({edge_point[h], c.b, left});
    }
    return out;
}

} // namespace tessemu
