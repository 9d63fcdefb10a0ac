// Control meshes as .obj, with OpenSubdiv's tags, or as .ply.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/mesh_writer.h"
#include "pipeline/mesh/mesh.h"

namespace tessemu {

/// Writes a mesh in its own numbers.
///
/// OBJ: v, vt where there are texture coordinates, f, and for each tag that is not the default a
/// `t` line: crease, corner, hole, interpolateboundary, creasemethod, smoothtriangles. Digits are
/// as many as bring back the same bits: read_obj gives the same mesh. Whether the faces at an edge
/// share it no OBJ says; a cut between two faces that have both vertices is its crease alone. PLY:
/// binary little endian, positions and faces alone, see left_out_of_ply().
///
/// Of a mesh that was moved or scaled positions are the file's, in double, as MeshWriter has them.
///
/// \param out       by its extension, see mesh_format(); the caller commits
/// \param progress  lines or records written, of all
/// Throws WriteError for another extension, and as bytes are lost.
void write_control_mesh(ControlMesh const& mesh, OutputFile& out, Placement const& placement = {},
                        DrawProgress const& progress = {});

/// What a PLY of the mesh lacks, in the user's words: "12 creases and 3 holes"; empty: nothing.
std::string left_out_of_ply(ControlMesh const& mesh);

/// Adds a mesh's bytes to a hash, little endian: each position as a PLY has it, then of each face
/// the number of its vertices and the vertices, as 32-bit integers.
void add_to_hash(ControlMesh const& mesh, Placement const& placement, Sha256& hash);

} // namespace tessemu
