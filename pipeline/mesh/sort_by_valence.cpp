// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/sort_by_valence.h"

#include <numeric>

namespace tessemu {

namespace {

struct Order {
    std::vector<std::uint32_t> old; ///< by new number
    std::vector<std::uint32_t> now; ///< by old number
};

template <class Valence> Order order_by(std::size_t n, Valence const& valence)
{
    Order out{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(n)};
    std::iota(out.old.begin(), out.old.end(), 0u);
    std::stable_sort(out.old.begin(), out.old.end(), [&](std::uint32_t a, std::uint32_t b) -> bool {
        return valence(a) < valence(b);
    });
    for (std::uint32_t i = 0; i < n; ++i) out.now[out.old[i]] = i;
    return out;
}

} // namespace

ControlMesh sort_by_valence(ControlMesh const& mesh, SubdivisionTables const& tables)
{
    Order const faces =
        order_by(mesh.faces(), [&](std::uint32_t f) { return mesh.face(f).size(); });
    Order const vertices = order_by(mesh.positions.size(), [&](std::uint32_t v) {
        return tables.vertex_offset_valence[2 * std::size_t(v) + 1];
    });
    ControlMesh out;
    out.name = mesh.name;
    for (std::uint32_t v : vertices.old) {
        out.positions.push_back(mesh.positions[v]);
        out.file_vertices.push_back(mesh.file_vertex(v));
    }
    out.coordinates = mesh.coordinates;
    std::vector<std::uint32_t> face;
    std::vector<std::uint32_t> corner_now(mesh.concave.empty() ? 0 : mesh.face_vertices.size());
    for (std::uint32_t f : faces.old) {
        if (!mesh.concave.empty())
            std::iota(corner_now.begin() + mesh.face_start[f],
                      corner_now.begin() + mesh.face_start[f + 1], out.face_start.back());
        face.clear();
        for (std::uint32_t v : mesh.face(f)) face.push_back(vertices.now[v]);
        out.add_face(face);
        out.file_faces.push_back(mesh.file_face(f));
        if (mesh.face_coordinates.empty()) continue;
        for (std::uint32_t h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
            out.face_coordinates.push_back(mesh.face_coordinates[h]);
    }
    for (ControlMesh::Crease const& c : mesh.creases)
        out.creases.push_back({vertices.now[c.a], vertices.now[c.b], c.sharpness});
    for (ControlMesh::Corner const& c : mesh.corners)
        out.corners.push_back({vertices.now[c.vertex], c.sharpness});
    for (std::uint32_t f : mesh.holes) out.holes.push_back(faces.now[f]);
    for (auto const& [a, b] : mesh.slits)
        out.slits.push_back(ordered_edge(vertices.now[a], vertices.now[b]));
    for (std::uint32_t h : mesh.concave) out.concave.push_back(corner_now[h]);
    std::sort(out.concave.begin(), out.concave.end());
    std::sort(out.holes.begin(), out.holes.end());
    std::sort(out.slits.begin(), out.slits.end());
    out.rules = mesh.rules;
    out.cut_edges = mesh.cut_edges;
    return out;
}

} // namespace tessemu
