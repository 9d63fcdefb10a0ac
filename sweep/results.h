// What runs of a sweep have found: a file for each run, a line for each case, whole or not there.
//
//     {"case":"HASH","status":"done","result":{...}}
//     {"case":"HASH","status":"failed","message":"..."}
//
// A line that a killed run did not end is none. So a sweep of any size leaves as many files as runs
// took part, each written from its begin to its end.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tessemu {

struct CaseRecord {
    std::string id;
    bool done = false; ///< or failed
    std::string text;  ///< the result as JSON; or the message
};

struct SweepManifest;
/// Cases that have failed and were not done since, in the manifest's order.
std::vector<CaseRecord> failures(SweepManifest const& manifest,
                                 std::filesystem::path const& folder);

/// A run's own file. Thread-safe.
class ResultLog {
public:
    /// The file is made with the first record, under a name that no other run has.
    explicit ResultLog(std::filesystem::path folder);
    ~ResultLog();
    ResultLog(ResultLog const&) = delete;

    /// Throws WriteError.
    void add(CaseRecord const& record);
    /// Others see what was added.
    void flush();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// All runs' files, read as they grow.
class ResultReader {
public:
    explicit ResultReader(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Records since the last call, run by run in the order of their files' names. Throws FormatError
    /// for a line that is none.
    void read(std::function<void(CaseRecord const& record)> const& take);
    /// The same without results.
    void read_states(std::function<void(std::string const& id, bool done)> const& take);

private:
    void
    read_lines(std::function<void(std::string_view line, std::string const& file)> const& take);

    std::filesystem::path folder_;
    std::map<std::string, std::uint64_t> read_; ///< bytes by file
};

} // namespace tessemu
