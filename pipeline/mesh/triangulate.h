// A mesh of triangles of any mesh, for schemes that take nothing else.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/mesh.h"

namespace tessemu {

struct TriangulatedMesh {
    ControlMesh mesh;
    std::size_t cut_faces = 0;   ///< that were no triangles
    std::uint32_t first_cut = 0; ///< of them, by its number in the file
};

/// Cuts faces of more than three sides by the diagonals from their first vertices, or from the
/// first other one whose diagonals are no edges yet: two faces may have the same. Tags stay, a
/// hole's triangles are holes, and each triangle keeps its face's number in the file.
/// \cost  linear in the corners of faces
TriangulatedMesh triangulate(ControlMesh mesh);

} // namespace tessemu
