// Lanes lost to divergence: threads that run in step wait for the one with the longest loop.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/subdivision_tables.h"

namespace tessemu {

/// Threads that run in step, one instruction for all: LOOP10's two cards.
inline constexpr int kWarpOfGtx480 = 32, kWavefrontOfRadeon5870 = 64;

/// Turns of a kernel's loop, of all its threads together.
struct LoopTurns {
    std::uint64_t needed = 0; ///< each thread's own
    std::uint64_t run = 0;    ///< with those in which it waits

    /// The share of lanes that do nothing: 0 to 1.
    double lost() const { return run ? double(run - needed) / double(run) : 0; }
    LoopTurns& operator+=(LoopTurns const& o)
    {
        needed += o.needed, run += o.run;
        return *this;
    }
    friend bool operator==(LoopTurns const&, LoopTurns const&) = default;
};

/// Of a step's kernels that loop. A turn is an entry of a face's row, a pair of entries of a
/// vertex's, a term of a blended point. A vertex of valence 1 takes the other side of a branch, in
/// one turn; where threads of both sides are in one group, all run both. One of valence 0 needs
/// none.
struct StepDivergence {
    LoopTurns face_points, vertex_points, blended_points;
};

/// From the tables alone: what a machine with groups of `width` threads in step makes of them. The
/// threads of an incomplete group that have no point are none. \cost linear in the points
/// Throws Error for a width below 1.
StepDivergence divergence(SubdivisionTables const& tables, int width);

} // namespace tessemu
