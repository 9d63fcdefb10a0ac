// Symmetry enforcement: entries of tables that patches share get equal bits (BOLZ03 2.1.1;
// docs/math/subdivision.md, 5.5 and 5.6).
//
// Two patches that share a side have the same surface there, so a control point of both has the
// same weights on it, and one that only one patch has has none. Along a side its tangents are equal
// too, and across it opposite: both patches' point inwards. Not so on an infinitely sharp edge,
// where each patch has a tangent of its own across, nor at the corner (0,0), whose tangents are
// directions alone.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/joints.h"

#include <span>

namespace tessemu {

struct SymmetryReport {
    std::size_t joints = 0;
    /// Classes of equal table edges: a control point's weights along a side of a type.
    struct Classes {
        std::size_t table_edges = 0; ///< those not 0 throughout
        std::size_t directed = 0;
        std::size_t undirected = 0; ///< where a side reversed is the same too

        bool operator==(Classes const&) const = default;
    };
    Classes off_corner;             ///< Right, Upper
    Classes off_corner_at_a_tag;    ///< that end at an infinitely sharp edge
    Classes on_corner;              ///< Lower, Left; of V, its ring and what lies beyond
    Classes two_ring;               ///< the same, of (2,0), (2,1), (2,-1) and their mirror images
    std::size_t entries = 0;        ///< of positions and tangents that were compared
    std::size_t changed = 0;        ///< entries that got another value
    std::size_t zeroed = 0;         ///< of these: roundings of 0
    std::uint64_t changed_ulps = 0; ///< of the others, in all
    std::uint32_t most_ulps = 0;    ///< of one entry
    std::size_t passes = 0;         ///< until nothing changed
};

/// Whether a report has classes, which say nothing of a mesh's few types.
enum class CountClasses { No, Yes };

/// Entries that joints make equal get the least of their values, those of tangents the value
/// nearest to 0 with its sign; of a control point that the other patch lacks they become 0. A
/// sample on two sides is in the classes of both.
///
/// \param points  of each joint, where a mesh tells; empty: as the types' names of them say
SymmetryReport enforce_symmetry(std::span<PatchTypeTables> types, std::span<Joint const> joints,
                                std::span<JointPoints const> points,
                                CountClasses classes = CountClasses::No);

} // namespace tessemu
