// LOOP10's figure 4: the models, regular regions grey, extraordinary ones by valence.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

/// \param meshes    in the order of kLoop10Models
/// \param settings  the panels' size, machine, samples; patches get a tess factor for their size
PaperFigure reproduce_loop10_figure4(std::vector<ControlMesh> const& meshes,
                                     FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress);

} // namespace tessemu
