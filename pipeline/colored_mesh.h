// Triangles and lines with colours of their own, through vertex and pixel shader: control meshes
// and figures.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/frame.h"

namespace tessemu {

struct ColoredMesh {
    std::vector<float> vertices; ///< position, normal, colour: nine floats each
    std::vector<std::uint32_t> triangles, lines;

    std::uint32_t add(glm::vec3 position, glm::vec3 normal, std::array<float, 3> color);
};

/// A control mesh: flat faces by kind, regular quads, irregular quads, triangles and others in the
/// colours of the patches view, and its edges. Faces with more than three sides are fans.
ColoredMesh control_mesh_picture(Topology const& topology);

/// Draws into a cleared frame of the same size; the lines lie over the triangles.
/// \param ambient  0 to 1: how bright a surface is that is seen edge on
void draw_colored_mesh(ColoredMesh const& mesh, FrameSettings const& settings, float ambient,
                       ThreadPool const& threads, Frame& frame);

} // namespace tessemu
