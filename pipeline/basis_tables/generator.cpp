// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/generator.h"

#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/limit.h"

#include <algorithm>
#include <cassert>

namespace tessemu {

namespace {

using X = RingWeights;

// In cells of the grid of the last step.
struct Place {
    int i = -1, j = -1;
    bool on_patch() const { return i >= 0; }
};

// A piece of a mesh around the patch. What its boundary cuts off has no influence on the patch.
struct Piece {
    ControlMesh mesh;
    std::vector<X> points;      // by vertex
    std::vector<Place> places;  // by vertex
    std::vector<char> is_cut;   // by vertex: its ring is not whole
    std::vector<char> of_patch; // by face
    std::uint32_t corner = 0;   // V
};

class PieceBuilder {
public:
    // Vertices are the control points in their order, those of beyond_points(), then others that
    // carry tags alone.
    PieceBuilder(PatchType const& type, int cells)
        : type_(type),
          ring_(type.corner),
          n_(type.corner.faces),
          j_(type.corner.position),
          x20_(std::uint32_t(type.ring_points())),
          vertices_(std::uint32_t(type.points()))
    {
        ControlMesh& mesh = out_.mesh;
        mesh.rules.crease_method = type.crease_method;
        mesh.rules.sectors = type.sectors;
        mesh.rules.flatness = type.flatness;
        // No vertex is sharp because one face of it is in the piece.
        mesh.rules.boundary = BoundaryRule::EdgeOnly;
        add_corner();
        for (int v = 0; v < 3; ++v)
            if (type.beyond[std::size_t(v)]) add_beyond(v, *type.beyond[std::size_t(v)]);
        std::uint32_t const with_weights = vertices_;
        if (type.crease_method == CreaseMethod::Chaikin) add_ends();
        mesh.positions.resize(vertices_);
        std::sort(mesh.concave.begin(), mesh.concave.end());
        for (std::uint32_t v = 0; v < vertices_; ++v) {
            X unit(0.0, with_weights);
            if (v < with_weights) unit[v] = 1;
            out_.points.push_back(std::move(unit));
        }
        out_.places.resize(vertices_);
        out_.places[0] = {0, 0};
        out_.places[e(j_)] = {cells, 0};
        out_.places[f(j_)] = {cells, cells};
        out_.places[e(j_ + 1)] = {0, cells};
        out_.is_cut.assign(vertices_, 1);
        for (std::uint32_t v : {0u, e(j_), f(j_), e(j_ + 1)}) out_.is_cut[v] = 0;
        if (type.beyond[PatchType::RightVertex]) out_.is_cut[x20()] = 0;
        if (type.beyond[PatchType::DiagonalVertex]) out_.is_cut[x22()] = 0;
        if (type.beyond[PatchType::UpperVertex]) out_.is_cut[x02()] = 0;
        out_.of_patch.assign(mesh.faces(), 0);
        out_.of_patch[j_] = 1;
    }

    Piece take() { return std::move(out_); }

private:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::uint32_t e(std::uint32_t i) const { return 1 + 2 * (ring_.closed ? i % n_ : i); }
    std::uint32_t f(std::uint32_t i) const { return 2 + 2 * (i % n_); }
    std::uint32_t x20() const { return x20_; }
    std::uint32_t x21() const { return x20_ + 1; }
    std::uint32_t x22() const { return x20_ + 2; }
    std::uint32_t x12() const { return x20_ + 3; }
    std::uint32_t x02() const { return x20_ + 4; }
    std::uint32_t lower() const { return x20_ + 5; }                    // (2,-1)
    std::uint32_t left() const { return x20_ + 5 + type_.has_lower(); } // (-1,2)

    HalfEdge add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
    {
        std::uint32_t const face[] = {a, b, c, d};
        out_.mesh.add_face(face);
        return HalfEdge(out_.mesh.face_vertices.size() - 4);
    }
    void tag(std::uint32_t a, std::uint32_t b, float sharpness)
    {
        auto const is_same = [&](ControlMesh::Crease const& c) {
            return ordered_edge(c.a, c.b) == ordered_edge(a, b);
        };
        auto& creases = out_.mesh.creases;
        if (sharpness > 0 && std::none_of(creases.begin(), creases.end(), is_same))
            creases.push_back({a, b, sharpness});
    }
    float outer(std::uint32_t i) const
    {
        std::size_t const edge = i % ring_.edge_count();
        return type_.outer.empty() ? ring_.edge(edge) : type_.outer[edge];
    }
    // half_edge[i]: of face i, at the vertex.
    template <class Edge>
    void tag_ring(VertexRing const& ring, std::uint32_t vertex, Edge const& edge,
                  std::vector<HalfEdge> const& half_edge)
    {
        if (ring.vertex > 0) out_.mesh.corners.push_back({vertex, ring.vertex});
        for (std::size_t i = 0; i < ring.edge_count(); ++i) tag(vertex, edge(i), ring.edge(i));
        for (std::uint16_t i : ring.concave) out_.mesh.concave.push_back(half_edge[i]);
    }

    void add_corner()
    {
        std::vector<HalfEdge> ring;
        for (std::uint32_t i = 0; i < n_; ++i) ring.push_back(add(0, e(i), f(i), e(i + 1)));
        right_ = add(e(j_), x20(), x21(), f(j_)) + 1;
        diagonal_ = add(f(j_), x21(), x22(), x12()) + 2;
        upper_ = add(e(j_ + 1), f(j_), x12(), x02()) + 3;
        if (type_.has_lower()) lower_ = add(f(j_ + n_ - 1), lower(), x20(), e(j_)) + 2;
        if (type_.has_left()) left_ = add(f(j_ + 1), e(j_ + 1), x02(), left()) + 2;
        tag_ring(
            ring_, 0, [&](std::size_t i) { return e(std::uint32_t(i)); }, ring);
        tag(e(j_), x20(), outer(j_));
        tag(e(j_ + 1), x02(), outer(j_ + 1));
    }

    // What is left of the ring of a vertex beyond.
    void add_beyond(int v, VertexRing const& ring)
    {
        int const n = ring.faces;
        std::vector<std::uint32_t> edges(ring.edge_count(), kNone), faces(ring.faces, kNone);
        std::vector<HalfEdge> half_edges(ring.faces, kNone);
        auto const set = [&](auto& list, int i, std::uint32_t x) {
            i += ring.position;
            if (ring.closed) i = (i + n) % n;
            if (i < 0 || std::size_t(i) >= list.size()) return;
            auto& entry = list[std::size_t(i)];
            if (entry != kNone) // closed, of two faces: its far ends are one
                std::replace(out_.mesh.face_vertices.begin(), out_.mesh.face_vertices.end(), x,
                             entry);
            else
                entry = x;
        };
        std::uint32_t center = 0;
        switch (v) {
        case PatchType::RightVertex:
            center = x20();
            set(edges, 0, x21());
            set(edges, 1, e(j_));
            set(faces, 0, f(j_)), set(half_edges, 0, right_);
            if (!type_.has_lower()) break;
            set(edges, 2, lower());
            set(faces, 1, f(j_ + n_ - 1)), set(half_edges, 1, lower_);
            break;
        case PatchType::DiagonalVertex:
            center = x22();
            set(edges, 0, x12());
            set(edges, 1, x21());
            set(faces, 0, f(j_)), set(half_edges, 0, diagonal_);
            break;
        case PatchType::UpperVertex:
            center = x02();
            set(edges, 0, e(j_ + 1));
            set(edges, 1, x12());
            set(faces, 0, f(j_)), set(half_edges, 0, upper_);
            if (!type_.has_left()) break;
            set(edges, -1, left());
            set(faces, -1, f(j_ + 1)), set(half_edges, -1, left_);
            break;
        }
        for (std::size_t i = 0; i < edges.size(); ++i) { // as beyond_points() has them
            if (edges[i] == kNone) edges[i] = vertices_++;
            if (i < faces.size() && faces[i] == kNone) faces[i] = vertices_++;
        }
        for (std::size_t i = 0; i < faces.size(); ++i)
            if (half_edges[i] == kNone)
                half_edges[i] = add(center, edges[i], faces[i], edges[(i + 1) % edges.size()]);
        tag_ring(
            ring, center, [&](std::size_t i) { return edges[i]; }, half_edges);
    }

    // The edges that go on from semi-sharp ones off the patch, for the sharpness they lend.
    void add_ends()
    {
        for (std::uint32_t i = 0; i < ring_.edge_count(); ++i) {
            if (i == j_ || i == (j_ + 1) % ring_.edge_count()) continue;
            if (ring_.edge(i) <= 0 || ring_.edge(i) >= kInfinitelySharp) continue;
            std::uint32_t const far = vertices_++;
            add(e(i), far, vertices_++, f(i));
            add(f(i + n_ - 1), vertices_++, far, e(i));
            tag(e(i), far, outer(i));
        }
    }

    PatchType const& type_;
    VertexRing const& ring_;
    std::uint32_t n_, j_, x20_, vertices_;
    // Half-edges at the vertices beyond, in the faces around the patch.
    HalfEdge right_ = 0, diagonal_ = 0, upper_ = 0, lower_ = 0, left_ = 0;
    Piece out_;
};

// The faces that touch the patch, after a step; by Chaikin's rule also those that touch the edge
// points of sharp edges that leave it.
Piece refined(Piece const& piece)
{
    Topology const topology(piece.mesh);
    Sharpness const sharpness(topology, piece.is_cut);
    std::vector<X> points = refined_points<CatmullClark, X>(topology, sharpness, piece.points);
    ControlMesh const fine =
        split_mesh(topology, sharpness, std::vector<glm::dvec3>(points.size()), false);
    std::vector<Place> places(points.size());
    std::vector<char> of_patch(fine.faces(), 0), is_kept(points.size(), 0);
    for (HalfEdge h = 0; h < fine.faces(); ++h) { // a face for each corner of the coarse ones
        if (!piece.of_patch[topology.face_of(h)]) continue;
        of_patch[h] = 1;
        auto const at = [&](HalfEdge k) { return piece.places[topology.vertex_of(k)]; };
        auto const middle = [](Place a, Place b) {
            return Place{(a.i + b.i) / 2, (a.j + b.j) / 2};
        };
        Place const a = at(h), b = at(topology.next(h)), c = at(topology.next(topology.next(h))),
                    d = at(topology.previous(h));
        Place const of_quad[] = {a, middle(a, b), middle(a, c), middle(d, a)};
        for (std::size_t i = 0; i < 4; ++i) {
            places[fine.face(h)[i]] = of_quad[i];
            is_kept[fine.face(h)[i]] = 1;
        }
    }
    std::size_t const first_vertex_point = fine.positions.size() - piece.mesh.positions.size();
    if (fine.rules.crease_method == CreaseMethod::Chaikin)
        for (ControlMesh::Crease const& c : fine.creases) {
            // One end is a vertex point, the other an edge point.
            auto const [middle, end] = ordered_edge(c.a, c.b);
            if (piece.places[end - first_vertex_point].on_patch()) is_kept[middle] = 1;
        }
    Piece out;
    out.mesh.rules = fine.rules;
    constexpr std::uint32_t kLeftOut = 0xffffffffu;
    std::vector<std::uint32_t> number(points.size(), kLeftOut), face_number(fine.faces(), kLeftOut);
    for (std::uint32_t f = 0; f < fine.faces(); ++f) {
        auto const face = fine.face(f);
        if (std::none_of(face.begin(), face.end(), [&](std::uint32_t v) { return is_kept[v]; }))
            continue;
        std::uint32_t quad[4];
        for (std::size_t i = 0; i < 4; ++i) {
            std::uint32_t& v = number[face[i]];
            if (v == kLeftOut) {
                v = std::uint32_t(out.points.size());
                out.points.push_back(std::move(points[face[i]]));
                out.places.push_back(places[face[i]]);
                out.is_cut.push_back(!places[face[i]].on_patch());
            }
            quad[i] = v;
        }
        face_number[f] = std::uint32_t(out.mesh.faces());
        out.mesh.add_face(quad);
        out.of_patch.push_back(of_patch[f]);
    }
    out.mesh.positions.resize(out.points.size());
    for (ControlMesh::Crease c : fine.creases) {
        c.a = number[c.a], c.b = number[c.b];
        if (c.a != kLeftOut && c.b != kLeftOut) out.mesh.creases.push_back(c);
    }
    for (ControlMesh::Corner c : fine.corners) {
        c.vertex = number[c.vertex];
        if (c.vertex != kLeftOut) out.mesh.corners.push_back(c);
    }
    for (HalfEdge h : fine.concave)
        if (std::uint32_t const f = face_number[h / 4]; f != kLeftOut)
            out.mesh.concave.push_back(4 * f + h % 4);
    out.corner = number[first_vertex_point + piece.corner];
    return out;
}

// A vertex of the patch.
struct Around {
    Ring<X> ring; // as Topology has it
    RingSharpness sharp;
    std::size_t position; // of a face of the patch
    int turns;            // the edge before that face runs along u, turned by so many right angles
};

// Of the piece's points, or of those after another step.
class Rings {
public:
    Rings(Piece const& piece, Topology const& t)
        : piece_(piece),
          t_(t),
          sharpness_(t, piece.is_cut),
          edges_(t)
    {
        // By Biermann's rules a vertex depends on those around it in the next step: how they lean
        // and flatten.
        if (piece.mesh.rules.sectors == SectorRules::Biermann)
            next_ = refined_points<CatmullClark, X>(t, sharpness_, piece.points);
    }
    int further_steps() const { return next_.empty() ? 0 : 1; }

    Around around(std::uint32_t v) const
    {
        auto const faces = t_.ring(v);
        Around out{{vertex(v), {}, {}}, {}, 0, 0};
        while (!piece_.of_patch[t_.face_of(faces[out.position])]) ++out.position;
        for (HalfEdge h : faces) {
            out.ring.edge.push_back(edge(h, t_.next(h)));
            out.ring.face.push_back(next_.empty() ? vertex(t_.vertex_of(t_.next(t_.next(h))))
                                                  : next_[t_.face_of(h)]);
        }
        if (t_.is_boundary(v)) {
            HalfEdge const last = t_.previous(faces.back());
            out.ring.edge.push_back(edge(last, last));
        }
        sharpness_.around(v, out.sharp);
        if (!next_.empty()) out.sharp = out.sharp.after_step();
        Place const a = piece_.places[v],
                    b = piece_.places[t_.vertex_of(t_.next(faces[out.position]))];
        out.turns = b.i > a.i ? 0 : b.j > a.j ? 1 : b.i < a.i ? 2 : 3;
        return out;
    }

private:
    X const& vertex(std::uint32_t v) const
    {
        return next_.empty() ? piece_.points[v] : next_[t_.mesh().faces() + edges_.size() + v];
    }
    // Along an edge, to the vertex of the half-edge `far`.
    X const& edge(HalfEdge h, HalfEdge far) const
    {
        return next_.empty() ? vertex(t_.vertex_of(far)) : next_[t_.mesh().faces() + edges_[h]];
    }

    Piece const& piece_;
    Topology const& t_;
    Sharpness sharpness_;
    EdgeNumbers edges_;
    std::vector<X> next_; // empty: not needed
};

struct Sample {
    X position, du, dv;
};

// Derivatives at a regular vertex of a mesh of cells of size h, from its ring; on an infinitely
// sharp line those of the patch's side.
void set_derivatives(Around const& a, double h, Sample& out)
{
    std::size_t const edges = a.ring.edge.size(), faces = a.ring.faces(), p = a.position;
    auto const edge = [&](std::size_t i) -> X const& { return a.ring.edge[(p + i) % edges]; };
    auto const face = [&](std::size_t i) -> X const& { return a.ring.face[(p + i) % faces]; };
    auto const is_sharp = [&](std::size_t i) { return a.sharp.edge[(p + i) % edges] > 0; };
    X along, left; // in the direction of the edge before the face, and to its left
    if (a.sharp.rule() == VertexRule::Smooth) {
        assert(faces == 4 && !a.sharp.open);
        along = (4.0 * (edge(0) - edge(2)) + (face(0) - face(1)) + (face(3) - face(2))) / (12 * h);
        left = (4.0 * (edge(1) - edge(3)) + (face(0) - face(3)) + (face(1) - face(2))) / (12 * h);
    } else {
        // The side's two faces: `first` and the one after it, from a sharp edge to the other.
        std::size_t const first = is_sharp(0) ? 0 : faces - 1;
        X const &start = edge(is_sharp(0) ? 0 : edges - 1), &middle = edge(is_sharp(0) ? 1 : 0),
                &end = edge(is_sharp(0) ? 2 : 1);
        X const forward = (start - end) / (2 * h);
        X const inward =
            (face(first) + 4.0 * middle + face(first + 1) - start - 4.0 * a.ring.vertex - end) /
            (6 * h);
        along = is_sharp(0) ? forward : inward;
        left = is_sharp(0) ? inward : X(-forward);
    }
    switch (a.turns) {
    case 0:
        out.du = along, out.dv = left;
        break;
    case 1:
        out.dv = along, out.du = -left;
        break;
    case 2:
        out.du = -along, out.dv = -left;
        break;
    default:
        out.dv = -along, out.du = left;
        break;
    }
}

// What a side's tangents make of the modes of theta = pi turn / of, whose edges are the cosines, or
// sines, of j theta and whose faces are the sums of their edges: [tangent][mode]
std::array<std::array<double, 2>, 2> on_modes(Around const& a, Limits<CatmullClark>& limits,
                                              std::size_t side, RingSector const& sector)
{
    std::size_t const n = a.ring.faces(), edges = a.ring.edge.size();
    std::array<std::array<double, 2>, 2> out;
    for (std::size_t m = 0; m < 2; ++m) {
        auto const at = [&](std::size_t j) {
            int const turn = int(j) * sector.turn;
            return m == 0 ? cos_pi(turn, sector.of) : sin_pi(turn, sector.of);
        };
        Ring<double> ring{0, std::vector<double>(edges, 0), std::vector<double>(n, 0)};
        for (std::size_t j = 0; j < sector.faces + (sector.closed ? 0 : 1); ++j)
            ring.edge[(sector.first + j) % edges] = at(j);
        for (std::size_t j = 0; j < sector.faces; ++j)
            ring.face[(sector.first + j) % n] = at(j) + at(j + 1);
        auto const limit = limits.of(ring, a.sharp);
        for (std::size_t t = 0; t < 2; ++t) out[t][m] = limit.sides[side].tangents[t];
    }
    return out;
}

// Of the corner: two directions, whose cross product points outwards.
void set_directions(Around const& a, Limits<CatmullClark>& limits, Sample& out)
{
    std::size_t const n = a.ring.faces();
    VertexLimit<X> const limit = limits.of(a.ring, a.sharp);
    std::vector<RingSector> const sectors = a.sharp.sectors();
    std::size_t s = 0, j = 0; // the patch is face j of side s
    while ((j = (a.position + n - sectors[s].first % n) % n) >= sectors[s].faces) ++s;
    RingSector const& sector = sectors[s];
    X first = limit.sides[s].tangents[0], second = limit.sides[s].tangents[1];
    bool const is_corner = limit.rule == VertexRule::Corner;
    if (is_corner && sector.closed && !a.sharp.biermann) { // with a sharp edge or without
        auto const of = [&](auto const& list) {
            return [&](std::size_t i) -> X const& { return list[(sector.first + i) % n]; };
        };
        auto const smooth =
            CatmullClark::limit(int(n), a.ring.vertex, of(a.ring.edge), of(a.ring.face));
        first = smooth[1], second = smooth[2];
    }
    // At a corner both sharp edges are tangent, for all patches between them; the edges of two
    // faces, and of one on a crease, lie in one line.
    if (sector.closed ? sector.faces == 2
                      : (is_corner && !a.sharp.biermann) || (!is_corner && sector.faces == 1)) {
        out.du = std::move(first), out.dv = std::move(second);
        return;
    }
    X even = first, odd = second; // the tangents dual to the modes, or of the scale of those
    if (a.sharp.biermann) {
        auto const m = on_modes(a, limits, s, sector);
        double const determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        even = (m[1][1] * first - m[0][1] * second) / determinant;
        odd = (m[0][0] * second - m[1][0] * first) / determinant;
    } else if (!is_corner && limit.rule != VertexRule::Smooth) {
        auto const m = on_modes(a, limits, s, sector);
        even /= m[0][0];
        odd /= m[1][1];
    }
    auto const direction = [&](std::size_t i) -> X {
        int const turn = int(i) * sector.turn;
        return cos_pi(turn, sector.of) * even + sin_pi(turn, sector.of) * odd;
    };
    out.du = direction(j);
    out.dv = direction(j + 1);
}

} // namespace

BasisTables make_basis_tables(PatchType const& type, int steps)
{
    int const cells = 1 << steps, side = cells + 1;
    auto const samples = std::size_t(side) * std::size_t(side);
    Piece piece = PieceBuilder(type, cells).take();
    for (int s = 0; s < steps; ++s) piece = refined(piece);
    Topology const topology(piece.mesh);
    Rings const rings(piece, topology);
    Limits<CatmullClark> limits;
    BasisTables out;
    std::size_t const all = piece.points[0].size();
    auto const size = all * samples;
    out.position.resize(size), out.du.resize(size), out.dv.resize(size);
    for (std::uint32_t v = 0; v < piece.points.size(); ++v) {
        Place const place = piece.places[v];
        if (!place.on_patch()) continue;
        Around a = rings.around(v);
        Sample s;
        s.position = limits.of(a.ring, a.sharp).position;
        double h = 1.0 / ((side - 1) << rings.further_steps());
        while (a.sharp.is_semi_sharp()) {
            a.ring = refined_ring<CatmullClark>(a.ring, a.sharp);
            a.sharp = a.sharp.after_step();
            h /= 2;
        }
        if (v == piece.corner)
            set_directions(a, limits, s);
        else
            set_derivatives(a, h, s);
        std::size_t const at = std::size_t(place.j) * std::size_t(side) + std::size_t(place.i);
        for (std::size_t k = 0; k < all; ++k) {
            out.position[k * samples + at] = s.position[k];
            out.du[k * samples + at] = s.du[k];
            out.dv[k * samples + at] = s.dv[k];
        }
    }
    // Of the rings beyond only points that count.
    out.points = type.points();
    for (auto k = std::size_t(out.points); k < all; ++k) {
        auto const first = std::ptrdiff_t(k * samples);
        auto const counts = [&](std::vector<double> const& table) {
            return std::any_of(table.begin() + first,
                               table.begin() + first + std::ptrdiff_t(samples),
                               [](double w) { return w != 0; });
        };
        if (!counts(out.position) && !counts(out.du) && !counts(out.dv)) continue;
        auto const to = std::ptrdiff_t(out.points++) * std::ptrdiff_t(samples);
        for (auto* table : {&out.position, &out.du, &out.dv})
            std::copy_n(table->begin() + first, samples, table->begin() + to);
        out.beyond.push_back(std::uint16_t(k - std::size_t(type.points())));
    }
    for (auto* table : {&out.position, &out.du, &out.dv})
        table->resize(std::size_t(out.points) * samples);
    return out;
}

} // namespace tessemu
