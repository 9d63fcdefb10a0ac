// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/biermann.h"

#include "pipeline/mesh/sharpness.h"

#include <glm/geometric.hpp>

#include <charconv>
#include <cmath>

namespace tessemu {

namespace {

using Vec = glm::dvec3;

std::string number(float x)
{
    char digits[32];
    return std::string(digits, std::to_chars(digits, digits + sizeof digits, x).ptr);
}

// A sum of angles, each of at most pi, until it is seen to pass pi: products of unit complex
// numbers.
class AngleSum {
public:
    /// \param y  not negative
    void add(double x, double y)
    {
        double const length = std::sqrt(x * x + y * y);
        if (!(length > 0)) return; // an edge without a direction
        x /= length, y /= length;
        bool const is_angle = y > kTolerance || x < 0;
        if (re_ < 0 && im_ <= kTolerance && is_angle) passes_ = true; // at pi
        double const re = re_ * x - im_ * y;
        im_ = re_ * y + im_ * x;
        re_ = re;
        if (im_ < -kTolerance) passes_ = true;
    }
    void add_more_than_pi() { passes_ = true; }
    bool passes_pi() const { return passes_; }

    static constexpr double kTolerance = 0x1p-20;

private:
    double re_ = 1, im_ = 0;
    bool passes_ = false;
};

Vec normal_of(ControlMesh const& mesh, std::uint32_t f)
{
    auto const face = mesh.face(f);
    Vec const a(mesh.positions[face[0]]);
    Vec sum(0);
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
        sum += cross(Vec(mesh.positions[face[k]]) - a, Vec(mesh.positions[face[k + 1]]) - a);
    return sum;
}

void add_angle(AngleSum& sum, Topology const& topology, HalfEdge h)
{
    ControlMesh const& mesh = topology.mesh();
    auto const at = [&](HalfEdge g) { return Vec(mesh.positions[topology.vertex_of(g)]); };
    Vec const here = at(h), after = at(topology.next(h)) - here,
              before = at(topology.previous(h)) - here, turn = cross(after, before);
    double const x = dot(after, before), y = std::sqrt(dot(turn, turn));
    if (dot(turn, normal_of(mesh, topology.face_of(h))) < 0 &&
        y > AngleSum::kTolerance * std::sqrt(x * x + y * y))
        sum.add_more_than_pi();
    else
        sum.add(x, y);
}

} // namespace

void check_sharpness_for_biermann(ControlMesh const& mesh)
{
    Topology const topology(mesh);
    Sharpness const sharpness(topology);
    auto const is_finite = [](float s) { return s > 0 && s < kInfinitelySharp; };
    auto const refuse = [&](std::string const& what, float s, HalfEdge at) {
        std::uint32_t const f = mesh.file_face(topology.face_of(at));
        throw MeshError(f, what + " of face " + std::to_string(f + 1) + " has sharpness " +
                               number(s) + "; rules=biermann knows none but infinite sharpness, " +
                               number(kInfinitelySharp) + " and above: rules=opensubdiv draws it");
    };
    auto const name = [&](std::uint32_t v) { return std::to_string(mesh.file_vertex(v) + 1); };
    for (ControlMesh::Crease const& c : mesh.creases) {
        HalfEdge const h = topology.find_edge(c.a, c.b);
        if (h != Topology::kNone && is_finite(sharpness.edge(h)))
            refuse("edge " + name(c.a) + "-" + name(c.b), sharpness.edge(h), h);
    }
    for (ControlMesh::Corner const& c : mesh.corners)
        if (!topology.ring(c.vertex).empty() && is_finite(sharpness.vertex(c.vertex)))
            refuse("vertex " + name(c.vertex), sharpness.vertex(c.vertex),
                   topology.ring(c.vertex)[0]);
}

ConcaveSectors mark_concave_sectors(ControlMesh& mesh)
{
    ConcaveSectors out;
    Topology const topology(mesh);
    Sharpness const sharpness(topology);
    mesh.concave.clear();
    RingSharpness around;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        auto const ring = topology.ring(v);
        if (ring.empty() || sharpness.is_plain(v)) continue;
        sharpness.around(v, around);
        if (around.rule() != VertexRule::Corner) continue;
        for (RingSector const& s : around.sectors()) {
            if (s.closed) continue;
            AngleSum sum;
            for (std::size_t k = 0; k < s.faces; ++k)
                add_angle(sum, topology, ring[(s.first + k) % ring.size()]);
            if (!sum.passes_pi()) continue;
            if (s.faces > 1) {
                ++out.several_faces;
                mesh.concave.push_back(ring[s.first]);
            } else if (out.one_face++ == 0) {
                out.first_vertex = v;
                out.first_face = topology.face_of(ring[s.first]);
            }
        }
    }
    std::sort(mesh.concave.begin(), mesh.concave.end());
    return out;
}

std::vector<std::string> in_words(ConcaveSectors const& sectors, ControlMesh const& mesh)
{
    if (sectors.one_face == 0) return {};
    std::string const at = "vertex " + std::to_string(mesh.file_vertex(sectors.first_vertex) + 1) +
                           " of face " + std::to_string(mesh.file_face(sectors.first_face) + 1);
    return {
        sectors.one_face == 1
            ? "the sharp corner of one face at " + at +
                  " is concave: a face alone is taken as convex"
            : std::to_string(sectors.one_face) +
                  " sharp corners of one face are concave: a face alone is taken as convex; the "
                  "first is at " +
                  at};
}

} // namespace tessemu
