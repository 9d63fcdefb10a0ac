// The plan of a sweep: a folder that holds its inputs and the list of its cases.
//
//     DIR/manifest.jsonl   a line about the sweep, then a line for each case
//     DIR/sweep.json       the user's file
//     DIR/inputs/HASH/     models, height maps and GPU files, each under its own name
//     DIR/results/         what runs have found (sweep/results.h)
//     DIR/claims/          who works on what, while runs last (sweep/claims.h)
//
// A case is named by the SHA-256 of its options, those not given too, of its inputs' bytes and of
// the program's version. The folder needs nothing outside of it: it can be moved, copied, kept.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sweep/sweep_file.h"

#include <filesystem>

namespace tessemu {

/// A file that cases read.
struct SweepInput {
    std::string name;   ///< without its folder
    std::string path;   ///< in the sweep's folder: what stands in a case's options
    std::string sha256; ///< of its bytes
};

struct SweepCase {
    std::string id; ///< 64 hexadecimal digits
    CaseOptions options;

    /// Of an option that is there.
    std::string const& text(std::string const& option) const { return options.at(option).at(0); }
};

struct SweepManifest {
    std::string version, verb;
    CaseOptions defaults; ///< of options that a case may leave out
    std::vector<SweepInput> inputs;
    std::vector<SweepCase> cases;
    std::size_t per_block = 1; ///< cases that one run takes at a time

    std::size_t blocks() const { return (cases.size() + per_block - 1) / per_block; }
    /// The case's options and the defaults of others.
    CaseOptions resolved(SweepCase const& c) const;
    /// The input that a text of options names, or null.
    SweepInput const* input(std::string const& text) const;
};

/// Where an option's text names a file, its name and bytes; a word that the verb knows, none.
using FindInput = std::function<std::optional<std::pair<std::string, std::string>>(
    std::string const& option, std::string const& text)>;

struct SweepPlan {
    SweepManifest manifest;
    std::vector<std::string> bytes; ///< of inputs
    std::size_t repeated = 0;       ///< cases that were there already, and left out
};
/// \cost  some microseconds a case; each input is read once
SweepPlan plan_sweep(Sweep const& sweep, SweepVerb const& verb, std::string const& version,
                     FindInput const& find_input);

/// Writes the folder, the manifest last, so that what has one is whole. Throws WriteError; Error for
/// a folder that holds another sweep, or anything that is none.
///
/// \param sweep_file  the user's text, kept beside the manifest
void write_plan(SweepPlan const& plan, std::filesystem::path const& folder,
                std::string const& sweep_file);

/// Throws FormatError for a folder without a manifest, or with one that is damaged.
SweepManifest read_manifest(std::filesystem::path const& folder);

/// Throws FormatError where a case's options are not those that it is named by.
/// \cost  some microseconds a case
void check_ids(SweepManifest const& manifest, std::filesystem::path const& folder);

/// A part of a sweep's blocks: each `count`th from `index` - 1 on.
struct Shard {
    std::size_t index = 1, count = 1; ///< index from 1

    bool has(std::size_t block) const { return block % count == index - 1; }
};

} // namespace tessemu
