// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop10/items.h"

#include "analysis/papers/loop10/figure2.h"
#include "analysis/papers/loop10/figure4.h"
#include "analysis/papers/loop10/figure5.h"
#include "analysis/papers/loop10/table1.h"

#include <fmt/format.h>

namespace tessemu {

std::string Loop10Model::caption() const
{
    return own ? paper : fmt::format("{} (stand-in {})", paper, ours);
}

std::string loop10_models_remark()
{
    return "The paper's Twohole and Cat are not to be had: two_hole, a cage of quads with two "
           "holes, and knight_tri_1k, 1000 triangles, stand for them.";
}

std::vector<PaperItem> loop10_items()
{
    std::vector<PaperModel> models;
    for (Loop10Model const& m : kLoop10Models) models.push_back({m.ours, false, true});
    std::vector<PaperItem> items;
    items.push_back({"loop10-figure2",
                     "tables of subdivision of the pyramid",
                     PaperKind::Table,
                     {},
                     {},
                     0,
                     [](PaperInput const&, auto&, auto&) { return reproduce_loop10_figure2(); }});
    items.push_back({"loop10-table1",
                     "times of the subdivision step",
                     PaperKind::Table,
                     models,
                     {"radeon5870", "gtx480"},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         return reproduce_loop10_table1(in.meshes, in.gpus, in.machine, threads,
                                                        progress)
                             .table;
                     }});
    items.push_back({"loop10-figure4",
                     "patches by the valence of their extraordinary vertex",
                     PaperKind::Figure,
                     models,
                     {},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         FrameSettings s = in.picture;
                         s.machine = in.machine;
                         return reproduce_loop10_figure4(in.meshes, s, threads, progress);
                     }});
    items.push_back({"loop10-figure5",
                     "frames a second by tess factor, and the paper's claims",
                     PaperKind::Plots,
                     models,
                     {"radeon5870", "gtx480"},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         FrameSettings s;
                         s.width = 1280;
                         s.height = 1024;
                         s.machine = in.machine;
                         return reproduce_loop10_figure5(in.meshes, in.gpus, s, threads, progress);
                     }});
    return items;
}

} // namespace tessemu
