// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/manifold.h"

#include "pipeline/mesh/topology.h"

#include <algorithm>
#include <numeric>

namespace tessemu {

namespace {

// A mesh of some of another's faces and corners, and where they come from.
struct Kept {
    ControlMesh mesh; ///< faces alone
    std::vector<std::uint32_t> faces, corners;
};

Kept without_degenerate_faces(ControlMesh const& mesh, MeshRepairs& repairs)
{
    Kept out;
    std::vector<std::uint32_t> face, corners, sorted;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        face.clear(), corners.clear();
        auto const all = mesh.face(f);
        for (std::uint32_t i = 0; i < all.size(); ++i) {
            if (all[i] == all[(i + 1) % all.size()] && all.size() > 1) continue;
            face.push_back(all[i]);
            corners.push_back(mesh.face_start[f] + i);
        }
        sorted = face;
        std::sort(sorted.begin(), sorted.end());
        bool const twice = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
        if (face.size() < 3 || twice) {
            repairs.dropped.add(mesh.file_face(f));
            continue;
        }
        if (face.size() < all.size()) repairs.repeated.add(mesh.file_face(f));
        out.mesh.add_face(face);
        out.faces.push_back(f);
        out.corners.insert(out.corners.end(), corners.begin(), corners.end());
    }
    return out;
}

using Edge = std::pair<std::uint32_t, std::uint32_t>; // ordered

// Which corners of a mesh share a vertex through shared edges, and which edges are not shared as
// they should be.
class Fans {
public:
    explicit Fans(ControlMesh const& mesh) : mesh_(mesh), parent_(mesh.face_vertices.size())
    {
        std::iota(parent_.begin(), parent_.end(), 0u);
        std::vector<std::pair<Edge, HalfEdge>> uses;
        next_.resize(parent_.size());
        for (std::uint32_t f = 0; f < mesh.faces(); ++f)
            for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h) {
                next_[h] = h + 1 < mesh.face_start[f + 1] ? h + 1 : mesh.face_start[f];
                uses.emplace_back(ordered_edge(from(h), to(h)), h);
            }
        std::sort(uses.begin(), uses.end());
        for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
            while (end < uses.size() && uses[end].first == uses[i].first) ++end;
            HalfEdge const h = uses[i].second, g = uses[end - 1].second;
            if (end - i == 1) {
                boundary.push_back(uses[i].first);
            } else if (end - i == 2 && from(h) == to(g)) {
                join(h, next_[g]);
                join(g, next_[h]);
            } else {
                cut.push_back(uses[i].first);
                for (std::size_t k = i; k < end; ++k) cut_half_edges.push_back(uses[k].second);
            }
            edges.push_back(uses[i].first);
        }
    }

    HalfEdge next(HalfEdge h) const { return next_[h]; }
    std::uint32_t from(HalfEdge h) const { return mesh_.face_vertices[h]; }
    std::uint32_t to(HalfEdge h) const { return mesh_.face_vertices[next_[h]]; }
    /// A fan's first corner.
    HalfEdge fan(HalfEdge h)
    {
        while (parent_[h] != h) h = parent_[h] = parent_[parent_[h]];
        return h;
    }

    std::vector<Edge> edges, boundary, cut; ///< ascending
    std::vector<HalfEdge> cut_half_edges;

private:
    void join(HalfEdge h, HalfEdge g)
    {
        h = fan(h), g = fan(g);
        parent_[std::max(h, g)] = std::min(h, g);
    }

    ControlMesh const& mesh_;
    std::vector<HalfEdge> parent_, next_;
};

// How many edges of a list meet each vertex.
std::vector<std::uint32_t> edges_at(std::vector<Edge> const& edges, std::size_t vertices)
{
    std::vector<std::uint32_t> out(vertices);
    for (Edge e : edges) ++out[e.first], ++out[e.second];
    return out;
}

} // namespace

ManifoldMesh make_manifold(ControlMesh mesh)
{
    ManifoldMesh out;
    MeshRepairs& repairs = out.repairs;
    std::size_t const vertices = mesh.positions.size();
    Kept kept = without_degenerate_faces(mesh, repairs);
    if (kept.faces.empty())
        throw MeshError(0, "no face is left: each has fewer than three different vertices");
    Fans fans(kept.mesh);
    std::size_t const corners = kept.corners.size();

    // Copies of vertices, by the first corners of their fans.
    std::vector<std::uint32_t> faces_at(vertices), fans_at(vertices), of_fan(corners);
    std::vector<HalfEdge> first_corner(vertices, Topology::kNone), copies;
    for (HalfEdge h = 0; h < corners; ++h) {
        std::uint32_t const v = fans.from(h);
        ++faces_at[v];
        if (fans.fan(h) != h) continue;
        if (fans_at[v]++ == 0)
            first_corner[v] = h;
        else
            copies.push_back(h);
    }
    bool split = false;
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (!faces_at[v]) repairs.unused.add(mesh.file_vertex(v));
        if (fans_at[v] > 1) repairs.split.add(mesh.file_vertex(v)), split = true;
    }
    for (Edge e : fans.cut) repairs.cut.add(mesh.file_vertex(e.first));
    if (kept.faces.size() == mesh.faces() && corners == mesh.face_vertices.size() &&
        !repairs.unused.number && !split && fans.cut.empty()) {
        out.mesh = std::move(mesh);
        return out;
    }

    ControlMesh& m = out.mesh;
    m.name = mesh.name;
    m.rules = mesh.rules;
    auto const add_vertex = [&](std::uint32_t v, HalfEdge fan) {
        of_fan[fan] = std::uint32_t(m.positions.size());
        m.positions.push_back(mesh.positions[v]);
        m.file_vertices.push_back(mesh.file_vertex(v));
    };
    for (std::uint32_t v = 0; v < vertices; ++v)
        if (faces_at[v]) add_vertex(v, first_corner[v]);
    std::stable_sort(copies.begin(), copies.end(), [&](HalfEdge a, HalfEdge b) {
        return std::pair(fans.from(a), a) < std::pair(fans.from(b), b);
    });
    for (HalfEdge h : copies) add_vertex(fans.from(h), h);
    auto const vertex = [&](HalfEdge h) { return of_fan[fans.fan(h)]; };
    for (HalfEdge h = 0; h < corners; ++h) m.face_vertices.push_back(vertex(h));
    m.face_start = kept.mesh.face_start;
    for (std::uint32_t f : kept.faces) m.file_faces.push_back(mesh.file_face(f));
    if (!mesh.face_coordinates.empty()) {
        m.coordinates = mesh.coordinates;
        for (std::uint32_t c : kept.corners) m.face_coordinates.push_back(mesh.face_coordinates[c]);
    }

    // Tags: of every copy of a vertex and of an edge.
    std::vector<std::vector<std::uint32_t>> copies_of(vertices);
    for (HalfEdge h = 0; h < corners; ++h)
        if (fans.fan(h) == h) copies_of[fans.from(h)].push_back(of_fan[h]);
    for (auto const& c : mesh.corners)
        for (std::uint32_t v : copies_of[c.vertex]) m.corners.push_back({v, c.sharpness});
    std::vector<std::pair<Edge, Edge>> edges; // in the given mesh, and now
    for (HalfEdge h = 0; h < corners; ++h)
        edges.emplace_back(ordered_edge(fans.from(h), fans.to(h)),
                           ordered_edge(vertex(h), vertex(fans.next(h))));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    auto const each_copy = [&](Edge e, auto const& f) {
        auto at = std::lower_bound(edges.begin(), edges.end(), std::pair(e, Edge{0, 0}));
        for (; at != edges.end() && at->first == e; ++at) f(at->second);
    };
    for (auto const& c : mesh.creases)
        each_copy(ordered_edge(c.a, c.b), [&](Edge e) {
            m.creases.push_back({e.first, e.second, c.sharpness});
        });
    for (HalfEdge h = 0; h < corners; ++h)
        if (std::binary_search(mesh.concave.begin(), mesh.concave.end(), kept.corners[h]))
            m.concave.push_back(h);
    std::vector<std::uint32_t> kept_as(mesh.faces(), Topology::kNone);
    for (std::uint32_t f = 0; f < kept.faces.size(); ++f) kept_as[kept.faces[f]] = f;
    for (std::uint32_t f : mesh.holes)
        if (kept_as[f] != Topology::kNone) m.holes.push_back(kept_as[f]);

    // What is no manifold is infinitely sharp.
    m.cut_edges = mesh.cut_edges + std::uint32_t(fans.cut.size());
    for (Edge e : fans.cut)
        each_copy(e, [&](Edge c) { m.creases.push_back({c.first, c.second, kInfinitelySharp}); });
    auto const cut_at = edges_at(fans.cut, vertices), open_at = edges_at(fans.boundary, vertices),
               edges_of = edges_at(fans.edges, vertices);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        if (fans_at[v] < 2 && !cut_at[v]) continue;
        bool const in_a_crease = cut_at[v] == 2 && !open_at[v] && faces_at[v] > edges_of[v];
        if (in_a_crease) continue;
        for (std::uint32_t c : copies_of[v]) m.corners.push_back({c, kInfinitelySharp});
    }
    // Both sides of a cut may still have the same two vertices: at the end of a slit.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> directed;
    for (HalfEdge h : fans.cut_half_edges) directed.emplace_back(vertex(h), vertex(fans.next(h)));
    std::sort(directed.begin(), directed.end());
    for (auto const& [a, b] : directed)
        if (a < b && std::binary_search(directed.begin(), directed.end(), std::pair(b, a)))
            m.slits.emplace_back(a, b);
    return out;
}

std::vector<std::string> in_words(MeshRepairs const& r, FileLines const& lines)
{
    std::vector<std::string> out;
    auto const say = [&](MeshRepairs::Count const& c, std::string const& what, char const* whats,
                         char const* one, char const* many) {
        if (c.number == 0) return;
        std::string const first = what + " " + std::to_string(c.first + 1);
        out.push_back((what == "face" ? lines.before_face(c.first) : lines.before_vertex(c.first)) +
                      (c.number == 1 ? first + " " + one
                                     : std::to_string(c.number) + " " + whats + " " + many +
                                           "; the first is " + first));
    };
    say(r.repeated, "face", "faces", "names a vertex twice in a row and loses the repetition",
        "name a vertex twice in a row and lose the repetition");
    say(r.dropped, "face", "faces",
        "has fewer than three different vertices, or names one twice, not in a row: left out",
        "have fewer than three different vertices, or name one twice, not in a row: left out");
    say(r.unused, "vertex", "vertices", "is in no face: left out", "are in no face: left out");
    say(r.cut, "an edge at vertex", "edges",
        "has more than two faces, or two that run along it in one direction: it is sharp, the "
        "mesh is cut there",
        "have more than two faces, or two that run along them in one direction: they are sharp, "
        "the mesh is cut there");
    say(r.split, "vertex", "vertices", "has several fans of faces: each gets a copy of it",
        "have several fans of faces: each gets a copy of them");
    return out;
}

} // namespace tessemu
