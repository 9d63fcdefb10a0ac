// From faces as a file has them to an oriented manifold.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/file_lines.h"
#include "pipeline/mesh/mesh.h"

namespace tessemu {

/// What was done to a mesh, in the file's numbers.
struct MeshRepairs {
    struct Count {
        std::size_t number = 0;
        std::uint32_t first = 0; ///< face or vertex, from 0

        void add(std::uint32_t where)
        {
            if (number++ == 0) first = where;
        }
    };
    Count repeated; ///< faces that named a vertex twice in a row, and lost the repetition
    Count dropped;  ///< faces with fewer than three vertices, or one vertex at two corners
    Count unused;   ///< vertices that no face has, left out
    Count cut;      ///< edges of more than two faces, or of two that run along it in one direction
    Count split;    ///< vertices whose faces form several fans: each fan has its own copy
};

struct ManifoldMesh {
    ControlMesh mesh;
    MeshRepairs repairs;
};

/// Makes any faces an oriented manifold, as OpenSubdiv takes them: an edge whose faces are not two
/// that run along it in opposite directions is infinitely sharp, so the mesh is cut there; so is a
/// vertex there, unless it lies inside a crease of just such edges.
///
/// Faces keep their order and vertices theirs; of a vertex's fans the one with the first corner
/// keeps the vertex, copies for the others follow all vertices, in the order of the vertices and
/// of the fans' first corners. Tags go to every copy. A mesh that needs nothing stays as it is.
///
/// \cost  linear in the corners, times a logarithm
/// Throws MeshError for a mesh of which no face is left.
ManifoldMesh make_manifold(ControlMesh mesh);

/// A line for each kind of repair, with its number and the first place.
std::vector<std::string> in_words(MeshRepairs const& repairs, FileLines const& lines = {});

} // namespace tessemu
