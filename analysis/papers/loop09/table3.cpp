// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop09/table3.h"

#include "pipeline/schemes/scheme.h"

namespace tessemu {

namespace {

struct PrintedRow {
    char const* model;
    char const* scheme; ///< ours; the paper prints ACC, Pm, Gregory
    double position, normal;
};
constexpr PrintedRow kPrinted[] = {
    {"monsterfrog", "acc", .146, .0148},
    {"monsterfrog", "pm", .079, .0111},
    {"monsterfrog", "gregory-stencil", .090, .0108},
    {"bigguy", "acc", .096, .0109},
    {"bigguy", "pm", .072, .00783},
    {"bigguy", "gregory-stencil", .082, .00710},
};

} // namespace

PaperTable reproduce_loop09_table3(std::vector<ControlMesh> const& meshes, int level,
                                   Machine const& machine, ThreadPool const& threads,
                                   PaperProgress const& progress)
{
    PaperTable out;
    out.title = "LOOP09 table 3: RMS error against the Catmull-Clark surface";
    std::size_t done = 0;
    for (PrintedRow const& printed : kPrinted) {
        std::size_t const which = printed.model == kLoop09Table3Models[0] ? 0 : 1;
        SchemeOnMesh const on = build_scheme(find_scheme(printed.scheme), meshes.at(which));
        FrameSettings settings;
        settings.machine = machine;
        SurfaceComparison const c = compare_with_limit(*on.patches, settings, level, threads);
        std::string const row = std::string(printed.model) + ", " + printed.scheme;
        out.cells.push_back({row, "position, closest point, 1e-3 of the diagonal", printed.position,
                             1e3 * c.to_limit.rms});
        out.cells.push_back(
            {row, "normal, equal parameter, radians", printed.normal, c.equal_normal.rms});
        out.cells.push_back({row, "normal, equal parameter, by patch grid", printed.normal,
                             c.equal_normal_grid.rms});
        out.cells.push_back(
            {row, "normal, closest point, radians", printed.normal, c.normal_to_limit.rms});
        if (progress) progress(++done, std::size(kPrinted));
    }
    out.remarks = {
        "The paper's position column has no unit that fits; it is read as thousandths of the "
        "bounding box's diagonal. Read as printed (percent of it, 1e-3) it would lie far below "
        "any distance between the surfaces.",
        "The paper does not say which normals it compares, nor how the samples weigh: by closest "
        "point; by equal parameter and area; by equal parameter, each patch's grid of samples "
        "counted in full, sides included, which at level 3 comes nearest to the paper.",
        "The paper's bigguy has 1754 patches by its table 2, which is the number of its texture "
        "vertices; the cage has 1450 faces.",
    };
    return out;
}

} // namespace tessemu
