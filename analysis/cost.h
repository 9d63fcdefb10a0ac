// From what a draw counted to the time it would take on a GPU.
//
// A stage of shaders takes the time of its arithmetic and, after it, of its fetches, or that of its
// memory traffic where that is longer; all such stages share the GPU's processors, so their times
// add up. Tessellator, set-up and rasterizer work beside them. The draw takes as long as the
// slowest of these, and the GPU's overhead.
//
// A fetch brings up to 16 bytes: a record counts in whole ones; scalars of a buffer, which
// neighbouring invocations read one after the other, share them (LOOP09 4.3 packs its stencils in a
// texture). Of buffers and textures memory sees every element once, and again the part of the
// repeated reads that the cache has no room for.
//
// A hull shader's groups do not span patches, so lanes idle. How many, each draw of a frame says
// for itself, for draws differ in control points; all else of a frame is costed as one draw.
//
// GPUs whose shaders are assembly issue instructions of several components: products with the sums
// that they feed, so many scalars at once, and one for each texel. Their fragments run in batches
// which draws cannot share, so places idle: of each draw for itself. Where the GPU says so, a draw
// into a target of its own switches to it, and the target travels to the CPU and, as vertices,
// back; these work beside the shaders, as does the bus for what the CPU makes.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/gpu_model.h"
#include "pipeline/commands/command_list.h"

#include <map>
#include <span>

namespace tessemu {

/// Seconds, by resource; and what they come from.
struct StageCost {
    std::string stage;
    double arithmetic = 0, fetch = 0, memory = 0, fixed = 0;
    double operations = 0, fetches = 0, fetched_bytes = 0, memory_bytes = 0;

    double seconds() const { return fixed + std::max(arithmetic + fetch, memory); }
    /// "arithmetic", "fetch", "memory", "rate" of a fixed-function stage, or "-" for no time at
    /// all.
    std::string bound() const;
};

struct DrawCost {
    std::vector<StageCost> stages;
    double shaders = 0; ///< sum over the shader stages
    double seconds = 0; ///< with the overhead
    std::string bound;  ///< the stage that the draw waits for
};
/// What the draw waits for: "vertex shader, fetch", "tessellator", "memory".
std::string in_words(DrawCost const& cost);

/// \param statistics  of a draw, or of several with the same patches added up
/// Throws Error for a stage that the GPU lacks.
DrawCost estimate_cost(GpuModel const& gpu, DrawStatistics const& statistics);
/// Of a frame's commands, with the overhead once.
DrawCost estimate_cost(GpuModel const& gpu, std::span<CommandStatistics const> commands);

/// The share of places in batches of fragments that have one.
///
/// \param draws  how many, by their fragments
double utilisation(GpuModel const& gpu, std::map<std::uint64_t, std::uint64_t> const& draws);

/// Fetches of up to 16 bytes.
double fetch_count(FetchStatistics const& f);

} // namespace tessemu
