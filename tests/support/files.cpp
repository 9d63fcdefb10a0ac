// SPDX-License-Identifier: Apache-2.0
#include "tests/support/files.h"

#include <fstream>
#include <iterator>

namespace tessemu::test {

std::filesystem::path golden(std::string const& name)
{
    return std::filesystem::path(TESSEMU_SOURCE_DIR) / "tests/golden" / name;
}

std::filesystem::path source(std::string const& name)
{
    return std::filesystem::path(TESSEMU_SOURCE_DIR) / name;
}

std::filesystem::path shared(std::string const& name)
{
    return std::filesystem::path(TESSEMU_SHARED_DIR) / name;
}

std::string read_text(std::filesystem::path const& path)
{
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace tessemu::test
