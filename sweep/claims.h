// Who works on which block of a sweep, among processes and hosts that share its folder.
//
// A claim is a file that exactly one process can make: claims/BLOCK.GENERATION, a link to a file that
// says which host and process made it; network file systems honour that too. The one of the
// highest generation holds. It has lapsed where its process is gone from the same host, or where
// another host has not touched it for a lease; then the next generation may be claimed. Nobody
// removes or renames another's claim, so there is no moment at which two hold one block.
//
// Static shards would need no claims; but who divides thousands of cases among hosts does not know
// which are slow, and a shard whose process dies is nobody's. Shards and claims can be combined.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace tessemu {

inline constexpr double kDefaultLease = 120; // seconds

class Claims {
public:
    /// Those of this process in `folder`, which must exist. A thread touches them four times a lease.
    explicit Claims(std::filesystem::path folder, double lease_seconds = kDefaultLease);
    /// Gives back what is left.
    ~Claims();
    Claims(Claims const&) = delete;

    /// Whether the block is now this process's. Throws WriteError where no claim can be made.
    bool take(std::size_t block);
    /// After the block's results can be seen by others.
    void give_back(std::vector<std::size_t> const& blocks);
    /// Removes claims of others that have lapsed, on blocks that need nobody any more.
    void clear_lapsed(std::function<bool(std::size_t block)> const& is_done);
    /// Who holds a block that take() did not give: "HOST, process 123".
    std::string holder(std::size_t block) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace tessemu
