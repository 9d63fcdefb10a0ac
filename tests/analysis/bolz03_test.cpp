// BOLZ03's numbers: instructions of the scheme's own pixel shaders, and what follows from them on the
// GPU that the paper describes.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/bolz03/listing.h"
#include "analysis/papers/paper.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

double cell(PaperTable const& t, std::string const& row, std::string const& column)
{
    for (PaperCell const& c : t.cells)
        if (c.row == row && c.column == column) return c.ours;
    ADD_FAILURE() << row << ": " << column;
    return 0;
}

// Two control points: an addition, two texels, two MADs (section 3).
TEST(Bolz03Listing, BitExactSumsHaveThePapersInstructionsAndRegisters)
{
    for (auto [points, instructions] : {std::pair{16, 40u}, {26, 65u}}) {
        auto const n = std::uint64_t(points);
        TableListing const l = position_listing(TableOrder::Global, points);
        EXPECT_EQ(l.code.instructions(), instructions);
        EXPECT_EQ(l.code.add, n / 2);
        EXPECT_EQ(l.code.tex, n);
        EXPECT_EQ(l.code.mad, n);
        EXPECT_EQ(l.code.registers, 2);
        EXPECT_EQ(l.loads, n);
        // Three products and sums a point, and two additions of its address.
        EXPECT_EQ(l.written.mul, 3 * n);
        EXPECT_EQ(l.written.add, 5 * n);
        EXPECT_EQ(l.fused.mad, 3 * n);
        EXPECT_EQ(l.fused.add, 2 * n);
    }
}

// Four control points: an addition, a texel of four channels, four MADs; what is left, as many MADs
// as there are points.
TEST(Bolz03Listing, PackedSumsHaveThePapersInstructionsAndRegisters)
{
    for (auto [points, instructions] : {std::pair{16, 24u}, {26, 40u}}) {
        auto const n = std::uint64_t(points), groups = (n + 3) / 4;
        TableListing const l = position_listing(TableOrder::Table, points);
        EXPECT_EQ(l.code.instructions(), instructions);
        EXPECT_EQ(l.code.add, groups);
        EXPECT_EQ(l.code.tex, groups);
        EXPECT_EQ(l.code.mad, n);
        EXPECT_EQ(l.code.registers, 2);
        EXPECT_EQ(l.written.mul, 3 * n);
    }
}

// Two sums at one address, and MUL, MUL, ADD of the cross product: not a single product in a MAD.
TEST(Bolz03Listing, NormalsShareAddressesAndRoundEveryProductOfTheCrossProduct)
{
    for (int points : {16, 26}) {
        auto const n = std::uint64_t(points), groups = (n + 3) / 4;
        TableListing const packed = normal_listing(TableOrder::Table, points);
        EXPECT_EQ(packed.code.instructions(), 3 * groups + 2 * n + 3);
        EXPECT_EQ(packed.code.mul, 2u);
        EXPECT_EQ(packed.code.mad, 2 * n);
        EXPECT_EQ(packed.fused.mul, 6u);
        EXPECT_EQ(packed.fused.mad, 6 * n);
        TableListing const exact = normal_listing(TableOrder::Global, points);
        EXPECT_EQ(exact.code.tex, 2 * n);
        EXPECT_EQ(exact.code.mad, 2 * n);
        EXPECT_EQ(exact.code.mul, 2u);
        // Four components at once, which addresses ask for, leave the cross product two differences.
        EXPECT_EQ(exact.code.instructions(), n / 2 + 4 * n + 4);
    }
}

TEST(Bolz03Listing, ReadsLikeThePapers)
{
    std::vector<std::string> const code = position_listing(TableOrder::Global, 4).code.listing;
    EXPECT_EQ(code, (std::vector<std::string>{
                        "ADD R0.xyzw, c0.xyzw, t0.xyxy", "TEX R0.x, R0.xy, tex0",
                        "MAD R1.xyz, R0.x, c1.xyz, c2.x", "TEX R0.x, R0.zw, tex0",
                        "MAD R1.xyz, R0.x, c3.xyz, R1.xyz", "ADD R0.xyzw, c4.xyzw, t0.xyxy",
                        "TEX R0.x, R0.xy, tex0", "MAD R1.xyz, R0.x, c5.xyz, R1.xyz",
                        "TEX R0.x, R0.zw, tex0", "MAD R1.xyz, R0.x, c6.xyz, R1.xyz"}));
}

TEST(Bolz03Listing, TheTableHasThePapersNumbersAndOurs)
{
    PaperTable const t = reproduce_bolz03_listing();
    ASSERT_EQ(t.cells.size(), 10u);
    for (PaperCell const& c : t.cells)
        if (c.column == "instructions" || c.column == "registers") {
            EXPECT_EQ(c.ours, c.paper) << c.row << ' ' << c.column;
        }
    // The paper's 52 and 84 less the shared addresses, 4 and 7, and what it does not print.
    constexpr char const* kNormals = "additional instructions of normals";
    EXPECT_EQ(cell(t, "packed, valence 4 (16 tables)", kNormals), 47);
    EXPECT_EQ(cell(t, "packed, valence 9 (26 tables)", kNormals), 76);
}

} // namespace
} // namespace tessemu
