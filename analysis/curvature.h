// How curved a surface is, for the range of the curvature view's colours.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/frame.h"

namespace tessemu {

/// The mean curvature, in size, that 99 % of the drawn area stays at or below: 1/length in object
/// space. At least 0.01 / diagonal of the mesh at rest, which is next to flat: what a flat surface
/// has is rounding. Patches without second derivatives take no part. Throws Error for a displaced
/// surface.
///
/// \param settings  tess factors, pose and machine; the samples are the domain points
double curvature_range(PatchMesh const& patches, FrameSettings settings, ThreadPool const& threads);

/// How many patches have no second derivatives, of a scheme that has curvature to show.
std::size_t patches_without_curvature(PatchMesh const& patches);

} // namespace tessemu
