// Papers' tables of times, to which two numbers of a GPU are fitted.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"
#include "tests/support/printed.h"

#include <gtest/gtest.h>

#include <map>
#include <regex>

namespace tessemu::test {

// The built-in description's two fitted numbers are what a fit gives today, to the digits that the
// file has.
inline void expect_stored(char const* name, GpuModel const& fitted)
{
    std::string const json = read_text(source(std::string("gpus/") + name + ".json"));
    auto const stored = [&](std::string const& place) {
        std::smatch match;
        EXPECT_TRUE(std::regex_search(json, match, std::regex(place + R"(: \{"value": ([^,]+),)")));
        return printed(match[1]);
    };
    EXPECT_TRUE(stored(R"("any")").rounds_from(fitted.any_fetch)) << fitted.any_fetch;
    EXPECT_TRUE(stored(R"("overhead")").rounds_from(fitted.overhead)) << fitted.overhead;
}

inline std::map<std::string, PaperCell> by_row(PaperTable const& table, std::string const& column)
{
    std::map<std::string, PaperCell> out;
    for (PaperCell const& c : table.cells)
        if (c.column == column) out[c.row] = c;
    return out;
}

} // namespace tessemu::test
