// A paper's table beside our own figures.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace tessemu {

/// A cell: what the paper prints, and ours.
struct PaperCell {
    std::string row, column;
    double paper, ours;
};

struct PaperTable {
    std::string title;
    std::vector<PaperCell> cells;
    std::vector<std::string> remarks; ///< what the paper leaves open, and how we read it
};

/// (done, all) comparisons
using PaperProgress = std::function<void(std::size_t, std::size_t)>;

} // namespace tessemu
