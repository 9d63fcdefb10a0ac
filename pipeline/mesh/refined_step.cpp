// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/refined_step.h"

#include "pipeline/mesh/limit_points.h"

namespace tessemu {

namespace {

// Children of a face: `corner(h)` of each half-edge, quads around the middle or triangles, of what
// `vertex`, `edge` and `middle` give.
template <class Vertex, class Edge, class Middle, class Add>
void split_face(Topology const& t, std::uint32_t f, bool keeps_triangles, Vertex const& vertex,
                Edge const& edge, Middle const& middle, Add const& add)
{
    ControlMesh const& mesh = t.mesh();
    HalfEdge const first = mesh.face_start[f], end = mesh.face_start[f + 1];
    using X = std::decay_t<decltype(vertex(first))>;
    if (!keeps_triangles || end - first != 3) {
        for (HalfEdge h = first; h < end; ++h) {
            X const quad[4] = {vertex(h), edge(h), middle(f), edge(t.previous(h))};
            add(std::span<X const>(quad));
        }
        return;
    }
    for (HalfEdge h = first; h < end; ++h) {
        X const triangle[3] = {vertex(h), edge(h), edge(t.previous(h))};
        add(std::span<X const>(triangle));
    }
    X const between[3] = {edge(first), edge(first + 1), edge(first + 2)};
    add(std::span<X const>(between));
}

// Linear in the face, child after child.
void split_coordinates(Topology const& t, bool keeps_triangles, ControlMesh& out)
{
    ControlMesh const& mesh = t.mesh();
    if (mesh.face_coordinates.empty()) return;
    auto const at = [&](HalfEdge h) { return mesh.coordinates[mesh.face_coordinates[h]]; };
    auto const edge = [&](HalfEdge h) { return (at(h) + at(t.next(h))) / 2.0; };
    auto const middle = [&](std::uint32_t f) {
        glm::dvec2 sum(0);
        for (HalfEdge k = mesh.face_start[f]; k < mesh.face_start[f + 1]; ++k) sum += at(k);
        return sum / double(mesh.face(f).size());
    };
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
        split_face(t, f, keeps_triangles, at, edge, middle, [&](std::span<glm::dvec2 const> face) {
            for (glm::dvec2 const& c : face) {
                out.face_coordinates.push_back(std::uint32_t(out.coordinates.size()));
                out.coordinates.push_back(c);
            }
        });
}

// Texture coordinates as a mesh: its faces, with a vertex for each run of faces around one of the
// mesh's between seams.
struct Charts {
    ControlMesh mesh;
    std::vector<glm::dvec3> coordinates; ///< by vertex: u, v, 0
};

Charts charts_of(Topology const& t)
{
    ControlMesh const& mesh = t.mesh();
    auto const at = [&](HalfEdge h) { return mesh.coordinates[mesh.face_coordinates[h]]; };
    auto const is_seam = [&](HalfEdge h) {
        HalfEdge const twin = t.twin(h);
        return twin == Topology::kNone || at(h) != at(t.next(twin)) || at(t.next(h)) != at(twin);
    };
    Charts out;
    std::vector<std::uint32_t> vertex(mesh.face_vertices.size()); // by half-edge
    std::vector<std::vector<std::uint32_t>> parts(mesh.positions.size());
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        auto const ring = t.ring(v);
        std::size_t const n = ring.size();
        std::size_t first = 0;
        while (first < n && !is_seam(ring[first])) ++first;
        if (first == n) first = 0;
        for (std::size_t j = 0; j < n; ++j) {
            HalfEdge const h = ring[(first + j) % n];
            if (j == 0 || is_seam(h)) {
                parts[v].push_back(std::uint32_t(out.coordinates.size()));
                out.coordinates.emplace_back(at(h), 0);
            }
            vertex[h] = parts[v].back();
        }
    }
    out.mesh.rules = mesh.rules;
    out.mesh.positions.resize(out.coordinates.size());
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
        out.mesh.add_face(std::span(vertex).subspan(mesh.face_start[f], mesh.face(f).size()));
    for (auto const& c : mesh.corners)
        for (std::uint32_t v : parts[c.vertex]) out.mesh.corners.push_back({v, c.sharpness});
    for (auto const& c : mesh.creases) {
        HalfEdge const h = t.find_edge(c.a, c.b);
        if (h == Topology::kNone) continue;
        out.mesh.creases.push_back({vertex[h], vertex[t.next(h)], c.sharpness});
        HalfEdge const twin = t.twin(h);
        if (twin != Topology::kNone && is_seam(h))
            out.mesh.creases.push_back({vertex[twin], vertex[t.next(twin)], c.sharpness});
    }
    for (auto const& [a, b] : mesh.slits)
        for (std::uint32_t v : parts[a])
            for (std::uint32_t w : parts[b]) out.mesh.slits.push_back(ordered_edge(v, w));
    std::sort(out.mesh.slits.begin(), out.mesh.slits.end());
    return out;
}

} // namespace

ControlMesh split_mesh(Topology const& t, Sharpness const& sharpness,
                       std::span<glm::dvec3 const> points, bool keeps_triangles)
{
    ControlMesh const& mesh = t.mesh();
    ControlMesh out;
    out.name = mesh.name;
    out.rules = mesh.rules;
    out.positions.assign(points.begin(), points.end());
    PointNumbers const number(t, keeps_triangles);
    auto const vertex = [&](HalfEdge h) { return number.vertex(t.vertex_of(h)); };
    auto const edge = [&](HalfEdge h) { return number.edge(h); };
    auto const middle = [&](std::uint32_t f) { return number.face(f); };
    std::vector<std::uint32_t> first_child;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        first_child.push_back(std::uint32_t(out.faces()));
        split_face(t, f, keeps_triangles, vertex, edge, middle,
                   [&](std::span<std::uint32_t const> face) { out.add_face(face); });
    }
    first_child.push_back(std::uint32_t(out.faces()));
    // A corner's child begins with it.
    for (HalfEdge h : mesh.concave) {
        std::uint32_t const f = t.face_of(h);
        out.concave.push_back(out.face_start[first_child[f] + h - mesh.face_start[f]]);
    }
    for (std::uint32_t f : mesh.holes)
        for (std::uint32_t child = first_child[f]; child < first_child[f + 1]; ++child)
            out.holes.push_back(child);
    for (auto const& c : mesh.corners)
        if (float const left = decremented(c.sharpness); left > 0)
            out.corners.push_back({number.vertex(c.vertex), left});
    for (auto const& c : mesh.creases) {
        HalfEdge const h = t.find_edge(c.a, c.b);
        if (h == Topology::kNone) continue;
        auto const [first, second] = sharpness.halves(h);
        std::uint32_t const a = t.vertex_of(h), b = t.vertex_of(t.next(h));
        if (first > 0) out.creases.push_back({number.vertex(a), edge(h), first});
        if (second > 0) out.creases.push_back({edge(h), number.vertex(b), second});
    }
    split_coordinates(t, keeps_triangles, out);
    return out;
}

void smooth_coordinates(Topology const& coarse, RefinementStep const& step, ControlMesh& fine)
{
    if (!step.limit) throw Error("a step without limit rules has no masks for texture coordinates");
    if (coarse.mesh().rules.sectors == SectorRules::Biermann)
        throw Error("texture coordinates have no masks by Biermann's rules: coordinates=linear "
                    "does without");
    Charts const charts = charts_of(coarse);
    Topology const t(charts.mesh);
    Sharpness const sharpness(t);
    std::vector<glm::dvec3> const points = step.limit->refined(t, sharpness, charts.coordinates);
    fine.face_coordinates = split_mesh(t, sharpness, points, step.keeps_triangles).face_vertices;
    fine.coordinates.assign(points.begin(), points.end());
}

} // namespace tessemu
