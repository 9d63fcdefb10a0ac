// Numbers as the project's pages and data files print them, for tests that hold the pages to what
// the program gives.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace tessemu::test {

/// A printed number: the value and the unit of its last digit.
struct Printed {
    double value = 0, unit = 0;
    /// Would print so: x lies within half a unit.
    bool rounds_from(double x) const { return std::abs(x - value) <= unit / 2; }
};

/// "0.637e-3", ".0696", "365"
inline Printed printed(std::string const& number)
{
    std::size_t const e = number.find('e'), point = number.find('.');
    std::size_t const digits = e == std::string::npos ? number.size() : e;
    int exponent = e == std::string::npos ? 0 : std::stoi(number.substr(e + 1));
    if (point != std::string::npos) exponent -= int(digits - point) - 1;
    return {std::stod(number), std::pow(10, exponent)};
}

/// All numbers of a text, in order.
inline std::vector<Printed> printed_numbers(std::string const& text)
{
    static std::regex const number(R"((\d+\.?\d*|\.\d+)(e-?\d+)?)");
    std::vector<Printed> out;
    for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it)
        out.push_back(printed(it->str()));
    return out;
}

/// What the groups of a pattern are in a page whose white space is single blanks; the test fails
/// where the page does not say so.
inline std::vector<Printed> said_in(std::string const& page, std::string const& pattern)
{
    std::string const text = std::regex_replace(read_text(source(page)), std::regex(R"(\s+)"), " ");
    std::smatch match;
    std::vector<Printed> out;
    EXPECT_TRUE(std::regex_search(text, match, std::regex(pattern)))
        << page << " does not say \"" << pattern << "\"";
    for (std::size_t i = 1; i < match.size(); ++i) out.push_back(printed(match[i]));
    return out;
}

/// Rows of the table below the line of a page that begins with `head`, as cells.
inline std::vector<std::vector<std::string>> table_of(std::string const& page,
                                                      std::string const& head)
{
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(read_text(source(page)));
    std::string line;
    while (std::getline(lines, line) && !line.starts_with(head)) {
    }
    std::getline(lines, line); // the rule below it
    while (std::getline(lines, line) && line.starts_with("|")) {
        std::vector<std::string> cells;
        std::istringstream row(line.substr(1));
        for (std::string cell; std::getline(row, cell, '|');)
            cells.push_back(std::regex_replace(cell, std::regex("^ +| +$"), ""));
        rows.push_back(std::move(cells));
    }
    EXPECT_FALSE(rows.empty()) << page << " has no table \"" << head << "\"";
    return rows;
}

} // namespace tessemu::test
