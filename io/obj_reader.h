// OBJ files with OpenSubdiv's tags.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/file_lines.h"
#include "pipeline/mesh/mesh.h"
#include "pipeline/mesh/placement.h"
#include "pipeline/mesh/warnings.h"

#include <string_view>

namespace tessemu {

struct ObjFile {
    ControlMesh mesh;
    Placement placement; ///< of the mesh in the file
    FileLines lines;
    std::vector<std::string> warnings; ///< with file name and line, by line
};

/// Largest magnitude of a vertex's coordinate, and of a texture coordinate.
inline constexpr double kMaxCoordinate = Placement::kLargest;
inline constexpr float kMaxTextureCoordinate = 1e9f;

/// Reads v, vt, f and t statements. Every other line is either without meaning for a surface
/// (names, materials, normals, comments) or told in a warning: lines, points, free-form curves and
/// surfaces, colours and weights of vertices, statements that no OBJ file has, tags that are not
/// honoured. Like warnings are counted and name the first line.
///
/// Coordinates are read in double; the mesh, placed by the vertices of its faces, has them in
/// single precision, rounded once. Of a mesh that is moved a warning says where a double, or
/// the file's format, has lost digits that are more than a thousandth of an edge. A format has
/// where its numbers have at most 6 to 14 significant digits, as of %g, and not where they are
/// whole or have a fixed number of decimals, which may be all there is to say.
///
/// Lines end with LF, CR LF or CR; one that is read goes on after a backslash, a name or a comment
/// does not. A UTF-8 byte order mark is skipped. Vertices that no face uses stay. A vt may have one
/// number, then v is 0. Where a corner's texture coordinates are missing or bad the mesh gets none,
/// with a warning.
///
/// Tags are read as those of OpenSubdiv's regression shapes: the integers of a crease are pairs,
/// with one sharpness for all, one for each pair, or one for each integer; of tags about the same
/// edge, vertex or rule the last holds; a sharpness below 0 is 0.
///
/// \param name  for messages and as the mesh's name
/// \param sink  hears the warnings too, those before an error before it is thrown
/// Throws FormatError with file and line for: text that is binary or UTF-16; a coordinate that is
/// missing, not a finite decimal number or beyond kMaxCoordinate; a vertex index of 0 or out of
/// range; no face at all; faces of no extent, or of one that a Placement refuses. Faces may be of
/// any number of vertices and meet in any way: see make_manifold.
ObjFile read_obj(std::string_view text, std::string const& name, WarningSink const& sink = {});

} // namespace tessemu
