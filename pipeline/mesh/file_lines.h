// Where a mesh stands in its file, for messages.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tessemu {

struct FileLines {
    std::string file;                 ///< as the user named it; empty: the mesh is of no file
    std::vector<int> faces, vertices; ///< counted from 1, by their numbers in the file

    int line_of_face(std::size_t face) const { return face < faces.size() ? faces[face] : 0; }
    /// "cage.obj:12: ", or nothing where the line is not known
    std::string before_face(std::size_t face) const { return before(faces, face); }
    std::string before_vertex(std::size_t vertex) const { return before(vertices, vertex); }

private:
    std::string before(std::vector<int> const& lines, std::size_t i) const
    {
        return i < lines.size() ? file + ":" + std::to_string(lines[i]) + ": " : "";
    }
};

} // namespace tessemu
