// Tess factors from the straight edges between a patch's corners in the cage, whatever the patch
// makes of them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/domain_edges.h"
#include "shaders_cpp/tess_factor_rule.h"

namespace tessemu {

/// An edge runs from the end that comes first by x, y, z: patches on both sides see the same one.
///
/// \param corner  corner(k), k = 0, ..., sides - 1: a vertex of the cage, with equal bits in all
///                patches that have it
template <TessellatorDomain kDomain, class T>
std::array<T, 6> cage_factors(TessFactorRule const& rule, auto const& corner)
{
    auto const end = [&](int k) -> float3<T> { return corner(k % sides_of(kDomain)); };
    return rule.template factors<kDomain, T>(
        [&](int k) {
            float3<T> const a = end(k), b = end(k + 1);
            return straight_edge(a, b);
        },
        [&](int k) {
            float3<T> const a = end(k), b = end(k + 1);
            return (a.x > b.x) | ((a.x == b.x) & ((a.y > b.y) | ((a.y == b.y) & (a.z > b.z))));
        });
}

} // namespace tessemu
