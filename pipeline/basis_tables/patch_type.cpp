// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/patch_type.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tessemu {

namespace {

bool is_finite_sharpness(float s)
{
    return s > 0 && s < kInfinitelySharp;
}

// Numbers as bytes, the lowest first, whatever the machine.
class Writer {
public:
    void number(std::uint64_t x, int bytes)
    {
        for (int i = 0; i < bytes; ++i) out += char(x >> (8 * i));
    }
    void real(float x) { number(std::bit_cast<std::uint32_t>(x), 4); }
    void reals(std::vector<float> const& list)
    {
        number(list.size(), 2);
        for (float x : list) real(x);
    }
    void ring(VertexRing const& r)
    {
        number(r.closed, 1);
        number(r.faces, 2);
        number(r.position, 2);
        real(r.vertex);
        reals(r.edges);
        number(r.concave.size(), 2);
        for (std::uint16_t edge : r.concave) number(edge, 2);
    }
    std::string out;
};

} // namespace

std::string in_words(PatchFamily family)
{
    switch (family) {
    case PatchFamily::Regular:
        return "regular";
    case PatchFamily::Smooth:
        return "smooth";
    case PatchFamily::Crease:
        return "crease or boundary";
    case PatchFamily::ConvexCorner:
        return "convex corner";
    case PatchFamily::ConcaveCorner:
        return "concave corner";
    case PatchFamily::Dart:
        return "dart";
    case PatchFamily::SemiSharp:
        return "semi-sharp";
    }
    return {};
}

float VertexRing::edge(std::size_t j) const
{
    if (!edges.empty()) return edges[j];
    return !closed && (j == 0 || j == faces) ? kInfinitelySharp : 0;
}

bool VertexRing::is_semi_sharp() const
{
    return is_finite_sharpness(vertex) ||
           std::any_of(edges.begin(), edges.end(), is_finite_sharpness);
}

bool VertexRing::leans(std::size_t j) const
{
    Lean const by = sharpness(SectorRules::Biermann, {}).leans()[j];
    return by.end == 0 && by.cos_theta != 0;
}

RingSharpness VertexRing::sharpness(SectorRules sectors, std::optional<double> flatness) const
{
    RingSharpness out;
    out.open = !closed;
    out.vertex = vertex;
    out.biermann = sectors == SectorRules::Biermann;
    out.flatness = flatness;
    for (std::size_t j = 0; j < edge_count(); ++j) out.edge.push_back(edge(j));
    out.concave.assign(concave.begin(), concave.end());
    return out;
}

PatchFamily PatchType::family() const
{
    if (corner.is_semi_sharp() || crease_method == CreaseMethod::Chaikin)
        return PatchFamily::SemiSharp;
    RingSharpness const sharp = corner.sharpness(sectors, flatness);
    switch (sharp.rule()) {
    case VertexRule::Corner:
        for (RingSector const& s : sharp.sectors())
            if ((corner.position + corner.faces - s.first % corner.faces) % corner.faces < s.faces)
                return s.concave ? PatchFamily::ConcaveCorner : PatchFamily::ConvexCorner;
        return PatchFamily::ConvexCorner;
    case VertexRule::Crease:
        return PatchFamily::Crease;
    case VertexRule::Dart:
        return PatchFamily::Dart;
    case VertexRule::Smooth:
        break;
    }
    return corner.faces == 4 ? PatchFamily::Regular : PatchFamily::Smooth;
}

std::string PatchType::in_words() const
{
    std::string const of = std::to_string(corner.faces) + (corner.faces == 1 ? " face" : " faces");
    std::string out = tessemu::in_words(family()) + ", ";
    if (!corner.closed) out += "face " + std::to_string(corner.position + 1) + " of ";
    return out + of;
}

int PatchType::points() const
{
    return ring_points() + 5 + has_lower() + has_left();
}

std::vector<PatchType::BeyondPoint> PatchType::beyond_points() const
{
    std::vector<BeyondPoint> out;
    for (int v = 0; v < 3; ++v) {
        auto const& ring = beyond[std::size_t(v)];
        if (!ring) continue;
        int const p = ring->position, n = ring->faces;
        // The edges and faces that points() has, from one to another.
        bool const lower = v == RightVertex && has_lower(), left = v == UpperVertex && has_left();
        int const first = p - left, edges = 2 + lower + left;
        auto const is_known = [&](int i, int count) {
            int const from_first = i - first;
            if (!ring->closed) return from_first >= 0 && from_first < count;
            return ((from_first % n) + n) % n < count;
        };
        for (int i = 0; i < n; ++i) {
            if (!is_known(i, edges)) out.push_back({v, false, std::uint16_t(i)});
            if (!is_known(i, edges - 1)) out.push_back({v, true, std::uint16_t(i)});
        }
        if (!ring->closed && !is_known(n, edges)) out.push_back({v, false, std::uint16_t(n)});
    }
    return out;
}

std::string PatchType::bytes() const
{
    Writer w;
    w.ring(corner);
    for (auto const& ring : beyond) {
        w.number(ring.has_value(), 1);
        if (ring) w.ring(*ring);
    }
    w.number(crease_method == CreaseMethod::Chaikin, 1);
    w.reals(outer);
    w.number(sectors == SectorRules::Biermann, 1);
    w.number(flatness.has_value(), 1);
    if (flatness) w.number(std::bit_cast<std::uint64_t>(*flatness), 8);
    return std::move(w.out);
}

PatchType smooth_type(int faces)
{
    PatchType out;
    out.corner.faces = std::uint16_t(faces);
    return out;
}

PatchType sector_type(int faces, int position, bool is_corner)
{
    PatchType out = smooth_type(faces);
    out.corner.closed = false;
    out.corner.position = std::uint16_t(position);
    out.corner.vertex = is_corner ? kInfinitelySharp : 0;
    return out;
}

PatchType dart_type(int faces, int edge)
{
    PatchType out = smooth_type(faces);
    out.corner.edges.assign(std::size_t(faces), 0);
    out.corner.edges[std::size_t(edge)] = kInfinitelySharp;
    return out;
}

} // namespace tessemu
