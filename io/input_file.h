// Files as text.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"

#include <filesystem>
#include <string>

namespace tessemu {

/// Reads a whole file. Throws FormatError that names it; refuses more than `limit` bytes.
std::string read_file(std::filesystem::path const& path, std::uint64_t limit = std::uint64_t(4)
                                                                               << 30);

} // namespace tessemu
