// Programs of Stam's evaluation and of the patches beside its own: compiled once, for the fast
// machine in programs_fast.cpp and for the checking machine in programs_check.cpp, so that two
// cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/schemes/gregory/programs.h"
#include "shaders_cpp/bezier_hull_shader.h"
#include "shaders_cpp/curvature.h"
#include "shaders_cpp/stam/stam_domain_shaders.h"
#include "shaders_cpp/stam/stam_hull_shader.h"
#include "shaders_cpp/stam/stam_projection_shader.h"

namespace tessemu {

/// Of a patch whose net comes from a buffer: the corners alone, for tess factors.
struct StamCorners {
    static constexpr int kPoints = 4;
    static constexpr int kCorners[4] = {0, 1, 2, 3};
};

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_STAM_PROGRAMS(instantiate, T)                                                      \
    instantiate class DomainProgramOn<StamPointsDomainShader, T>;                                  \
    instantiate class DomainProgramOn<StamBufferDomainShader, T>;                                  \
    instantiate class DomainProgramOn<StamSharedDomainShader, T>;                                  \
    instantiate class DomainProgramOn<CagedGregoryDomainShader, T>;                                \
    instantiate class DomainProgramOn<BsplineRowsDomainShader, T>;                                 \
    instantiate class DomainProgramOn<BsplineQuadDomainShader, T>;                                 \
    instantiate class DomainProgramOn<BezierQuadDomainShader, T>;                                  \
    instantiate class DomainProgramOn<CurvedSurface<StamPointsDomainShader>, T>;                   \
    instantiate class DomainProgramOn<CurvedSurface<StamBufferDomainShader>, T>;                   \
    instantiate class DomainProgramOn<CurvedSurface<StamSharedDomainShader>, T>;                   \
    instantiate class DomainProgramOn<CurvedSurface<BsplineRowsDomainShader>, T>;                  \
    instantiate class DomainProgramOn<CurvedSurface<BsplineQuadDomainShader>, T>;                  \
    instantiate class DomainProgramOn<CurvedSurface<BezierQuadDomainShader>, T>;                   \
    instantiate class HullProgramOn<StamHullShader<SummedRows<4>>, T>;                             \
    instantiate class HullProgramOn<NetHullShader<StamCorners>, T>;                                \
    instantiate class HullProgramOn<CagedStencilHullShader<SummedRows<4>>, T>;                     \
    instantiate class HullProgramOn<CagedStencilHullShader<GatheredRows<4>>, T>;                   \
    instantiate class HullProgramOn<BsplineQuadHullShader, T>;                                     \
    instantiate class HullProgramOn<BezierHullShader, T>;                                          \
    instantiate class ComputeProgramOn<StamProjectionShader, T>;

TESSEMU_STAM_PROGRAMS(extern template, FastScalar)
TESSEMU_STAM_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
