// Where a patch lies on the file's mesh, and names for its points and edges that do not depend on
// the patch: what checkers, displacement, comparisons and exports know a refined surface by.
//
// A unit of a mesh is a face; of a face that is no quad and was split, the quad at one of its
// corners:
//
//     quad         corner k of an n-gon                 triangle
//     3 --- 2      (0,1) ------ (1,1) centre            weights of corners 0 and 1
//     |     |  y   half of         | spoke to the
//     |     |  |   edge k-1        | middle of edge k
//     0 --- 1  +-x (0,0) corner k -(1,0)
//                     half of edge k
//
// A patch covers a dyadic cell of its unit: of a triangle's, cell (i, j) is the triangle whose corner
// 2 is the point (i, j), or, if it is flipped, the other half of that parallelogram. Coordinates are
// whole numbers of 2^-25.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/mesh.h"

#include <compare>

namespace tessemu {

struct PatchPlace {
    static constexpr std::uint16_t kWhole = 0xffff;
    static constexpr int kMaxLevel = 8;

    std::uint32_t face = 0;        ///< of the file's mesh
    std::uint16_t corner = kWhole; ///< the unit is the quad at this corner; kWhole: the face itself
    std::uint8_t sides = 4;        ///< of the patch
    std::uint8_t rotation = 0;     ///< the domain's corner 0 is corner `rotation` of the cell
    std::uint8_t level = 0;        ///< the cell's side is 2^-level of the unit's
    bool is_flipped = false;       ///< of a triangle: upside down, corner 0 at (i, j+1)
    std::uint16_t i = 0, j = 0;    ///< cell [i, i+1] x [j, j+1], in its sides

    friend bool operator==(PatchPlace const&, PatchPlace const&) = default;
};

/// The place of a patch whose corner 0 is corner `turns` of a face that has this place.
PatchPlace turned(PatchPlace face, int turns);
/// The places of the quads that a split makes of a face, one at each corner; each starts at the old
/// vertex and runs along the face's edge there. \param sides  of the face
PatchPlace split(PatchPlace const& face, int sides, int corner);
/// The places of the triangles that a split makes of one: at corners 0 to 2, each from the old
/// vertex on, and 3, the middle, from the middle of edge 0 on.
PatchPlace split_triangle(PatchPlace const& face, int child);

/// A domain point in its unit: quad, x and y as drawn above; triangle, weights of corners 0 and 1.
/// Exact for 16-bit fractions.
struct UnitPoint {
    float u, v;
};
UnitPoint domain_to_unit(PatchPlace const& place, float u, float v);

/// A point of the surface by name: equal for all patches that have it.
struct MeshPoint {
    static constexpr std::uint32_t kOne = 1u << 25;
    enum class Kind : std::uint8_t {
        Vertex, ///< a
        Edge,   ///< at t from vertex a to vertex b, a < b; s: the side of a slit
        Face,   ///< at (s, t) in the unit of face a at corner b
    };
    Kind kind = Kind::Vertex;
    std::uint32_t a = 0, b = 0, s = 0, t = 0;

    friend auto operator<=>(MeshPoint const&, MeshPoint const&) = default;
};
/// \param u, v  domain point in 1/65536
MeshPoint mesh_point(ControlMesh const& mesh, PatchPlace const& place, std::uint32_t u,
                     std::uint32_t v);
/// With the numbers that vertices and faces have in the file.
MeshPoint as_in_file(ControlMesh const& mesh, MeshPoint point);
/// "edge 3-7, t = 32768/65536", "corner at vertex 3", counted from 1
std::string in_words(MeshPoint const& point);

/// A line that edges of patches lie on: an edge of the mesh, or a line of a unit.
struct MeshLine {
    enum class Kind : std::uint8_t { Edge, ConstantX, ConstantY, ConstantSum };
    Kind kind = Kind::Edge;
    std::uint32_t a = 0, b = 0; ///< Edge: vertices, a < b; otherwise face and corner of the unit
    std::uint32_t at = 0;       ///< the constant coordinate or sum; Edge: the side of a slit

    friend auto operator<=>(MeshLine const&, MeshLine const&) = default;
};

/// A patch's edge as an interval of a line: from its corner k, at `from`, to corner k+1, at `to`.
struct MeshInterval {
    MeshLine line;
    std::uint32_t from = 0, to = 0;

    /// At a domain parameter in 1/65536 from corner k.
    std::uint32_t at(std::uint32_t t) const
    {
        std::int64_t const length = std::int64_t(to) - std::int64_t(from);
        return std::uint32_t(std::int64_t(from) + length * std::int64_t(t) / 65536);
    }
};
MeshInterval mesh_interval(ControlMesh const& mesh, PatchPlace const& place, int k);

} // namespace tessemu
