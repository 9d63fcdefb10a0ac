// Generator of basis-function tables: BOLZ03 section 2 (docs/math/subdivision.md, 5.4).
//
// A piece of a mesh around the patch, each control point of it the unit vector of its own axis, is
// refined by the library's own rules, down to the grid's vertices, and those are taken to their
// limits. After each step only faces that touch the patch are kept.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/patch_type.h"

namespace tessemu {

/// Steps down to the grid; 2^5 + 1 samples on a side.
inline constexpr int kTableSteps = 5;
inline constexpr int kTableSide = (1 << kTableSteps) + 1;
inline constexpr int kTableSamples = kTableSide * kTableSide;

/// Weights of a patch's control points, in double.
struct BasisTables {
    int points = 0;                    ///< control points, in the order of PatchType::points()
    std::vector<std::uint16_t> beyond; ///< the last of them, by number in beyond_points()
    /// [control point * kTableSamples + j * kTableSide + i]: at u = i/32, v = j/32. Sums over the
    /// control points are 1, 0, 0.
    ///
    /// du and dv are derivatives; at the corner (0,0), where those may be 0 or infinite, two
    /// directions whose cross product points outwards. On an infinitely sharp edge they are those
    /// of the patch's side.
    std::vector<double> position, du, dv;

    std::size_t bytes() const { return sizeof(double) * 3 * position.size(); }
    bool operator==(BasisTables const&) const = default;
};

/// \param steps  down to the grid, of 2^steps + 1 samples on a side in place of kTableSide
/// \cost  time of order of the samples times the control points: some milliseconds
BasisTables make_basis_tables(PatchType const& type, int steps = kTableSteps);

} // namespace tessemu
