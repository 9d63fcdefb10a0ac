// Vertices that lie on each other, as where a file gives every face vertices of its own.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/placement.h"
#include "pipeline/mesh/topology.h"

namespace tessemu {

/// What joining did, in the file's numbers, from 0.
struct VertexJoin {
    std::size_t joined = 0;            ///< vertices that have become another
    std::uint32_t first = 0, into = 0; ///< the first of them, and what it became
    std::size_t collapsed = 0;         ///< faces that have fewer vertices now
    std::uint32_t first_collapsed = 0;
};

struct JoinedMesh {
    ControlMesh mesh;
    VertexJoin join;
};

/// Joins vertices: two that lie within `distance` become one, and so does a chain of them. The one
/// of the lowest number stays, where it lies. Faces, tags and texture coordinates follow; of
/// several creases on an edge, or corners on a vertex, the sharpest stays, and a crease between two
/// vertices that are one goes.
///
/// \param distance  in the file's units, which messages have too; 0 joins equal positions
/// \cost  n log n for positions that do not crowd within the distance
/// Throws Error for a distance below 0 or NaN, MeshError where no face would be left.
JoinedMesh join_vertices(ControlMesh mesh, double distance, Placement const& placement = {});

/// A line for each thing that was done.
std::vector<std::string> in_words(VertexJoin const& join, double distance);

/// Edges with one face that lie on each other with different vertices of the file: where a surface
/// looks closed and is not.
struct Seams {
    std::size_t edges = 0;
    double apart = 0; ///< joining within this distance closes them
};
/// \param within  how far vertices may lie apart
Seams find_seams(Topology const& topology, double within);
/// Within a millionth of the mesh's diagonal.
Seams find_seams(Topology const& topology);

} // namespace tessemu
