// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/type_tables.h"

#include <algorithm>
#include <numeric>

namespace tessemu {

PatchTypeTables in_single_precision(PatchType const& type, BasisTables const& tables,
                                    std::vector<std::uint16_t> point_of)
{
    if (point_of.empty()) {
        point_of.resize(std::size_t(tables.points));
        std::iota(point_of.begin(), point_of.end(), std::uint16_t(0));
    }
    int const points = 1 + *std::max_element(point_of.begin(), point_of.end());
    auto const rounded = [&](std::vector<double> const& x) {
        std::vector<double> sums(std::size_t(points) * kTableSamples, 0.0);
        for (std::size_t k = 0; k < point_of.size(); ++k)
            for (std::size_t s = 0; s < kTableSamples; ++s)
                sums[point_of[k] * std::size_t(kTableSamples) + s] += x[k * kTableSamples + s];
        return std::vector<float>(sums.begin(), sums.end());
    };
    auto position = rounded(tables.position), du = rounded(tables.du), dv = rounded(tables.dv);
    return {type,          points,       std::move(point_of), tables.beyond, std::move(position),
            std::move(du), std::move(dv)};
}

} // namespace tessemu
