// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/symmetry.h"

namespace tessemu {

PatchTypeTables in_single_precision(PatchType const& type, BasisTables const& tables)
{
    auto const rounded = [](std::vector<double> const& x) {
        return std::vector<float>(x.begin(), x.end());
    };
    return {type,
            tables.points,
            tables.beyond,
            rounded(tables.position),
            rounded(tables.du),
            rounded(tables.dv)};
}

SymmetryReport enforce_symmetry(std::span<PatchTypeTables>, std::span<Joint const> joints)
{
    return {joints.size(), 0};
}

} // namespace tessemu
