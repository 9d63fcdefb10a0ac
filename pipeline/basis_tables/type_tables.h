// The tables of a patch type as shaders read them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/generator.h"

#include <vector>

namespace tessemu {

/// Tables of one patch type in single precision.
struct PatchTypeTables {
    PatchType type;
    int points = 0; ///< control points, each a vertex of its own
    /// Of each control point of BasisTables, in its order: which of these it is. In tiny meshes two
    /// of them may be one vertex.
    std::vector<std::uint16_t> point_of;
    std::vector<std::uint16_t> beyond; ///< as BasisTables has it
    /// As BasisTables has them; of control points that are one vertex their sums.
    std::vector<float> position, du, dv;
};
/// \param point_of  empty: each is one of its own
PatchTypeTables in_single_precision(PatchType const& type, BasisTables const& tables,
                                    std::vector<std::uint16_t> point_of = {});

} // namespace tessemu
