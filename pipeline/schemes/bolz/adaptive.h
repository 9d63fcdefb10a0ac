// Levels of patches by how far their triangles may lie from the surface (BOLZ03 3).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/mesh_basis.h"
#include "pipeline/schemes/bolz/grid.h"

namespace tessemu {

/// A patch that is drawn.
struct DrawnPatch {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t patch;                     ///< of MeshBasis::patches()
    std::array<std::uint32_t, 4> neighbours; ///< drawn patches beyond edges 0 to 3, or kNone
};

struct AdaptiveLevels {
    std::vector<GridLevels> patches; ///< of the drawn patches
    /// Those whose bound is above the distance at the most segments, and the largest bound.
    std::size_t beyond = 0;
    double largest = 0;
    double rounding = 0; ///< the most that single precision has of a bound
};

/// Each patch has the smallest level whose bound is at most `distance`, and its edges the lesser of
/// both patches' levels. Where that takes a strip at an edge beyond the distance, the coarser patch
/// beyond the edge gets a level more, until none is: so the bound is that of the triangles as they
/// are drawn.
///
/// \param mesh      at rest
/// \param distance  in the mesh's unit of length, above 0
/// \param origin    what is taken off the control points before they are summed
AdaptiveLevels adaptive_levels(std::span<DrawnPatch const> drawn, MeshBasis const& basis,
                               ControlMesh const& mesh, double distance,
                               glm::dvec3 origin = glm::dvec3(0));

} // namespace tessemu
