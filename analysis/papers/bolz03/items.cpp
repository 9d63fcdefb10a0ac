// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/bolz03/items.h"

#include "analysis/papers/bolz03/listing.h"
#include "analysis/papers/bolz03/section3.h"

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
    items.push_back({"bolz03-section3",
                     "vertices a second, batches, the price of bit-exact sums",
                     PaperKind::Table,
                     {},
                     {"geforce-fx"},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         return reproduce_bolz03_section3(in.gpus[0], in.machine, threads,
                                                          progress);
                     }});
    return items;
}

} // namespace tessemu
