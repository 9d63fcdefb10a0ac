// Where tests find their data.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace tessemu::test {

/// A file of tests/golden.
std::filesystem::path golden(std::string const& name);
/// A file of the project.
std::filesystem::path source(std::string const& name);
/// A file of the shared folder beside the project; may be missing.
std::filesystem::path shared(std::string const& name);
std::string read_text(std::filesystem::path const& path);

} // namespace tessemu::test

/// Skips the test, with the reason, where the shared folder lacks a file.
#define TESSEMU_NEEDS_SHARED(name)                                                                 \
    if (!std::filesystem::exists(tessemu::test::shared(name)))                                     \
    GTEST_SKIP() << "needs " << tessemu::test::shared(name) << ", which is not there"
