// Neighbourhood of a patch: the faces around its corners with the vertices numbered locally.
//
// Two patches have the same connectivity type when their neighbourhoods are equal after a rotation
// (LOOP09 section 4.3): valences, boundary flags, sides of the faces around, and which of their
// vertices coincide.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"

#include <string>
#include <unordered_map>

namespace tessemu {

/// Faces around a corner of a patch. In an interior ring face 0 is the patch itself; in a boundary
/// ring faces run from one boundary edge to the other and the patch is face `position`.
struct CornerNeighbourhood {
    struct Face {
        int sides;
        int vertices[4]; ///< the corner's vertex first, then counter-clockwise
    };
    bool boundary = false;
    int position = 0;
    std::vector<Face> faces;

    int valence() const { return int(faces.size()) + (boundary ? 1 : 0); }
    int vertex() const { return faces[0].vertices[0]; }
    /// Far end of edge j; edge `faces` is the last one of a boundary ring.
    int edge_to(int j) const
    {
        int const n = int(faces.size());
        if (boundary && j == n)
            return faces[std::size_t(n) - 1].vertices[faces[std::size_t(n) - 1].sides - 1];
        return faces[std::size_t(((j % n) + n) % n)].vertices[1];
    }
};

struct Neighbourhood {
    int sides = 4;
    int rotation = 0; ///< patch corner 0 is this corner of the face
    CornerNeighbourhood corner[4];
    std::vector<std::uint32_t> inputs; ///< global vertex of each local number
    std::string key;                   ///< equal for equal connectivity types
    /// Local numbers of the inputs, where they are too many to search.
    std::unordered_map<std::uint32_t, int> numbers;

    /// Ring start relative to the patch's face: ring edge 0 is edge `ring_shift[i]` of corner i's
    /// list.
    int ring_shift[4] = {};
};

/// The neighbourhood of a triangle or quad, rotated so that its corners' signatures are smallest.
/// \param out  reused from call to call
/// \cost  linear in the corners of the faces around
/// Throws LimitError for more than 65,535 inputs.
void find_neighbourhood(Topology const& topology, std::uint32_t face, Neighbourhood& out);

} // namespace tessemu
