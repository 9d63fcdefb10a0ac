// A sweep as jobs of Slurm: an array whose tasks run cases until none is left, and a last job that
// merges.
//
// Tasks are no shards. Each takes what nobody is at (sweep/claims.h), so none is done long before the
// others, and what a killed task was at is another's a lease later, or at once on the same host.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tessemu {

struct SlurmJob {
    std::filesystem::path program; ///< absolute, as the nodes see it
    std::filesystem::path folder;  ///< the sweep's, absolute
    std::size_t tasks = 1;
    std::filesystem::path table;      ///< of the merge, absolute; empty: none
    std::vector<std::string> options; ///< of sbatch: "--time=1:00:00"
};

/// The array's batch script.
std::string slurm_array_script(SlurmJob const& job);
/// The last job's.
std::string slurm_merge_script(SlurmJob const& job);

} // namespace tessemu
