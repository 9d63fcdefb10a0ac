// The type of a patch of a subdivision surface: all that its basis functions depend on (BOLZ03
// section 2; docs/math/subdivision.md, 1.7 and 5.1).
//
//      (-1,2)--(0,2)---(1,2)---(2,2)        A patch is a quad of a mesh on which a step has been
//         |      |       |       |          taken, so that all its vertices but one are regular and
//        f_1----e_1-----f_0----(2,1)        untagged: V, its corner (0,0). Its control points are
//         |      |   p   |       |          V's ring, or the sector of it between two infinitely
//        e_2-----V------e_0----(2,0)        sharp edges, e_0 f_0 e_1 ... counter-clockwise, and up
//         |      |       |       |          to seven more. Here it is face 0 of a closed ring.
//        ...   e_n-1 --f_n-1---(2,-1)
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/sharpness.h"

#include <string>
#include <string_view>

namespace tessemu {

enum class PatchFamily {
    Regular, ///< smooth, four faces
    Smooth,
    Crease, ///< a sector of a boundary or an infinitely sharp crease
    ConvexCorner,
    ConcaveCorner,
    Dart,      ///< one infinitely sharp edge ends here
    SemiSharp, ///< a finite sharpness is left at the corner
};
inline constexpr int kPatchFamilies = 7;
std::string in_words(PatchFamily family);

/// Faces around a vertex, counter-clockwise, and what is sharp there.
struct VertexRing {
    bool closed = true;
    std::uint16_t faces = 4;
    std::uint16_t position = 0; ///< the patch is this face; closed: 0
    float vertex = 0;           ///< its own sharpness
    /// Of each edge: as many as faces, and one more where it is open, whose first and last are
    /// infinitely sharp. Empty: nothing else is sharp.
    std::vector<float> edges;

    auto operator<=>(VertexRing const&) const = default;
    float edge(std::size_t j) const;
    std::size_t edge_count() const { return std::size_t(faces) + (closed ? 0 : 1); }
    bool is_semi_sharp() const;
};

/// Patches of equal types have the same tables, bit for bit.
struct PatchType {
    static constexpr int kMostFaces = 1024; ///< around a vertex
    /// Of a corner's angle over the faces' sum, by Biermann's rules.
    VertexRing corner;

    auto operator<=>(PatchType const&) const = default;

    PatchFamily family() const;
    /// "semi-sharp, 5 faces", "crease, face 2 of 3"
    std::string in_words() const;

    /// Control points: V, e_0, f_0, e_1, f_1, ..., then (2,0) (2,1) (2,2) (1,2) (0,2), then (2,-1)
    /// unless the patch is the first of a sector, then (-1,2) unless it is the last.
    int points() const;
    int ring_points() const { return 1 + corner.faces + int(corner.edge_count()); }
    bool has_lower() const { return corner.closed || corner.position > 0; }
    bool has_left() const { return corner.closed || corner.position + 1 < corner.faces; }

    /// Canonical, equal if and only if the types are.
    std::string bytes() const;
    /// Throws Error for what bytes() cannot have made.
    static PatchType from_bytes(std::string_view bytes);
};

/// The vertex is closed and regular or not, and nothing is sharp.
PatchType smooth_type(int faces);
/// A sector between two infinitely sharp edges.
PatchType sector_type(int faces, int position, bool is_corner);
/// Edge `edge` of a closed ring is infinitely sharp; the patch lies between edges 0 and 1.
PatchType dart_type(int faces, int edge);

} // namespace tessemu
