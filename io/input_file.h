// Files as text.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"

#include <filesystem>
#include <string>

namespace tessemu {

/// A path as messages have it: "-" is "standard input".
std::string input_name(std::filesystem::path const& path);

/// Reads a whole file, or standard input, "-". Throws FormatError that names it, also where reading
/// fails halfway; refuses more than `limit` bytes.
std::string read_file(std::filesystem::path const& path, std::uint64_t limit = std::uint64_t(4)
                                                                               << 30);

} // namespace tessemu
