// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/holl10/items.h"

#include "analysis/papers/holl10/figure8.h"
#include "analysis/papers/holl10/figures.h"
#include "analysis/papers/holl10/table1.h"

#include <fmt/format.h>

namespace tessemu {

std::string Holl10Model::caption() const
{
    return own ? paper : fmt::format("{} (stand-in)", paper);
}

std::string holl10_models_remark()
{
    return "The paper's Head and Guy are not to be had: spot_control (372 triangles) and "
           "knight_tri_1k (1000) stand for them, their counts scaled to the paper's 524 and 1168. "
           "Frog and Big Guy are monsterfrog and bigguy, each quad cut in two.";
}

std::vector<PaperItem> holl10_items()
{
    std::vector<PaperModel> models;
    for (Holl10Model const& m : kHoll10Models) models.push_back({m.ours, false, true});
    std::vector<PaperItem> items;
    items.push_back({"holl10-table1",
                     "output triangles and frames a second of tables and substitutes",
                     PaperKind::Table,
                     models,
                     {"gtx295"},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         return reproduce_holl10_table1(in.meshes, in.gpus.at(0), in.machine,
                                                        threads, progress)
                             .table;
                     }});
    auto const figure = [&](int number, char const* about, std::vector<PaperModel> shown,
                            auto const& reproduce) {
        items.push_back({fmt::format("holl10-figure{}", number),
                         about,
                         PaperKind::Figure,
                         std::move(shown),
                         {},
                         0,
                         [reproduce](PaperInput const& in, auto& threads, auto& progress) {
                             FrameSettings s = in.picture;
                             s.machine = in.machine;
                             return reproduce(in.meshes, s, threads, progress);
                         }});
    };
    figure(4, "subdivision shading from the first three meshes on",
           {{"golem"}, {"monsterfrog", false, false}}, reproduce_holl10_figure4);
    figure(5, "a triangle with different factors along its edges, from one table", {},
           [](auto&, FrameSettings const& s, auto& threads, auto&) {
               return reproduce_holl10_figure5(s, threads);
           });
    figure(6, "reflection lines around extraordinary vertices", {},
           [](auto&, FrameSettings const& s, auto& threads, auto& progress) {
               return reproduce_holl10_figure6(s, threads, progress);
           });
    figure(7, "substitutes beside subdivision",
           {{"golem"}, {"monsterfrog", false, false}, {"bigguy", false, false}},
           reproduce_holl10_figure7);
    items.push_back({"holl10-figure8",
                     "cost of a triangle by level, and the share of the initial pass",
                     PaperKind::Plots,
                     models,
                     {"gtx295"},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         return reproduce_holl10_figure8(in.meshes, in.gpus.at(0), in.machine,
                                                         threads, progress);
                     }});
    return items;
}

} // namespace tessemu
