// Symmetry enforcement: entries of tables that patches share get equal bits (BOLZ03 2.1.1;
// docs/math/subdivision.md, 5.5 and 5.6).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/generator.h"

#include <span>

namespace tessemu {

/// Tables of one patch type in single precision.
struct PatchTypeTables {
    PatchType type;
    int points = 0;                    ///< control points
    std::vector<std::uint16_t> beyond; ///< as BasisTables has it
    /// As BasisTables has them.
    std::vector<float> position, du, dv;
};
PatchTypeTables in_single_precision(PatchType const& type, BasisTables const& tables);

/// Counter-clockwise from the corner; the first and the last are on-corner.
enum class PatchSide : std::uint8_t { Lower, Right, Upper, Left };

/// Patches of types a and b, by number, share a side; they run along it in opposite directions.
struct Joint {
    std::uint32_t a;
    PatchSide side_a;
    std::uint32_t b;
    PatchSide side_b;

    auto operator<=>(Joint const&) const = default;
    /// Of the two ways to write a joint the one with Lower or Right first.
    bool is_canonical() const { return side_a == PatchSide::Lower || side_a == PatchSide::Right; }
};

struct SymmetryReport {
    std::size_t joints = 0;
    std::size_t passes = 0;
};

/// Entries of the tables that joints make equal get the least of them, of tangents the one nearest
/// to 0, until nothing changes; weights of control points that the other patch lacks become 0.
SymmetryReport enforce_symmetry(std::span<PatchTypeTables> types, std::span<Joint const> joints);

} // namespace tessemu
