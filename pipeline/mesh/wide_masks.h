// Schemes whose points look further than a ring's sums (ring.h): they are given the mesh.
//
//     kKeepsTriangles, face(sum, sides)  as in ring.h; kSectorRules is false
//     kRings                    of faces around a face that weigh in its limit surface
//     edge_point(t, h, x)       of the mesh's points x
//     vertex_point(t, v, x)
//     limit_point(t, v, x)      where a vertex comes to
//
// Tags are not looked at: boundaries alone.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"

#include <span>

namespace tessemu {

template <class Masks>
concept WideMasks = requires
{
    {
        Masks::kRings
        } -> std::convertible_to<int>;
};

/// Of faces around a face that weigh in its limit surface.
template <class Masks> constexpr int rings_of()
{
    if constexpr (WideMasks<Masks>)
        return Masks::kRings;
    else
        return 1;
}

} // namespace tessemu
