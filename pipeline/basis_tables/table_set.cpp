// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/table_set.h"

namespace tessemu {

std::vector<TableFamily> table_families(int first, int last, SubdivisionRules const& rules)
{
    bool const biermann = rules.sectors == SectorRules::Biermann;
    TableFamily smooth{PatchFamily::Smooth, {}}, crease{PatchFamily::Crease, {}},
        convex{PatchFamily::ConvexCorner, {}}, concave{PatchFamily::ConcaveCorner, {}},
        dart{PatchFamily::Dart, {}};
    auto const add = [&](TableFamily& family, PatchType type) {
        if (type.corner.is_tagged() || (rules.flatness && *rules.flatness > 0 &&
                                        type.corner.faces != 4 && type.corner.faces != 2)) {
            type.sectors = rules.sectors;
            if (biermann) type.flatness = rules.flatness;
        }
        family.types.push_back(std::move(type));
    };
    for (int k = first; k <= last; ++k) {
        if (k >= 2) {
            add(smooth, smooth_type(k));
            for (int edge = 0; edge < k; ++edge) add(dart, dart_type(k, edge));
        }
        for (int j = 0; j < k; ++j) {
            add(crease, sector_type(k, j));
            PatchType corner = sector_type(k, j, true);
            add(convex, corner);
            corner.corner.concave = {0};
            if (biermann && k >= 2) add(concave, corner);
        }
    }
    std::vector<TableFamily> out;
    for (TableFamily* f : {&smooth, &crease, &convex, &concave, &dart})
        if (!f->types.empty()) out.push_back(std::move(*f));
    return out;
}

} // namespace tessemu
