// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/local_tables.h"

namespace tessemu::detail {

template <class X> TablePiece<X> first_piece(LocalMesh const& type, TableGrid const& grid)
{
    TablePiece<X> out;
    out.mesh = type.mesh();
    for (std::uint16_t point : type.point_of) {
        X unit(0.0, type.points);
        unit[point] = 1;
        out.points.push_back(std::move(unit));
    }
    out.places.resize(out.points.size());
    for (int k = 0; k < type.sides(); ++k) {
        auto const [i, j] = grid.corner(k);
        out.places[std::size_t(k)] = {i, j};
    }
    out.is_of_patch.assign(out.mesh.faces(), 0);
    out.is_of_patch[0] = 1;
    return out;
}

template <class X>
TablePiece<X> kept_piece(TablePiece<X> const& coarse, Topology const& t, ControlMesh fine,
                         std::vector<X> points, bool keeps_triangles, int rings)
{
    ControlMesh const& mesh = t.mesh();
    PointNumbers const number(t, keeps_triangles);
    std::vector<TablePlaceOnGrid> places(points.size());
    std::vector<char> is_of_patch;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        std::size_t const sides = mesh.face(f).size();
        is_of_patch.insert(is_of_patch.end(), keeps_triangles && sides == 3 ? 4 : sides,
                           coarse.is_of_patch[f]);
        if (!coarse.is_of_patch[f]) continue;
        TablePlaceOnGrid sum{0, 0};
        for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h) {
            TablePlaceOnGrid const a = coarse.places[t.vertex_of(h)],
                                   b = coarse.places[t.vertex_of(t.next(h))];
            places[number.vertex(t.vertex_of(h))] = a;
            places[number.edge(h)] = {(a.i + b.i) / 2, (a.j + b.j) / 2};
            sum.i += a.i, sum.j += a.j;
        }
        if (!keeps_triangles || sides != 3)
            places[number.face(f)] = {sum.i / int(sides), sum.j / int(sides)};
    }
    std::vector<char> is_near(points.size(), 0);
    for (std::size_t v = 0; v < points.size(); ++v) is_near[v] = places[v].is_on_patch();
    std::vector<std::uint32_t> kept;
    for (int ring = 0; ring < rings; ++ring) {
        kept.clear();
        for (std::uint32_t f = 0; f < fine.faces(); ++f) {
            auto const face = fine.face(f);
            if (std::any_of(face.begin(), face.end(), [&](auto v) { return is_near[v] != 0; }))
                kept.push_back(f);
        }
        for (std::uint32_t f : kept)
            for (std::uint32_t v : fine.face(f)) is_near[v] = 1;
    }
    Topology const all(fine);
    SubMesh const sub = SubMeshes(all).of(kept, [](HalfEdge) { return false; });
    TablePiece<X> out;
    out.mesh.rules = fine.rules;
    std::size_t at = 0;
    for (std::uint32_t f : kept) {
        std::size_t const sides = fine.face(f).size();
        out.mesh.add_face(std::span(sub.face_vertices).subspan(at, sides));
        out.is_of_patch.push_back(is_of_patch[f]);
        at += sides;
    }
    // A tag is where the patch is, whose vertices are of one fan each.
    std::vector<std::vector<std::uint32_t>> copies(points.size());
    for (std::uint32_t v = 0; v < sub.vertices.size(); ++v) {
        std::uint32_t const of = sub.vertices[v];
        copies[of].push_back(v);
        out.points.push_back(points[of]);
        out.places.push_back(copies[of].size() == 1 ? places[of] : TablePlaceOnGrid{});
    }
    out.mesh.positions.resize(out.points.size());
    for (ControlMesh::Crease const& c : fine.creases)
        for (std::uint32_t a : copies[c.a])
            for (std::uint32_t b : copies[c.b]) out.mesh.creases.push_back({a, b, c.sharpness});
    for (ControlMesh::Corner const& c : fine.corners)
        for (std::uint32_t v : copies[c.vertex]) out.mesh.corners.push_back({v, c.sharpness});
    return out;
}

#define TESSEMU_TABLE_PIECES(X)                                                                    \
    template TablePiece<X> first_piece(LocalMesh const&, TableGrid const&);                        \
    template TablePiece<X> kept_piece(TablePiece<X> const&, Topology const&, ControlMesh,          \
                                      std::vector<X>, bool, int);
TESSEMU_TABLE_PIECES(RingWeights)
TESSEMU_TABLE_PIECES(SingleRow)

} // namespace tessemu::detail
