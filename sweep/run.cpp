// SPDX-License-Identifier: Apache-2.0
#include "sweep/run.h"

#include "io/output_file.h"
#include "sweep/results.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <unordered_map>

namespace tessemu {

namespace {

// Without what differs from run to run: times, threads, lanes.
std::string one_line(std::string const& result)
{
    auto j = nlohmann::ordered_json::parse(result);
    j.erase("run");
    return j.dump();
}

// A shard's cases and how far they are.
class Cases {
public:
    Cases(SweepManifest const& manifest, std::filesystem::path const& folder, Shard const& shard)
        : manifest_(manifest),
          shard_(shard),
          reader_(folder / "results"),
          states_(manifest.cases.size(), State::Open)
    {
        number_.reserve(manifest.cases.size());
        for (std::size_t i = 0; i < manifest.cases.size(); ++i) {
            number_.emplace(manifest.cases[i].id, i);
            if (shard.has(i / manifest.per_block)) ++counts_.cases;
        }
        read();
    }

    /// What others have done meanwhile.
    void read()
    {
        reader_.read_states([&](std::string const& id, bool done) { settle(id, done); });
    }
    void settle(std::string const& id, bool done)
    {
        auto const at = number_.find(id);
        if (at == number_.end()) return; // of a plan that is gone
        State& s = states_[at->second];
        if (s == State::Done) return;
        State const next = done ? State::Done : State::Failed;
        if (shard_.has(at->second / manifest_.per_block)) {
            counts_.failed -= s == State::Failed;
            counts_.done += done;
            counts_.failed += !done;
        }
        s = next;
    }
    void reopen_failed()
    {
        for (State& s : states_)
            if (s == State::Failed) s = State::Open;
        counts_.failed = 0;
    }
    std::vector<std::size_t> open_cases(std::size_t block) const
    {
        std::vector<std::size_t> out;
        std::size_t const end = std::min((block + 1) * manifest_.per_block, manifest_.cases.size());
        for (std::size_t i = block * manifest_.per_block; i < end; ++i)
            if (states_[i] == State::Open) out.push_back(i);
        return out;
    }
    std::vector<std::size_t> open_blocks() const
    {
        std::vector<std::size_t> out;
        for (std::size_t b = 0; b < manifest_.blocks(); ++b)
            if (shard_.has(b) && !open_cases(b).empty()) out.push_back(b);
        return out;
    }
    SweepState const& counts() const { return counts_; }

private:
    enum class State : char { Open, Done, Failed };
    SweepManifest const& manifest_;
    Shard shard_;
    ResultReader reader_;
    std::unordered_map<std::string, std::size_t> number_;
    std::vector<State> states_;
    SweepState counts_;
};

class Run {
public:
    Run(SweepManifest const& manifest, std::filesystem::path const& folder,
        SweepRunSettings const& settings)
        : manifest_(manifest),
          folder_(made(folder)),
          settings_(settings),
          cases_(manifest, folder, settings.shard),
          claims_(folder / "claims", settings.lease),
          log_(folder / "results")
    {
    }

    SweepState run()
    {
        if (settings_.retry) cases_.reopen_failed();
        for (;;) {
            cases_.read();
            blocks_ = cases_.open_blocks();
            if (blocks_.empty()) break;
            std::size_t const before = computed_;
            run_blocks();
            if (computed_ == before) wait();
        }
        report("");
        claims_.clear_lapsed([&](std::size_t block) {
            return block >= manifest_.blocks() || cases_.open_cases(block).empty();
        });
        SweepState out = sweep_state(manifest_, folder_, settings_.shard);
        if (out.open() > 0)
            throw WriteError(fmt::format("{}: results of {} cases were there and are gone",
                                         (folder_ / "results").string(), out.open()));
        out.computed = computed_;
        return out;
    }

private:
    using Clock = std::chrono::steady_clock;

    // Once over the blocks, by all workers.
    void run_blocks()
    {
        next_ = 0;
        std::vector<std::thread> workers;
        for (int i = 0; i < settings_.workers; ++i) workers.emplace_back([this] { work(); });
        for (std::thread& w : workers) w.join();
        if (error_) std::rethrow_exception(error_);
        give_back();
    }

    void work()
    {
        try {
            for (;;) {
                std::size_t block = 0;
                {
                    std::scoped_lock const lock(mutex_);
                    if (error_ || next_ == blocks_.size()) return;
                    block = blocks_[next_++];
                }
                run_block(block);
            }
        } catch (...) {
            std::scoped_lock const lock(mutex_);
            if (!error_) error_ = std::current_exception();
        }
    }

    void run_block(std::size_t block)
    {
        if (!claims_.take(block)) return;
        std::vector<std::size_t> open;
        {
            std::scoped_lock const lock(mutex_);
            cases_.read(); // somebody may have done it and given the claim back just now
            open = cases_.open_cases(block);
        }
        for (std::size_t const i : open) {
            CaseRecord r{manifest_.cases[i].id, true, ""};
            try {
                r.text = one_line(settings_.run_case(manifest_.cases[i]));
            } catch (std::bad_alloc const&) {
                r = {r.id, false, "out of memory"};
            } catch (std::exception const& e) {
                r = {r.id, false, e.what()};
            }
            log_.add(r);
            std::scoped_lock const lock(mutex_);
            cases_.settle(r.id, r.done);
            ++computed_;
            report("");
        }
        std::scoped_lock const lock(mutex_);
        finished_.push_back(block);
        // A file server would rather hear of many at once.
        if (Clock::now() - given_back_ > std::chrono::milliseconds(500)) give_back();
    }

    void give_back()
    {
        log_.flush();
        claims_.give_back(finished_);
        finished_.clear();
        given_back_ = Clock::now();
    }

    // All that is left is others'.
    void wait()
    {
        report(claims_.holder(blocks_[0]));
        auto const seconds = std::chrono::duration<double>(std::min(1.0, settings_.lease / 8));
        std::this_thread::sleep_for(seconds);
    }

    void report(std::string const& waits_for)
    {
        SweepState state = cases_.counts();
        state.computed = computed_;
        if (settings_.progress) settings_.progress({state, waits_for});
    }

    // Archives drop empty folders.
    static std::filesystem::path made(std::filesystem::path const& folder)
    {
        for (char const* name : {"results", "claims"}) {
            std::error_code error;
            std::filesystem::create_directories(folder / name, error);
            if (error) throw WriteError((folder / name).string() + ": " + error.message());
        }
        return folder;
    }

    SweepManifest const& manifest_;
    std::filesystem::path folder_;
    SweepRunSettings const& settings_;
    std::mutex mutex_; // of all below, but claims and log, which have their own
    Cases cases_;
    std::vector<std::size_t> blocks_, finished_;
    std::size_t next_ = 0, computed_ = 0;
    Clock::time_point given_back_ = Clock::now();
    std::exception_ptr error_;
    Claims claims_;
    ResultLog log_;
};

} // namespace

SweepState run_sweep(SweepManifest const& manifest, std::filesystem::path const& folder,
                     SweepRunSettings const& settings)
{
    return Run(manifest, folder, settings).run();
}

SweepState sweep_state(SweepManifest const& manifest, std::filesystem::path const& folder,
                       Shard const& shard)
{
    return Cases(manifest, folder, shard).counts();
}

} // namespace tessemu
