// All types of patches that a paper's tables are made for: BOLZ03 section 2.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/table_set.h"

namespace tessemu::test {

inline std::vector<PatchType> all_types(int most, SectorRules sectors = SectorRules::OpenSubdiv)
{
    std::vector<PatchType> out;
    for (TableFamily const& f : table_families(1, most, {.sectors = sectors}))
        out.insert(out.end(), f.types.begin(), f.types.end());
    return out;
}

} // namespace tessemu::test
