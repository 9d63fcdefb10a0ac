// Files that are whole or not there: written beside their place, then renamed.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/error.h"

#include <filesystem>
#include <functional>
#include <string_view>

namespace tessemu {

/// A file cannot be written; what() names it and the reason.
struct WriteError : Error {
    using Error::Error;
};

/// Calls `write` with a temporary path in the target's folder (same extension), then renames.
/// Removes the temporary and rethrows if `write` throws.
void write_atomically(std::filesystem::path const& path,
                      std::function<void(std::filesystem::path const&)> const& write);

/// Writes a whole text or byte string.
void write_file(std::filesystem::path const& path, std::string_view bytes);

/// Reads a whole file. Throws FormatError that names it; refuses more than `limit` bytes.
std::string read_file(std::filesystem::path const& path, std::uint64_t limit = std::uint64_t(4)
                                                                               << 30);

} // namespace tessemu
