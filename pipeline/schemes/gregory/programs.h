// Programs of Gregory patches: compiled once, for the fast machine in programs_fast.cpp and for the
// checking machine in programs_check.cpp, so that two cores share the work.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/forms/programs.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/gregory/corner_domain_shaders.h"
#include "shaders_cpp/gregory/corner_hull_shader.h"
#include "shaders_cpp/gregory/ring_vertex_shader.h"
#include "shaders_cpp/gregory/ring_window_shader.h"

namespace tessemu {

/// Of both forms.
std::vector<SchemeParameter> gregory_parameters();
/// SchemeInfo::no_curvature
inline constexpr char const* kNoGregoryCurvature =
    "its irregular patches are rational and share the tangent plane alone with their neighbours, "
    "so curvature jumps at their edges";

/// All of them for a machine's scalar T; `instantiate` is template, or extern template.
#define TESSEMU_GREGORY_PROGRAMS(instantiate, T)                                                   \
    instantiate class DomainProgramOn<GregoryQuadDomainShader, T>;                                 \
    instantiate class DomainProgramOn<GregoryTriangleDomainShader, T>;                             \
    instantiate class DomainProgramOn<GregoryQuadCornersDomainShader, T>;                          \
    instantiate class DomainProgramOn<GregoryTriangleCornersDomainShader, T>;                      \
    instantiate class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 4>, T>;              \
    instantiate class HullProgramOn<CornerHullShader<TessellatorDomain::Quad, 5>, T>;              \
    instantiate class HullProgramOn<CornerHullShader<TessellatorDomain::Tri, 5>, T>;               \
    instantiate class VertexProgramOn<RingVertexShader<>, T>;                                      \
    instantiate class ComputeProgramOn<RingWindowShader, T>;

TESSEMU_GREGORY_PROGRAMS(extern template, FastScalar)
TESSEMU_GREGORY_PROGRAMS(extern template, CheckScalar)

} // namespace tessemu
