// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/poles.h"

#include "pipeline/mesh/limit_constants.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numeric>

namespace tessemu {

namespace {

using Vec = glm::dvec3;

// cos(pi j / n) and sin(pi j / n) for j = 0 to 2n, of each n that was asked for.
class Circles {
public:
    struct Angle {
        double cosine, sine;
    };
    std::vector<Angle> const& of(int n)
    {
        std::vector<Angle>& out = angles_[n];
        if (out.empty())
            for (int j = 0; j <= 2 * n; ++j) out.push_back({cos_pi(j, n), sin_pi(j, n)});
        return out;
    }

private:
    std::map<int, std::vector<Angle>> angles_;
};

// A vertex's ring relative to it.
struct Ring {
    std::vector<Vec> d; // far ends
    std::vector<Vec> c; // the faces' middles
    double reach = 0;   // squared distance to the farthest point
    bool boundary = false;

    /// Becomes that of another vertex, in the memory that is there.
    void read(Topology const& t, std::uint32_t v)
    {
        d.clear(), c.clear();
        reach = 0;
        boundary = t.is_boundary(v);
        ControlMesh const& mesh = t.mesh();
        Vec const origin(mesh.positions[v]);
        for (HalfEdge h : t.ring(v)) {
            Vec sum(0);
            auto const face = mesh.face(t.face_of(h));
            for (std::uint32_t i : face) {
                Vec const x = Vec(mesh.positions[i]) - origin;
                reach = std::max(reach, dot(x, x));
                sum += x;
            }
            c.push_back(sum / double(face.size()));
            d.push_back(Vec(mesh.positions[t.vertex_of(t.next(h))]) - origin);
        }
        if (boundary)
            d.push_back(Vec(mesh.positions[t.vertex_of(t.previous(t.ring(v).back()))]) - origin);
    }
};

// The cross product of the limit tangents.
Vec limit_normal(Ring const& ring, Circles& circles)
{
    int const n = int(ring.c.size());
    if (!ring.boundary) {
        auto const& angle = circles.of(n); // of pi / n
        double const sigma = loop09_sigma(n);
        double const on_edge = (1 - sigma * angle[1].cosine) / n, on_face = 4 * sigma / n;
        Vec a(0), b(0);
        for (int j = 0; j < n; ++j) {
            auto const i = std::size_t(j);
            auto const &edge = angle[2 * i], &face = angle[2 * i + 1];
            a += on_edge * edge.cosine * ring.d[i] + on_face * face.cosine * ring.c[i];
            b += on_edge * edge.sine * ring.d[i] + on_face * face.sine * ring.c[i];
        }
        return cross(a, b);
    }
    Vec const &first = ring.d.front(), &last = ring.d.back();
    if (n == 1) return cross(first, last);
    auto const& angle = circles.of(n);
    double const co = angle[1].cosine, s = angle[1].sine, scale = 1 / (n * (3 + co));
    Vec across = -(1 + 2 * co) * ((1 + co) / s) * scale * (first + last);
    for (std::size_t j = 0; j < std::size_t(n); ++j) {
        Vec const x = 4.0 * ring.c[j] - ring.d[j] - ring.d[j + 1];
        across +=
            4 * angle[j].sine * scale * ring.d[j] + (angle[j].sine + angle[j + 1].sine) * scale * x;
    }
    return cross(0.5 * (first - last), across);
}

bool is_pole(Ring const& ring, Circles& circles)
{
    Vec const n = limit_normal(ring, circles);
    return !(dot(n, n) > 0x1p-32 * ring.reach * ring.reach);
}

} // namespace

std::vector<std::uint32_t> points_of(ControlMesh const& mesh)
{
    std::vector<std::uint32_t> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    auto const root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        for (std::size_t i = 0; i < face.size(); ++i) {
            std::uint32_t const a = face[i], b = face[(i + 1) % face.size()];
            if (mesh.positions[a] != mesh.positions[b]) continue;
            std::uint32_t const r = root(a), s = root(b);
            parent[std::max(r, s)] = std::min(r, s);
        }
    }
    for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
    return parent;
}

namespace {

// Of a pole's faces, each once, in their order.
void add_pole(Poles& out, ControlMesh const& mesh, std::vector<std::uint32_t> around)
{
    out.first.push_back(std::uint32_t(out.faces.size()));
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    for (std::uint32_t f : around) {
        auto const face = mesh.face(f);
        out.faces.push_back({face[0], face[1], face[2], face[face.size() == 4 ? 3 : 0]});
    }
}

} // namespace

Poles vertices_as_poles(ControlMesh const& mesh)
{
    std::vector<std::uint32_t> const point = points_of(mesh);
    std::vector<std::vector<std::uint32_t>> faces(mesh.positions.size());
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
        for (std::uint32_t v : mesh.face(f)) faces[point[v]].push_back(f);
    Poles out;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        out.of_vertex.push_back(v);
        add_pole(out, mesh, faces[point[v]]);
    }
    out.first.push_back(std::uint32_t(out.faces.size()));
    return out;
}

Poles find_poles(Topology const& t)
{
    ControlMesh const& mesh = t.mesh();
    Circles circles;
    std::vector<std::uint32_t> poles;
    Ring ring;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (t.ring(v).empty()) continue;
        ring.read(t, v);
        if (is_pole(ring, circles)) poles.push_back(v);
    }
    Poles out;
    if (poles.empty()) return out;

    std::vector<std::uint32_t> const point = points_of(mesh);
    std::vector<std::uint32_t> pole_of_point(mesh.positions.size(), Poles::kNone);
    std::vector<std::vector<std::uint32_t>> faces;
    out.of_vertex.assign(mesh.positions.size(), Poles::kNone);
    for (std::uint32_t v : poles) {
        std::uint32_t& pole = pole_of_point[point[v]];
        if (pole == Poles::kNone) pole = std::uint32_t(faces.size()), faces.emplace_back();
        out.of_vertex[v] = pole;
        for (HalfEdge h : t.ring(v)) faces[pole].push_back(t.face_of(h));
    }
    for (std::vector<std::uint32_t>& around : faces) add_pole(out, mesh, std::move(around));
    out.first.push_back(std::uint32_t(out.faces.size()));
    return out;
}

} // namespace tessemu
