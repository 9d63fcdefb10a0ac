// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/catmull_clark.h"

namespace tessemu {

namespace {

// Linear in the face, a corner's quad after another's.
void refine_coordinates(Topology const& topology, ControlMesh& out)
{
    ControlMesh const& mesh = topology.mesh();
    if (mesh.face_coordinates.empty()) return;
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

} // namespace

ControlMesh catmull_clark_step(Topology const& topology)
{
    Sharpness const sharpness(topology);
    std::vector<glm::dvec3> const x(topology.mesh().positions.begin(),
                                    topology.mesh().positions.end());
    ControlMesh out = catmull_clark_mesh(
        topology, sharpness, refined_points<CatmullClark, glm::dvec3>(topology, sharpness, x));
    refine_coordinates(topology, out);
    return out;
}

ControlMesh catmull_clark_mesh(Topology const& topology, Sharpness const& sharpness,
                               std::span<glm::dvec3 const> points)
{
    ControlMesh const& mesh = topology.mesh();
    ControlMesh out;
    out.name = mesh.name;
    out.boundary = mesh.boundary;
    out.crease_method = mesh.crease_method;
    out.smooth_triangles = mesh.smooth_triangles;
    out.positions.assign(points.begin(), points.end());
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
    for (std::uint32_t f : mesh.holes)
        for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
            out.holes.push_back(h);
    for (auto const& c : mesh.corners)
        if (float const left = decremented(c.sharpness); left > 0)
            out.corners.push_back({c.vertex, left});
    for (auto const& c : mesh.creases) {
        HalfEdge const h = topology.find_edge(c.a, c.b);
        if (h == Topology::kNone) continue;
        auto const [first, second] = sharpness.halves(h);
        std::uint32_t const a = topology.vertex_of(h), b = topology.vertex_of(topology.next(h));
        if (first > 0) out.creases.push_back({a, edge_point[h], first});
        if (second > 0) out.creases.push_back({edge_point[h], b, second});
    }
    return out;
}

} // namespace tessemu
