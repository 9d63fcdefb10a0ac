// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/patch_place.h"

#include <array>
#include <utility>

namespace tessemu {

namespace {

constexpr std::uint32_t kOne = MeshPoint::kOne;

struct Place2 {
    std::uint32_t x, y;
};

// A domain point of a quad patch, in 1/65536, in its unit.
Place2 in_unit(PatchPlace const& p, std::uint32_t u, std::uint32_t v)
{
    std::uint32_t const one = 65536;
    std::array<Place2, 4> const turned{{{u, v}, {one - v, u}, {one - u, one - v}, {v, one - u}}};
    Place2 const at = turned[p.rotation];
    int const shift = 25 - 16 - p.level;
    return {((std::uint32_t(p.i) << 16) + at.x) << shift, ((std::uint32_t(p.j) << 16) + at.y)
                                                              << shift};
}

// Weights of a triangle's corners, in 2^-25.
std::array<std::uint32_t, 3> in_triangle(PatchPlace const& p, std::uint32_t u, std::uint32_t v)
{
    constexpr std::uint32_t one = 65536;
    std::array<std::uint32_t, 3> const domain{u, v, one - u - v};
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t i = 0; i < 3; ++i) cell[(i + p.rotation) % 3] = domain[i];
    auto const at = [&](std::uint32_t first, std::uint32_t weight) {
        return ((first << 16) + (p.is_flipped ? one - weight : weight)) << (25 - 16 - p.level);
    };
    std::uint32_t const x = at(p.i, cell[0]), y = at(p.j, cell[1]);
    return {x, y, kOne - x - y};
}

std::uint32_t vertex(ControlMesh const& mesh, PatchPlace const& p, std::size_t i)
{
    auto const face = mesh.face(p.face);
    return face[i % face.size()];
}
std::uint32_t sides_of_face(ControlMesh const& mesh, PatchPlace const& p)
{
    return std::uint32_t(mesh.face(p.face).size());
}

// The two sides of a slit are two lines.
std::uint32_t side_of_slit(ControlMesh const& mesh, std::uint32_t from, std::uint32_t to)
{
    return from > to && mesh.is_slit(from, to) ? 1 : 0;
}

// A point of edge k of the face, t from vertex k.
MeshPoint on_edge(ControlMesh const& mesh, PatchPlace const& p, std::size_t k, std::uint32_t t)
{
    std::uint32_t a = vertex(mesh, p, k), b = vertex(mesh, p, k + 1);
    if (t == 0) return {MeshPoint::Kind::Vertex, a, 0, 0, 0};
    if (t == kOne) return {MeshPoint::Kind::Vertex, b, 0, 0, 0};
    std::uint32_t const side = side_of_slit(mesh, a, b);
    if (a > b) std::swap(a, b), t = kOne - t;
    return {MeshPoint::Kind::Edge, a, b, side, t};
}

MeshInterval along_edge(ControlMesh const& mesh, PatchPlace const& p, std::size_t k,
                        std::uint32_t from, std::uint32_t to)
{
    std::uint32_t a = vertex(mesh, p, k), b = vertex(mesh, p, k + 1);
    std::uint32_t const side = side_of_slit(mesh, a, b);
    if (a > b) std::swap(a, b), from = kOne - from, to = kOne - to;
    return {{MeshLine::Kind::Edge, a, b, side}, from, to};
}

} // namespace

PatchPlace turned(PatchPlace p, int turns)
{
    p.rotation = std::uint8_t((p.rotation + turns) % p.sides);
    return p;
}

PatchPlace split(PatchPlace const& face, int sides, int corner)
{
    PatchPlace p = face;
    if (sides != 4) {
        p.corner = std::uint16_t(corner);
        p.sides = 4;
        p.rotation = 0;
        return p;
    }
    int const c = (face.rotation + corner) % 4; // of the cell
    p.rotation = std::uint8_t(c);
    ++p.level;
    p.i = std::uint16_t(2 * p.i + (c == 1 || c == 2));
    p.j = std::uint16_t(2 * p.j + (c >= 2));
    return p;
}

PatchPlace split_triangle(PatchPlace const& face, int child)
{
    PatchPlace p = face;
    ++p.level;
    p.i = std::uint16_t(2 * p.i + face.is_flipped);
    p.j = std::uint16_t(2 * p.j + face.is_flipped);
    if (child == 3) {
        p.is_flipped = !face.is_flipped;
        p.rotation = std::uint8_t((face.rotation + 2) % 3);
        return p;
    }
    p.rotation = std::uint8_t((face.rotation + child) % 3); // of the cell
    int const away = face.is_flipped ? -1 : 1;
    if (p.rotation == 0) p.i = std::uint16_t(p.i + away);
    if (p.rotation == 1) p.j = std::uint16_t(p.j + away);
    return p;
}

UnitPoint domain_to_unit(PatchPlace const& p, float u, float v)
{
    if (p.sides == 3) {
        float const weight[3] = {u, v, 1 - u - v};
        UnitPoint const at{weight[(3 - p.rotation) % 3], weight[(4 - p.rotation) % 3]};
        if (p.level == 0) return at;
        float const size = 1.0f / float(1 << p.level);
        return {size * (float(p.i) + (p.is_flipped ? 1 - at.u : at.u)),
                size * (float(p.j) + (p.is_flipped ? 1 - at.v : at.v))};
    }
    std::array<UnitPoint, 4> const turned{{{u, v}, {1 - v, u}, {1 - u, 1 - v}, {v, 1 - u}}};
    UnitPoint const at = turned[p.rotation];
    if (p.level == 0) return at;
    float const size = 1.0f / float(1 << p.level);
    return {size * (float(p.i) + at.u), size * (float(p.j) + at.v)};
}

MeshPoint mesh_point(ControlMesh const& mesh, PatchPlace const& p, std::uint32_t u, std::uint32_t v)
{
    if (p.sides == 3) {
        auto const w = in_triangle(p, u, v);
        if (w[2] == 0) return on_edge(mesh, p, 0, w[1]);
        if (w[0] == 0) return on_edge(mesh, p, 1, w[2]);
        if (w[1] == 0) return on_edge(mesh, p, 2, w[0]);
        return {MeshPoint::Kind::Face, p.face, p.corner, w[0], w[1]};
    }
    auto const [x, y] = in_unit(p, u, v);
    if (p.corner == PatchPlace::kWhole) {
        if (y == 0) return on_edge(mesh, p, 0, x);
        if (x == kOne) return on_edge(mesh, p, 1, y);
        if (y == kOne) return on_edge(mesh, p, 2, kOne - x);
        if (x == 0) return on_edge(mesh, p, 3, kOne - y);
        return {MeshPoint::Kind::Face, p.face, p.corner, x, y};
    }
    std::uint32_t const n = sides_of_face(mesh, p), before = (p.corner + n - 1) % n;
    if (y == 0) return on_edge(mesh, p, p.corner, x / 2);
    if (x == 0) return on_edge(mesh, p, before, kOne - y / 2);
    if (x == kOne && y == kOne) return {MeshPoint::Kind::Face, p.face, 0, kOne, kOne};
    // Two units have a spoke: it is named as the side x = 1 of one of them.
    if (x == kOne) return {MeshPoint::Kind::Face, p.face, p.corner, kOne, y};
    if (y == kOne) return {MeshPoint::Kind::Face, p.face, before, kOne, x};
    return {MeshPoint::Kind::Face, p.face, p.corner, x, y};
}

MeshPoint as_in_file(ControlMesh const& mesh, MeshPoint point)
{
    if (point.kind == MeshPoint::Kind::Face) {
        point.a = mesh.file_face(point.a);
        return point;
    }
    point.a = mesh.file_vertex(point.a);
    if (point.kind != MeshPoint::Kind::Edge) return point;
    point.b = mesh.file_vertex(point.b);
    if (point.b < point.a) {
        std::swap(point.a, point.b);
        point.t = MeshPoint::kOne - point.t;
    }
    return point;
}

std::string in_words(MeshPoint const& m)
{
    auto const number = [](std::uint32_t i) { return std::to_string(i + 1); };
    auto const fraction = [](std::uint32_t t) {
        return t % 512 ? std::to_string(t) + "/33554432" : std::to_string(t / 512) + "/65536";
    };
    switch (m.kind) {
    case MeshPoint::Kind::Vertex:
        return "corner at vertex " + number(m.a);
    case MeshPoint::Kind::Edge:
        return "edge " + number(m.a) + "-" + number(m.b) + ", t = " + fraction(m.t);
    default:
        return "inside face " + number(m.a) +
               (m.b == PatchPlace::kWhole ? "" : ", at its corner " + number(m.b)) +
               ", (u, v) = (" + fraction(m.s) + ", " + fraction(m.t) + ")";
    }
}

MeshInterval mesh_interval(ControlMesh const& mesh, PatchPlace const& p, int k)
{
    if (p.sides == 3) {
        constexpr std::uint32_t kCorners[3][2] = {{65536, 0}, {0, 65536}, {0, 0}};
        auto const end = [&](int i) {
            return in_triangle(p, kCorners[i % 3][0], kCorners[i % 3][1]);
        };
        auto const a = end(k), b = end(k + 1);
        // An edge k of the face is where the weight of corner k - 1 is 0.
        for (std::size_t i = 0; i < 3; ++i)
            if (a[(i + 2) % 3] == 0 && b[(i + 2) % 3] == 0)
                return along_edge(mesh, p, i, a[(i + 1) % 3], b[(i + 1) % 3]);
        if (a[0] == b[0]) return {{MeshLine::Kind::ConstantX, p.face, p.corner, a[0]}, a[1], b[1]};
        if (a[1] == b[1]) return {{MeshLine::Kind::ConstantY, p.face, p.corner, a[1]}, a[0], b[0]};
        return {{MeshLine::Kind::ConstantSum, p.face, p.corner, kOne - a[2]}, a[0], b[0]};
    }
    constexpr std::uint32_t kCorner[4][2] = {{0, 0}, {65536, 0}, {65536, 65536}, {0, 65536}};
    auto const end = [&](int i) { return in_unit(p, kCorner[i % 4][0], kCorner[i % 4][1]); };
    Place2 const a = end(k), b = end(k + 1);
    bool const whole = p.corner == PatchPlace::kWhole;
    std::uint32_t const n = sides_of_face(mesh, p), before = whole ? 0 : (p.corner + n - 1) % n;
    auto const spoke = [&](std::uint32_t corner, std::uint32_t from, std::uint32_t to) {
        return MeshInterval{{MeshLine::Kind::ConstantX, p.face, corner, kOne}, from, to};
    };
    if (a.y == b.y) {
        if (a.y == 0)
            return whole ? along_edge(mesh, p, 0, a.x, b.x)
                         : along_edge(mesh, p, p.corner, a.x / 2, b.x / 2);
        if (a.y == kOne)
            return whole ? along_edge(mesh, p, 2, kOne - a.x, kOne - b.x) : spoke(before, a.x, b.x);
        return {{MeshLine::Kind::ConstantY, p.face, p.corner, a.y}, a.x, b.x};
    }
    if (a.x == kOne) return whole ? along_edge(mesh, p, 1, a.y, b.y) : spoke(p.corner, a.y, b.y);
    if (a.x == 0)
        return whole ? along_edge(mesh, p, 3, kOne - a.y, kOne - b.y)
                     : along_edge(mesh, p, before, kOne - a.y / 2, kOne - b.y / 2);
    return {{MeshLine::Kind::ConstantX, p.face, p.corner, a.x}, a.y, b.y};
}

} // namespace tessemu
