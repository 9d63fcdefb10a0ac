// SPDX-License-Identifier: Apache-2.0
#include "sweep/sweep_file.h"

#include "tests/sweep/toy_sweep.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

using test::toy_sweep;

// A case as "model=jug tess=1", options by their names; those of several texts "set=a+b".
std::vector<std::string> cases(std::string const& text)
{
    std::vector<std::string> out;
    for (CaseOptions const& c : cases_of(toy_sweep(text))) {
        std::string words;
        for (auto const& [name, texts] : c)
            words += fmt::format("{}{}={}", words.empty() ? "" : " ", name, fmt::join(texts, "+"));
        out.push_back(words);
    }
    return out;
}

std::string refusal(std::string const& text)
{
    return test::refusal([&] { cases_of(toy_sweep(text)); });
}

using Words = std::vector<std::string>;

TEST(SweepFile, ValuesOfAllKeysMakeTheGridLastKeyFirst)
{
    EXPECT_EQ(
        cases(R"({"verb": "toy", "models": ["b", "a"], "tess": [2, 1], "samples": [8, 4]})"),
        (Words{"model=b samples=8 tess=2", "model=b samples=4 tess=2", "model=b samples=8 tess=1",
               "model=b samples=4 tess=1", "model=a samples=8 tess=2", "model=a samples=4 tess=2",
               "model=a samples=8 tess=1", "model=a samples=4 tess=1"}));
}

TEST(SweepFile, ModelsAndThenSchemesChangeLastWhereverTheyStand)
{
    EXPECT_EQ(
        cases(R"({"tess": [1, 2], "schemes": ["pm", "acc"], "verb": "toy",
                        "models": ["a", "b"]})"),
        (Words{"model=a scheme=pm tess=1", "model=a scheme=pm tess=2", "model=a scheme=acc tess=1",
               "model=a scheme=acc tess=2", "model=b scheme=pm tess=1", "model=b scheme=pm tess=2",
               "model=b scheme=acc tess=1", "model=b scheme=acc tess=2"}));
}

TEST(SweepFile, AValueAloneIsAListOfOne)
{
    EXPECT_EQ(cases(R"({"verb": "toy", "models": "jug", "scheme": "pm", "tess": 2.5})"),
              Words{"model=jug scheme=pm tess=2.5"});
    EXPECT_EQ(cases(R"({"verb": "toy", "model": ["jug"], "schemes": ["pm"], "tess": ["2.5"]})"),
              Words{"model=jug scheme=pm tess=2.5"});
}

TEST(SweepFile, NumbersAreTheirShortestTexts)
{
    EXPECT_EQ(cases(R"({"verb": "toy", "models": "a", "samples": [1, 1.0, 0.1, 1e-7, -3, "1.0"]})"),
              (Words{"model=a samples=1", "model=a samples=1", "model=a samples=0.1",
                     "model=a samples=1e-07", "model=a samples=-3", "model=a samples=1.0"}));
}

TEST(SweepFile, AnInnerListIsOneValueOfARepeatedOption)
{
    EXPECT_EQ(cases(R"({"verb": "toy", "models": "a", "set": ["x=1", ["x=1", "y=2"], []]})"),
              (Words{"model=a set=x=1", "model=a set=x=1+y=2", "model=a set="}));
    EXPECT_EQ(cases(R"({"verb": "toy", "cases": [{"model": "a", "set": ["x=1", "y=2"]}]})"),
              Words{"model=a set=x=1+y=2"});
    EXPECT_NE(refusal(R"({"verb": "toy", "models": "a", "tess": [[1, 2]]})"), "");
}

TEST(SweepFile, AFlagIsTrueOrFalse)
{
    EXPECT_EQ(cases(R"({"verb": "toy", "models": "a", "quick": [true, false]})"),
              (Words{"model=a quick=true", "model=a quick=false"}));
    EXPECT_EQ(refusal(R"({"verb": "toy", "models": "a", "quick": 1})"),
              R"(toy.json: "quick" is 1, it must be true or false)");
}

TEST(SweepFile, SingleCasesFollowTheGrid)
{
    EXPECT_EQ(cases(R"({"verb": "toy", "cases": [{"tess": 64, "model": "z"}, {"model": "y"}],
                        "models": ["a", "b"]})"),
              (Words{"model=a", "model=b", "model=z tess=64", "model=y"}));
    EXPECT_EQ(cases(R"({"verb": "toy", "cases": [{"model": "z"}]})"), Words{"model=z"});
}

TEST(SweepFile, AnExceptionLeavesOutWhatHasOneOfItsValuesForEachOfItsOptions)
{
    EXPECT_EQ(cases(R"({"verb": "toy", "models": ["a", "b"], "tess": [1, 2, 3],
                        "except": [{"model": "a", "tess": [1, 3]}, {"tess": 2}]})"),
              (Words{"model=b tess=1", "model=b tess=3"}));
    EXPECT_THROW(cases(R"({"verb": "toy", "models": "a", "except": [{"scheme": "pm"}]})"), Error)
        << "no case names the option";
    EXPECT_EQ(cases(R"({"verb": "toy", "models": "a", "cases": [{"model": "a", "tess": 1}],
                        "except": [{"model": "a"}]})"),
              Words{"model=a tess=1"})
        << "single cases are asked for by name";
    EXPECT_EQ(cases(R"({"verb": "toy", "models": "a", "set": [["x=1", "y=2"], "x=1"],
                        "except": [{"set": [["x=1", "y=2"]]}]})"),
              Words{"model=a set=x=1"});
}

TEST(SweepFile, RefusalsNameTheFileTheKeyAndWhatIsAllowed)
{
    std::string const all = "model, quick, samples, scheme, set or tess";
    for (auto const& [text, words] : std::vector<std::pair<std::string, std::string>>{
             {R"({"verb": "toy", "models": "a", "tes": 1})",
              R"("tes" is no option of toy that a sweep can set; there are )" + all},
             {R"({"verb": "toy", "models": "a", "except": [{"modles": "a"}]})",
              R"("modles" is no option of toy that a sweep can set; there are )" + all},
             {R"({"verb": "toy", "cases": [{"model": "a", "cases": []}]})",
              R"("cases" is no option of toy that a sweep can set; there are )" + all},
             {R"({"verb": "toy", "models": "a", "tess": [1, 65]})",
              R"("tess" is 65, it must be 1 to 64)"},
             {R"({"verb": "toy", "cases": [{"model": "a", "tess": 0.5}]})",
              R"("tess" is 0.5, it must be 1 to 64)"},
             {R"({"verb": "toy", "models": "a", "except": [{"tess": 0}]})",
              R"("tess" is 0, it must be 1 to 64)"},
             {R"({"verb": "toy", "models": "a", "tess": 1, "tess": 2})",
              R"("tess" is there twice)"},
             {R"({"verb": "toy", "cases": [{"model": "a", "model": "b"}]})",
              R"("model" is there twice)"},
             {R"({"verb": "toy", "model": "a", "models": ["b"]})",
              R"("model" and "models" are the same)"},
             {R"({"verb": "toy", "models": "a", "except": [{"scheme": "pm", "schemes": "acc"}]})",
              R"("scheme" and "schemes" are the same)"},
             {R"({"verb": "toy", "cases": [{"model": "a", "models": "b"}]})",
              R"("model" and "models" are the same)"},
             {R"({"verb": "toy", "models": []})", R"("models" is an empty list)"},
             {R"({"verb": "toy", "models": "a", "tess": []})", R"("tess" is an empty list)"},
             {R"({"verb": "toy", "models": "a", "tess": null})", R"("tess" has null, which is )"},
             {R"({"verb": "toy", "models": [{"a": 1}]})", R"("models" has {"a":1}, which is )"},
             {R"({"verb": "toy", "schemes": "acc"})", R"(there is no "models")"},
             {R"({"verb": "toy"})", R"(there is no case: no "models", no "cases")"},
             {R"({"verb": "toy", "cases": [{"tess": 1}]})", R"(one of "cases" has no "model")"},
             {R"({"verb": "toy", "cases": [{"model": ["a", "b"]}]})",
              R"("model" of one of "cases" is a list; a case has one value)"},
             {R"({"verb": "toy", "cases": {"model": "a"}})",
              R"("cases" must be a list of objects)"},
             {R"({"verb": "toy", "models": "a", "except": ["a"]})",
              R"("except" must be a list of objects)"},
             {R"({"verb": "toy", "models": "a", "except": [{}]})",
              R"(one of "except" is {}, which is every case)"},
             {R"({"verb": "toys", "models": "a"})", R"("verb" is "toys", it must be toy)"},
             {R"({"models": "a"})", R"(a sweep is an object with a "verb")"},
             {R"({"verb": ["toy"]})", R"(a sweep is an object with a "verb")"},
             {R"(["toy"])", R"(a sweep is an object with a "verb")"}}) {
        std::string const said = refusal(text);
        EXPECT_TRUE(said.starts_with("toy.json: " + words)) << text << "\n" << said;
    }
}

TEST(SweepFile, WhatIsNoJsonHasItsLine)
{
    EXPECT_EQ(refusal("{\"verb\": \"toy\",\n\n \"models\": [1 2]}"),
              "toy.json:3: this is not JSON");
    EXPECT_EQ(refusal(""), "toy.json:1: this is not JSON");
    EXPECT_EQ(refusal("{\"verb\": \"toy\"\n"), "toy.json:2: this is not JSON");
    EXPECT_EQ(refusal("{\"verb\": \"toy\",\n\"models\": \"\xff\"}"),
              "toy.json:2: this is not JSON");
}

TEST(SweepFile, ANumberBeyondDoubleIsRefused)
{
    EXPECT_EQ(refusal(R"({"verb": "toy", "models": "a", "samples": 1e999})"),
              "toy.json: a number is beyond what a double holds");
}

TEST(SweepFile, CasesHaveALimit)
{
    auto const grid = [](std::size_t models, std::size_t factors) {
        Sweep sweep;
        sweep.grid = {{"model", std::vector<std::vector<std::string>>(models, {"a"})},
                      {"tess", std::vector<std::vector<std::string>>(factors, {"1"})}};
        sweep.except = {{{"tess", {{"1"}}}}};
        return sweep;
    };
    EXPECT_EQ(cases_of(grid(100, 1000)).size(), 0u);
    EXPECT_EQ(test::refusal([&] { cases_of(grid(10001, 1000)); }),
              "cases of the sweep is 10001000, the limit is 10000000");
    std::size_t const large = std::size_t(1) << 20;
    EXPECT_NE(test::refusal([&] { cases_of(grid(large, large)); }), "");
}

} // namespace
} // namespace tessemu
