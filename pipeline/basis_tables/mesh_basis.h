// Basis-function tables of a mesh's patches: BOLZ03 section 2.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/symmetry.h"
#include "pipeline/basis_tables/table_store.h"
#include "pipeline/mesh/refinement.h"

namespace tessemu {

class ThreadPool;

/// A patch of the drawn mesh.
struct BasisPatch {
    std::uint32_t face;        ///< of the drawn mesh
    int rotation;              ///< the corner (0,0) is the face's corner `rotation`
    std::uint32_t type;        ///< index into MeshBasis::types()
    std::uint32_t first_point; ///< its control points: MeshBasis::points()[first_point + k], by
                               ///< vertex of the drawn mesh, in the order of the type's tables
    /// A number for the corner's vertex and sector: the same for all patches that meet there on one
    /// side of its infinitely sharp edges.
    std::uint32_t corner;
};

struct BasisOptions {
    bool enforced = true;                ///< entries that patches share have equal bits
    ThreadPool const* threads = nullptr; ///< makes tables on several threads; none: on this one
};

class MeshBasis {
public:
    /// \param mesh   after the steps that leave each face one extraordinary or tagged vertex
    /// \param store  where tables are looked for, and kept; none: all are made
    /// \cost  linear in the patches; some milliseconds and 3 MB for a type that is in no store
    /// Throws Error for a face with more than one such vertex, and LimitError for a vertex of more
    /// than PatchType::kMostFaces.
    explicit MeshBasis(RefinedMesh const& mesh, BasisTableStore* store = nullptr,
                       BasisOptions options = {}, RefinementProgress const& progress = {});

    /// In the order of first use. A PatchType may occur more than once, with other points that are
    /// one vertex.
    std::span<PatchTypeTables const> types() const { return types_; }
    /// Of all faces, holes too, in the order of the faces.
    std::span<BasisPatch const> patches() const { return patches_; }
    std::span<std::uint32_t const> points() const { return points_; }
    std::size_t corners() const { return corner_owner_.size(); }
    /// By corner: the first of its patches, whose tangents at (0,0) give the normal of all.
    std::span<std::uint32_t const> corner_owner() const { return corner_owner_; }

private:
    std::vector<PatchTypeTables> types_;
    std::vector<BasisPatch> patches_;
    std::vector<std::uint32_t> points_, corner_owner_;
};

} // namespace tessemu
