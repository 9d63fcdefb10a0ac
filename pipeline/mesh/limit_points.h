// The limit surface at the vertices of a mesh, by any scheme's masks, with a normal on each side of
// what is sharp (docs/compare.md says which, tag by tag).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/limit.h"
#include "pipeline/mesh/poles.h"
#include "pipeline/mesh/subdivision.h"

#include <glm/geometric.hpp>

#include <optional>

namespace tessemu {

/// A vertex on infinitely sharp edges is a point for each side, one after the other: the same
/// position, its own normal.
struct LimitPoints {
    std::vector<glm::dvec3> position;
    /// Of unit length. Where a side of a vertex has no tangent plane (a pole, a sharp corner whose
    /// edges lie in one line) the mean of the faces around.
    std::vector<glm::dvec3> normal;
    std::vector<std::uint32_t> of_corner; ///< by half-edge: the point of its vertex on its side
};

/// A scheme's rules in double, as far as its limit surface asks for them.
struct LimitRules {
    /// As refined_points().
    std::vector<glm::dvec3> (*refined)(Topology const&, Sharpness const&,
                                       std::span<glm::dvec3 const>);
    /// Of a mesh that a step has made: of quads, or of triangles where the step keeps them.
    LimitPoints (*limits)(Topology const&, std::span<glm::dvec3 const>);
    bool
        knows_tags; ///< creases and corners; otherwise they are drawn smooth from the first step on
};

/// Of a side of a vertex. Where the tangents are parallel, as two sharp edges in one line are, the
/// faces decide; and at a corner whose faces turn by more than half a circle they say which side of
/// the plane of its sharp edges is outside, unless Biermann's rules have. By those the edges of a
/// face alone on its side may lie in one line too.
glm::dvec3 side_normal(Ring<glm::dvec3> const& ring, RingSharpness const& sharp, VertexRule rule,
                       VertexLimit<glm::dvec3>::Side const& side);
/// By pole: the mean of the faces around, as the schemes have it.
std::vector<glm::dvec3> pole_normals(Poles const& poles, std::span<glm::dvec3 const> x);
glm::dvec3 unit_or_zero(glm::dvec3 const& v);

/// The vertices around a vertex of a mesh of quads, or of triangles that the masks keep.
template <class Masks>
Ring<glm::dvec3> ring_of(Topology const& t, std::span<glm::dvec3 const> x, std::uint32_t v)
{
    auto const faces = t.ring(v);
    Ring<glm::dvec3> out{x[v], {}, {}};
    for (HalfEdge h : faces) {
        out.edge.push_back(x[t.vertex_of(t.next(h))]);
        if constexpr (!Masks::kKeepsTriangles)
            out.face.push_back(x[t.vertex_of(t.next(t.next(h)))]);
    }
    if (t.is_boundary(v)) out.edge.push_back(x[t.vertex_of(t.previous(faces.back()))]);
    return out;
}

/// The same after another step, from its new points.
template <class Masks>
Ring<glm::dvec3> ring_after_step(Topology const& t, PointNumbers const& number,
                                 std::span<glm::dvec3 const> next, std::uint32_t v)
{
    auto const faces = t.ring(v);
    Ring<glm::dvec3> out{next[number.vertex(v)], {}, {}};
    for (HalfEdge h : faces) {
        out.edge.push_back(next[number.edge(h)]);
        if constexpr (!Masks::kKeepsTriangles) out.face.push_back(next[number.face(t.face_of(h))]);
    }
    if (t.is_boundary(v)) out.edge.push_back(next[number.edge(t.previous(faces.back()))]);
    return out;
}

/// As LimitRules::limits. Throws Error by Biermann's rules where the masks do not know them.
/// \cost  linear in the faces
template <class Masks>
requires(!WideMasks<Masks>) LimitPoints
    limit_points(Topology const& t, std::span<glm::dvec3 const> x)
{
    using Vec = glm::dvec3;
    Sharpness const sharpness(t);
    Poles const poles = find_poles(t);
    std::vector<Vec> const of_pole = pole_normals(poles, x);
    Limits<Masks> limits;
    RingSharpness sharp;
    // By Biermann's rules a vertex depends on those around it in the next step: how they lean and
    // flatten.
    bool const biermann = t.mesh().rules.sectors == SectorRules::Biermann;
    if (biermann && !Masks::kSectorRules)
        throw Error("these masks have no limits by Biermann's rules");
    std::vector<Vec> next;
    std::optional<PointNumbers> number;
    if (biermann) {
        next = refined_points<Masks, Vec>(t, sharpness, x);
        number.emplace(t, Masks::kKeepsTriangles);
    }
    LimitPoints out;
    out.of_corner.resize(t.mesh().face_vertices.size());
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
            auto const [p, a, b] = Masks::limit(int(ring.size()), x[v], edge, face);
            for (HalfEdge h : ring) out.of_corner[h] = std::uint32_t(out.position.size());
            out.position.push_back(p);
            out.normal.push_back(unit_or_zero(cross(a, b)));
        } else {
            sharpness.around(v, sharp);
            if (biermann) sharp = sharp.after_step();
            Ring<Vec> const around =
                biermann ? ring_after_step<Masks>(t, *number, next, v) : ring_of<Masks>(t, x, v);
            VertexLimit<Vec> const limit = limits.of(around, sharp);
            for (auto const& side : limit.sides) {
                for (std::size_t j = 0; j < side.faces; ++j)
                    out.of_corner[ring[(side.first_face + j) % ring.size()]] =
                        std::uint32_t(out.position.size());
                out.position.push_back(limit.position);
                out.normal.push_back(side_normal(around, sharp, limit.rule, side));
            }
        }
        std::uint32_t const pole = poles.at(v);
        if (pole != Poles::kNone && sharpness.is_untagged(v)) out.normal.back() = of_pole[pole];
    }
    return out;
}

/// The same without tangents: normals are the mean of the faces' around, each by its area.
template <class Masks>
requires WideMasks<Masks> LimitPoints limit_points(Topology const& t, std::span<glm::dvec3 const> x)
{
    LimitPoints out;
    std::vector<std::uint32_t> number(x.size());
    for (std::uint32_t v = 0; v < x.size(); ++v) {
        if (t.ring(v).empty()) continue;
        number[v] = std::uint32_t(out.position.size());
        out.position.push_back(Masks::limit_point(t, v, x));
    }
    for (std::uint32_t v : t.mesh().face_vertices) out.of_corner.push_back(number[v]);
    out.normal.assign(out.position.size(), glm::dvec3(0));
    auto const at = [&](HalfEdge h) { return out.position[out.of_corner[h]]; };
    for (HalfEdge h = 0; h < out.of_corner.size(); ++h)
        out.normal[out.of_corner[h]] += cross(at(t.next(h)) - at(h), at(t.previous(h)) - at(h));
    for (glm::dvec3& n : out.normal) n = unit_or_zero(n);
    return out;
}

template <class Masks>
inline constexpr LimitRules limit_rules{refined_points<Masks, glm::dvec3>, limit_points<Masks>,
                                        !WideMasks<Masks>};

} // namespace tessemu
