// OBJ files with OpenSubdiv's tags.
//
// tinyobjloader parses the numbers; what it lets pass in silence (missing or odd coordinates, bad
// indices, cut lines, unknown tags) is found by a scan of the lines, which also knows their
// numbers.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/mesh.h"

#include <filesystem>
#include <string_view>

namespace tessemu {

struct ObjFile {
    ControlMesh mesh;
    std::vector<int> face_lines;       ///< where each face stands in the file
    std::vector<std::string> warnings; ///< with file name and line
};

/// Largest magnitude of a coordinate: the squared length of a normal, about its fourth power, must
/// stay within a 32-bit float.
inline constexpr float kMaxCoordinate = 1e9f;

/// Reads v, vt, f and t statements; everything else is skipped (unknown tags with a warning).
/// Vertices that no face uses stay. Where a corner's texture coordinates are missing or bad, the
/// mesh gets none, with a warning. Accepts Windows line ends, a byte order mark and line
/// continuations.
///
/// \param name  for messages and as the mesh's name
/// Throws FormatError with file and line for: a coordinate that is missing, not a number or
/// beyond kMaxCoordinate; an index of 0 or out of range; no face at all. Faces may be of any number
/// of vertices and meet in any way: see make_manifold.
ObjFile read_obj(std::string_view text, std::string const& name);
ObjFile read_obj_file(std::filesystem::path const& path);

} // namespace tessemu
