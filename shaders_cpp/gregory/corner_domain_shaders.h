// Domain shaders of Gregory patches in the two-stage form.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/domain_shaders.h"
#include "shaders_cpp/two_stage_form/by_corners.h"

namespace tessemu {

using GregoryQuadCornersDomainShader = WatertightPatch<ByCorners<GregoryQuadInside, 5>>;
using GregoryTriangleCornersDomainShader = WatertightPatch<ByCorners<GregoryTriangleInside, 5>>;

} // namespace tessemu
