// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/bolz03/items.h"
#include "analysis/papers/holl10/items.h"
#include "analysis/papers/loop09/items.h"
#include "analysis/papers/loop10/items.h"
#include "analysis/papers/paper.h"
#include "analysis/papers/schemes/items.h"

namespace tessemu {

std::vector<PaperItem> const& paper_items()
{
    static std::vector<PaperItem> const all = [] {
        std::vector<PaperItem> items;
        for (auto const& paper :
             {bolz03_items(), loop09_items(), loop10_items(), holl10_items(), schemes_items()})
            items.insert(items.end(), paper.begin(), paper.end());
        return items;
    }();
    return all;
}

std::string_view name_of(PaperClaim::Verdict verdict)
{
    switch (verdict) {
    case PaperClaim::Verdict::Holds:
        return "holds";
    case PaperClaim::Verdict::DoesNot:
        return "does not hold";
    default:
        return "cannot follow from counters";
    }
}

PaperItem const& find_paper_item(std::string_view name)
{
    std::string known;
    for (PaperItem const& i : paper_items()) {
        if (i.name == name) return i;
        known += (known.empty() ? "" : ", ") + i.name;
    }
    throw Error("'" + std::string(name) + "' is not known; there is " + known);
}

} // namespace tessemu
