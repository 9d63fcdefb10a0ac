// LOOP10's figure 5: frames a second of four ways to draw four models on two GPUs.
//
// Frames are drawn and counted, and the counts put on the GPUs' descriptions; the step of
// subdivision is what the fit to table 1 says of it (table1.h). A factor counts segments on an edge
// of the model: where a curve takes k steps of subdivision, patches have the 2^k-th part of it, 1 at
// least.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/divergence.h"
#include "analysis/papers/loop10/claims.h"
#include "analysis/papers/loop10/table1.h"

#include <map>

namespace tessemu {

/// A curve: a scheme, by its name in the registry.
struct Figure5Scheme {
    char const* paper;
    char const* scheme;
    bool subdivided; ///< by as many steps as isolate the model's extraordinary vertices: either
                     ///< before the scheme, or the scheme's own
    bool own_steps;
};
/// In the places of kGregory1 to kBiseptic.
inline constexpr std::array<Figure5Scheme, kFigure5Curves> kFigure5Schemes{
    {{"Gregory1", "gregory-stencil", false, false},
     {"Gregory2", "gregory-stencil", true, false},
     {"Stam", "stam", true, true},
     {"Biseptic", "biseptic", true, true}}};

/// Turns of the loops of a mesh's kernels of subdivision, by the names of their dispatches.
using KernelTurns = std::map<std::string, LoopTurns>;

/// What frames counted, by the factor of a patch.
struct Figure5Counts {
    using Frames = ByFactor<std::vector<CommandStatistics>>;
    std::array<std::array<Frames, kFigure5Curves>, kFigure5Models> frames;
    std::array<Frames, kFigure5Models> sorted;        ///< Gregory2's, sorted by valence
    ByGpuModel<KernelTurns> turns, turns_when_sorted; ///< Gregory2's
};

/// What a frame's factors count segments of.
enum class FactorOf { Face, Patch };

/// \param fit  of what no counter has
Figure5Times figure5_times(Figure5Counts const& counts, std::vector<GpuModel> const& gpus,
                           SubdivisionFit const& fit, FactorOf factors);

/// \param meshes   in the order of kLoop10Models
/// \param gpus     Radeon HD 5870, GeForce GTX 480, of one vertex cache
/// \param picture  the frames' size and machine
PaperPlots reproduce_loop10_figure5(
    std::vector<ControlMesh> const& meshes, std::vector<GpuModel> const& gpus,
    FrameSettings const& picture, ThreadPool const& threads, PaperProgress const& progress,
    std::array<Figure5Scheme, kFigure5Curves> const& schemes = kFigure5Schemes);

} // namespace tessemu
