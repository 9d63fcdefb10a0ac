// The Direct3D 10 path of any scheme (LOOP09 section 5): without hull shader, tessellator and
// domain shader.
//
// A geometry shader does the hull shader's work and streams the control points out. A second draw
// has a refinement pattern as its vertices (Boubekeur and Schlick's kernel), the tessellator's
// domain points for one uniform factor or a uniform grid, and an instance for each patch: its
// vertex shader does the domain shader's work and loads control points from the streamed buffer.
// The programs are the scheme's own, so the surface has the same bits.
//
// Two liberties: the first draw has patch lists, which Direct3D 11 gives to geometry shaders
// and Direct3D 10 did not have, where the vertices would come by adjacency or from a buffer; and
// control points and patch constants go to a stream each.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"

namespace tessemu {

/// Every draw of tessellated patches by two: the first fills buffers with control points, the
/// second shows the patches. Other commands stay.
///
/// \param settings  that the list was made with; factors must be uniform, or Error is thrown
/// \cost            memory for all control points
CommandList instanced(CommandList list, SurfaceSettings const& settings);

} // namespace tessemu
