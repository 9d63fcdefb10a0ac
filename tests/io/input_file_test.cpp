// SPDX-License-Identifier: Apache-2.0
#include "io/input_file.h"

#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

std::string message_of(fs::path const& path, std::uint64_t limit = 1000)
{
    try {
        read_file(path, limit);
    } catch (FormatError const& e) {
        return e.what();
    }
    return "";
}

TEST(ReadFile, SaysWhyNotAllCouldBeRead)
{
    EXPECT_EQ(message_of("/nowhere/a"), "/nowhere/a: cannot be opened: No such file or directory");
    EXPECT_EQ(message_of("/"), "/: is a folder, not a file");
    if (fs::exists("/proc/self/mem")) // its first page is not there
    {
        EXPECT_EQ(message_of("/proc/self/mem"),
                  "/proc/self/mem: cannot be read: Input/output error");
    }
}

TEST(ReadFile, ReadsStandardInputWithTheSameLimit)
{
    fs::path const path =
        fs::temp_directory_path() / ("tessemu_input_test_" + std::to_string(getpid()));
    std::ofstream(path) << "12345";
    for (std::uint64_t limit : {5, 4}) {
        ASSERT_NE(std::freopen(path.c_str(), "rb", stdin), nullptr);
        EXPECT_EQ(message_of("-", limit),
                  limit == 5 ? "" : "standard input: is larger than the limit of 4 bytes");
    }
    ASSERT_NE(std::freopen(path.c_str(), "rb", stdin), nullptr);
    EXPECT_EQ(read_file("-"), "12345");
    fs::remove(path);
}

} // namespace
} // namespace tessemu
