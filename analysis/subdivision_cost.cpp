// SPDX-License-Identifier: Apache-2.0
#include "analysis/subdivision_cost.h"

namespace tessemu {

namespace {

// What a dispatch of that name counted; none: the step has none.
StageStatistics const* counted(ListStatistics const& statistics, std::string const& name)
{
    for (CommandStatistics const& c : statistics.commands)
        if (c.name == name && !c.statistics.stages.empty()) return &c.statistics.stages[0];
    return nullptr;
}

} // namespace

std::vector<StepCost> subdivision_cost(std::span<SubdivisionTables const> tables,
                                       ListStatistics const& statistics)
{
    std::vector<StepCost> out;
    for (SubdivisionTables const& t : tables) {
        StepCost& step = out.emplace_back(StepCost{t.faces, t.edges, t.vertices, {}});
        StepDivergence const narrow = divergence(t, kWarpOfGtx480),
                             wide = divergence(t, kWavefrontOfRadeon5870);
        auto const add = [&](char const* kernel, std::uint64_t threads, LoopTurns const& gtx480,
                             LoopTurns const& radeon5870) {
            StageStatistics const* const s =
                counted(statistics, kernel + (", step " + std::to_string(out.size())));
            if (!s) return;
            KernelCost cost{kernel, threads, s->flops, 0, 0, 0, gtx480, radeon5870};
            for (FetchStatistics const& f : s->fetches) {
                (f.resource == "vertices" ? cost.vertex_fetches : cost.index_fetches) += f.count;
                cost.fetched_bytes += f.bytes;
            }
            step.kernels.push_back(std::move(cost));
        };
        add("face points", t.faces, narrow.face_points, wide.face_points);
        add("edge points", t.edges, {}, {});
        add("vertex points", t.vertices, narrow.vertex_points, wide.vertex_points);
        add("blended points", t.blended.target.size(), narrow.blended_points, wide.blended_points);
    }
    return out;
}

} // namespace tessemu
