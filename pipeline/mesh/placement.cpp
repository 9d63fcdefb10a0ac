// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/placement.h"

#include "emu/error.h"
#include "pipeline/mesh/mesh.h"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tessemu {

double bounding_box_diagonal(ControlMesh const& mesh)
{
    glm::dvec3 low(1e300), high(-1e300);
    for (glm::dvec3 const p : mesh.positions) low = min(low, p), high = max(high, p);
    return length(high - low);
}

Placement::Placement(std::span<glm::dvec3 const> points)
{
    if (points.empty()) throw Error("a mesh without vertices has no place");
    glm::dvec3 low = points[0], high = low;
    for (glm::dvec3 const& p : points) low = min(low, p), high = max(high, p);
    double const diagonal = length(high - low);
    if (diagonal == 0 && low == high) throw Error("all vertices of all faces are at one point");
    if (!(diagonal >= kSmallest && diagonal <= kLargest))
        throw Error(fmt::format("the bounding box has a diagonal of {}, it must be {} to {}",
                                diagonal, kSmallest, kLargest));

    int exponent = 0; // diagonal = fraction * 2^exponent, fraction 1/2 to 1
    bool const power = std::frexp(diagonal, &exponent) == 0.5;
    glm::dvec3 const center = low + (high - low) / 2.0;
    if (length(center) > kFar * diagonal) {
        double const step = std::ldexp(1.0, power ? exponent - 1 : exponent);
        // Values further off than a step, and not further from each other, are multiples of the
        // last bit of the nearest to 0. So is the shift, and the differences are no larger than
        // that value: exact. Nearer ones may have bits that a shift would push out.
        for (int k = 0; k < 3; ++k)
            if (std::max(low[k], -high[k]) >= step)
                shift_[k] = std::floor(center[k] / step + 0.5) * step;
    }
    double const most = std::ldexp(1.0, kScale);
    while (diagonal * scale_ > most) scale_ /= most * most;
    while (diagonal * scale_ < 1 / most) scale_ *= most * most;
}

} // namespace tessemu
