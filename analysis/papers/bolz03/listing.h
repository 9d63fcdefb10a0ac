// BOLZ03's instruction counts: the pixel shaders of the scheme as code of a GeForce FX.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"
#include "emu/vector_code.h"
#include "pipeline/schemes/bolz/table_patches.h"

namespace tessemu {

/// A pixel shader, recorded.
struct TableListing {
    VectorCode code;
    FlopCount written; ///< scalar operations
    /// Unique ones, products fused into sums but for those of the cross product, which are rounded
    /// by themselves.
    FlopCount fused;
    std::uint64_t loads = 0; ///< texels
};

/// Of a patch with so many control points, from 1 to 500.
TableListing position_listing(TableOrder order, int points);
/// Of the second pass.
TableListing normal_listing(TableOrder order, int points);

/// Control points of a patch whose corner is an interior vertex of so many faces.
constexpr int control_points_at(int valence)
{
    return 2 * valence + 8;
}

/// Section 3.1's counts and section 3's two listings.
PaperTable reproduce_bolz03_listing();

} // namespace tessemu
