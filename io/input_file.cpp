// SPDX-License-Identifier: Apache-2.0
#include "io/input_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace tessemu {

namespace fs = std::filesystem;

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
