// LOOP09's figures with other cages: 1, 3, 9, 10, 11, 12.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/error_view.h"
#include "analysis/papers/paper.h"

namespace tessemu {

/// `settings` gives the panels' size, machine, tess factor.
///
/// 1, 9: control mesh, patches, surface, displaced surface, a row for each mesh. 12: the first
/// three of them, a column for each mesh. 10: a close-up of the first mesh. 11: errors of ACC, Pm
/// and Gregory patches on the first mesh. 3: the tessellator's patterns, no mesh.
///
/// \param meshes  quads and triangles; 11: closed, quads
/// Throws Error for a figure that there is not.
PaperFigure reproduce_loop09_figure(int number, std::vector<ControlMesh> const& meshes,
                                    FrameSettings const& settings, ThreadPool const& threads,
                                    PaperProgress const& progress);

} // namespace tessemu
