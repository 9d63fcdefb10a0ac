// docs/conformance.md: its table of formats is the enum, row by row.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/formats.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

namespace tessemu::test {
namespace {

TEST(Conformance, F6TheTableOfFormatsIsTheEnum)
{
    std::vector<std::string> expected;
    for (std::size_t i = 0; i < kFormats; ++i) {
        FormatInfo const& f = info(Format(i));
        auto const word = [](bool can) { return can ? "yes" : "no"; };
        std::ostringstream row;
        row << "| " << f.name << " | " << int(f.bytes) << " | "
            << word(can_be_vertex_element(f.type)) << " | " << word(can_be_render_target(f.type))
            << " | "
            << (f.type == FormatType::Depth      ? "no"
                : f.name == "R32G32B32A32_FLOAT" ? "yes"
                                                 : "decoded")
            << " | " << word(f.type == FormatType::Depth) << " |";
        expected.push_back(row.str());
    }
    std::vector<std::string> rows;
    std::istringstream page(read_text(source("docs/conformance.md")));
    bool inside = false;
    for (std::string line; std::getline(page, line);) {
        if (line.starts_with("## ")) inside = line == "## Formats";
        if (inside && line.starts_with("| ") && !line.starts_with("| format") &&
            !line.starts_with("| ---"))
            rows.push_back(line);
    }
    EXPECT_EQ(rows, expected);
}

} // namespace
} // namespace tessemu::test
