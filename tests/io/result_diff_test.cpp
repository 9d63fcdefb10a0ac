// Two results side by side.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/result_diff.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tessemu {
namespace {

std::string const kA = R"({"tool": {"version": "1"}, "counters": {"VSInvocations": 100, "x": 0},
    "stages": {"vertex_shader": {"fetches": [{"resource": "a", "count": 5}, {"resource": "b", "count": 6}]}},
    "run": {"seconds": 1}, "hash": "aa"})";

std::vector<std::string> differing(std::string const& a, std::string const& b, double tolerance = 0)
{
    std::vector<std::string> out;
    for (ResultValue const& v : diff_results(a, b, {"a.json", "b.json"}, tolerance))
        if (v.differs) out.push_back(v.path);
    return out;
}

std::string replaced(std::string text, std::string const& from, std::string const& to)
{
    text.replace(text.find(from), from.size(), to);
    return text;
}

TEST(ResultDiff, RunAndToolDoNotCount)
{
    EXPECT_TRUE(differing(kA, kA).empty());
    EXPECT_TRUE(differing(kA, replaced(kA, "\"seconds\": 1", "\"seconds\": 2")).empty());
    EXPECT_TRUE(differing(kA, replaced(kA, "\"version\": \"1\"", "\"version\": \"2\"")).empty());
}

TEST(ResultDiff, NumbersMayDifferByTheTolerance)
{
    std::string const b = replaced(kA, "100", "101");
    EXPECT_EQ(differing(kA, b), std::vector<std::string>{"counters.VSInvocations"});
    EXPECT_TRUE(differing(kA, b, 0.01).empty()); // 1 / 101
    EXPECT_EQ(differing(kA, b, 0.009).size(), 1u);
    EXPECT_EQ(differing(kA, replaced(kA, "\"x\": 0", "\"x\": 1e-9"), 0.5).size(), 1u);
}

TEST(ResultDiff, HashesCountWithoutAToleranceOnly)
{
    std::string const b = replaced(kA, "\"aa\"", "\"bb\"");
    EXPECT_EQ(differing(kA, b), std::vector<std::string>{"hash"});
    EXPECT_TRUE(differing(kA, b, 1e-9).empty());
}

TEST(ResultDiff, ElementsGoByNameAndMissingOnesDiffer)
{
    std::string const b = replaced(kA, R"({"resource": "a", "count": 5}, )", "");
    EXPECT_EQ(differing(kA, b), (std::vector<std::string>{"stages.vertex_shader.fetches.a.resource",
                                                          "stages.vertex_shader.fetches.a.count"}));
    EXPECT_EQ(differing(b, kA).size(), 2u);
    EXPECT_EQ(differing(kA, replaced(kA, "\"count\": 6", "\"count\": \"6\""), 1).size(), 1u);
}

TEST(ResultDiff, BadJsonNamesFileAndLine)
{
    try {
        diff_results(kA, "{\n\"a\": 1,\n oops}", {"a.json", "b.json"}, 0);
        FAIL();
    } catch (FormatError const& e) {
        EXPECT_EQ(e.file, "b.json");
        EXPECT_EQ(e.line, 3);
    }
}

} // namespace
} // namespace tessemu
