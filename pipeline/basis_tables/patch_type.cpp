// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/patch_type.h"

#include <algorithm>
#include <bit>

namespace tessemu {

namespace {

bool is_finite_sharpness(float s)
{
    return s > 0 && s < kInfinitelySharp;
}

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

PatchFamily PatchType::family() const
{
    if (corner.is_semi_sharp()) return PatchFamily::SemiSharp;
    if (corner.vertex > 0) return PatchFamily::ConvexCorner;
    if (!corner.closed) return PatchFamily::Crease;
    if (!corner.edges.empty()) return PatchFamily::Dart;
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
