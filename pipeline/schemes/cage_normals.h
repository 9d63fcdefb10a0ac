// The parameter "normals" of schemes in cage form.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/cage_form.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

/// Adds it; patches of faces' normals do not meet.
inline void add_normals_parameter(SchemeInfo& info)
{
    info.parameters.push_back({"normals",
                               "of a face's corners: their vertices', or the face's own",
                               0,
                               0,
                               0,
                               {"vertices", "faces"}});
    info.watertight_with.push_back({"normals", "vertices"});
}

inline CageNormals normals_of(Parameters const& parameters)
{
    return parameters.word("normals") == "faces" ? CageNormals::Faces : CageNormals::Vertices;
}

} // namespace tessemu
