// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/join.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numeric>

namespace tessemu {

namespace {

double squared(glm::dvec3 d)
{
    return (d.x * d.x + d.y * d.y) + d.z * d.z;
}

// Points in clusters: two within a distance of each other are in one. A tree of boxes is joined
// with itself. Boxes decide by the same rounded sums as pairs of points, and rounding keeps order,
// so that they decide the same.
class Clusters {
public:
    Clusters(std::vector<glm::dvec3> points, double distance)
        : points_(std::move(points)),
          order_(points_.size()),
          parent_(points_.size()),
          limit_(distance * distance)
    {
        std::iota(order_.begin(), order_.end(), 0u);
        std::iota(parent_.begin(), parent_.end(), 0u);
        if (!points_.empty()) join(build(0, points_.size()));
    }

    /// The lowest number of a point's cluster.
    std::uint32_t lowest(std::uint32_t p)
    {
        while (parent_[p] != p) p = parent_[p] = parent_[parent_[p]];
        return p;
    }

private:
    static constexpr std::size_t kLeaf = 8, kNone = 0;
    struct Node {
        glm::dvec3 low, high;
        std::size_t begin, end;
        std::size_t left = kNone, right = kNone;
        bool whole = false; ///< all its points are known to be in one cluster
    };

    std::size_t build(std::size_t begin, std::size_t end)
    {
        Node node{points_[order_[begin]], points_[order_[begin]], begin, end};
        for (std::size_t i = begin; i < end; ++i) {
            node.low = glm::min(node.low, points_[order_[i]]);
            node.high = glm::max(node.high, points_[order_[i]]);
        }
        std::size_t const at = nodes_.size();
        nodes_.push_back(node);
        if (end - begin <= kLeaf) return at;
        glm::dvec3 const size = node.high - node.low;
        int const axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::size_t const middle = begin + (end - begin) / 2;
        auto const place = [&](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
        std::nth_element(place(begin), place(middle), place(end), [&](auto a, auto b) {
            return std::pair(points_[a][axis], a) < std::pair(points_[b][axis], b);
        });
        std::size_t const left = build(begin, middle), right = build(middle, end);
        nodes_[at].left = left, nodes_[at].right = right;
        return at;
    }

    double nearest(Node const& a, Node const& b) const
    {
        return squared(glm::max(glm::max(a.low - b.high, b.low - a.high), glm::dvec3(0)));
    }
    double farthest(Node const& a, Node const& b) const
    {
        return squared(glm::max(a.high - b.low, b.high - a.low));
    }

    void unite(std::uint32_t a, std::uint32_t b)
    {
        a = lowest(a), b = lowest(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    void unite_all(std::size_t n)
    {
        Node& node = nodes_[n];
        if (node.whole) return;
        for (std::size_t i = node.begin + 1; i < node.end; ++i)
            unite(order_[node.begin], order_[i]);
        node.whole = true;
    }
    bool in_one(std::size_t a, std::size_t b)
    {
        return nodes_[a].whole && nodes_[b].whole &&
               lowest(order_[nodes_[a].begin]) == lowest(order_[nodes_[b].begin]);
    }
    void update(std::size_t n)
    {
        Node& node = nodes_[n];
        if (node.whole) return;
        if (node.left != kNone) {
            node.whole = in_one(node.left, node.right);
            return;
        }
        node.whole = true;
        for (std::size_t i = node.begin + 1; i < node.end; ++i)
            node.whole = node.whole && lowest(order_[i]) == lowest(order_[node.begin]);
    }

    void join(std::size_t n)
    {
        if (farthest(nodes_[n], nodes_[n]) <= limit_) return unite_all(n);
        if (nodes_[n].left == kNone) {
            pairs(n, n);
        } else {
            join(nodes_[n].left);
            join(nodes_[n].right);
            join(nodes_[n].left, nodes_[n].right);
        }
        update(n);
    }
    void join(std::size_t a, std::size_t b)
    {
        Node const &A = nodes_[a], &B = nodes_[b];
        if (in_one(a, b) || nearest(A, B) > limit_) return;
        if (farthest(A, B) <= limit_) {
            unite(order_[A.begin], order_[B.begin]);
            unite_all(a);
            unite_all(b);
            return;
        }
        if (A.left == kNone && B.left == kNone) {
            pairs(a, b);
        } else if (B.left == kNone || (A.left != kNone && A.end - A.begin >= B.end - B.begin)) {
            join(A.left, b);
            join(A.right, b);
        } else {
            join(a, B.left);
            join(a, B.right);
        }
        update(a);
        update(b);
    }
    void pairs(std::size_t a, std::size_t b)
    {
        for (std::size_t i = nodes_[a].begin; i < nodes_[a].end; ++i)
            for (std::size_t j = nodes_[b].begin; j < nodes_[b].end; ++j)
                if (squared(points_[order_[i]] - points_[order_[j]]) <= limit_)
                    unite(order_[i], order_[j]);
    }

    std::vector<glm::dvec3> points_;
    std::vector<std::uint32_t> order_, parent_;
    std::vector<Node> nodes_; // 0 is the root, and no one's child
    double limit_;
};

std::string number(double x)
{
    char digits[32];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
}

std::size_t different(std::span<std::uint32_t const> face)
{
    std::vector<std::uint32_t> sorted(face.begin(), face.end());
    std::sort(sorted.begin(), sorted.end());
    return std::size_t(std::unique(sorted.begin(), sorted.end()) - sorted.begin());
}

double shortest_edge(ControlMesh const& mesh)
{
    double shortest = INFINITY;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        for (std::size_t k = 0; k < face.size(); ++k) {
            glm::dvec3 const a(mesh.positions[face[k]]),
                b(mesh.positions[face[(k + 1) % face.size()]]);
            if (a != b) shortest = std::min(shortest, glm::length(b - a));
        }
    }
    return shortest;
}

} // namespace

JoinedMesh join_vertices(ControlMesh mesh, double distance, Placement const& placement)
{
    if (!(distance >= 0))
        throw Error("the distance within which vertices are joined is " + number(distance) +
                    ", it must be 0 or more");
    JoinedMesh out;
    std::size_t const vertices = mesh.positions.size();
    std::vector<std::uint32_t> to(vertices); // their numbers among those that stay
    std::vector<std::uint32_t> stays;
    {
        Clusters clusters({mesh.positions.begin(), mesh.positions.end()},
                          placement.length_from_file(distance));
        for (std::uint32_t v = 0; v < vertices; ++v) {
            std::uint32_t const lowest = clusters.lowest(v);
            if (lowest == v) {
                to[v] = std::uint32_t(stays.size());
                stays.push_back(v);
                continue;
            }
            to[v] = to[lowest];
            if (out.join.joined++ == 0)
                out.join.first = mesh.file_vertex(v), out.join.into = mesh.file_vertex(lowest);
        }
    }
    if (out.join.joined == 0) {
        out.mesh = std::move(mesh);
        return out;
    }
    double const shortest = placement.length_to_file(shortest_edge(mesh));
    std::vector<std::size_t> had(mesh.faces());
    for (std::size_t f = 0; f < mesh.faces(); ++f) had[f] = different(mesh.face(f));
    for (std::uint32_t& v : mesh.face_vertices) v = to[v];
    bool face_left = false;
    for (std::size_t f = 0; f < mesh.faces(); ++f) {
        std::size_t const has = different(mesh.face(f));
        face_left = face_left || has >= 3;
        if (has < had[f] && out.join.collapsed++ == 0)
            out.join.first_collapsed = mesh.file_face(std::uint32_t(f));
    }
    if (!face_left && out.join.collapsed)
        throw MeshError(out.join.first_collapsed,
                        "no face is left where vertices within " + number(distance) +
                            " are joined: the shortest edge is " + number(shortest));

    std::vector<std::uint32_t> file_vertices;
    for (std::uint32_t& v : stays) {
        file_vertices.push_back(mesh.file_vertex(v));
        mesh.positions[file_vertices.size() - 1] = mesh.positions[v];
    }
    mesh.positions.resize(stays.size());
    mesh.file_vertices = std::move(file_vertices);

    std::vector<ControlMesh::Crease> creases;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> crease_of;
    for (ControlMesh::Crease const& c : mesh.creases) {
        auto const [a, b] = ordered_edge(to[c.a], to[c.b]);
        if (a == b) continue;
        auto const [at, first] = crease_of.emplace(std::pair(a, b), creases.size());
        if (first) creases.push_back({to[c.a], to[c.b], c.sharpness});
        float& sharpness = creases[at->second].sharpness;
        sharpness = std::max(sharpness, c.sharpness);
    }
    mesh.creases = std::move(creases);
    std::vector<ControlMesh::Corner> corners;
    std::map<std::uint32_t, std::size_t> corner_of;
    for (ControlMesh::Corner const& c : mesh.corners) {
        auto const [at, first] = corner_of.emplace(to[c.vertex], corners.size());
        if (first) corners.push_back({to[c.vertex], c.sharpness});
        float& sharpness = corners[at->second].sharpness;
        sharpness = std::max(sharpness, c.sharpness);
    }
    mesh.corners = std::move(corners);
    for (auto& [a, b] : mesh.slits) std::tie(a, b) = ordered_edge(to[a], to[b]);
    std::sort(mesh.slits.begin(), mesh.slits.end());
    out.mesh = std::move(mesh);
    return out;
}

std::vector<std::string> in_words(VertexJoin const& join, double distance)
{
    std::vector<std::string> out;
    if (join.joined == 0) return out;
    std::string const first = "vertex " + std::to_string(join.first + 1);
    std::string const into = "vertex " + std::to_string(join.into + 1);
    out.push_back(join.joined == 1
                      ? first + " is joined with " + into + ", within " + number(distance)
                      : std::to_string(join.joined) + " vertices are joined with others within " +
                            number(distance) + "; the first is " + first + ", with " + into);
    if (join.collapsed) {
        std::string const face = "face " + std::to_string(join.first_collapsed + 1);
        out.push_back(join.collapsed == 1
                          ? face + " has fewer vertices by that"
                          : std::to_string(join.collapsed) +
                                " faces have fewer vertices by that; the first is " + face);
    }
    return out;
}

Seams find_seams(Topology const& topology, double within)
{
    ControlMesh const& mesh = topology.mesh();
    struct Edge {
        std::uint32_t ends[2]; ///< in the order of their clusters
        std::pair<std::uint32_t, std::uint32_t> clusters, in_file;
    };
    std::vector<Edge> edges;
    std::vector<std::uint32_t> number_of(mesh.positions.size(), Topology::kNone), vertices;
    auto const add = [&](std::uint32_t v) {
        if (number_of[v] != Topology::kNone) return;
        number_of[v] = std::uint32_t(vertices.size());
        vertices.push_back(v);
    };
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        if (topology.twin(h) != Topology::kNone) continue;
        std::uint32_t const a = topology.vertex_of(h), b = topology.vertex_of(topology.next(h));
        add(a), add(b);
        edges.push_back({{a, b}, {}, ordered_edge(mesh.file_vertex(a), mesh.file_vertex(b))});
    }
    std::vector<glm::dvec3> points;
    for (std::uint32_t v : vertices) points.emplace_back(mesh.positions[v]);
    Clusters clusters(std::move(points), within);
    for (Edge& e : edges) {
        std::uint32_t a = clusters.lowest(number_of[e.ends[0]]),
                      b = clusters.lowest(number_of[e.ends[1]]);
        if (a > b) std::swap(a, b), std::swap(e.ends[0], e.ends[1]);
        e.clusters = {a, b};
    }
    std::sort(edges.begin(), edges.end(), [](Edge const& x, Edge const& y) {
        return std::pair(x.clusters, x.in_file) < std::pair(y.clusters, y.in_file);
    });
    Seams out;
    for (std::span<Edge const> rest(edges); !rest.empty();) {
        Edge const& first = rest[0];
        auto const other = std::find_if(
            rest.begin(), rest.end(), [&](Edge const& e) { return e.clusters != first.clusters; });
        auto const group = rest.first(std::size_t(other - rest.begin()));
        rest = rest.subspan(group.size());
        bool const point = first.clusters.first == first.clusters.second;
        // Both sides of a cut are one edge of the file.
        if (point || first.in_file == group.back().in_file) continue;
        out.edges += group.size();
        for (Edge const& e : group)
            for (int side : {0, 1})
                out.apart =
                    std::max(out.apart, glm::length(glm::dvec3(mesh.positions[e.ends[side]]) -
                                                    glm::dvec3(mesh.positions[first.ends[side]])));
    }
    out.apart *= 1 + 0x1p-50; // a root is rounded, and its square must reach as far
    return out;
}

Seams find_seams(Topology const& topology)
{
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (auto const& p : topology.mesh().positions)
        low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
    return find_seams(topology, 1e-6 * glm::length(high - low));
}

} // namespace tessemu
