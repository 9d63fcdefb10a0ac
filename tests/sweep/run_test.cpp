// SPDX-License-Identifier: Apache-2.0
#include "sweep/run.h"

#include "io/output_file.h"
#include "sweep/results.h"
#include "tests/sweep/toy_sweep.h"

#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <set>
#include <thread>

#include <signal.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using test::Planned, test::spawn, test::wait_for;

// Computes a case in a moment, and leaves a byte in counts/N.
struct Toy {
    Planned sweep;
    fs::path counts;
    SweepRunSettings settings;

    explicit Toy(int cases, std::size_t per_block = 1)
        : sweep(cases, per_block),
          counts(sweep.folder.parent_path() / "counts")
    {
        fs::create_directory(counts);
        settings.lease = 1;
        settings.run_case = [this](SweepCase const& c) {
            test::append_byte(counts / c.text("samples"));
            return R"({"n":)" + c.text("samples") + R"(,"run":{"seconds":0.25}})";
        };
    }
    SweepState run() const { return run_sweep(sweep.manifest, sweep.folder, settings); }
    SweepState state(Shard const& shard = {}) const
    {
        return sweep_state(sweep.manifest, sweep.folder, shard);
    }
    /// How often the case was computed.
    std::size_t count(std::size_t number) const
    {
        std::error_code none;
        auto const size = fs::file_size(counts / std::to_string(number), none);
        return none ? 0 : std::size_t(size);
    }
    std::size_t count_all() const
    {
        std::size_t out = 0;
        for (std::size_t i = 1; i <= sweep.manifest.cases.size(); ++i) out += count(i);
        return out;
    }
    /// Each case's results, as texts.
    std::map<std::string, std::vector<std::string>> results() const
    {
        std::map<std::string, std::vector<std::string>> out;
        ResultReader(sweep.folder / "results").read([&](CaseRecord const& r) {
            out[r.id].push_back(r.done ? r.text : "failed: " + r.text);
        });
        return out;
    }
};

std::string counts_of(SweepState const& s)
{
    return fmt::format("{} of {} done, {} failed", s.done, s.cases, s.failed);
}

TEST(SweepRun, ComputesEachCaseOnceAndKeepsNothingOfTheRun)
{
    for (int workers : {1, 4})
        for (std::size_t per_block : {1u, 3u, 100u}) {
            Toy toy(20, per_block);
            toy.settings.workers = workers;
            EXPECT_EQ(counts_of(toy.state()), "0 of 20 done, 0 failed");
            EXPECT_EQ(counts_of(toy.run()), "20 of 20 done, 0 failed");
            EXPECT_EQ(counts_of(toy.state()), "20 of 20 done, 0 failed");
            auto const results = toy.results();
            for (std::size_t i = 0; i < 20; ++i) {
                std::string const n = std::to_string(i + 1);
                EXPECT_EQ(toy.count(i + 1), 1u);
                EXPECT_EQ(results.at(toy.sweep.manifest.cases[i].id),
                          std::vector<std::string>{"{\"n\":" + n + "}"});
            }
            EXPECT_EQ(test::files_in(toy.sweep.folder / "claims"), 0u);
            EXPECT_EQ(counts_of(toy.run()), "20 of 20 done, 0 failed");
            EXPECT_EQ(toy.count_all(), 20u) << "nothing is left to do";
        }
}

TEST(SweepRun, AFailureIsTheCasesOwn)
{
    Toy toy(5);
    auto const good = toy.settings.run_case;
    toy.settings.run_case = [&](SweepCase const& c) -> std::string {
        std::string const out = good(c);
        if (c.text("samples") == "2") throw Error("not \"2\"");
        if (c.text("samples") == "3") throw std::bad_alloc();
        return c.text("samples") == "4" ? "no JSON" : out;
    };
    EXPECT_EQ(counts_of(toy.run()), "2 of 5 done, 3 failed");
    auto const results = toy.results();
    auto const text = [&](std::size_t i) { return results.at(toy.sweep.manifest.cases[i].id)[0]; };
    EXPECT_EQ(text(0), R"({"n":1})");
    EXPECT_EQ(text(1), R"(failed: not "2")");
    EXPECT_EQ(text(2), "failed: out of memory");
    EXPECT_TRUE(text(3).starts_with("failed: ")) << text(3);
    EXPECT_EQ(text(4), R"({"n":5})");

    EXPECT_EQ(counts_of(toy.run()), "2 of 5 done, 3 failed");
    EXPECT_EQ(toy.count(2), 1u) << "it is not tried again unasked";
    toy.settings.retry = true;
    EXPECT_EQ(counts_of(toy.run()), "2 of 5 done, 3 failed");
    EXPECT_EQ(toy.count(2), 2u);
    EXPECT_EQ(toy.count(1), 1u) << "what is done is not tried again";
    toy.settings.run_case = good;
    EXPECT_EQ(counts_of(toy.run()), "5 of 5 done, 0 failed");
    EXPECT_EQ(counts_of(toy.state()), "5 of 5 done, 0 failed");
    EXPECT_EQ(failures(toy.sweep.manifest, toy.sweep.folder).size(), 0u);
}

TEST(SweepRun, AFailureInWhateverBytesIsTheCasesOwn)
{
    Toy toy(3);
    auto const good = toy.settings.run_case;
    toy.settings.run_case = [&](SweepCase const& c) -> std::string {
        if (c.text("samples") == "2") throw Error("caf\xe9.obj");
        return good(c);
    };
    EXPECT_EQ(counts_of(toy.run()), "2 of 3 done, 1 failed");
}

TEST(SweepRun, ShardsPartitionTheCases)
{
    for (std::size_t per_block : {1u, 4u}) {
        Toy toy(30, per_block);
        std::size_t all = 0;
        for (std::size_t i = 1; i <= 3; ++i) {
            toy.settings.shard = {i, 3};
            SweepState const s = toy.run();
            EXPECT_EQ(s.done, s.cases);
            EXPECT_EQ(counts_of(toy.state({i, 3})), counts_of(s));
            all += s.cases;
            EXPECT_EQ(toy.count_all(), all) << "a shard computes its own";
        }
        EXPECT_EQ(all, 30u);
        EXPECT_EQ(counts_of(toy.state()), "30 of 30 done, 0 failed");
        for (std::size_t i = 1; i <= 30; ++i) EXPECT_EQ(toy.count(i), 1u);
    }
}

TEST(SweepRun, AShardWithoutCasesIsDone)
{
    Toy toy(2);
    toy.settings.shard = {3, 3};
    EXPECT_EQ(counts_of(toy.run()), "0 of 0 done, 0 failed");
}

TEST(SweepRun, ProcessesShareTheCases)
{
    for (std::size_t per_block : {1u, 7u}) {
        Toy toy(150, per_block);
        toy.settings.workers = 2;
        std::vector<pid_t> processes;
        for (int i = 0; i < 4; ++i)
            processes.push_back(spawn([&] {
                if (toy.run().done != 150) throw Error("it ended before all was done");
            }));
        for (pid_t p : processes) EXPECT_EQ(wait_for(p), 0);
        for (std::size_t i = 1; i <= 150; ++i) EXPECT_EQ(toy.count(i), 1u) << i;
        EXPECT_EQ(test::files_in(toy.sweep.folder / "claims"), 0u);
    }
}

TEST(SweepRun, ProcessesThatAreKilledLoseNoCase)
{
    Toy toy(300, 3);
    auto const quick = toy.settings.run_case;
    toy.settings.workers = 2;
    toy.settings.run_case = [&](SweepCase const& c) {
        std::string const out = quick(c);
        std::this_thread::sleep_for(std::chrono::microseconds(500));
        return out;
    };
    std::mt19937 random(3);
    std::set<std::string> done;
    std::size_t kills = 0;
    for (int round = 0; round < 12; ++round) {
        std::vector<pid_t> processes;
        for (int i = 0; i < 3; ++i) processes.push_back(spawn([&] { toy.run(); }));
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 20000));
        for (pid_t p : processes) kill(p, SIGKILL);
        for (pid_t p : processes) kills += wait_for(p) == -1;
        auto const results = toy.results();
        for (std::string const& id : done) EXPECT_EQ(results.count(id), 1u) << "a result is lost";
        for (auto const& [id, texts] : results) done.insert(id);
    }
    EXPECT_EQ(counts_of(toy.run()), "300 of 300 done, 0 failed");
    auto const results = toy.results();
    EXPECT_EQ(results.size(), 300u);
    for (std::size_t i = 0; i < 300; ++i)
        for (std::string const& text : results.at(toy.sweep.manifest.cases[i].id))
            EXPECT_EQ(text, "{\"n\":" + std::to_string(i + 1) + "}");
    EXPECT_LE(toy.count_all(), 300 + 2 * kills) << "a kill costs a worker the case it is at";
    // Claims that were made and not yet signed go once their lease is over.
    for (auto const& e : fs::directory_iterator(toy.sweep.folder / "claims"))
        fs::last_write_time(e.path(), fs::file_time_type::clock::now() - std::chrono::hours(1));
    toy.run();
    EXPECT_EQ(test::files_in(toy.sweep.folder / "claims"), 0u);
}

TEST(SweepRun, WaitsForWhoIsAtTheRestAndTakesOverWhereItsClaimLapses)
{
    Toy toy(3);
    fs::path const claim = toy.sweep.folder / "claims" / "000001.0";
    write_file(claim, R"({"host":"elsewhere","system":"another","process":17,"start":"1"})"
                      "\n");
    auto const touch = [&](std::chrono::hours later) {
        fs::last_write_time(claim, fs::file_time_type::clock::now() + later);
    };
    touch(std::chrono::hours(1));
    std::vector<std::string> waits;
    SweepState waiting;
    toy.settings.progress = [&](SweepProgress const& p) {
        if (p.waits_for.empty()) return;
        waits.push_back(p.waits_for);
        waiting = p.state;
        touch(std::chrono::hours(-1));
    };
    EXPECT_EQ(counts_of(toy.run()), "3 of 3 done, 0 failed");
    EXPECT_EQ(waits, std::vector<std::string>{"elsewhere, process 17"});
    EXPECT_EQ(counts_of(waiting), "2 of 3 done, 0 failed");
    EXPECT_EQ(toy.count_all(), 3u);
}

TEST(SweepRun, WhatAnotherFoundMeanwhileIsNotComputedAgain)
{
    Toy toy(3);
    auto const compute = toy.settings.run_case;
    toy.settings.run_case = [&](SweepCase const& c) {
        if (c.text("samples") == "1")
            ResultLog(toy.sweep.folder / "results")
                .add({toy.sweep.manifest.cases[2].id, true, R"({"n":3})"});
        return compute(c);
    };
    EXPECT_EQ(counts_of(toy.run()), "3 of 3 done, 0 failed");
    EXPECT_EQ(toy.count(3), 0u);
}

TEST(SweepRun, ProgressCountsUpToAll)
{
    Toy toy(10);
    toy.settings.workers = 3;
    std::size_t settled = 0, computed = 0;
    std::atomic<int> inside = 0;
    toy.settings.progress = [&](SweepProgress const& p) {
        EXPECT_EQ(inside++, 0) << "one at a time";
        EXPECT_GE(p.state.done, settled);
        EXPECT_EQ(p.state.cases, 10u);
        settled = p.state.done;
        computed = p.state.computed;
        --inside;
    };
    toy.run();
    EXPECT_EQ(settled, 10u);
    EXPECT_EQ(computed, 10u);
}

TEST(SweepRun, WhatCannotBeWrittenEndsTheRun)
{
    for (int workers : {1, 3}) {
        Toy toy(20);
        toy.settings.workers = workers;
        auto const compute = toy.settings.run_case;
        toy.settings.run_case = [&](SweepCase const& c) {
            fs::remove_all(toy.sweep.folder / "results");
            return compute(c);
        };
        EXPECT_NE(test::refusal([&] { toy.run(); }).find("results"), std::string::npos);
        EXPECT_LE(toy.count_all(), std::size_t(workers));
        EXPECT_EQ(test::files_in(toy.sweep.folder / "claims"), 0u);
    }
}

} // namespace
} // namespace tessemu
