// SPDX-License-Identifier: Apache-2.0
#include "io/input_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace tessemu {

namespace fs = std::filesystem;

std::string input_name(fs::path const& path)
{
    return path == "-" ? "standard input" : path.string();
}

std::string read_file(fs::path const& path, std::uint64_t limit)
{
    auto const fail = [&](std::string const& what) {
        throw FormatError(input_name(path), 0, what);
    };
    struct Close {
        void operator()(std::FILE* file) const
        {
            if (file != stdin) std::fclose(file);
        }
    };
    std::error_code ec;
    bool const standard_input = path == "-";
    if (!standard_input && fs::is_directory(path, ec)) fail("is a folder, not a file");
    std::unique_ptr<std::FILE, Close> const file(standard_input ? stdin
                                                                : std::fopen(path.c_str(), "rb"));
    if (!file) fail(std::string("cannot be opened: ") + std::strerror(errno));
    std::string text;
    char block[1 << 16];
    while (std::size_t const n = std::fread(block, 1, sizeof block, file.get())) {
        text.append(block, n);
        if (text.size() > limit)
            fail("is larger than the limit of " + std::to_string(limit) + " bytes");
    }
    if (std::ferror(file.get())) fail(std::string("cannot be read: ") + std::strerror(errno));
    return text;
}

} // namespace tessemu
