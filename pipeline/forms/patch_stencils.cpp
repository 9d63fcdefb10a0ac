// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/patch_stencils.h"

namespace tessemu {

std::vector<VertexStencils> corners_of(Neighbourhood const& patch, bool smooth_corners)
{
    std::vector<VertexStencils> out;
    for (int i = 0; i < patch.sides; ++i)
        out.emplace_back(patch.corner[i], int(patch.inputs.size()), smooth_corners);
    return out;
}

} // namespace tessemu
