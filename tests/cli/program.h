// Runs the program as its users do.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/support/files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace tessemu::test {

struct Result {
    int status; ///< -1: ended by a signal
    std::string out, err;
};

/// A folder of the test's own.
inline std::filesystem::path scratch()
{
    static std::filesystem::path const folder = [] {
        auto const p =
            std::filesystem::temp_directory_path() / ("tessemu_cli_" + std::to_string(getpid()));
        std::filesystem::create_directories(p);
        return p;
    }();
    return folder;
}

/// A command of the shell.
inline Result run_command(std::string const& command,
                          std::filesystem::path const& input = "/dev/null")
{
    std::filesystem::path const out = scratch() / "stdout", err = scratch() / "stderr";
    int const status = std::system(
        (command + " >" + out.string() + " 2>" + err.string() + " <" + input.string()).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(out), read_text(err)};
}

/// The program with these arguments.
inline Result run(std::string const& arguments, std::filesystem::path const& input = "/dev/null")
{
    return run_command(std::string(TESSEMU_PROGRAM) + " " + arguments, input);
}

/// The JSON of draw with these arguments.
inline nlohmann::ordered_json draw_json(std::string const& arguments)
{
    Result const r = run("draw " + arguments + " --json -");
    EXPECT_EQ(r.status, 0) << r.err;
    return nlohmann::ordered_json::parse(r.out);
}

} // namespace tessemu::test
