// The types of patches that tables can be made for ahead of any mesh: BOLZ03 section 2.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/symmetry.h"
#include "pipeline/basis_tables/table_store.h"
#include "pipeline/mesh/refinement.h"

namespace tessemu {

class ThreadPool;

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

/// What tables are, family by family.
struct TableSet {
    struct Family {
        PatchFamily family;
        std::size_t types = 0, made = 0; ///< made: not in the store
        std::size_t tables = 0;          ///< control points of all types
        /// In single precision: position and two tangents.
        std::uint64_t bytes() const { return bytes_of(tables); }
        static std::uint64_t bytes_of(std::size_t tables_)
        {
            return std::uint64_t(tables_) * 3 * kTableSamples * sizeof(float);
        }
    };
    std::vector<Family> families;
    SymmetryReport symmetry; ///< of enforcement over all of them
};

/// Takes tables from a store, or makes and keeps them.
TableSet make_table_set(std::span<TableFamily const> families, BasisTableStore& store,
                        ThreadPool const& threads, RefinementProgress const& progress = {});

} // namespace tessemu
