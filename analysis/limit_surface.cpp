// SPDX-License-Identifier: Apache-2.0
#include "analysis/limit_surface.h"

#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/limit_constants.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <memory>

namespace tessemu {

namespace {

using Vec = glm::dvec3;

// Limit position and normal direction of a vertex whose faces are quads.
std::pair<Vec, Vec> limit(Topology const& t, std::vector<Vec> const& x, std::uint32_t v)
{
    auto const ring = t.ring(v);
    int const n = int(ring.size());
    auto const edge = [&](int j) { return x[t.vertex_of(t.next(ring[std::size_t(j)]))]; };
    auto const diagonal = [&](int j) {
        return x[t.vertex_of(t.next(t.next(ring[std::size_t(j)])))];
    };
    if (t.is_boundary(v)) {
        Vec const first = edge(0), last = x[t.vertex_of(t.previous(ring.back()))];
        bool const fixed = n == 1 && !t.mesh().smooth_corners();
        Vec const p = fixed ? x[v] : (first + 4.0 * x[v] + last) / 6.0;
        if (n == 1) return {p, cross(first - x[v], last - x[v])};
        double const co = cos_pi(1, n), s = sin_pi(1, n);
        Vec b = -4 * s * x[v] - (1 + 2 * co) * ((1 + co) / s) * (first + last);
        for (int j = 1; j < n; ++j) b += 4 * sin_pi(j, n) * edge(j);
        for (int j = 0; j < n; ++j) b += (sin_pi(j, n) + sin_pi(j + 1, n)) * diagonal(j);
        return {p, cross(first - last, b)};
    }
    double const k = n, sigma = loop09_sigma(n);
    double const on_edge = 1 + sigma * cos_pi(1, n), on_face = sigma;
    Vec p = k * k * x[v], A(0), B(0);
    for (int j = 0; j < n; ++j) {
        Vec const d = edge(j), q = diagonal(j);
        p += 4.0 * d + q;
        A += on_edge * cos_pi(2 * j, n) * d + on_face * cos_pi(2 * j + 1, n) * q;
        B += on_edge * sin_pi(2 * j, n) * d + on_face * sin_pi(2 * j + 1, n) * q;
    }
    return {p / (k * (k + 5)), cross(A, B)};
}

} // namespace

LimitSurface::LimitSurface(Topology const& topology, int level) : level_(level)
{
    if (level < 1 || level > 7)
        throw LimitError("refinement level", std::uint64_t(std::max(level, 0)), 7);
    ControlMesh const& base = topology.mesh();
    std::vector<Vec> x(base.positions.begin(), base.positions.end());
    Topology const* at = &topology;
    std::unique_ptr<Topology> own;
    for (int l = 0; l < level; ++l) {
        std::vector<Vec> finer = catmull_clark_points(*at, x);
        ControlMesh next = catmull_clark_step(*at);
        next.creases.clear();
        next.corners.clear();
        own.reset(); // reads mesh_
        mesh_ = std::move(next);
        x = std::move(finer);
        own = std::make_unique<Topology>(mesh_);
        at = own.get();
    }
    position_.resize(x.size());
    normal_.resize(x.size());
    for (std::uint32_t v = 0; v < x.size(); ++v) {
        if (at->ring(v).empty()) continue;
        auto const [p, n] = limit(*at, x, v);
        double const length = glm::length(n);
        position_[v] = p;
        normal_[v] = length > 0 ? n / length : Vec(0);
    }
    set_pole_normals(find_poles(*at), x);

    // A quad's children are the quads of its corners, in order: the digits of a descendant's number
    // in base 4 say where it lies.
    grid_start_.assign(base.faces(), kNone);
    auto const n = std::size_t(grid() + 1);
    std::size_t const descendants = std::size_t(1) << (2 * (level - 1));
    for (std::uint32_t start : base.face_start) first_quad_.push_back(start * descendants);
    for (std::uint32_t f = 0; f < base.faces(); ++f) {
        if (base.face(f).size() != 4) continue;
        grid_start_[f] = grid_.size();
        grid_.resize(grid_.size() + n * n);
        for (std::size_t d = 0; d < 4 * descendants; ++d) {
            std::array<std::array<int, 2>, 4> c{
                {{0, 0}, {grid(), 0}, {grid(), grid()}, {0, grid()}}};
            for (int l = level - 1; l >= 0; --l) {
                std::size_t const i = d >> (2 * l) & 3, after = (i + 1) % 4, before = (i + 3) % 4;
                auto const middle = [&](std::size_t a, std::size_t b) {
                    return std::array{(c[a][0] + c[b][0]) / 2, (c[a][1] + c[b][1]) / 2};
                };
                c = {c[i], middle(i, after), middle(i, (i + 2) % 4), middle(before, i)};
            }
            auto const quad = mesh_.face(first_quad_[f] + d);
            for (std::size_t k = 0; k < 4; ++k)
                grid_[grid_start_[f] + std::size_t(c[k][1]) * n + std::size_t(c[k][0])] = quad[k];
        }
    }
}

// As the schemes have them: the mean of the faces around.
void LimitSurface::set_pole_normals(Poles const& poles, std::vector<glm::dvec3> const& x)
{
    std::vector<Vec> normals;
    for (std::size_t k = 0; k < poles.size(); ++k) {
        Vec area(0);
        for (std::uint32_t f = poles.first[k]; f < poles.first[k + 1]; ++f) {
            auto const& v = poles.faces[f];
            area += cross(x[v[2]] - x[v[0]], x[v[3]] - x[v[1]]);
        }
        double const length = glm::length(area);
        normals.push_back(length > 0 ? area / length : Vec(0, 0, 1));
    }
    for (std::uint32_t v = 0; v < poles.of_vertex.size(); ++v)
        if (std::uint32_t const pole = poles.at(v); pole != Poles::kNone)
            normal_[v] = normals[pole];
}

} // namespace tessemu
