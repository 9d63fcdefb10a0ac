// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop09/items.h"
#include "analysis/papers/paper.h"

namespace tessemu {

std::vector<PaperItem> const& paper_items()
{
    static std::vector<PaperItem> const all = [] {
        std::vector<PaperItem> items;
        for (PaperItem& i : loop09_items()) items.push_back(std::move(i));
        return items;
    }();
    return all;
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
