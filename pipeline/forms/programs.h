// Programs that schemes of one form share: compiled once, for the fast machine in programs_fast.cpp
// and for the checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/curvature.h"
#include "shaders_cpp/pole_normals.h"
#include "shaders_cpp/stencil_form/stencil_compute_shader.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"
#include "shaders_cpp/subdivision/catmull_clark_kernels.h"
#include "shaders_cpp/two_stage_form/by_corners.h"

namespace tessemu {

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_FORM_PROGRAMS(instantiate, T)                                                      \
    instantiate class DomainProgramOn<RegularQuadDomainShader, T>;                                 \
    instantiate class DomainProgramOn<CurvedSurface<RegularQuadDomainShader>, T>;                  \
    instantiate class DomainProgramOn<RegularCornersDomainShader, T>;                              \
    instantiate class HullProgramOn<StencilQuadHullShader<SummedRows<4>>, T>;                      \
    instantiate class HullProgramOn<StencilQuadHullShader<GatheredRows<4>>, T>;                    \
    instantiate class HullProgramOn<StencilTriHullShader<SummedRows<3>>, T>;                       \
    instantiate class HullProgramOn<StencilTriHullShader<GatheredRows<3>>, T>;                     \
    instantiate class ComputeProgramOn<StencilComputeShader, T>;                                   \
    instantiate class ComputeProgramOn<PoleNormalShader, T>;                                       \
    instantiate class ComputeProgramOn<FacePointShader, T>;                                        \
    instantiate class ComputeProgramOn<EdgePointShader, T>;                                        \
    instantiate class ComputeProgramOn<VertexPointShader, T>;                                      \
    instantiate class ComputeProgramOn<BlendedPointShader, T>;

TESSEMU_FORM_PROGRAMS(extern template, FastScalar)
TESSEMU_FORM_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
