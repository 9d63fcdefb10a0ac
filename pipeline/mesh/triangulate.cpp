// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/triangulate.h"

#include <unordered_set>

namespace tessemu {

namespace {

// Edges, and diagonals that have become some.
class Edges {
public:
    explicit Edges(ControlMesh const& mesh)
    {
        for (std::size_t f = 0; f < mesh.faces(); ++f) {
            auto const face = mesh.face(f);
            for (std::size_t k = 0; k < face.size(); ++k)
                edges_.insert(key(face[k], face[(k + 1) % face.size()]));
        }
    }
    // The corner to cut a face from: the first whose diagonals are no edges yet, or 0.
    std::uint32_t cut(std::span<std::uint32_t const> face)
    {
        auto const n = std::uint32_t(face.size());
        auto const diagonal = [&](std::uint32_t from, std::uint32_t k) {
            return key(face[from], face[(from + k) % n]);
        };
        std::uint32_t from = 0;
        for (std::uint32_t c = 0; c < n; ++c) {
            bool free = true;
            for (std::uint32_t k = 2; k + 1 < n; ++k) free = free && !edges_.count(diagonal(c, k));
            if (!free) continue;
            from = c;
            break;
        }
        for (std::uint32_t k = 2; k + 1 < n; ++k) edges_.insert(diagonal(from, k));
        return from;
    }

private:
    static std::uint64_t key(std::uint32_t a, std::uint32_t b)
    {
        auto const [low, high] = ordered_edge(a, b);
        return std::uint64_t(low) << 32 | high;
    }
    std::unordered_set<std::uint64_t> edges_;
};

} // namespace

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
    Edges edges(mesh);
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        auto const sides = std::uint32_t(face.size());
        std::uint32_t const from = sides > 3 ? edges.cut(face) : 0;
        for (std::uint32_t k = 1; k + 1 < sides; ++k) {
            if (is_hole[f]) holes.push_back(std::uint32_t(start.size() - 1));
            for (std::uint32_t turn : {0u, k, k + 1}) {
                std::uint32_t const c = mesh.face_start[f] + (from + turn) % sides;
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
