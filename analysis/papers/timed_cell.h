// Times that papers print, predicted from counters: two numbers of a GPU are fitted to a table, the
// overhead of a frame and the rate of fetches; everything else is counted by the emulated pipeline
// or comes from the GPU's description.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/cost.h"

#include <span>

namespace tessemu {

/// A time that a paper gives, and what the same work counts here.
struct TimedCell {
    std::string model, scheme;
    int segments = 0; ///< along an edge of a patch
    double seconds = 0;
    double scale = 1; ///< of the counts, to the paper's number of patches
    DrawStatistics statistics = {};
};

/// Seconds that the cell's work takes on the GPU.
double predicted_seconds(GpuModel const& gpu, TimedCell const& cell);

/// Of fitted_to(): no cell.
inline constexpr std::size_t kNoCell = std::size_t(-1);

/// The GPU with overhead and any_fetch by least squares of the relative errors over the cells but
/// one. Throws Error where they come out below 0: the GPU does not fit the table.
///
/// A stage's memory traffic is on top of its fetches here, where predicted_seconds() takes the
/// longer of the two: only so is the sum linear in overhead and 1 / rate. Where no stage waits for
/// memory both agree; elsewhere this is near predicted_seconds()'s least squares, and not at them.
GpuModel fitted_to(std::span<TimedCell const> cells, GpuModel gpu, std::size_t left_out = kNoCell);

/// What was fitted, for a table's remarks.
std::string in_words_of_fit(GpuModel const& fitted);

} // namespace tessemu
