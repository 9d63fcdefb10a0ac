// docs/conformance.md: every rule, fact, gap and finding has one row, and what a row names exists.
// All pages: line widths.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

namespace tessemu::test {
namespace {

std::set<std::string> all_tests()
{
    std::set<std::string> names;
    std::regex const test(R"((?:^|\n)(?:TEST|TYPED_TEST|RC_GTEST_PROP)\((\w+),\s*(\w+))");
    for (auto const& entry : std::filesystem::recursive_directory_iterator(source("tests"))) {
        if (entry.path().extension() != ".cpp") continue;
        std::string const text = read_text(entry.path());
        for (std::sregex_iterator it(text.begin(), text.end(), test), end; it != end; ++it)
            names.insert((*it)[1].str() + "." + (*it)[2].str());
    }
    return names;
}

// A row of one of the page's tables: its cells, of which the first is the number.
struct Row {
    std::vector<std::string> cells;
    std::string const& number() const { return cells.front(); }
};

// Rows whose number has one of the prefixes. A cell's own bar is written \|.
std::vector<Row> rows_of(std::string const& prefixes)
{
    std::regex const number("(" + prefixes + ")\\d+"), cell(R"(\|((?:[^|\\]|\\.)*)(?=\|))"),
        blanks("^ +| +$");
    std::vector<Row> rows;
    std::istringstream page(read_text(source("docs/conformance.md")));
    for (std::string line; std::getline(page, line);) {
        Row row;
        for (std::sregex_iterator it(line.begin(), line.end(), cell), end; it != end; ++it)
            row.cells.push_back(std::regex_replace((*it)[1].str(), blanks, ""));
        if (!row.cells.empty() && std::regex_match(row.number(), number)) rows.push_back(row);
    }
    return rows;
}

// How many tests a row names. Each exists and carries the row's number.
int tests_named(Row const& row, std::set<std::string> const& tests)
{
    std::regex const name(R"(`(\w+\.\w+)`)");
    std::string const digits = std::regex_replace(row.number(), std::regex("-"), "");
    std::regex const carries(digits + "(?!\\d)");
    int named = 0;
    std::string const& last = row.cells.back();
    for (std::sregex_iterator it(last.begin(), last.end(), name), end; it != end; ++it) {
        std::string const t = (*it)[1];
        EXPECT_TRUE(tests.count(t)) << row.number() << " names " << t;
        EXPECT_TRUE(std::regex_search(t, carries)) << row.number() << " " << t;
        ++named;
    }
    return named;
}

// Each number from a range's first to its last has one row, and no other number has any.
void expect_numbers(std::vector<Row> const& rows, std::map<std::string, std::array<int, 2>> ranges)
{
    std::map<std::string, int> count;
    for (Row const& row : rows) ++count[row.number()];
    std::size_t all = 0;
    for (auto const& [prefix, range] : ranges)
        for (int i = range[0]; i <= range[1]; ++i, ++all)
            EXPECT_EQ(count[prefix + std::to_string(i)], 1) << prefix << i;
    EXPECT_EQ(count.size(), all);
}

TEST(Conformance, EveryRuleHasARowAndEveryTestExists)
{
    std::set<std::string> const tests = all_tests();
    EXPECT_TRUE(tests.count("Conformance.EveryRuleHasARowAndEveryTestExists"));
    std::vector<Row> const rows = rows_of("R|V|I-");
    for (Row const& row : rows) {
        std::string const& last = row.cells.back();
        bool const reason =
            last.find("out of scope: ") != std::string::npos ||
            (row.number()[0] == 'I' && last.find("nothing to test") != std::string::npos);
        EXPECT_TRUE(tests_named(row, tests) > 0 || reason)
            << row.number() << " has neither a test nor a reason";
    }
    expect_numbers(rows, {{"R", {1, 166}}, {"V", {1, 18}}, {"I-", {1, 29}}});
}

// S: facts of other suites; G: what they test beyond the rules; F: practice (F1, F5 and F6 were
// mended).
TEST(Conformance, EveryFactGapAndFindingHasARow)
{
    std::set<std::string> const tests = all_tests();
    std::vector<Row> const rows = rows_of("S|G|F");
    for (Row const& row : rows) {
        ASSERT_EQ(row.cells.size(), 3u) << row.number();
        for (std::string const& cell : row.cells) EXPECT_NE(cell, "") << row.number();
        bool const reason = std::regex_search(row.cells[2], std::regex("out of scope: \\w"));
        EXPECT_TRUE(tests_named(row, tests) > 0 || (reason && row.number()[0] != 'F'))
            << row.number() << " has neither a test nor a reason";
    }
    expect_numbers(rows, {{"S", {1, 69}}, {"G", {1, 20}}, {"F", {2, 4}}});
}

std::size_t code_points(std::string const& line)
{
    return std::size_t(
        std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// A row of a table, or a link or picture with nothing around it to break at.
bool cannot_be_wrapped(std::string const& line)
{
    static std::regex const link(R"(!?\[[^\]]*\]\([^)]*\))");
    std::string const rest = std::regex_replace(line, link, "");
    return line.starts_with("|") || (rest != line && rest.find(' ') == std::string::npos);
}

TEST(Docs, LinesAreAtMostAHundredWide)
{
    std::vector<std::filesystem::path> pages{source("README.md"), source("CHANGELOG.md")};
    for (char const* folder : {"docs", "docs/math"})
        for (auto const& entry : std::filesystem::directory_iterator(source(folder)))
            if (entry.path().extension() == ".md") pages.push_back(entry.path());
    EXPECT_GE(pages.size(), 18u);
    for (auto const& page : pages) {
        std::istringstream text(read_text(page));
        int number = 0;
        for (std::string line; std::getline(text, line);) {
            ++number;
            if (cannot_be_wrapped(line)) continue;
            EXPECT_LE(code_points(line), 100u) << page << ":" << number << ": " << line;
        }
    }
}

} // namespace
} // namespace tessemu::test
