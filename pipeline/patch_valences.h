// Which extraordinary vertex shapes a patch, and the colours that the valence view gives them
// (LOOP10's figure 4).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"

namespace tessemu {

/// What the valence view says of a patch.
struct PatchValence {
    static constexpr int kRegular = 4, kBoundary = 0;
    static constexpr int kLast = 12; ///< that has a colour of its own

    /// The valence among its interior corners' that is furthest from 4, of two the larger; of a
    /// face that is no quad also its number of sides, which is the valence of the vertex that a
    /// step of subdivision puts into it. kRegular where none is extraordinary, and kBoundary if
    /// such a face touches the boundary.
    int valence = kRegular;

    /// "green"
    std::string_view color_name() const;
    std::array<float, 3> color() const;
    /// "valence 5", "regular", "boundary"
    std::string in_words() const;
};

PatchValence patch_valence(Topology const& topology, std::uint32_t face);

/// Of the patches of a mesh, by their places.
class PatchValences {
public:
    explicit PatchValences(RefinedMesh const& mesh);
    /// Of a patch of the mesh, however it is turned.
    PatchValence operator()(PatchPlace const& place) const;

private:
    FacesByPlace faces_;
    std::vector<int> valences_; // by face
};

/// How many patches of a draw's or a frame's list each has: regular ones first, then by valence,
/// those at the boundary last; what does not occur is left out.
std::vector<std::pair<PatchValence, std::size_t>> count_valences(PatchMesh const& mesh);
/// A line for each of them, with its colour.
std::string valence_legend(PatchMesh const& mesh);

} // namespace tessemu
