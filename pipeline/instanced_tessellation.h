// The Direct3D 10 path of any scheme (LOOP09 section 5): without hull shader, tessellator and
// domain shader.
//
// A geometry shader does the hull shader's work and streams the control points out. A second draw
// has a refinement pattern as its vertices, the tessellator's domain points for one uniform factor
// (Boubekeur and Schlick's kernel), and an instance for each patch: its vertex shader does the
// domain shader's work and loads control points from the streamed buffer. The programs are the
// scheme's own, so the surface has the same bits.
//
// Two liberties: the first draw has patch lists, which Direct3D 11 gives to geometry shaders
// and Direct3D 10 did not have, where the vertices would come by adjacency or from a buffer; and
// control points and patch constants go to a stream each.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/technique.h"

namespace tessemu {

/// The same patches by two draws: the first in `prepare`, the second the pass's own.
///
/// \param pass      of a technique
/// \param settings  that it was made with; factors must be uniform, or Error is thrown
/// \cost            memory for all control points of the pass
DrawPass instanced(DrawPass pass, PassSettings const& settings);

} // namespace tessemu
