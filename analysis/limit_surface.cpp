// SPDX-License-Identifier: Apache-2.0
#include "analysis/limit_surface.h"

#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/limit.h"
#include "pipeline/mesh/poles.h"

#include <glm/geometric.hpp>

#include <memory>
#include <optional>

namespace tessemu {

namespace {

using Vec = glm::dvec3;

Vec unit_or_zero(Vec const& n)
{
    double const length = glm::length(n);
    return length > 0 ? n / length : Vec(0);
}

// The vertices around a vertex of a mesh of quads.
Ring<Vec> ring_of(Topology const& t, std::vector<Vec> const& x, std::uint32_t v)
{
    auto const faces = t.ring(v);
    Ring<Vec> out{x[v], {}, {}};
    for (HalfEdge h : faces) {
        out.edge.push_back(x[t.vertex_of(t.next(h))]);
        out.face.push_back(x[t.vertex_of(t.next(t.next(h)))]);
    }
    if (t.is_boundary(v)) out.edge.push_back(x[t.vertex_of(t.previous(faces.back()))]);
    return out;
}

// The same after another step, from its new points.
Ring<Vec> ring_after_step(Topology const& t, EdgeNumbers const& edges, std::vector<Vec> const& next,
                          std::uint32_t v)
{
    auto const faces = t.ring(v);
    std::size_t const first_edge = t.mesh().faces(), first_vertex = first_edge + edges.size();
    Ring<Vec> out{next[first_vertex + v], {}, {}};
    for (HalfEdge h : faces) {
        out.edge.push_back(next[first_edge + edges[h]]);
        out.face.push_back(next[t.face_of(h)]);
    }
    if (t.is_boundary(v)) out.edge.push_back(next[first_edge + edges[t.previous(faces.back())]]);
    return out;
}

// Of a side of a vertex. Where the tangents are parallel, as two sharp edges in one line are, the
// faces decide; and at a corner whose faces turn by more than half a circle they say which side of
// the plane of its sharp edges is outside, unless Biermann's rules have. By those the edges of a
// face alone on its side may lie in one line too.
Vec side_normal(Ring<Vec> const& ring, RingSharpness const& sharp, VertexRule rule,
                VertexLimit<Vec>::Side const& side)
{
    auto const& [a, b] = side.tangents;
    Vec const n = cross(a, b);
    Vec faces(0);
    for (std::size_t j = side.first_face; j < side.first_face + side.faces; ++j) {
        std::size_t const f = j % ring.faces();
        faces += sharp.biermann
                     ? cross(ring.face[f] - ring.vertex, ring.edge_after(f) - ring.edge[f])
                     : cross(ring.edge[f] - ring.vertex, ring.edge_after(f) - ring.vertex);
    }
    if (!(dot(n, n) > 0x1p-32 * dot(a, a) * dot(b, b))) return unit_or_zero(faces);
    bool const turns = rule == VertexRule::Corner && !sharp.biermann && dot(n, faces) < 0;
    return unit_or_zero(turns ? -n : n);
}

// Poles have the mean of the faces around, as the schemes have it.
std::vector<Vec> pole_normals(Poles const& poles, std::vector<Vec> const& x)
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
    return normals;
}

} // namespace

LimitSurface::LimitSurface(Topology const& topology, int level, std::span<Vec const> positions)
    : level_(level)
{
    if (level < 1 || level > 7)
        throw LimitError("refinement level", std::uint64_t(std::max(level, 0)), 7);
    ControlMesh const& base = topology.mesh();
    std::vector<Vec> x(base.positions.begin(), base.positions.end());
    if (!positions.empty()) x.assign(positions.begin(), positions.end());
    std::unique_ptr<ControlMesh const> mesh;
    std::unique_ptr<Topology const> fine;
    for (int l = 0; l < level; ++l) {
        Topology const& coarse = fine ? *fine : topology;
        Sharpness const sharpness(coarse);
        x = refined_points<CatmullClark, Vec>(coarse, sharpness, x);
        auto next = std::make_unique<ControlMesh const>(catmull_clark_mesh(coarse, sharpness, x));
        fine.reset(); // reads mesh
        mesh = std::move(next);
        fine = std::make_unique<Topology const>(*mesh);
    }
    add_points(*fine, x);
    std::size_t const descendants = std::size_t(1) << (2 * (level - 1));
    for (std::uint32_t start : base.face_start) first_quad_.push_back(start * descendants);
    set_grids(base);
}

void LimitSurface::add_points(Topology const& t, std::vector<Vec> const& x)
{
    ControlMesh const& mesh = t.mesh();
    Sharpness const sharpness(t);
    Poles const poles = find_poles(t);
    std::vector<Vec> const of_pole = pole_normals(poles, x);
    Limits<CatmullClark> limits;
    RingSharpness sharp;
    // By Biermann's rules a vertex depends on those around it in the next step: how they lean and
    // flatten.
    bool const biermann = mesh.rules.sectors == SectorRules::Biermann;
    std::vector<Vec> next;
    std::optional<EdgeNumbers> edges;
    if (biermann) {
        next = refined_points<CatmullClark, Vec>(t, sharpness, x);
        edges.emplace(t);
    }
    quads_.resize(mesh.faces());
    auto const set_corner = [&](HalfEdge h, std::size_t point) {
        quads_[t.face_of(h)][h - mesh.face_start[t.face_of(h)]] = std::uint32_t(point);
    };
    for (std::uint32_t v = 0; v < x.size(); ++v) {
        auto const ring = t.ring(v);
        if (ring.empty()) continue;
        if (sharpness.is_plain(v) && !biermann) { // nearly all: no ring is copied
            auto const edge = [&](std::size_t j) -> Vec const& {
                return x[t.vertex_of(t.next(ring[j]))];
            };
            auto const face = [&](std::size_t j) -> Vec const& {
                return x[t.vertex_of(t.next(t.next(ring[j])))];
            };
            auto const [p, a, b] = CatmullClark::limit(int(ring.size()), x[v], edge, face);
            for (HalfEdge h : ring) set_corner(h, position_.size());
            position_.push_back(p);
            normal_.push_back(unit_or_zero(cross(a, b)));
        } else {
            sharpness.around(v, sharp);
            if (biermann) sharp = sharp.after_step();
            Ring<Vec> const around =
                biermann ? ring_after_step(t, *edges, next, v) : ring_of(t, x, v);
            VertexLimit<Vec> const limit = limits.of(around, sharp);
            for (auto const& side : limit.sides) {
                for (std::size_t j = 0; j < side.faces; ++j)
                    set_corner(ring[(side.first_face + j) % ring.size()], position_.size());
                position_.push_back(limit.position);
                normal_.push_back(side_normal(around, sharp, limit.rule, side));
            }
        }
        std::uint32_t const pole = poles.at(v);
        if (pole != Poles::kNone && sharpness.is_untagged(v)) normal_.back() = of_pole[pole];
    }
}

void LimitSurface::set_grids(ControlMesh const& base)
{
    // A quad's children are the quads of its corners, in order: the digits of a descendant's number
    // in base 4 say where it lies.
    grid_start_.assign(base.faces(), kNone);
    auto const n = std::size_t(grid() + 1);
    std::size_t const descendants = std::size_t(1) << (2 * (level_ - 1));
    for (std::uint32_t f = 0; f < base.faces(); ++f) {
        if (base.face(f).size() != 4) continue;
        grid_start_[f] = grid_.size();
        grid_.resize(grid_.size() + n * n);
        for (std::size_t d = 0; d < 4 * descendants; ++d) {
            std::array<std::array<int, 2>, 4> c{
                {{0, 0}, {grid(), 0}, {grid(), grid()}, {0, grid()}}};
            for (int l = level_ - 1; l >= 0; --l) {
                std::size_t const i = d >> (2 * l) & 3, after = (i + 1) % 4, before = (i + 3) % 4;
                auto const middle = [&](std::size_t a, std::size_t b) {
                    return std::array{(c[a][0] + c[b][0]) / 2, (c[a][1] + c[b][1]) / 2};
                };
                c = {c[i], middle(i, after), middle(i, (i + 2) % 4), middle(before, i)};
            }
            Quad const& quad = quads_[first_quad_[f] + d];
            for (std::size_t k = 0; k < 4; ++k)
                grid_[grid_start_[f] + std::size_t(c[k][1]) * n + std::size_t(c[k][0])] = quad[k];
        }
    }
}

} // namespace tessemu
