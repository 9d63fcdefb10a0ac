// SPDX-License-Identifier: Apache-2.0
#include "io/atomic_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

#include <unistd.h>

namespace tessemu {

namespace fs = std::filesystem;

void write_atomically(fs::path const& path, std::function<void(fs::path const&)> const& write)
{
    fs::path const folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ec;
    if (!fs::is_directory(folder, ec))
        throw WriteError(path.string() + ": the folder " + folder.string() + " does not exist");
    if (fs::is_directory(path, ec)) throw WriteError(path.string() + ": is a folder");
    fs::path const temporary = folder / (path.stem().string() + ".tmp" + std::to_string(getpid()) +
                                         path.extension().string());
    try {
        write(temporary);
    } catch (...) {
        fs::remove(temporary, ec);
        throw;
    }
    fs::rename(temporary, path, ec);
    if (ec) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw WriteError(path.string() + ": " + ec.message());
    }
}

void write_file(fs::path const& path, std::string_view bytes)
{
    write_atomically(path, [&](fs::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        if (!out) throw WriteError(path.string() + ": " + std::strerror(errno));
        out.write(bytes.data(), std::streamsize(bytes.size()));
        out.close();
        if (!out) throw WriteError(path.string() + ": writing failed (is the disk full?)");
    });
}

std::string read_file(fs::path const& path, std::uint64_t limit)
{
    std::error_code ec;
    if (fs::is_directory(path, ec)) throw FormatError(path.string(), 0, "is a folder, not a file");
    std::ifstream in(path, std::ios::binary);
    if (!in)
        throw FormatError(path.string(), 0,
                          std::string("cannot be opened: ") + std::strerror(errno));
    std::string text;
    char block[1 << 16];
    while (in.read(block, sizeof block) || in.gcount() > 0) {
        text.append(block, std::size_t(in.gcount()));
        if (text.size() > limit)
            throw FormatError(path.string(), 0,
                              "is larger than the limit of " + std::to_string(limit) + " bytes");
    }
    return text;
}

} // namespace tessemu
