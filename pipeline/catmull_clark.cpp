// SPDX-License-Identifier: Apache-2.0
#include "pipeline/catmull_clark.h"

namespace tessemu {

ControlMesh catmull_clark_step(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    auto const vertices = std::uint32_t(mesh.positions.size());
    auto const at = [&](std::uint32_t v) { return glm::dvec3(mesh.positions[v]); };

    std::vector<glm::dvec3> face_point(mesh.faces());
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        glm::dvec3 sum(0);
        for (std::uint32_t v : mesh.face(f)) sum += at(v);
        face_point[f] = sum / double(mesh.face(f).size());
    }

    ControlMesh out;
    out.name = mesh.name;
    out.boundary = mesh.boundary;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        auto const ring = topology.ring(v);
        double const n = double(ring.size());
        if (ring.empty()) {
            out.positions.emplace_back(mesh.positions[v]);
        } else if (topology.is_boundary(v)) {
            glm::dvec3 const first = at(topology.vertex_of(topology.next(ring.front())));
            glm::dvec3 const last = at(topology.vertex_of(topology.previous(ring.back())));
            bool const fixed = ring.size() == 1 && mesh.boundary != BoundaryRule::EdgeOnly;
            out.positions.emplace_back(fixed ? at(v) : (first + 6.0 * at(v) + last) / 8.0);
        } else {
            glm::dvec3 edges(0), faces(0);
            for (HalfEdge h : ring) {
                edges += at(topology.vertex_of(topology.next(h)));
                faces += face_point[topology.face_of(h)];
            }
            out.positions.emplace_back((n - 2) / n * at(v) + edges / (n * n) + faces / (n * n));
        }
    }

    std::vector<std::uint32_t> edge_point(mesh.face_vertices.size());
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const other = topology.twin(h);
        if (other != Topology::kNone && other < h) {
            edge_point[h] = edge_point[other];
            continue;
        }
        glm::dvec3 const a = at(topology.vertex_of(h)),
                         b = at(topology.vertex_of(topology.next(h)));
        edge_point[h] = std::uint32_t(out.positions.size());
        if (other == Topology::kNone)
            out.positions.emplace_back((a + b) / 2.0);
        else
            out.positions.emplace_back(
                (a + b + face_point[topology.face_of(h)] + face_point[topology.face_of(other)]) /
                4.0);
    }
    auto const first_face_point = std::uint32_t(out.positions.size());
    for (glm::dvec3 const& f : face_point) out.positions.emplace_back(f);

    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        std::uint32_t const quad[4] = {topology.vertex_of(h), edge_point[h],
                                       first_face_point + topology.face_of(h),
                                       edge_point[topology.previous(h)]};
        out.add_face(quad);
    }
    for (std::uint32_t f : mesh.holes)
        for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
            out.holes.push_back(h);
    for (auto const& c : mesh.corners) out.corners.push_back(c);
    for (auto const& c : mesh.creases) {
        HalfEdge const h = topology.find_edge(c.a, c.b);
        if (c.sharpness <= 1 || h == Topology::kNone) continue;
        float const left = c.sharpness >= 10 ? c.sharpness : c.sharpness - 1;
        out.creases.push_back({c.a, edge_point[h], left});
        out.creases.push_back({edge_point[h], c.b, left});
    }
    return out;
}

} // namespace tessemu
