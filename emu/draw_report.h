// From what a draw counted to its statistics.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/raster_stages.h"

namespace tessemu {

/// Counts of all chunks and instances.
struct DrawCounters {
    StageCounters vertex, hull, domain, geometry;
    std::uint64_t tessellated_points = 0, tessellated_indices = 0;
};

/// A draw that has run.
struct DrawnParts {
    GraphicsPipelineDesc const& pipeline;
    DrawCall const& call;
    AssembledPrimitives const& primitives;
    FrontEnd const& front_end;
    StageBuffers const& vertex_buffers;
    RasterStages const* raster;        ///< null: rasterization was off
    StreamOutput const* stream_output; ///< null: there is none
    DrawCounters const& counters;
};

/// Adds the rows of all stages that ran, and what pipeline statistics follow from them.
void report_draw(DrawnParts const& draw, DrawStatistics& out);

} // namespace tessemu
