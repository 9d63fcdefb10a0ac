// Models by name or path, as the command line takes them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/obj_reader.h"

namespace tessemu {

struct Model {
    ControlMesh mesh;
    std::string name;   ///< file name without its folder, or the built-in's name
    std::string sha256; ///< of the OBJ text
    std::vector<int> face_lines;
    std::vector<std::string> warnings;

    std::string path; ///< as given, for messages

    int line_of_face(std::size_t face) const
    {
        return face < face_lines.size() ? face_lines[face] : 0;
    }
};

/// A file if there is one, else a built-in cage. Throws FormatError; for a name that is neither it
/// lists the built-ins.
Model load_model(std::string const& path_or_name);

} // namespace tessemu
