// docs/conformance.md: every rule has one row, and what a row names exists. All pages: line widths.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(Conformance, EveryRuleHasARowAndEveryTestExists)
{
    std::set<std::string> const tests = all_tests();
    EXPECT_TRUE(tests.count("Conformance.EveryRuleHasARowAndEveryTestExists"));
    std::map<std::string, int> rows;
    std::regex const id(R"(^\| ([RV]\d+|I-\d+) \|)"), name(R"(`(\w+\.\w+)`)");
    std::istringstream page(read_text(source("docs/conformance.md")));
    for (std::string line; std::getline(page, line);) {
        std::smatch m;
        if (!std::regex_search(line, m, id)) continue;
        std::string const rule = m[1];
        ++rows[rule];
        int named = 0;
        for (std::sregex_iterator it(line.begin(), line.end(), name), end; it != end; ++it) {
            std::string const t = (*it)[1];
            EXPECT_TRUE(tests.count(t)) << rule << " names " << t;
            // A rule's test carries its number.
            std::string const number = rule[1] == '-' ? "I" + rule.substr(2) : rule;
            EXPECT_TRUE(std::regex_search(t, std::regex(number + "(?!\\d)"))) << rule << " " << t;
            ++named;
        }
        bool const reason = line.find("out of scope: ") != std::string::npos ||
                            (rule[0] == 'I' && line.find("nothing to test") != std::string::npos);
        EXPECT_TRUE(named > 0 || reason) << rule << " has neither a test nor a reason";
    }
    auto const expect_all = [&](std::string const& prefix, int last) {
        for (int i = 1; i <= last; ++i)
            EXPECT_EQ(rows[prefix + std::to_string(i)], 1) << prefix << i;
    };
    expect_all("R", 166);
    expect_all("V", 18);
    expect_all("I-", 29);
    EXPECT_EQ(rows.size(), 166u + 18 + 29);
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
