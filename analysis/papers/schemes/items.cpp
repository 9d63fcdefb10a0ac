// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/schemes/items.h"

#include "analysis/papers/schemes/figure.h"

namespace tessemu {

std::vector<PaperItem> schemes_items()
{
    return {{"schemes",
             "error against cost of all schemes, and what a point of each takes",
             PaperKind::Plots,
             {{"golem"}},
             {"gtx480"},
             0,
             [](PaperInput const& in, auto& threads, auto& progress) {
                 return reproduce_schemes(in.meshes.at(0), in.gpus.at(0), in.machine, threads,
                                          progress);
             }}};
}

} // namespace tessemu
