// Basis-function tables of any scheme (HOLL10 2A): the local mesh of a patch, each control point of
// it the unit vector of its own axis, refined by the scheme's masks down to the grid, and taken to
// the limit there. After each step only faces that touch the patch are kept.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/local_mesh.h"
#include "pipeline/basis_tables/table_grid.h"
#include "pipeline/mesh/refined_step.h"

namespace tessemu {

/// Weights of a patch's control points.
struct LocalTables {
    int points = 0; ///< control points, those of LocalMesh
    TableGrid grid;
    /// [control point * samples + sample]; sums over the control points are 1, 0, 0.
    ///
    /// The tangents are two directions whose cross product points outwards, of any length: on the
    /// patch's sides the first runs along them, from corner k to k + 1. On an infinitely sharp edge
    /// they are those of the patch's side. At the patch's corners each patch has others. Empty where
    /// the masks have no tangents (WideMasks).
    std::vector<double> position, tangents[2];
};

/// Weights in single precision, as a generator makes them that has no other: sums are rounded one
/// by one, in the order in which a patch's own local mesh has them.
class SingleRow {
public:
    SingleRow() = default;
    SingleRow(double value, std::size_t size) : weights_(float(value), size) {}

    float operator[](std::size_t i) const { return weights_[i]; }
    float& operator[](std::size_t i) { return weights_[i]; }

    SingleRow& operator+=(SingleRow const& o) { return weights_ += o.weights_, *this; }
    SingleRow& operator-=(SingleRow const& o) { return weights_ -= o.weights_, *this; }
    SingleRow& operator*=(double s) { return weights_ *= float(s), *this; }
    SingleRow& operator/=(double s) { return weights_ /= float(s), *this; }
    friend SingleRow operator+(SingleRow a, SingleRow const& b) { return a += b; }
    friend SingleRow operator-(SingleRow a, SingleRow const& b) { return a -= b; }
    friend SingleRow operator*(SingleRow a, double s) { return a *= s; }
    friend SingleRow operator*(double s, SingleRow a) { return a *= s; }
    friend SingleRow operator/(SingleRow a, double s) { return a /= s; }

private:
    std::valarray<float> weights_;
};

namespace detail {

/// Of a vertex in the grid's samples, where it is one of the patch.
struct TablePlaceOnGrid {
    int i = -1, j = -1;
    bool is_on_patch() const { return i >= 0; }
};
/// Faces around a patch with the points that steps have made of control points.
template <class X> struct TablePiece {
    ControlMesh mesh;
    std::vector<X> points;                // by vertex
    std::vector<TablePlaceOnGrid> places; // by vertex
    std::vector<char> is_of_patch;        // by face
};

template <class X> TablePiece<X> first_piece(LocalMesh const& type, TableGrid const& grid);
/// Faces of a step's mesh that touch the patch, and `rings - 1` more of them around.
///
/// \param points  of the step's vertices
template <class X>
TablePiece<X> kept_piece(TablePiece<X> const& coarse, Topology const& topology, ControlMesh fine,
                         std::vector<X> points, bool keeps_triangles, int rings);

template <class Masks, class X>
void take_limit_positions(TablePiece<X> const& piece, LocalTables& out)
{
    Topology const t(piece.mesh);
    auto const samples = std::size_t(out.grid.samples());
    out.position.resize(samples * std::size_t(out.points));
    for (std::uint32_t v = 0; v < piece.points.size(); ++v) {
        if (!piece.places[v].is_on_patch()) continue;
        X const limit = Masks::limit_point(t, v, std::span<X const>(piece.points));
        auto const at = std::size_t(out.grid.index(piece.places[v].i, piece.places[v].j));
        for (std::size_t k = 0; k < std::size_t(out.points); ++k)
            out.position[k * samples + at] = limit[k];
    }
}

template <class Masks, class X> void take_limits(TablePiece<X> const& piece, LocalTables& out)
{
    Topology const t(piece.mesh);
    Sharpness const sharpness(t);
    Limits<Masks> limits;
    auto const samples = std::size_t(out.grid.samples()), all = samples * std::size_t(out.points);
    out.position.resize(all);
    for (auto& tangents : out.tangents) tangents.resize(all);
    for (std::uint32_t v = 0; v < piece.points.size(); ++v) {
        if (!piece.places[v].is_on_patch()) continue;
        // The ring from an edge of the patch on: inside it any, on a side the one along it.
        auto const faces = t.ring(v);
        std::size_t const n = faces.size();
        std::size_t first = 0;
        while (!piece.is_of_patch[t.face_of(faces[first])]) ++first;
        while (!t.is_boundary(v) && piece.is_of_patch[t.face_of(faces[(first + n - 1) % n])]) {
            first = (first + n - 1) % n;
            if (first == 0) break; // inside
        }
        RingSharpness sharp;
        sharpness.around(v, sharp);
        Ring<X> ring{piece.points[v], {}, {}};
        auto const end = [&](HalfEdge h) { return piece.points[t.vertex_of(h)]; };
        for (HalfEdge h : faces) {
            ring.edge.push_back(end(t.next(h)));
            if constexpr (!Masks::kKeepsTriangles) ring.face.push_back(end(t.next(t.next(h))));
        }
        if (t.is_boundary(v)) {
            ring.edge.push_back(end(t.previous(faces.back())));
        } else {
            auto const turn = [&](auto& list) {
                if (!list.empty())
                    std::rotate(list.begin(), list.begin() + std::ptrdiff_t(first), list.end());
            };
            turn(ring.edge), turn(ring.face), turn(sharp.edge), turn(sharp.far_end);
            first = 0;
        }
        VertexLimit<X> const limit = limits.of(ring, sharp);
        auto side = limit.sides.begin();
        while ((first + n - side->first_face % n) % n >= side->faces) ++side;
        auto const at = std::size_t(out.grid.index(piece.places[v].i, piece.places[v].j));
        for (std::size_t k = 0; k < std::size_t(out.points); ++k) {
            out.position[k * samples + at] = limit.position[k];
            for (std::size_t i = 0; i < 2; ++i)
                out.tangents[i][k * samples + at] = side->tangents[i][k];
        }
    }
}

} // namespace detail

/// \tparam X     RingWeights, or SingleRow
/// \param steps  down to the grid, of 2^steps segments
/// \cost  time of order of the samples times the control points: some milliseconds
template <class Masks, class X = RingWeights>
LocalTables make_local_tables(LocalMesh const& type, int steps)
{
    LocalTables out{type.points, {type.sides(), 1 << steps}, {}, {}};
    detail::TablePiece<X> piece = detail::first_piece<X>(type, out.grid);
    int const rings =
        std::max(rings_of<Masks>(), type.crease_method == CreaseMethod::Chaikin ? 2 : 1);
    for (int s = 0; s < steps; ++s) {
        Topology const topology(piece.mesh);
        Sharpness const sharpness(topology);
        auto points = refined_points<Masks, X>(topology, sharpness, piece.points);
        ControlMesh fine = split_mesh(topology, sharpness, std::vector<glm::dvec3>(points.size()),
                                      Masks::kKeepsTriangles);
        piece = detail::kept_piece(piece, topology, std::move(fine), std::move(points),
                                   Masks::kKeepsTriangles, rings);
    }
    if constexpr (WideMasks<Masks>)
        detail::take_limit_positions<Masks>(piece, out);
    else
        detail::take_limits<Masks>(piece, out);
    return out;
}

} // namespace tessemu
