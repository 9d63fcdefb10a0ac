// SPDX-License-Identifier: Apache-2.0
#include "sweep/manifest.h"

#include "io/output_file.h"
#include "tests/sweep/toy_sweep.h"

#include <gtest/gtest.h>

#include <set>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using test::toy_plan;
using test::toy_sweep;

using Files = std::map<std::string, std::string>; // bytes by path

// A sweep whose models are files where there are such.
SweepPlan plan_with(std::string const& text, Files const& files, std::string const& version = "1")
{
    FindInput const find_input =
        [&](std::string const& option,
            std::string const& word) -> std::optional<std::pair<std::string, std::string>> {
        auto const at = files.find(word);
        if (option != "model" || at == files.end()) return {};
        return std::pair(fs::path(word).filename().string(), at->second);
    };
    return plan_sweep(toy_sweep(text), test::toy_verb(), version, find_input);
}

std::string id_of(std::string const& single, Files const& files = {},
                  std::string const& version = "1")
{
    return plan_with(R"({"verb": "toy", "cases": [)" + single + "]}", files, version)
        .manifest.cases.at(0)
        .id;
}

std::vector<std::string> ids_of(SweepManifest const& m)
{
    std::vector<std::string> out;
    for (SweepCase const& c : m.cases) out.push_back(c.id);
    return out;
}

TEST(SweepPlan, AnIdDependsOnEveryOptionTheVersionAndTheInputsBytes)
{
    std::vector<std::string> const ids{
        id_of(R"({"model": "a"})"),
        id_of(R"({"model": "b"})"),
        id_of(R"({"model": "a", "scheme": "pm"})"),
        id_of(R"({"model": "a", "tess": 1})"),
        id_of(R"({"model": "a", "tess": 2})"),
        id_of(R"({"model": "a", "samples": 1})"),
        id_of(R"({"model": "a", "set": ["x", "y"]})"),
        id_of(R"({"model": "a", "set": ["y", "x"]})"),
        id_of(R"({"model": "a", "set": "x y"})"),
        id_of(R"({"model": "a", "quick": true})"),
        id_of(R"({"model": "a"})", {}, "2"),
        id_of(R"({"model": "a"})", {{"a", "mesh"}}),
        id_of(R"({"model": "a"})", {{"a", "mesh "}}),
        id_of(R"({"model": "b"})", {{"b", "mesh"}}),
    };
    for (std::string const& id : ids) {
        EXPECT_EQ(id.size(), 64u);
        EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos) << id;
    }
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), ids.size());
}

TEST(SweepPlan, AnIdDependsOnNoFolderAndNotOnWhetherADefaultIsGiven)
{
    EXPECT_EQ(id_of(R"({"model": "x/a.obj"})", {{"x/a.obj", "mesh"}}),
              id_of(R"({"model": "../y/a.obj"})", {{"../y/a.obj", "mesh"}}));
    std::string const bare = id_of(R"({"model": "a", "tess": 2})");
    EXPECT_EQ(id_of(R"({"tess": 2.0, "model": "a"})"), bare);
    EXPECT_EQ(id_of(R"({"model": "a", "tess": 2, "scheme": "acc"})"), bare);
    EXPECT_EQ(id_of(R"({"model": "a", "tess": 2, "samples": 4, "quick": false})"), bare);
    // Nor on the rest of the sweep.
    SweepPlan const all = toy_plan(R"({"verb": "toy", "models": ["b", "a"], "tess": [1, 2]})");
    EXPECT_EQ(all.manifest.cases[3].id, bare);
}

TEST(SweepPlan, ACaseThatIsThereTwiceIsOne)
{
    SweepPlan const plan = toy_plan(R"({"verb": "toy", "models": "a", "tess": [1, 2, 1.0],
                                        "cases": [{"model": "a", "tess": 2, "samples": 4}]})");
    EXPECT_EQ(plan.manifest.cases.size(), 2u);
    EXPECT_EQ(plan.repeated, 2u);
}

TEST(SweepPlan, AThousandBlocksAtLeastOfManyCases)
{
    auto const per_block = [](int factors) {
        std::string list;
        for (int i = 0; i < factors; ++i) list += (i ? "," : "") + std::to_string(i);
        return toy_plan(R"({"verb": "toy", "models": "a", "samples": [)" + list + "]}").manifest;
    };
    EXPECT_EQ(per_block(1).per_block, 1u);
    EXPECT_EQ(per_block(1999).blocks(), 1999u);
    EXPECT_EQ(per_block(2500).per_block, 2u);
    EXPECT_EQ(per_block(2501).blocks(), 1251u);
}

constexpr char const* kText = R"({"verb": "toy", "models": ["x/a.obj", "y/a.obj", "jug"],
    "set": [["p=1", "q=\"2\""], []], "quick": true})";
Files const kFiles{{"x/a.obj", "first"}, {"y/a.obj", std::string("se\0cond", 7)}};

TEST(SweepManifest, IsReadAsItWasWritten)
{
    fs::path const folder = test::scratch() / "new" / "sweep";
    SweepPlan const plan = plan_with(kText, kFiles, "0.1 \xc3\xa9");
    write_plan(plan, folder, kText);
    SweepManifest const back = read_manifest(folder), &m = plan.manifest;
    EXPECT_EQ(back.version, "0.1 \xc3\xa9");
    EXPECT_EQ(back.verb, "toy");
    EXPECT_EQ(back.defaults, m.defaults);
    EXPECT_EQ(back.per_block, m.per_block);
    EXPECT_EQ(ids_of(back), ids_of(m));
    ASSERT_EQ(back.cases.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(back.cases[i].options, m.cases[i].options);
    EXPECT_EQ(back.cases[4].text("model"), "jug");
    EXPECT_EQ(back.cases[0].options.at("set"), (std::vector<std::string>{"p=1", "q=\"2\""}));
    EXPECT_EQ(back.resolved(back.cases[0]), (CaseOptions{{"model", {back.inputs[0].path}},
                                                         {"scheme", {"acc"}},
                                                         {"samples", {"4"}},
                                                         {"set", {"p=1", "q=\"2\""}},
                                                         {"quick", {"true"}}}));
    EXPECT_EQ(test::read_text(folder / "sweep.json"), kText);
}

TEST(SweepManifest, InputsLieInTheFolderUnderTheirNames)
{
    fs::path const folder = test::scratch() / "sweep";
    write_plan(plan_with(kText, kFiles), folder, kText);
    SweepManifest const m = read_manifest(folder);
    ASSERT_EQ(m.inputs.size(), 2u);
    std::vector<std::string> bytes;
    for (SweepInput const& i : m.inputs) {
        EXPECT_EQ(i.name, "a.obj");
        EXPECT_EQ(fs::path(i.path).filename(), "a.obj");
        EXPECT_TRUE(fs::path(i.path).is_relative());
        bytes.push_back(test::read_text(folder / i.path));
    }
    EXPECT_EQ(bytes, (std::vector<std::string>{"first", std::string("se\0cond", 7)}));
    EXPECT_EQ(m.input(m.cases[2].text("model")), &m.inputs[1]);
    EXPECT_EQ(m.input("jug"), nullptr);
    // sha256sum of "first"
    EXPECT_EQ(m.inputs[0].sha256,
              "a7937b64b8caa58f03721bb6bacf5c78cb235febe0e70b1b84cd99541461a08e");
}

TEST(SweepManifest, TheSamePlanAgainKeepsResults)
{
    fs::path const folder = test::scratch() / "sweep";
    write_plan(plan_with(kText, kFiles), folder, kText);
    write_file(folder / "results" / "1.jsonl", "found");
    write_plan(plan_with(kText, kFiles), folder, kText);
    EXPECT_EQ(test::read_text(folder / "results" / "1.jsonl"), "found");
}

TEST(SweepManifest, AnotherPlanIsRefusedAndChangesNothing)
{
    fs::path const folder = test::scratch() / "sweep";
    write_plan(plan_with(kText, kFiles), folder, kText);
    std::string const before = test::read_text(folder / "manifest.jsonl");
    Files changed = kFiles;
    changed["x/a.obj"] = "other";
    for (SweepPlan const& plan : {plan_with(kText, changed), plan_with(kText, kFiles, "2"),
                                  plan_with(R"({"verb": "toy", "models": "jug"})", {})}) {
        std::string const said = test::refusal([&] { write_plan(plan, folder, "{}"); });
        EXPECT_NE(said.find(folder.string() + ": another sweep is planned there"),
                  std::string::npos)
            << said;
        EXPECT_EQ(test::read_text(folder / "manifest.jsonl"), before);
        EXPECT_EQ(test::read_text(folder / "sweep.json"), kText);
        EXPECT_EQ(test::files_in(folder / "inputs"), 2u);
    }
}

TEST(SweepManifest, AFolderOfSomethingElseIsRefused)
{
    fs::path const folder = test::scratch();
    write_file(folder / "thesis.tex", "years of work");
    std::string const said =
        test::refusal([&] { write_plan(plan_with(kText, kFiles), folder, kText); });
    EXPECT_NE(said.find("there is something that is no sweep"), std::string::npos) << said;
    EXPECT_EQ(test::files_in(folder), 1u);
}

TEST(SweepManifest, AUsersOwnSweepFileIsNotOverwritten)
{
    fs::path const folder = test::scratch();
    write_file(folder / "sweep.json", "another one");
    EXPECT_NE(test::refusal([&] { write_plan(plan_with(kText, kFiles), folder, kText); }), "");
    EXPECT_EQ(test::read_text(folder / "sweep.json"), "another one");
}

TEST(SweepManifest, APlanThatWasCutShortIsPlannedAgain)
{
    fs::path const folder = test::scratch() / "sweep";
    write_plan(plan_with(kText, kFiles), folder, kText);
    std::string const whole = test::read_text(folder / "manifest.jsonl");
    fs::remove(folder / "manifest.jsonl"); // it comes last
    fs::remove(folder / plan_with(kText, kFiles).manifest.inputs[1].path);
    EXPECT_NE(test::refusal([&] { read_manifest(folder); }), "");
    write_plan(plan_with(kText, kFiles), folder, kText);
    EXPECT_EQ(test::read_text(folder / "manifest.jsonl"), whole);
    EXPECT_EQ(test::read_text(folder / read_manifest(folder).inputs[1].path), kFiles.at("y/a.obj"));
}

TEST(SweepManifest, SaysThatItIsDamagedShortOrNotThere)
{
    fs::path const folder = test::scratch() / "sweep", path = folder / "manifest.jsonl";
    auto const said = [&](std::string const& text) {
        write_file(path, text);
        return test::refusal([&] { read_manifest(folder); });
    };
    std::string const none = test::refusal([&] { read_manifest(folder); });
    EXPECT_EQ(none, folder.string() +
                        ": there is no manifest.jsonl: 'tessemu sweep plan "
                        "SWEEP.json -o " +
                        folder.string() + "' makes one");
    write_plan(plan_with(kText, kFiles), folder, kText);
    std::string const whole = test::read_text(path);
    EXPECT_EQ(said(whole), "");

    std::string const short_one = whole.substr(0, whole.rfind('\n', whole.size() - 2) + 1);
    EXPECT_EQ(said(short_one),
              path.string() + ": the manifest has 5 of 6 cases: plan the sweep again");
    EXPECT_EQ(said(""), path.string() + ": the manifest has 0 of 0 cases: plan the sweep again");
    std::string const again = ": the manifest is damaged: plan the sweep again";
    EXPECT_EQ(said(whole.substr(0, whole.size() - 9)), path.string() + ":7" + again);
    EXPECT_EQ(said("{}\n"), path.string() + ":1" + again);
    EXPECT_EQ(said("\x1f\x8b\x08"), path.string() + ":1" + again);
    std::string wrong = whole;
    wrong.replace(wrong.find("\"options\":{"), 11, "\"options\":{\"tess\":1,");
    EXPECT_EQ(said(wrong), path.string() + ":2" + again);
    std::string newer = whole;
    newer.replace(newer.find("tessemu.sweep/1"), 15, "tessemu.sweep/2");
    EXPECT_EQ(said(newer), path.string() + ":1: not a tessemu.sweep/1");
    // No length of it passes for the whole but the one without the last line's end.
    for (std::size_t n = 0; n + 1 < whole.size(); n += 7)
        EXPECT_NE(said(whole.substr(0, n)), "") << n;
}

TEST(Shard, ShardsPartitionTheBlocks)
{
    for (std::size_t count = 1; count <= 5; ++count)
        for (std::size_t block = 0; block < 12; ++block) {
            std::size_t owners = 0;
            for (std::size_t i = 1; i <= count; ++i) owners += Shard{i, count}.has(block);
            EXPECT_EQ(owners, 1u) << block << " of " << count;
        }
    EXPECT_TRUE((Shard{1, 3}.has(0)));
    EXPECT_TRUE((Shard{3, 3}.has(5)));
}

} // namespace
} // namespace tessemu
