// Programs of biseptic patches: compiled once, for the fast machine in programs_fast.cpp and for the
// checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/schemes/isolated/programs.h"
#include "shaders_cpp/biseptic/biseptic_domain_shaders.h"

namespace tessemu {

using BisepticHullShader =
    PackedHullShader<DenseNetHullShader<SummedRows<4>>, BisepticInside::kPacked>;
using BisepticRowsHullShader =
    PackedHullShader<StencilQuadHullShader<SummedRows<4>>, BisepticRowsInside::kPacked>;

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_BISEPTIC_PROGRAMS(instantiate, T)                                                  \
    instantiate class DomainProgramOn<BisepticDomainShader, T>;                                    \
    instantiate class DomainProgramOn<BisepticRowsDomainShader, T>;                                \
    instantiate class HullProgramOn<BisepticHullShader, T>;                                        \
    instantiate class HullProgramOn<BisepticRowsHullShader, T>;

/// Those with second derivatives, for the curvature view: a compilation of their own.
#define TESSEMU_BISEPTIC_CURVED_PROGRAMS(instantiate, T)                                           \
    instantiate class DomainProgramOn<CurvedSurface<BisepticDomainShader>, T>;                     \
    instantiate class DomainProgramOn<CurvedSurface<BisepticRowsDomainShader>, T>;

TESSEMU_BISEPTIC_PROGRAMS(extern template, FastScalar)
TESSEMU_BISEPTIC_PROGRAMS(extern template, CheckScalar)
TESSEMU_BISEPTIC_CURVED_PROGRAMS(extern template, FastScalar)
TESSEMU_BISEPTIC_CURVED_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
