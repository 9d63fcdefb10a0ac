// SPDX-License-Identifier: Apache-2.0
#include "sweep/results.h"

#include "io/output_file.h"
#include "tests/sweep/toy_sweep.h"

#include <gtest/gtest.h>

#include <thread>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

std::string id(char c)
{
    return std::string(64, c);
}

std::string words(CaseRecord const& r)
{
    return std::string(1, r.id[0]) + (r.done ? " done " : " failed ") + r.text;
}

std::vector<std::string> all(ResultReader& reader)
{
    std::vector<std::string> out;
    reader.read([&](CaseRecord const& r) { out.push_back(words(r)); });
    return out;
}

std::vector<std::string> all(fs::path const& folder)
{
    ResultReader reader(folder);
    return all(reader);
}

using Words = std::vector<std::string>;

TEST(Results, AreReadAsTheyWereAdded)
{
    fs::path const folder = test::scratch();
    std::string const message = "a \"quote\",\na new line, \\, \t, \x01 and \xc3\xa9\xe2\x82\xac";
    {
        ResultLog log(folder);
        EXPECT_EQ(test::files_in(folder), 0u) << "no record, no file";
        log.add({id('a'), true, R"({"status":"failed\"","result":{"message":"x"}})"});
        log.add({id('b'), false, message});
        log.add({id('c'), false, ""});
        log.flush();
        EXPECT_EQ(all(folder).size(), 3u) << "while the run goes on";
    }
    EXPECT_EQ(test::files_in(folder), 1u);
    EXPECT_EQ(all(folder), (Words{R"(a done {"status":"failed\"","result":{"message":"x"}})",
                                  "b failed " + message, "c failed "}));
    std::vector<std::string> states;
    ResultReader(folder).read_states([&](std::string const& which, bool done) {
        states.push_back(which.substr(0, 1) + (done ? "+" : "-"));
    });
    EXPECT_EQ(states, (Words{"a+", "b-", "c-"}));
}

TEST(Results, AMessageThatIsNoUtf8IsKeptAsFarAsItIs)
{
    fs::path const folder = test::scratch();
    ResultLog(folder).add({id('a'), false, "caf\xe9.obj: no such file"});
    Words const read = all(folder);
    ASSERT_EQ(read.size(), 1u);
    EXPECT_TRUE(read[0].starts_with("a failed caf")) << read[0];
    EXPECT_TRUE(read[0].ends_with(".obj: no such file")) << read[0];
}

TEST(Results, ALineWithoutAnEndIsNone)
{
    fs::path const folder = test::scratch(), path = folder / "1.jsonl";
    std::string const line = R"({"case":")" + id('a') + R"(","status":"done","result":{}})" + "\n";
    for (std::size_t n = 0; n < line.size(); ++n) {
        write_file(path, line + line.substr(0, n));
        EXPECT_EQ(all(folder), Words{"a done {}"}) << n;
    }
}

TEST(Results, ALineIsReadOnceItHasItsEnd)
{
    fs::path const folder = test::scratch();
    std::ofstream file(folder / "1.jsonl", std::ios::binary);
    ResultReader reader(folder);
    file << R"({"case":")" + id('a') + R"(","status":"done",)" << std::flush;
    EXPECT_EQ(all(reader), Words{});
    file << R"("result":{"n":1}})" << std::flush;
    EXPECT_EQ(all(reader), Words{});
    file << "\n"
         << R"({"case":")" << std::flush;
    EXPECT_EQ(all(reader), Words{R"(a done {"n":1})"});
    EXPECT_EQ(all(reader), Words{}) << "once";
    file << id('b') + R"(","status":"failed","message":"no"})" + "\n" << std::flush;
    write_file(folder / "0.jsonl",
               R"({"case":")" + id('c') + R"(","status":"done","result":{}})" + "\n");
    EXPECT_EQ(all(reader), (Words{"c done {}", "b failed no"}));
}

TEST(Results, RunsHaveAFileEach)
{
    fs::path const folder = test::scratch();
    ResultLog first(folder), second(folder);
    first.add({id('a'), true, "{}"});
    std::this_thread::sleep_for(std::chrono::milliseconds(1)); // files are named by microseconds
    second.add({id('b'), true, "{}"});
    first.add({id('c'), true, "{}"});
    EXPECT_EQ(test::files_in(folder), 2u);
    EXPECT_EQ(all(folder), (Words{"a done {}", "c done {}", "b done {}"}));
}

TEST(Results, ThreadsAddWholeLines)
{
    fs::path const folder = test::scratch();
    {
        ResultLog log(folder);
        std::vector<std::thread> threads;
        for (char c : {'a', 'b', 'c', 'd'})
            threads.emplace_back([&log, c] {
                for (int i = 0; i < 200; ++i)
                    log.add({id(c), true, "\"" + std::string(100, c) + "\""});
            });
        for (std::thread& t : threads) t.join();
    }
    std::map<std::string, int> count;
    for (std::string const& r : all(folder)) ++count[r];
    EXPECT_EQ(count.size(), 4u);
    EXPECT_EQ(count["b done \"" + std::string(100, 'b') + "\""], 200);
}

TEST(Results, WhatIsNoResultIsNamed)
{
    fs::path const folder = test::scratch(), path = folder / "1.jsonl";
    for (std::string const& line :
         Words{"hello", "", R"({"case":"short","status":"done","result":{}})",
               R"({"case":")" + id('a') + R"(","status":"maybe","result":{}})"}) {
        write_file(path, line + "\n");
        EXPECT_EQ(test::refusal([&] { all(folder); }),
                  path.string() + ": this is no result of a sweep: '" + line.substr(0, 60) + "'");
    }
    write_file(path, R"({"case":")" + id('a') + R"(","status":"done","res)" + "\n");
    EXPECT_EQ(test::refusal([&] { all(folder); }),
              path.string() + ": the result of case " + id('a') + " is damaged");
    write_file(path, "");
    write_file(folder / "notes.txt", "hello\n");
    EXPECT_EQ(all(folder), Words{}) << "other files are not results";
}

TEST(Results, AFailureIsOneUntilTheCaseIsDone)
{
    test::Planned const sweep(3);
    auto const case_id = [&](std::size_t i) { return sweep.manifest.cases[i].id; };
    auto const failed = [&] {
        Words out;
        for (CaseRecord const& r : failures(sweep.manifest, sweep.folder)) {
            for (std::size_t i = 0; i < 3; ++i)
                if (case_id(i) == r.id) out.push_back(std::to_string(i) + " " + r.text);
        }
        return out;
    };
    ResultLog log(sweep.folder / "results");
    log.add({case_id(2), false, "no"});
    log.add({case_id(0), false, "never"});
    log.add({id('f'), false, "of another sweep"});
    EXPECT_EQ(failed(), (Words{"0 never", "2 no"}));
    log.add({case_id(2), true, "{}"});
    log.add({case_id(0), false, "not now"});
    EXPECT_EQ(failed(), (Words{"0 not now"}));
}

TEST(Results, ATornLineIsCompletedByAnotherRun)
{
    test::Planned const sweep(2);
    SweepRunSettings settings;
    settings.run_case = [](SweepCase const& c) { return "{\"n\":" + c.text("samples") + "}"; };
    run_sweep(sweep.manifest, sweep.folder, settings);
    fs::path const first = fs::directory_iterator(sweep.folder / "results")->path();
    fs::resize_file(first, fs::file_size(first) - 1);
    EXPECT_EQ(sweep_state(sweep.manifest, sweep.folder).open(), 1u);
    std::string const torn = test::read_text(first);
    EXPECT_EQ(run_sweep(sweep.manifest, sweep.folder, settings).done, 2u);
    EXPECT_EQ(test::read_text(first), torn) << "nobody writes into another's file";
    EXPECT_EQ(all(sweep.folder / "results").size(), 2u);
}

} // namespace
} // namespace tessemu
