// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/bolz03/items.h"

#include "analysis/papers/bolz03/listing.h"

namespace tessemu {

std::vector<PaperItem> bolz03_items()
{
    std::vector<PaperItem> items;
    items.push_back({"bolz03-listing",
                     "four-wide instructions and registers of the pixel shaders",
                     PaperKind::Table,
                     {},
                     {},
                     0,
                     [](PaperInput const&, auto&, auto&) { return reproduce_bolz03_listing(); }});
    return items;
}

} // namespace tessemu
