// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/generator.h"

#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/limit.h"

#include <cassert>

namespace tessemu {

namespace {

using X = RingWeights;

// In cells of the grid of the last step.
struct Place {
    int i = -1, j = -1;
    bool on_patch() const { return i >= 0; }
};

// A piece of a mesh around the patch. What else its boundary cuts off has no influence on it.
struct Piece {
    ControlMesh mesh;
    std::vector<X> points;      // by vertex
    std::vector<Place> places;  // by vertex
    std::vector<char> of_patch; // by face
    std::uint32_t corner = 0;   // V
};

void add_quad(ControlMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d)
{
    std::uint32_t const face[] = {a, b, c, d};
    mesh.add_face(face);
}

// Vertices are the control points in their order.
Piece control_piece(PatchType const& type, int cells)
{
    VertexRing const& ring = type.corner;
    std::uint32_t const n = ring.faces, j = ring.position;
    auto const e = [&](std::uint32_t i) { return 1 + 2 * (ring.closed ? i % n : i); };
    auto const f = [&](std::uint32_t i) { return 2 + 2 * (i % n); };
    std::uint32_t next = std::uint32_t(type.ring_points());
    std::uint32_t const x20 = next++, x21 = next++, x22 = next++, x12 = next++, x02 = next++;
    Piece out;
    ControlMesh& mesh = out.mesh;
    for (std::uint32_t i = 0; i < n; ++i) add_quad(mesh, 0, e(i), f(i), e(i + 1));
    add_quad(mesh, e(j), x20, x21, f(j));
    add_quad(mesh, f(j), x21, x22, x12);
    add_quad(mesh, e(j + 1), f(j), x12, x02);
    if (type.has_lower()) add_quad(mesh, f(j + n - 1), next++, x20, e(j));
    if (type.has_left()) add_quad(mesh, f(j + 1), e(j + 1), x02, next++);
    assert(next == std::uint32_t(type.points()));
    mesh.positions.resize(next);
    // No vertex is sharp because one face of it is in the piece.
    mesh.rules.boundary = BoundaryRule::EdgeOnly;
    if (ring.vertex > 0) mesh.corners.push_back({0, ring.vertex});
    for (std::uint32_t i = 0; i < ring.edge_count(); ++i)
        if (float const s = ring.edge(i); s > 0) mesh.creases.push_back({0, e(i), s});
    // The edges beyond, where they are on the patch.
    if (float const s = ring.edge(j); s > 0) mesh.creases.push_back({e(j), x20, s});
    if (float const s = ring.edge((j + 1) % ring.edge_count()); s > 0)
        mesh.creases.push_back({e(j + 1), x02, s});
    for (std::uint32_t v = 0; v < next; ++v) {
        X unit(0.0, next);
        unit[v] = 1;
        out.points.push_back(std::move(unit));
    }
    out.places.resize(next);
    out.places[0] = {0, 0};
    out.places[e(j)] = {cells, 0};
    out.places[f(j)] = {cells, cells};
    out.places[e(j + 1)] = {0, cells};
    out.of_patch.assign(mesh.faces(), 0);
    out.of_patch[j] = 1;
    return out;
}

// The faces that touch the patch, after a step.
Piece refined(Piece const& piece)
{
    Topology const topology(piece.mesh);
    Sharpness const sharpness(topology);
    std::vector<X> points = refined_points<CatmullClark, X>(topology, sharpness, piece.points);
    ControlMesh const fine =
        catmull_clark_mesh(topology, sharpness, std::vector<glm::dvec3>(points.size()));
    std::vector<Place> places(points.size());
    std::vector<char> of_patch(fine.faces(), 0);
    for (HalfEdge h = 0; h < fine.faces(); ++h) { // a face for each corner of the coarse ones
        std::uint32_t const f = topology.face_of(h);
        if (!piece.of_patch[f]) continue;
        of_patch[h] = 1;
        auto const at = [&](HalfEdge k) { return piece.places[topology.vertex_of(k)]; };
        auto const middle = [](Place a, Place b) {
            return Place{(a.i + b.i) / 2, (a.j + b.j) / 2};
        };
        Place const a = at(h), b = at(topology.next(h)), c = at(topology.next(topology.next(h))),
                    d = at(topology.previous(h));
        auto const quad = fine.face(h);
        places[quad[0]] = a;
        places[quad[1]] = middle(a, b);
        places[quad[2]] = middle(a, c);
        places[quad[3]] = middle(d, a);
    }
    Piece out;
    out.mesh.rules = fine.rules;
    constexpr std::uint32_t kLeftOut = 0xffffffffu;
    std::vector<std::uint32_t> number(points.size(), kLeftOut);
    for (std::uint32_t f = 0; f < fine.faces(); ++f) {
        auto const face = fine.face(f);
        if (std::none_of(face.begin(), face.end(),
                         [&](std::uint32_t v) { return places[v].on_patch(); }))
            continue;
        std::uint32_t quad[4];
        for (std::size_t i = 0; i < 4; ++i) {
            std::uint32_t& v = number[face[i]];
            if (v == kLeftOut) {
                v = std::uint32_t(out.points.size());
                out.points.push_back(std::move(points[face[i]]));
                out.places.push_back(places[face[i]]);
            }
            quad[i] = v;
        }
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
    // Vertex points are last, in the order of the vertices.
    out.corner = number[fine.positions.size() - piece.points.size() + piece.corner];
    return out;
}

// A vertex of the patch, in the order of a closed ring from the edge that is first
// counter-clockwise on the patch's side on; open rings as they are.
struct Around {
    Ring<X> ring;
    RingSharpness sharp;
    std::size_t position; // of a face of the patch
    int turns = 0;        // the edge before that face runs along u turned by so many right angles
};

Around around(Piece const& piece, Topology const& t, Sharpness const& sharpness, std::uint32_t v)
{
    auto const faces = t.ring(v);
    std::size_t position = 0;
    while (!piece.of_patch[t.face_of(faces[position])]) ++position;
    bool const closed = !t.is_boundary(v);
    std::size_t const n = faces.size(), first = closed ? position : 0;
    Around out;
    out.position = closed ? 0 : position;
    auto const& x = piece.points;
    out.ring.vertex = x[v];
    for (std::size_t j = 0; j < n; ++j) {
        HalfEdge const h = faces[(first + j) % n];
        out.ring.edge.push_back(x[t.vertex_of(t.next(h))]);
        out.ring.face.push_back(x[t.vertex_of(t.next(t.next(h)))]);
    }
    if (!closed) out.ring.edge.push_back(x[t.vertex_of(t.previous(faces.back()))]);
    sharpness.around(v, out.sharp);
    auto const rotate = [&](auto& list) {
        if (!list.empty())
            std::rotate(list.begin(), list.begin() + std::ptrdiff_t(first), list.end());
    };
    rotate(out.sharp.edge);
    rotate(out.sharp.far_end);
    Place const a = piece.places[v], b = piece.places[t.vertex_of(t.next(faces[position]))];
    out.turns = b.i > a.i ? 0 : b.j > a.j ? 1 : b.i < a.i ? 2 : 3;
    return out;
}

struct Sample {
    X position, du, dv;
};

// Derivatives at a regular vertex of a mesh of cells of size h, from its ring; on an infinitely
// sharp line those of the side of face `position`.
void set_derivatives(Around const& a, double h, Sample& out)
{
    Ring<X> const& r = a.ring;
    std::size_t const p = a.position;
    X along, left; // in the direction of the edge before the face, and to its left
    auto const sharp = [&](std::size_t edge) { return a.sharp.edge[edge] > 0; };
    if (!a.sharp.open &&
        std::none_of(a.sharp.edge.begin(), a.sharp.edge.end(), [](float s) { return s > 0; })) {
        assert(r.faces() == 4);
        along =
            (4.0 * (r.edge[0] - r.edge[2]) + (r.face[0] - r.face[1]) + (r.face[3] - r.face[2])) /
            (12 * h);
        left = (4.0 * (r.edge[1] - r.edge[3]) + (r.face[0] - r.face[3]) + (r.face[1] - r.face[2])) /
               (12 * h);
    } else {
        // The two faces of the side: `first` and the one after it, from a sharp edge to another.
        std::size_t const edges = r.edge.size(), faces = r.faces();
        std::size_t const first = sharp(p) ? p : (p + faces - 1) % faces;
        X const &start = r.edge[first % edges], &middle = r.edge[(first + 1) % edges],
                &end = r.edge[(first + 2) % edges], &f0 = r.face[first],
                &f1 = r.face[(first + 1) % faces];
        X const forward = (start - end) / (2 * h);
        X const inward = (f0 + 4.0 * middle + f1 - start - 4.0 * r.vertex - end) / (6 * h);
        if (first == p)
            along = forward, left = inward;
        else
            along = inward, left = -forward;
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

// What a side's tangents make of the modes whose edges are the cosines, or sines, of j theta and
// whose faces are the sums of their edges: to bring the tangents to one scale.
std::array<double, 2> on_angular_modes(Around const& a, Limits<CatmullClark>& limits,
                                       std::size_t side, std::size_t first, int half_turns, int k)
{
    std::size_t const n = a.ring.faces(), edges = a.ring.edge.size();
    std::array<double, 2> out;
    for (std::size_t m = 0; m < 2; ++m) {
        auto const at = [&](int j) {
            return m == 0 ? cos_pi(half_turns * j, k) : sin_pi(half_turns * j, k);
        };
        Ring<double> ring{0, std::vector<double>(edges, 0), std::vector<double>(n, 0)};
        for (int j = 0; j <= k; ++j) ring.edge[(first + std::size_t(j)) % edges] = at(j);
        for (int j = 0; j < k; ++j) ring.face[(first + std::size_t(j)) % n] = at(j) + at(j + 1);
        out[m] = limits.of(ring, a.sharp).sides[side].tangents[m];
    }
    return out;
}

// Of the corner: two directions, whose cross product points outwards.
void set_directions(Around const& a, Limits<CatmullClark>& limits, Sample& out)
{
    std::size_t const n = a.ring.faces();
    VertexLimit<X> const limit = limits.of(a.ring, a.sharp);
    std::size_t s = 0, j = 0; // the patch is face j of side s
    while ((j = (a.position + n - limit.sides[s].first_face) % n) >= limit.sides[s].faces) ++s;
    auto const& side = limit.sides[s];
    int const k = int(side.faces);
    bool const whole = !a.sharp.open && side.faces == n;
    X even = side.tangents[0], odd = side.tangents[1];
    if (whole && limit.rule == VertexRule::Corner) { // with a sharp edge or without
        auto const of = [&](auto const& list) {
            return [&](std::size_t i) -> X const& { return list[(side.first_face + i) % n]; };
        };
        auto const smooth = CatmullClark::limit(k, a.ring.vertex, of(a.ring.edge), of(a.ring.face));
        even = smooth[1], odd = smooth[2];
    }
    // At a corner both sharp edges are tangent, for all patches between them; two faces lie at
    // opposite sides of their edges.
    if ((!whole && (limit.rule == VertexRule::Corner || k == 1)) || (whole && k == 2)) {
        out.du = std::move(even), out.dv = std::move(odd);
        return;
    }
    int const half_turns = whole ? 2 : 1; // theta is so many, over k
    if (limit.rule == VertexRule::Dart || limit.rule == VertexRule::Crease) {
        auto const [on_even, on_odd] =
            on_angular_modes(a, limits, s, side.first_face, half_turns, k);
        even /= on_even;
        odd /= on_odd;
    }
    auto const direction = [&](int i) -> X {
        return cos_pi(half_turns * i, k) * even + sin_pi(half_turns * i, k) * odd;
    };
    out.du = direction(int(j));
    out.dv = direction(int(j) + 1);
}

} // namespace

BasisTables make_basis_tables(PatchType const& type, int steps)
{
    int const cells = 1 << steps, side = cells + 1;
    auto const samples = std::size_t(side) * std::size_t(side);
    Piece piece = control_piece(type, cells);
    for (int s = 0; s < steps; ++s) piece = refined(piece);
    Topology const topology(piece.mesh);
    Sharpness const sharpness(topology);
    Limits<CatmullClark> limits;
    BasisTables out;
    out.points = type.points();
    auto const size = std::size_t(out.points) * samples;
    out.position.resize(size), out.du.resize(size), out.dv.resize(size);
    for (std::uint32_t v = 0; v < piece.points.size(); ++v) {
        Place const place = piece.places[v];
        if (!place.on_patch()) continue;
        Around a = around(piece, topology, sharpness, v);
        Sample s;
        s.position = limits.of(a.ring, a.sharp).position;
        double h = 1.0 / cells;
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
        for (std::size_t k = 0; k < std::size_t(out.points); ++k) {
            out.position[k * samples + at] = s.position[k];
            out.du[k * samples + at] = s.du[k];
            out.dv[k * samples + at] = s.dv[k];
        }
    }
    return out;
}

} // namespace tessemu
