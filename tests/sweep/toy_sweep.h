// A verb that computes nothing, sweeps of it, and processes that share them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "sweep/manifest.h"
#include "sweep/run.h"
#include "tests/support/files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tessemu::test {

/// An empty folder of the test's own.
inline std::filesystem::path scratch()
{
    auto const p =
        std::filesystem::temp_directory_path() / ("tessemu_sweep_test_" + std::to_string(getpid()));
    std::filesystem::remove_all(p);
    std::filesystem::create_directories(p);
    return p;
}

/// "toy": model, scheme (acc), tess (1 to 64), samples (4), set, quick
inline SweepVerb toy_verb(std::string const& name = "toy")
{
    if (name != "toy") throw Error("\"verb\" is \"" + name + "\", it must be toy");
    SweepVerb out;
    out.name = name;
    out.options = {{.name = "model", .required = true},
                   {.name = "scheme", .fallback = {"acc"}},
                   {.name = "tess"},
                   {.name = "samples", .fallback = {"4"}},
                   {.name = "set", .repeated = true},
                   {.name = "quick", .flag = true, .fallback = {"false"}}};
    out.check = [](SweepVerb::Option const& o, std::string const& text, std::string const& label) {
        if (o.name != "tess") return;
        double const x = std::strtod(text.c_str(), nullptr);
        if (!(x >= 1 && x <= 64)) throw Error(label + " is " + text + ", it must be 1 to 64");
    };
    return out;
}

inline Sweep toy_sweep(std::string const& text)
{
    return read_sweep(text, "toy.json", [](std::string const& name) { return toy_verb(name); });
}

/// No option names a file.
inline SweepPlan toy_plan(std::string const& text, std::string const& version = "1")
{
    return plan_sweep(toy_sweep(text), toy_verb(), version, [](auto&&...) { return std::nullopt; });
}

/// A sweep of so many cases, planned.
struct Planned {
    std::filesystem::path folder;
    SweepManifest manifest;

    explicit Planned(int cases, std::size_t per_block = 1) : folder(scratch() / "sweep")
    {
        std::string samples;
        for (int i = 1; i <= cases; ++i) samples += (i > 1 ? "," : "") + std::to_string(i);
        std::string const text =
            R"({"verb": "toy", "models": "jug", "samples": [)" + samples + "]}";
        write_plan(toy_plan(text), folder, text);
        manifest = read_manifest(folder);
        manifest.per_block = per_block;
    }
};

inline std::size_t files_in(std::filesystem::path const& folder)
{
    return std::size_t(std::distance(std::filesystem::directory_iterator(folder),
                                     std::filesystem::directory_iterator()));
}

/// Files of claims on blocks.
inline std::size_t claims_in(std::filesystem::path const& folder)
{
    std::size_t out = 0;
    for (auto const& e : std::filesystem::directory_iterator(folder))
        out += e.path().filename().string().find_first_not_of("0123456789.") == std::string::npos;
    return out;
}

/// Also among processes.
inline void append_byte(std::filesystem::path const& path)
{
    int const file = open(path.c_str(), O_CREAT | O_WRONLY | O_APPEND | O_CLOEXEC, 0666);
    if (file < 0 || write(file, "x", 1) != 1) throw Error("cannot append to " + path.string());
    close(file);
}

/// Another process; its status is 0 where the work ends and throws nothing.
template <class Work> pid_t spawn(Work const& work)
{
    pid_t const pid = fork();
    if (pid != 0) return pid;
    try {
        work();
        _exit(0);
    } catch (std::exception const& e) {
        fmt::print(stderr, "{}\n", e.what());
    } catch (...) {
    }
    _exit(1);
}

/// \returns  the exit status; -1: ended by a signal
inline int wait_for(pid_t pid)
{
    int status = 0;
    EXPECT_EQ(waitpid(pid, &status, 0), pid);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// What an Error says; "" without one.
template <class Work> std::string refusal(Work const& work)
{
    try {
        work();
    } catch (Error const& e) {
        return e.what();
    }
    return "";
}

} // namespace tessemu::test
