// The type of a patch of a subdivision surface: all that its basis functions depend on (BOLZ03
// section 2; docs/math/subdivision.md, 1.7 and 5.1).
//
//      (-1,2)--(0,2)---(1,2)---(2,2)     A patch p is a quad of a mesh that a step has made, so
//         |      |       |       |       that all its vertices but one are regular: V, its
//        f_1----e_1-----f_0----(2,1)     corner (0,0). Its control points are V's ring, or the
//         |      |   p   |       |       sector of it between two infinitely sharp edges, e_0 f_0
//        e_2-----V------e_0----(2,0)     e_1 ... counter-clockwise, and up to seven more. Here it
//         |      |       |       |       is face 0 of a closed ring.
//        ...   e_n-1 --f_n-1---(2,-1)
//
// A vertex *beyond*, (2,0), (2,2) or (0,2), may be extraordinary or tagged too: it is another
// patch's corner. By OpenSubdiv's rules that is without influence. By Biermann's the edge point
// between (1,0) and (2,0) leans to a tagged (2,0), as its sector's angle says, and flatness moves
// the whole ring; by Chaikin's rule the sharp edges that end there lend their sharpness.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/sharpness.h"

#include <array>
#include <compare>
#include <optional>
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
    SemiSharp, ///< a finite sharpness is left
};
inline constexpr int kPatchFamilies = 7;
std::string in_words(PatchFamily family);

/// Faces around a vertex, counter-clockwise, and what is sharp there.
struct VertexRing {
    bool closed = true;
    std::uint16_t faces = 4;
    std::uint16_t position = 0; ///< of the face by which it is looked at; closed: 0
    float vertex = 0;           ///< its own sharpness
    /// Of each edge: as many as faces, and one more where it is open, whose first and last are
    /// infinitely sharp. Empty: nothing else is sharp.
    std::vector<float> edges;
    std::vector<std::uint16_t> concave; ///< by Biermann's rules: first edges of concave sectors

    auto operator<=>(VertexRing const&) const = default;
    std::size_t edge_count() const { return std::size_t(faces) + (closed ? 0 : 1); }
    float edge(std::size_t j) const;
    bool is_semi_sharp() const;
    bool is_tagged() const { return !closed || vertex > 0 || !edges.empty(); }
    /// By Biermann's rules: the point of edge `j` is not the plain one.
    bool leans(std::size_t j) const;
    /// Where it is the ring of a vertex of a mesh with such rules.
    RingSharpness sharpness(SectorRules sectors, std::optional<double> flatness) const;
};

/// Patches of equal types have the same tables, bit for bit.
struct PatchType {
    static constexpr int kMostFaces = 1024;                   ///< around a vertex
    enum Beyond { RightVertex, DiagonalVertex, UpperVertex }; ///< (2,0), (2,2), (0,2)

    VertexRing corner;
    /// Where they have an influence; looked at by the face that lies on the patch's right, diagonal
    /// or upper side.
    std::array<std::optional<VertexRing>, 3> beyond;
    CreaseMethod crease_method = CreaseMethod::Normal; ///< Chaikin: only SemiSharp
    /// By Chaikin's rule, of each edge of the corner: sharpness of the edge that goes on from it.
    std::vector<float> outer;
    SectorRules sectors = SectorRules::OpenSubdiv; ///< Biermann: only where it matters
    std::optional<double> flatness;                ///< SubdivisionRules::flatness, where it matters

    auto operator<=>(PatchType const&) const = default;

    PatchFamily family() const;
    /// "semi-sharp, 5 faces", "convex corner, face 2 of 3"
    std::string in_words() const;

    /// Control points: V, e_0, f_0, e_1, f_1, ..., then (2,0) (2,1) (2,2) (1,2) (0,2), then (2,-1)
    /// unless the patch is the first of a sector, then (-1,2) unless it is the last. Those of
    /// beyond_points() that have weights follow.
    int points() const;
    int ring_points() const { return 1 + corner.faces + int(corner.edge_count()); }
    bool has_lower() const { return corner.closed || corner.position > 0; }
    bool has_left() const { return corner.closed || corner.position + 1 < corner.faces; }

    /// A point of the ring of a vertex beyond that is not among points().
    struct BeyondPoint {
        int vertex; ///< Beyond
        bool is_face;
        std::uint16_t index; ///< of the edge whose far end, the face whose opposite vertex it is

        auto operator<=>(BeyondPoint const&) const = default;
    };
    std::vector<BeyondPoint> beyond_points() const;

    /// Canonical, equal if and only if the types are.
    std::string bytes() const;
};

/// Nothing is sharp.
PatchType smooth_type(int faces);
/// Between two infinitely sharp edges.
PatchType sector_type(int faces, int position, bool is_corner = false);
/// Edge `edge` of a closed ring is infinitely sharp; the patch lies between edges 0 and 1.
PatchType dart_type(int faces, int edge);

} // namespace tessemu
