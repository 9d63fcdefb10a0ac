// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/table_set.h"

#include "emu/parallel.h"

#include <algorithm>

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
    for (int k = first == 2 ? 1 : first; k <= last; ++k) {
        if (k >= std::max(first, 2)) {
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

TableSet make_table_set(std::span<TableFamily const> families, BasisTableStore& store,
                        ThreadPool const& threads, RefinementProgress const& progress)
{
    TableSet out;
    std::vector<PatchTypeTables> all;
    std::size_t done = 0, count = 0;
    for (TableFamily const& f : families) count += f.types.size();
    for (TableFamily const& f : families) {
        TableSet::Family& row = out.families.emplace_back();
        row.family = f.family;
        row.types = f.types.size();
        std::size_t const at_once = std::size_t(4 * threads.threads());
        for (std::size_t first = 0; first < f.types.size(); first += at_once) {
            std::size_t const n = std::min(at_once, f.types.size() - first);
            std::vector<std::optional<BasisTables>> tables(n);
            std::vector<std::size_t> missing;
            for (std::size_t i = 0; i < n; ++i) {
                tables[i] = store.find(f.types[first + i]);
                if (!tables[i]) missing.push_back(i);
            }
            threads.parallel_for(missing.size(), [&](std::size_t i) {
                tables[missing[i]] = make_basis_tables(f.types[first + missing[i]]);
            });
            for (std::size_t i : missing) store.keep(f.types[first + i], *tables[i]);
            row.made += missing.size();
            for (std::size_t i = 0; i < n; ++i) {
                PatchType const& type = f.types[first + i];
                all.push_back(in_single_precision(type, *tables[i]));
                row.tables += std::size_t(tables[i]->points);
                if (!type.corner.closed || type.corner.faces > 2)
                    row.tables_but_2 += std::size_t(tables[i]->points);
            }
            done += n;
            if (progress) progress(done, count);
        }
    }
    out.symmetry = enforce_symmetry(all, possible_joints(all), {}, CountClasses::Yes);
    return out;
}

} // namespace tessemu
