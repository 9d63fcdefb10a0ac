// LOOP10's figure 2: the tables of subdivision of its pyramid.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

/// Figure 1's control mesh; the figure's numbers are its vertices'.
ControlMesh loop10_pyramid();
/// Every number that the figure prints beside the one that our tables hold.
PaperTable reproduce_loop10_figure2();

} // namespace tessemu
