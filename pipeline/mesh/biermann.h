// What Biermann's rules want to know of a cage before its first step: whether they apply to it, and
// which sectors of its sharp corners are concave (docs/math/subdivision.md, 5.2).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"

namespace tessemu {

/// Throws MeshError that names the first edge or vertex whose sharpness is finite, which these
/// rules do not know. A crease on the boundary counts as infinite, as everywhere.
void check_sharpness_for_biermann(ControlMesh const& mesh);

/// Corners whose faces surround more than half a circle.
struct ConcaveSectors {
    std::uint32_t several_faces = 0;                ///< marked
    std::uint32_t one_face = 0;                     ///< not marked: a face alone is taken as convex
    std::uint32_t first_vertex = 0, first_face = 0; ///< of those of one face, in the mesh
};

/// Fills ControlMesh::concave: sectors of sharp corners, between two infinitely sharp edges that
/// follow each other (a boundary's are), whose face angles sum to more than pi. Angles within 2^-20
/// of it are taken as pi, for positions are single precision; a face's angle is more than pi where
/// the face turns the other way there than on the whole.
///
/// \cost  linear in the corners of faces
ConcaveSectors mark_concave_sectors(ControlMesh& mesh);

/// "2 corners of one face turn by more than half a circle ..."; nothing where there is none.
std::vector<std::string> in_words(ConcaveSectors const& sectors, ControlMesh const& mesh);

} // namespace tessemu
