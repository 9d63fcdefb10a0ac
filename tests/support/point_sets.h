// Sets of points compared by place.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace tessemu::test {

/// The largest distance from a point of a golden file, [[x, y, z], ...], to the nearest of ours
/// that is not taken yet: files number edges in another order. Expects as many. Quadratic.
inline double worst_distance(std::span<glm::dvec3 const> ours, nlohmann::json const& theirs)
{
    EXPECT_EQ(ours.size(), theirs.size());
    double worst = 0;
    std::vector<char> taken(ours.size());
    for (auto const& p : theirs) {
        glm::dvec3 const q(p[0], p[1], p[2]);
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < ours.size(); ++i)
            if (!taken[i] &&
                (taken[nearest] || glm::length(ours[i] - q) < glm::length(ours[nearest] - q)))
                nearest = i;
        taken[nearest] = 1;
        worst = std::max(worst, glm::length(ours[nearest] - q));
    }
    return worst;
}

} // namespace tessemu::test
