// Programs of the patches beside those at isolated extraordinary vertices: compiled once, for the
// fast machine in programs_fast.cpp and for the checking machine in programs_check.cpp, so that two
// cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/schemes/gregory/programs.h"
#include "shaders_cpp/bezier_hull_shader.h"
#include "shaders_cpp/curvature.h"
#include "shaders_cpp/isolated/domain_shaders.h"
#include "shaders_cpp/isolated/net_hull_shaders.h"

namespace tessemu {

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_ISOLATED_PROGRAMS(instantiate, T)                                                  \
    instantiate class DomainProgramOn<CagedGregoryDomainShader, T>;                                \
    instantiate class DomainProgramOn<BsplineRowsDomainShader, T>;                                 \
    instantiate class DomainProgramOn<BsplineQuadDomainShader, T>;                                 \
    instantiate class DomainProgramOn<BezierQuadDomainShader, T>;                                  \
    instantiate class HullProgramOn<CagedStencilHullShader<SummedRows<4>>, T>;                     \
    instantiate class HullProgramOn<CagedStencilHullShader<GatheredRows<4>>, T>;                   \
    instantiate class HullProgramOn<BsplineQuadHullShader, T>;                                     \
    instantiate class HullProgramOn<BezierHullShader, T>;

/// Those with second derivatives, for the curvature view: a compilation of their own.
#define TESSEMU_ISOLATED_CURVED_PROGRAMS(instantiate, T)                                           \
    instantiate class DomainProgramOn<CurvedSurface<BsplineRowsDomainShader>, T>;                  \
    instantiate class DomainProgramOn<CurvedSurface<BsplineQuadDomainShader>, T>;                  \
    instantiate class DomainProgramOn<CurvedSurface<BezierQuadDomainShader>, T>;

TESSEMU_ISOLATED_PROGRAMS(extern template, FastScalar)
TESSEMU_ISOLATED_PROGRAMS(extern template, CheckScalar)
TESSEMU_ISOLATED_CURVED_PROGRAMS(extern template, FastScalar)
TESSEMU_ISOLATED_CURVED_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
