// Running what of a sweep is not there yet.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sweep/claims.h"
#include "sweep/manifest.h"

namespace tessemu {

/// Of a shard's cases, or of all.
struct SweepState {
    std::size_t cases = 0, done = 0, failed = 0;
    std::size_t computed = 0; ///< by this run
    std::size_t open() const { return cases - done - failed; }
};

struct SweepProgress {
    SweepState state;
    std::string waits_for = {}; ///< who computes all that is left; empty: nobody
};

struct SweepRunSettings {
    Shard shard = {};
    int workers = 1; ///< cases at a time
    double lease = kDefaultLease;
    bool retry = false; ///< cases that failed before, too
    /// A case's result as JSON (io/report.h). What it throws becomes the case's message. From any
    /// worker.
    std::function<std::string(SweepCase const&)> run_case;
    /// From any worker, one at a time; may be empty.
    std::function<void(SweepProgress const&)> progress = {};
};

/// Runs the shard's cases that nobody has run; waits for those that others are at, and takes them
/// over where their claims lapse. Throws WriteError.
SweepState run_sweep(SweepManifest const& manifest, std::filesystem::path const& folder,
                     SweepRunSettings const& settings);

/// What there is.
SweepState sweep_state(SweepManifest const& manifest, std::filesystem::path const& folder,
                       Shard const& shard = {});

} // namespace tessemu
