// Models by name or path, as the command line takes them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/obj_reader.h"

namespace tessemu {

struct Model {
    ControlMesh mesh;
    Placement placement; ///< of the mesh in its file
    std::string name;    ///< file name without its folder, or the built-in's name; "-"
    std::string sha256;  ///< of the OBJ text
    FileLines lines;     ///< its file as given; "standard input"
    std::vector<std::string> warnings;
};

/// "-" is standard input; else a file if there is one, else a built-in cage. Throws FormatError;
/// for a name that is neither it lists the built-ins.
/// \param sink  hears the warnings as read_obj does
Model load_model(std::string const& path_or_name, WarningSink const& sink = {});

} // namespace tessemu
