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

RefinedStep catmull_clark_step(Topology const& topology, std::uint32_t first)
{
    Sharpness const sharpness(topology);
    std::vector<glm::dvec3> const x(topology.mesh().positions.begin(),
                                    topology.mesh().positions.end());
    RefinedStep out;
    out.tables = catmull_clark_tables(topology, sharpness, first, first > 0); // or refuses
    out.mesh = catmull_clark_mesh(topology, sharpness,
                                  refined_points<CatmullClark, glm::dvec3>(topology, sharpness, x));
    refine_coordinates(topology, out.mesh);
    return out;
}

ControlMesh catmull_clark_mesh(Topology const& topology, Sharpness const& sharpness,
                               std::span<glm::dvec3 const> points)
{
    ControlMesh const& mesh = topology.mesh();
    ControlMesh out;
    out.name = mesh.name;
    out.rules = mesh.rules;
    out.positions.assign(points.begin(), points.end());
    EdgeNumbers const edges(topology);
    auto const edge_point = [&, F = std::uint32_t(mesh.faces())](HalfEdge h) {
        return F + edges[h];
    };
    auto const vertex_point =
        [first = std::uint32_t(mesh.faces() + edges.size())](std::uint32_t v) { return first + v; };
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        std::uint32_t const quad[4] = {vertex_point(topology.vertex_of(h)), edge_point(h),
                                       topology.face_of(h), edge_point(topology.previous(h))};
        out.add_face(quad);
    }
    for (HalfEdge h : mesh.concave) out.concave.push_back(4 * h);
    for (std::uint32_t f : mesh.holes)
        for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
            out.holes.push_back(h);
    for (auto const& c : mesh.corners)
        if (float const left = decremented(c.sharpness); left > 0)
            out.corners.push_back({vertex_point(c.vertex), left});
    for (auto const& c : mesh.creases) {
        HalfEdge const h = topology.find_edge(c.a, c.b);
        if (h == Topology::kNone) continue;
        auto const [first, second] = sharpness.halves(h);
        std::uint32_t const a = topology.vertex_of(h), b = topology.vertex_of(topology.next(h));
        if (first > 0) out.creases.push_back({vertex_point(a), edge_point(h), first});
        if (second > 0) out.creases.push_back({edge_point(h), vertex_point(b), second});
    }
    return out;
}

} // namespace tessemu
