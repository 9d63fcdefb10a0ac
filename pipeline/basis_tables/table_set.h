// The types of patches that tables can be made for ahead of any mesh: BOLZ03 section 2.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/patch_type.h"

namespace tessemu {

/// Patches whose corners are alike, of each number of faces and with the tags in each position.
struct TableFamily {
    PatchFamily family; ///< Regular is among Smooth
    std::vector<PatchType> types;
};

/// Smooth and dart vertices of 2 faces and more (a ring of one face is no manifold), sectors of
/// creases and boundaries, convex corners, and by Biermann's rules concave corners (of 2 faces and
/// more: a face alone is taken as convex); nothing beyond a patch has an influence on it.
///
/// \param first, last  faces, 1 to PatchType::kMostFaces
/// \param rules        sectors and flatness of them
std::vector<TableFamily> table_families(int first, int last, SubdivisionRules const& rules);

} // namespace tessemu
