// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/holl10/figure8.h"

#include "analysis/papers/holl10/frames.h"
#include "analysis/papers/holl10/table1.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace tessemu {

namespace {

constexpr int kLevels = 6; ///< 1 to 6: the tables have 32 segments, of M1

struct Share {
    double operations = 0, bytes = 0, seconds = 0;
};

struct Level {
    double seconds = 0, overhead = 0, triangles = 0;
    std::string bound;
    Share initial; ///< of the pass before the one that shows the surface; seconds without overhead

    double of_triangle() const { return 1e9 * seconds / triangles; }
    double of_triangle_without_overhead() const { return 1e9 * (seconds - overhead) / triangles; }
};

double operations(DrawCost const& c)
{
    double n = 0;
    for (StageCost const& s : c.stages) n += s.operations;
    return n;
}

double fetched_bytes(DrawCost const& c)
{
    double n = 0;
    for (StageCost const& s : c.stages) n += s.fetched_bytes;
    return n;
}

Level level_of(GpuModel const& gpu, Holl10Frame const& frame, double scale)
{
    DrawCost const all = estimate_cost(gpu, frame.all), initial = estimate_cost(gpu, frame.initial);
    double const work = all.seconds - gpu.overhead;
    return {gpu.overhead + scale * work,
            gpu.overhead,
            scale * double(frame.triangles),
            in_words(all),
            {operations(initial) / operations(all), fetched_bytes(initial) / fetched_bytes(all),
             initial.shaders / work}};
}

} // namespace

PaperPlots reproduce_holl10_figure8(std::vector<ControlMesh> const& meshes, GpuModel const& gpu,
                                    Machine const& machine, ThreadPool const& threads,
                                    PaperProgress const& progress)
{
    FrameSettings settings;
    settings.machine = machine;
    settings.vertex_cache = gpu.vertex_cache;
    PaperPlots out;
    out.title = "HOLL10 figure 8: cost of a triangle by level";
    out.sheet = {{"4^level", 4, {}}, {"ns a triangle", 10, {}}, {}, 2};
    bool falls = true, falls_without = true, is_small = true;
    std::vector<std::string> of_triangle, without, shares;
    std::string bound;
    for (std::size_t m = 0; m < std::size(kHoll10Models); ++m) {
        Holl10Model const& model = kHoll10Models[m];
        SchemeOnMesh const on = build_holl10(kHoll10Schemes[0], meshes.at(m));
        std::vector<Level> levels;
        PlotSeries ours{"ours", {}}, alone{"ours, without the frame's overhead", {}},
            paper{"by the paper's table I", {}};
        for (int level = 1; level <= kLevels; ++level) {
            Holl10Frame const frame = count_frame(on, settings, level, threads);
            double const scale = double(model.triangles) / double(frame.triangles_of_m0);
            Level const l = levels.emplace_back(level_of(gpu, frame, scale));
            double const x = double(1 << 2 * level);
            ours.points.push_back({x, l.of_triangle(), l.bound});
            alone.points.push_back({x, l.of_triangle_without_overhead(), l.bound});
            if (progress)
                progress(m * kLevels + std::size_t(level), std::size(kHoll10Models) * kLevels);
        }
        for (std::size_t l = 0; l < std::size(kHoll10Levels); ++l) {
            double const x = double(1 << 2 * kHoll10Levels[l]);
            paper.points.push_back({x, 1e9 / (kHoll10Printed[l][m] * x * model.triangles)});
        }
        for (std::size_t l = 1; l < levels.size(); ++l) {
            falls = falls && levels[l].of_triangle() < levels[l - 1].of_triangle();
            falls_without = falls_without && levels[l].of_triangle_without_overhead() <
                                                 levels[l - 1].of_triangle_without_overhead();
        }
        for (Level const& l : levels)
            is_small = is_small &&
                       std::max({l.initial.operations, l.initial.bytes, l.initial.seconds}) < 0.5;
        of_triangle.push_back(fmt::format("{} {:.3g} to {:.3g} ns", model.paper,
                                          levels.front().of_triangle(),
                                          levels.back().of_triangle()));
        without.push_back(fmt::format("{:.3g} to {:.3g} ns",
                                      levels.front().of_triangle_without_overhead(),
                                      levels.back().of_triangle_without_overhead()));
        if (model.own) {
            std::vector<std::string> of_levels;
            for (int l : {1, 2, 4, 5}) {
                Share const& s = levels[std::size_t(l - 1)].initial;
                of_levels.push_back(fmt::format("level {} {:.2g}, {:.2g}, {:.2g} %", l,
                                                100 * s.operations, 100 * s.bytes,
                                                100 * s.seconds));
            }
            shares.push_back(fmt::format("{}: {}", model.paper, fmt::join(of_levels, "; ")));
        }
        bound = levels.back().bound;
        out.sheet.panels.push_back(
            {model.caption(), {std::move(ours), std::move(alone), std::move(paper)}});
    }
    using Verdict = PaperClaim::Verdict;
    out.claims = {
        {"a",
         "the cost of a triangle falls with the level that it is made at",
         falls ? Verdict::Holds : Verdict::DoesNot,
         "each level of 1 to 6 costs less a triangle than the one before, on every model",
         fmt::format("{}", fmt::join(of_triangle, ", ")),
         bound,
         {fmt::format("without what a frame costs whatever it draws it {}: {}",
                      name_of(falls_without ? Verdict::Holds : Verdict::DoesNot),
                      fmt::join(without, ", "))}},
        {"b", "the initial step does not represent the bulk of the computation",
         is_small ? Verdict::Holds : Verdict::DoesNot,
         "less than half of a frame's operations, of the bytes that it fetches and of its work's "
         "time, at every level and on every model",
         fmt::format("operations, bytes, time. {}", fmt::join(shares, ". ")), bound}};
    out.remarks = {
        "The figure's own numbers are not printed: table I's stand for them, where its levels "
        "are. Geometry without rasterization, each vertex of a pattern once.",
        "A pattern of n x n triangles has (n+1)(n+2)/2 vertices, on 1 segment three for one "
        "triangle and on 16 segments 0.6: that, and the overhead, is what falls.",
        holl10_models_remark()};
    return out;
}

} // namespace tessemu
