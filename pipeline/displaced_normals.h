// The displaced surface by its own normals, beside the smooth surface's, which draws hand on.
//
// Of p = S + h N, with N the smooth surface's true normal, the directions (1) and (2) of a patch
// give
//
//     p_1 x p_2 = (N . (a_1 x a_2)) N + h_2 (a_1 x N) + h_1 (N x a_2),     a_i = S_i + h N_i
//
// S_i and N_i are differences between points of the patch, exact for polynomials of degree 4 but
// for the points' roundings. h_i is the height map's own derivative. Where it jumps, as at a texel's
// centre, both sides' mean counts, and at a point that several patches have the mean of theirs, from
// each its own side: so all have the same bits. Where the tangents are parallel or zero, at a pole,
// N stays.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/frame.h"

namespace tessemu {

/// visit_surface() of a displaced surface with true normals, whose vertices have the displaced
/// surface's normal instead. Where the map is level, that is the smooth surface's, bit for bit. The
/// statistics are those of visit_surface(): differences are not counted.
///
/// Throws Error where the settings have no displacement.
/// \cost  draws twice, and 30 times the domain shader in all; memory for points on patches' edges
ListStatistics visit_displaced_surface(PatchMesh const& mesh, FrameSettings const& settings,
                                       ThreadPool const& threads, SurfaceVisitor const& visit);

} // namespace tessemu
