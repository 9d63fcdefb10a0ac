// BOLZ03 section 3.1: how many vertices a second, from the listings and the GPU that it describes.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"
#include "pipeline/mesh/mesh.h"

namespace tessemu {

/// A torus of so many faces around and along, from 3: every vertex has four.
ControlMesh torus_net(int around, int along);
/// So many quads around a vertex, from 3.
ControlMesh fan_net(int valence);

/// \param gpu  with issues of the pixel shader
PaperTable reproduce_bolz03_section3(GpuModel const& gpu, Machine const& machine,
                                     ThreadPool const& threads, PaperProgress const& progress);

} // namespace tessemu
