// Patch types of quad meshes by the valences of a quad's four corners, as LOOP10 4.4 counts them:
// each is a change-of-basis matrix, the same for all meshes.
//
// The control set of a quad whose corners are interior and whose neighbours are quads is its
// one-ring: 4 + sum of (2 n - 5) vertices. A hull shader takes 32, so the valences of LOOP10's
// types, 3 to 12, add up to 24 at most: 449 types, rotations being one type and reflections two. A
// step of subdivision leaves at most one extraordinary vertex to a quad, and so 9 types besides the
// regular one.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/connectivity.h"

#include <array>
#include <compare>
#include <optional>

namespace tessemu {

/// Counter-clockwise, from the corner where the sequence is smallest.
struct ValenceType {
    std::array<int, 4> valence{};

    friend auto operator<=>(ValenceType const&, ValenceType const&) = default;

    int inputs() const;
    /// Valences 3 to 12, and no more inputs than a hull shader takes.
    bool is_of_loop10() const;
    /// At most one corner is extraordinary.
    bool is_isolated() const;
};

/// Of a quad whose corners have these valences, wherever they begin.
ValenceType valence_type(std::array<int, 4> valence);
/// None where a corner lies on the boundary, or a neighbour is no quad.
std::optional<ValenceType> valence_type(Neighbourhood const& patch);

/// All with valences from 3 to 12 and at most so many inputs, ascending. LOOP10's 449 by default.
std::vector<ValenceType> valence_types(int max_inputs = 32);
/// Those of them that a step of subdivision leaves, the regular one included: 10.
std::vector<ValenceType> isolated_valence_types();

/// A quad, face 0, and the faces around it, no vertex of which is another's: for who makes a type's
/// matrix before any mesh is there. All positions are 0.
ControlMesh one_ring_cage(ValenceType const& type);

} // namespace tessemu
