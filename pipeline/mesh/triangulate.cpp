// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/triangulate.h"

namespace tessemu {

TriangulatedMesh triangulate(ControlMesh mesh)
{
    TriangulatedMesh out;
    for (std::uint32_t f = std::uint32_t(mesh.faces()); f-- > 0;)
        if (mesh.face(f).size() > 3) ++out.cut_faces, out.first_cut = mesh.file_face(f);
    if (out.cut_faces == 0) {
        out.mesh = std::move(mesh);
        return out;
    }
    std::vector<std::uint32_t> start{0}, vertices, coordinates, file_faces, holes;
    std::vector<char> is_hole(mesh.faces(), 0);
    for (std::uint32_t f : mesh.holes) is_hole[f] = 1;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        std::uint32_t const first = mesh.face_start[f];
        for (std::uint32_t k = 1; k + 1 < std::uint32_t(mesh.face(f).size()); ++k) {
            if (is_hole[f]) holes.push_back(std::uint32_t(start.size() - 1));
            for (std::uint32_t c : {first, first + k, first + k + 1}) {
                vertices.push_back(mesh.face_vertices[c]);
                if (!mesh.face_coordinates.empty()) coordinates.push_back(mesh.face_coordinates[c]);
            }
            start.push_back(std::uint32_t(vertices.size()));
            file_faces.push_back(mesh.file_face(f));
        }
    }
    mesh.face_start = std::move(start);
    mesh.face_vertices = std::move(vertices);
    mesh.face_coordinates = std::move(coordinates);
    mesh.file_faces = std::move(file_faces);
    mesh.holes = std::move(holes);
    mesh.concave.clear(); // sectors of quads
    out.mesh = std::move(mesh);
    return out;
}

} // namespace tessemu
