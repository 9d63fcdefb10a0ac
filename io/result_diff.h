// Two results (tessemu.VERB/1) side by side: what differs, and by how much. Counters of a run can
// so serve as golden files.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"
#include "io/report.h"

namespace tessemu {

/// A value that one of two results or both have.
struct ResultValue {
    std::string path;     ///< "stages.domain_shader.fetches.control_points.count"
    std::string a, b;     ///< as JSON; empty where the result has no such value
    double relative = 0;  ///< of numbers: |a - b| / max(|a|, |b|); 1 for anything else that differs
    bool differs = false; ///< beyond the tolerance
};

/// All values but those under "run" and "tool". "hash" is compared only with tolerance 0: it covers
/// every bit.
///
/// \param names  of the two texts, for errors. Throws FormatError for what is not JSON.
std::vector<ResultValue> diff_results(std::string const& a, std::string const& b,
                                      std::pair<std::string, std::string> const& names,
                                      double tolerance);

/// diff: the differing values.
std::string diff_report(ReportHeader const& header, std::vector<ResultValue> const& values);
/// \param all  equal values too
std::string diff_table(std::vector<ResultValue> const& values, bool all);

} // namespace tessemu
