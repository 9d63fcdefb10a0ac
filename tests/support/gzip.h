// Compressed text of the golden data.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <filesystem>
#include <string>

namespace tessemu::test {

inline std::string read_gzip(std::filesystem::path const& path)
{
    std::string text;
    gzFile const file = gzopen(path.c_str(), "rb");
    char block[1 << 16];
    for (int n; (n = gzread(file, block, sizeof block)) > 0;) text.append(block, std::size_t(n));
    gzclose(file);
    return text;
}

} // namespace tessemu::test
