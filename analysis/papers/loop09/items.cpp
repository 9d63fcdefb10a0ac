// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop09/items.h"

#include "analysis/papers/loop09/figures.h"
#include "analysis/papers/loop09/table3.h"
#include "analysis/papers/loop09/timing.h"

namespace tessemu {

std::vector<PaperItem> loop09_items()
{
    std::vector<PaperModel> const papers{{"monsterfrog", false, true}, {"bigguy", false, true}};
    auto const where_there = [&](std::vector<PaperModel> first, std::vector<PaperModel> last) {
        for (PaperModel m : papers) {
            m.required = false;
            first.push_back(m);
        }
        first.insert(first.end(), last.begin(), last.end());
        return first;
    };
    std::vector<PaperItem> items;
    items.push_back({"loop09-table1",
                     "times on a Direct3D 11 emulator",
                     PaperKind::Table,
                     {{"golem"}},
                     {"loop09-emulator"},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         return reproduce_loop09_table1(in.meshes.at(0), in.gpus.at(0), in.machine,
                                                        threads, progress)
                             .table;
                     }});
    items.push_back({"loop09-table2",
                     "frames a second by instanced tessellation",
                     PaperKind::Table,
                     papers,
                     {"gtx260"},
                     0,
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         return reproduce_loop09_table2(in.meshes, in.gpus.at(0), in.machine,
                                                        threads, progress)
                             .table;
                     }});
    items.push_back({"loop09-table3",
                     "error against the Catmull-Clark surface",
                     PaperKind::Table,
                     papers,
                     {},
                     3, // nearest to the paper, see the table's remarks
                     [](PaperInput const& in, auto& threads, auto& progress) {
                         return reproduce_loop09_table3(in.meshes, in.level, in.machine, threads,
                                                        progress);
                     }});
    auto const figure = [&](int number, char const* about, std::vector<PaperModel> models) {
        items.push_back({"loop09-figure" + std::to_string(number),
                         about,
                         PaperKind::Figure,
                         std::move(models),
                         {},
                         0,
                         [number](PaperInput const& in, auto& threads, auto& progress) {
                             FrameSettings s = in.picture;
                             s.machine = in.machine;
                             return reproduce_loop09_figure(number, in.meshes, s, threads,
                                                            progress);
                         }});
    };
    figure(1, "control mesh, patches, surface, displaced surface", {{"jug"}});
    figure(3, "the tessellator's patterns", {});
    figure(9, "the same for several cages", where_there({{"golem"}}, {}));
    figure(10, "where triangles and quads meet", {{"jug"}});
    figure(11, "errors of ACC, Pm and Gregory patches", where_there({}, {{"golem"}}));
    figure(12, "a gallery", where_there({{"jug"}, {"spindle"}, {"saddle_star"}, {"golem"}}, {}));
    return items;
}

} // namespace tessemu
