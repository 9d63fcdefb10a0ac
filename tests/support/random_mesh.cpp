// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_mesh.h"

#include "pipeline/mesh/topology.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace tessemu::test {

namespace {

using Face = std::vector<std::uint32_t>;

ControlMesh assemble(std::vector<glm::vec3> const& positions, std::vector<Face> const& faces)
{
    ControlMesh m;
    // Vertices that no face uses would be no fault, but tell nothing.
    std::vector<std::uint32_t> id(positions.size(), 0xffffffffu);
    for (Face const& f : faces) {
        Face renumbered;
        for (std::uint32_t v : f) {
            if (id[v] == 0xffffffffu) {
                id[v] = std::uint32_t(m.positions.size());
                m.positions.push_back(positions[v]);
            }
            renumbered.push_back(id[v]);
        }
        m.add_face(renumbered);
    }
    return m;
}

bool is_manifold(ControlMesh const& mesh, std::uint32_t largest_valence)
{
    try {
        Topology const t(mesh);
        for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
            if (t.valence(v) > largest_valence || t.valence(v) < (t.is_boundary(v) ? 2 : 3))
                return false;
        return true;
    } catch (MeshError const&) {
        return false;
    }
}

} // namespace

ControlMesh random_mesh(std::uint32_t seed)
{
    std::mt19937 random(seed * 2654435761u + 1);
    auto const below = [&](std::size_t n) { return std::size_t(random() % n); };
    auto const unit = [&] { return float(random() >> 8) * 0x1p-24f; };

    // A cube's surface of s x s quads a side, bent a little.
    int const s = 1 + int(below(3));
    std::vector<glm::vec3> positions;
    std::vector<Face> faces;
    auto const vertex = [&](int x, int y, int z) {
        glm::vec3 const p{float(x), float(y), float(z)};
        for (std::uint32_t i = 0; i < positions.size(); ++i)
            if (positions[i] == p) return i;
        positions.push_back(p);
        return std::uint32_t(positions.size() - 1);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int side : {0, s})
            for (int i = 0; i < s; ++i)
                for (int j = 0; j < s; ++j) {
                    auto const at = [&](int a, int b) {
                        std::array<int, 3> p{};
                        p[std::size_t(axis)] = side;
                        p[std::size_t((axis + 1) % 3)] = a;
                        p[std::size_t((axis + 2) % 3)] = b;
                        return vertex(p[0], p[1], p[2]);
                    };
                    Face f{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
                    if (side == 0) std::swap(f[1], f[3]);
                    faces.push_back(std::move(f));
                }

    // Triangles: quads cut, faces poked, most of them around one face so that its valences grow.
    bool const quads_only = below(4) == 0;
    Face const favourites = faces[below(faces.size())]; // its patch gets many inputs
    std::size_t const changes = quads_only ? 0 : below(45);
    for (std::size_t k = 0; k < changes; ++k) {
        std::size_t f = below(faces.size());
        if (below(2))
            for (std::size_t i = 0; i < faces.size(); ++i)
                for (std::uint32_t v : faces[i])
                    if (std::count(favourites.begin(), favourites.end(), v) && below(4) == 0) f = i;
        std::vector<glm::vec3> const old_positions = positions;
        std::vector<Face> const old_faces = faces;
        Face const face = faces[f];
        if (face.size() == 4 && below(2)) {
            faces[f] = {face[0], face[1], face[2]};
            faces.push_back({face[0], face[2], face[3]});
        } else {
            glm::vec3 middle(0);
            for (std::uint32_t v : face) middle += positions[v] / float(face.size());
            auto const centre = std::uint32_t(positions.size());
            positions.push_back(middle);
            faces.erase(faces.begin() + std::ptrdiff_t(f));
            for (std::size_t i = 0; i < face.size(); ++i)
                faces.push_back({face[i], face[(i + 1) % face.size()], centre});
        }
        if (!is_manifold(assemble(positions, faces), 12))
            positions = old_positions, faces = old_faces;
    }
    // Open: some faces go.
    if (below(3) == 0)
        for (std::size_t k = 0, n = 1 + below(faces.size() / 3); k < n; ++k) {
            std::vector<Face> const old_faces = faces;
            faces.erase(faces.begin() + std::ptrdiff_t(below(faces.size())));
            if (!is_manifold(assemble(positions, faces), 12)) faces = old_faces;
        }
    float const scale = std::ldexp(1.0f, int(below(9)) - 4);
    for (glm::vec3& p : positions)
        for (int k = 0; k < 3; ++k) p[k] = scale * (p[k] + 0.6f * (unit() - 0.5f));
    return assemble(positions, faces);
}

ControlMesh join_faces(ControlMesh const& mesh, std::uint32_t seed)
{
    std::mt19937 random(seed * 2654435761u + 3);
    std::vector<Face> faces;
    for (std::size_t f = 0; f < mesh.faces(); ++f)
        faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
    for (std::size_t k = 0; k < mesh.faces() / 3; ++k) {
        std::vector<Face> const old = faces;
        std::size_t const f = random() % faces.size(), i = random() % faces[f].size();
        std::uint32_t const a = faces[f][i], b = faces[f][(i + 1) % faces[f].size()];
        for (std::size_t g = 0; g < faces.size(); ++g) {
            Face& other = faces[g];
            auto const at = std::find(other.begin(), other.end(), b);
            if (g == f || at == other.end()) continue;
            std::rotate(other.begin(), at, other.end()); // b, a?, ...
            if (other[1] != a) continue;
            // Behind a the rest of the other face, which leads to b.
            faces[f].insert(faces[f].begin() + std::ptrdiff_t(i) + 1, other.begin() + 2,
                            other.end());
            faces.erase(faces.begin() + std::ptrdiff_t(g));
            break;
        }
        ControlMesh const joined = assemble(mesh.positions, faces);
        if (joined.positions.size() < mesh.positions.size() || !is_manifold(joined, 12))
            faces = old;
    }
    return assemble(mesh.positions, faces);
}

ControlMesh prism(int n)
{
    ControlMesh m;
    auto const count = std::uint32_t(n);
    for (float z : {0.0f, 1.0f})
        for (int i = 0; i < n; ++i) {
            double const angle = 2 * std::acos(-1.0) * i / n;
            m.positions.emplace_back(std::cos(angle), std::sin(angle), z);
        }
    Face bottom, top;
    for (std::uint32_t i = 0; i < count; ++i) {
        bottom.push_back(count - 1 - i);
        top.push_back(count + i);
    }
    m.add_face(bottom);
    m.add_face(top);
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t const next = (i + 1) % count;
        m.add_face(Face{i, next, count + next, count + i});
    }
    return m;
}

ControlMesh with_random_tags(ControlMesh mesh, std::uint32_t seed)
{
    std::mt19937 random(seed);
    auto const sharpness = [&] {
        switch (random() % 5) {
        case 0:
            return 10.0f;
        case 1:
            return float(1 + random() % 3);
        default:
            return float(random() % 4096) / 1024;
        }
    };
    Topology const topology(mesh);
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const twin = topology.twin(h);
        if (twin != Topology::kNone && twin > h && random() % 4 == 0)
            mesh.creases.push_back(
                {topology.vertex_of(h), topology.vertex_of(topology.next(h)), sharpness()});
    }
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
        if (random() % 12 == 0) mesh.corners.push_back({v, sharpness()});
    mesh.rules.boundary = random() % 2 ? BoundaryRule::EdgeOnly : BoundaryRule::EdgeAndCorner;
    mesh.rules.crease_method = random() % 2 ? CreaseMethod::Chaikin : CreaseMethod::Normal;
    mesh.rules.smooth_triangles = random() % 2;
    return mesh;
}

} // namespace tessemu::test
