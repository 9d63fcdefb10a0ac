// Programs of Stam's evaluation: compiled once, for the fast machine in programs_fast.cpp and for
// the checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/schemes/isolated/programs.h"
#include "shaders_cpp/stam/stam_domain_shaders.h"
#include "shaders_cpp/stam/stam_projection_shader.h"

namespace tessemu {

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_STAM_PROGRAMS(instantiate, T)                                                      \
    instantiate class DomainProgramOn<StamPointsDomainShader, T>;                                  \
    instantiate class DomainProgramOn<StamBufferDomainShader, T>;                                  \
    instantiate class DomainProgramOn<StamSharedDomainShader, T>;                                  \
    instantiate class HullProgramOn<DenseNetHullShader<SummedRows<4>>, T>;                         \
    instantiate class HullProgramOn<NetHullShader<CornersAlone>, T>;                               \
    instantiate class ComputeProgramOn<StamProjectionShader, T>;

/// Those with second derivatives, for the curvature view: a compilation of their own.
#define TESSEMU_STAM_CURVED_PROGRAMS(instantiate, T)                                               \
    instantiate class DomainProgramOn<CurvedSurface<StamPointsDomainShader>, T>;                   \
    instantiate class DomainProgramOn<CurvedSurface<StamBufferDomainShader>, T>;                   \
    instantiate class DomainProgramOn<CurvedSurface<StamSharedDomainShader>, T>;

TESSEMU_STAM_PROGRAMS(extern template, FastScalar)
TESSEMU_STAM_PROGRAMS(extern template, CheckScalar)
TESSEMU_STAM_CURVED_PROGRAMS(extern template, FastScalar)
TESSEMU_STAM_CURVED_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
