// A table of numbers, a row a thing, with a word on each.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace tessemu {

struct NumberTable {
    struct Row {
        std::string name;
        std::vector<double> numbers; ///< of columns; NaN: there is none
        std::string note;
    };
    std::string name, note;           ///< heads of Row::name, Row::note
    std::vector<std::string> columns; ///< heads of Row::numbers
    std::vector<Row> rows;            ///< none: no table
};

} // namespace tessemu
