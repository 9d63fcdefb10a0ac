// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop10/figure5.h"

#include "pipeline/schemes/scheme.h"

#include <fmt/format.h>

#include <algorithm>

namespace tessemu {

namespace {

// A frame of the paper, whose window nobody knows.
FrameSettings frame_of(FrameSettings settings, SchemeOnMesh const& on, int factor)
{
    settings.tess_factor = float(factor);
    settings.partitioning = Partitioning::Integer;
    settings.camera = frame_points(on.mesh->base().positions, {0.45f, 0.35f, 1},
                                   float(settings.width) / float(settings.height));
    return settings;
}

SchemeOnMesh build(Figure5Scheme const& scheme, ControlMesh const& mesh, int steps,
                   ParameterTexts set = {})
{
    BuildOptions options;
    options.subdivide = scheme.subdivided && !scheme.own_steps ? steps : 0;
    options.set = std::move(set);
    return build_scheme(find_scheme(scheme.scheme), mesh, options);
}

// The better of two rates that a forum quotes; gpus/radeon5870.json has both.
constexpr double kRadeonTriangularPatches = 600e6;

// Of a frame without its dispatches.
DrawCost cost_of_draws(GpuModel const& gpu, std::vector<CommandStatistics> commands)
{
    std::erase_if(commands, [](CommandStatistics const& c) { return c.kind != "draw"; });
    return estimate_cost(gpu, commands);
}

double step_seconds(SubdivisionTime const& time, SubdivisionFit const& fit)
{
    return time.dispatches ? fit.frame + fit.dispatch * double(time.dispatches) + time.seconds : 0;
}

FrameTime frame_time(GpuModel const& gpu, std::vector<CommandStatistics> const& commands,
                     SubdivisionFit const& fit)
{
    DrawCost const draws = cost_of_draws(gpu, commands);
    FrameTime out;
    out.subdivision = step_seconds(subdivision_time(gpu, commands), fit);
    out.seconds = draws.seconds + out.subdivision;
    out.bound = out.subdivision > draws.seconds ? "subdivision step" : in_words(draws);
    return out;
}

KernelTurns kernel_turns(GpuModel const& gpu, std::span<SubdivisionTables const> tables)
{
    KernelTurns out;
    for (std::size_t i = 0; i < tables.size(); ++i) {
        StepDivergence const d = divergence(tables[i], gpu.group_width);
        std::string const step = fmt::format(" points, step {}", i + 1);
        out["face" + step] = d.face_points;
        out["vertex" + step] = d.vertex_points;
        out["blended" + step] = d.blended_points;
    }
    return out;
}

// Seconds by which lanes that wait make the kernels longer, at most: as if all of them were loop.
double waiting_seconds(GpuModel const& gpu, KernelTurns const& kernels,
                       std::vector<CommandStatistics> const& commands)
{
    double out = 0;
    for (CommandStatistics const& c : commands) {
        auto const it = kernels.find(c.name);
        if (it == kernels.end() || it->second.needed == 0) continue;
        double const longer = double(it->second.run) / double(it->second.needed) - 1;
        out += longer * estimate_cost(gpu, c.statistics).shaders;
    }
    return out;
}

class Figure5 {
public:
    Figure5(std::vector<ControlMesh> const& meshes, std::vector<GpuModel> const& gpus,
            FrameSettings const& picture, ThreadPool const& threads, PaperProgress const& progress,
            std::array<Figure5Scheme, kFigure5Curves> const& schemes)
        : meshes_(meshes),
          gpus_(gpus),
          picture_(picture),
          threads_(threads),
          progress_(progress),
          schemes_(schemes),
          frame_(picture)
    {
        if (meshes.size() != kFigure5Models || gpus.size() != kFigure5Gpus)
            throw Error(fmt::format("figure 5 has {} models and {} GPUs, not {} and {}",
                                    kFigure5Models, kFigure5Gpus, meshes.size(), gpus.size()));
        if (gpus[0].vertex_cache != gpus[1].vertex_cache)
            throw Error("the GPUs of figure 5 differ in their vertex caches, and frames are "
                        "counted once for both");
        picture_.vertex_cache = gpus[0].vertex_cache;
    }

    PaperPlots run()
    {
        SubdivisionTable const table1 =
            reproduce_loop10_table1(meshes_, gpus_, picture_.machine, threads_, {});
        fit_ = table1.fit;
        done(1);
        for (std::size_t m = 0; m < meshes_.size(); ++m) {
            for (std::size_t c = 0; c < schemes_.size(); ++c) count_curve(m, c);
            count_sorted(m);
            measure_bsplines(m);
            measure_samples(m);
        }
        PaperPlots out;
        out.title = "LOOP10 figure 5: frames a second by tess factor";
        Figure5Times const times = figure5_times(counts_, gpus_, fit_, FactorOf::Face);
        out.sheet = sheet(times);
        out.claims = claims();
        out.remarks = remarks();
        return out;
    }

private:
    static constexpr std::size_t kWork =
        1 + kFigure5Models * (kFigure5Curves + 3) * kFigure5Factors;

    void done(std::size_t work)
    {
        done_ += work;
        if (progress_) progress_(done_, kWork);
    }
    int steps(std::size_t m) const { return kLoop10Models[m].steps; }

    void count_curve(std::size_t m, std::size_t c)
    {
        SchemeOnMesh const on = build(schemes_[c], meshes_[m], steps(m));
        if (c == kGregory2) count_turns(counts_.turns, m, on);
        count_frames(counts_.frames[m][c], on);
    }
    void count_sorted(std::size_t m)
    {
        SchemeOnMesh const on =
            build(schemes_[kGregory2], meshes_[m], steps(m), {{"sort", "valence"}});
        count_turns(counts_.turns_when_sorted, m, on);
        count_frames(counts_.sorted[m], on);
        for (std::size_t g = 0; g < gpus_.size(); ++g)
            for (auto const& [name, turns] : counts_.turns[g][m])
                measures_.lost_lanes[g][m] = std::max(measures_.lost_lanes[g][m], turns.lost());
    }
    void count_turns(ByGpuModel<KernelTurns>& turns, std::size_t m, SchemeOnMesh const& on)
    {
        for (std::size_t g = 0; g < gpus_.size(); ++g)
            turns[g][m] = kernel_turns(gpus_[g], on.mesh->tables());
    }
    void count_frames(Figure5Counts::Frames& frames, SchemeOnMesh const& on)
    {
        for (std::size_t f = 0; f < kFigure5Factors; ++f) {
            draw_frame(*on.patches, frame_of(picture_, on, kFigure5Factor[f]), threads_, frame_);
            frames[f] = frame_.commands;
            done(1);
        }
    }

    // Stam's regular quads are the ones that all curves but Gregory1 draw.
    void measure_bsplines(std::size_t m)
    {
        std::array<SchemeOnMesh, 2> const ways{
            build(schemes_[kStam], meshes_[m], steps(m), {{"regular", "bezier"}}),
            build(schemes_[kStam], meshes_[m], steps(m), {{"regular", "bspline"}})};
        for (std::size_t f = 0; f < kFigure5Factors; ++f) {
            std::array<std::vector<CommandStatistics>, 2> quads;
            for (std::size_t way : {0u, 1u}) {
                quads[way] = regular_quads(ways[way], f);
                done(1);
            }
            for (std::size_t g = 0; g < gpus_.size(); ++g) {
                DrawCost const bezier = cost_of_draws(gpus_[g], quads[0]),
                               bspline = cost_of_draws(gpus_[g], quads[1]);
                if (bspline.shaders > 0)
                    measures_.regular_quads[g][m][f] = {bezier.shaders / bspline.shaders,
                                                        in_words(bspline)};
            }
        }
    }
    std::vector<CommandStatistics> regular_quads(SchemeOnMesh const& on, std::size_t f) const
    {
        FrameSettings const s = frame_of(picture_, on, kFigure5Factor[f]);
        CommandList list = frame_commands(*on.patches, s, surface_settings(s));
        list.filter_surface_draws(
            [](Draw const& d) { return d.kind.patch_class == PatchClass::RegularQuad; });
        return run_commands(list, threads_, {nullptr, {}, s.vertex_cache, nullptr, {}}).commands;
    }

    // Patches of one factor have the same number of points: the children of the first step's faces.
    void measure_samples(std::size_t m)
    {
        struct Patches {
            std::uint64_t number = 0, children = 0;
        };
        auto const extraordinary = [&](int subdivide) {
            BuildOptions options;
            options.subdivide = subdivide;
            SchemeOnMesh const on =
                build_scheme(find_scheme(schemes_[kGregory1].scheme), meshes_[m], options);
            Patches out;
            on.patches->commands(frame_of(picture_, on, 1))
                .for_each_surface_draw([&](Draw const& d) {
                    if (d.kind.patch_class == PatchClass::RegularQuad) return;
                    std::uint64_t const n = d.patches.size();
                    out.number += n;
                    out.children += n * (d.kind.patch_class == PatchClass::Triangle ? 3 : 4);
                });
            return out;
        };
        constexpr std::uint64_t kPoints = 17 * 17; // of a child, at factor 16 of it
        std::uint64_t const all = extraordinary(0).children, left = extraordinary(1).number;
        measures_.samples[m] = {(all - left) * kPoints, all * kPoints};
    }

    PlotSheet sheet(Figure5Times const& times) const
    {
        PlotSheet out{{"tess factor", 2, {}}, {"frames a second", 10, {}}, {}, kFigure5Models};
        for (std::size_t g = 0; g < gpus_.size(); ++g)
            for (std::size_t m = 0; m < kFigure5Models; ++m) {
                Loop10Model const& model = kLoop10Models[m];
                Plot panel{
                    fmt::format("{}{}, {}", model.paper, model.own ? "" : "*", gpus_[g].name), {}};
                for (std::size_t c = 0; c < kFigure5Curves; ++c) {
                    PlotSeries curve{schemes_[c].paper, {}};
                    for (std::size_t f = 0; f < kFigure5Factors; ++f) {
                        FrameTime const& t = times.frame[g][m][c][f];
                        curve.points.push_back({double(kFigure5Factor[f]), t.rate(), t.bound});
                    }
                    panel.series.push_back(std::move(curve));
                }
                out.panels.push_back(std::move(panel));
            }
        return out;
    }

    // And what they say under other readings, where that decides or the reader will ask.
    std::vector<PaperClaim> claims() const
    {
        auto const read = [&](std::vector<GpuModel> const& gpus, FactorOf factors) {
            return loop10_claims(figure5_times(counts_, gpus, fit_, factors),
                                 figure5_times(counts_, gpus, {}, factors), measures_);
        };
        auto const with_tessellator = [&](double triangles) {
            std::vector<GpuModel> gpus = gpus_;
            gpus[kRadeon5870].tessellated_triangles = triangles;
            return read(gpus, FactorOf::Face);
        };
        std::vector<PaperClaim> out = read(gpus_, FactorOf::Face);
        auto const also = [&](std::vector<PaperClaim> const& other, std::string const& where,
                              std::string_view letters) {
            for (std::size_t i = 0; i < out.size(); ++i)
                if (other[i].verdict != out[i].verdict ||
                    letters.find(out[i].letter) != std::string_view::npos)
                    out[i].other_readings.push_back(fmt::format(
                        "{} it {}: {}", where, name_of(other[i].verdict), other[i].ours));
        };
        also(read(gpus_, FactorOf::Patch), "with factors of patches instead of faces", "bcfl");
        also(loop10_claims(figure5_times(counts_, gpus_, {}, FactorOf::Face), measures_),
             "with the counted work of the subdivision step alone", "abcdefl");
        also(with_tessellator(kRadeonTriangularPatches),
             "with the other rate of the Radeon's tessellator, 600 million triangles a second,",
             "be");
        also(with_tessellator(GpuModel::kUnknown), "with no limit to the Radeon's tessellator",
             "be");
        return out;
    }

    std::vector<std::string> remarks() const
    {
        return {
            fmt::format("Frames of {} x {} pixels, lit; the paper does not tell its window.",
                        picture_.width, picture_.height),
            "A factor is read as segments on an edge of the model, since the paper compares equal "
            "sampling rates and finds curves with 4 times the patches about as fast: after k steps "
            "a patch has the 2^k-th part, and 1 at least.",
            fmt::format("The subdivision step is {:.3g} ms of a frame, {:.3g} ms of a dispatch "
                        "(both fitted to table 1) and the counted work. Other frames have no "
                        "overhead: nobody published one, so frames of low factors are too many.",
                        1e3 * fit_.frame, 1e3 * fit_.dispatch),
            "So what does not hold with the fitted numbers, but with the counted work of the step "
            "alone, hangs on what a frame costs whatever it draws, and cannot follow from "
            "counters.",
            "The Radeon's rate of tessellated triangles, three clocks each, is one of two that a "
            "forum quotes, not AMD's word; that of the GTX 480 is not known and bounds nothing.",
            "Gregory1 draws Cat's triangles by LOOP09's Gregory triangles; the paper does not say "
            "how it does.",
            "Of models with a star: " + loop10_models_remark()};
    }

    std::vector<ControlMesh> const& meshes_;
    std::vector<GpuModel> const& gpus_;
    FrameSettings picture_;
    ThreadPool const& threads_;
    PaperProgress const& progress_;
    std::array<Figure5Scheme, kFigure5Curves> const& schemes_;
    Frame frame_; // its memory serves all
    std::size_t done_ = 0;
    SubdivisionFit fit_;
    Figure5Counts counts_;
    Figure5Measures measures_;
};

} // namespace

Figure5Times figure5_times(Figure5Counts const& counts, std::vector<GpuModel> const& gpus,
                           SubdivisionFit const& fit, FactorOf factors)
{
    Figure5Times out;
    for (std::size_t g = 0; g < kFigure5Gpus; ++g)
        for (std::size_t m = 0; m < kFigure5Models; ++m) {
            GpuModel const& gpu = gpus[g];
            auto const& frames = counts.frames[m];
            SubdivisionTime const step = subdivision_time(gpu, frames[kGregory2][0]);
            out.step[g][m] = {step_seconds(step, fit), step.bound_name + ", " + step.bound};
            for (std::size_t f = 0; f < kFigure5Factors; ++f) {
                auto const of_patch = [&](std::size_t curve) {
                    bool const parts = factors == FactorOf::Face && curve != kGregory1;
                    return f - std::min(f, std::size_t(parts ? kLoop10Models[m].steps : 0));
                };
                for (std::size_t c = 0; c < kFigure5Curves; ++c) {
                    FrameTime& t = out.frame[g][m][c][f];
                    t = frame_time(gpu, frames[c][of_patch(c)], fit);
                    t.factor = kFigure5Factor[of_patch(c)];
                }
                auto const& unsorted = frames[kGregory2][of_patch(kGregory2)];
                auto const& sorted = counts.sorted[m][of_patch(kGregory2)];
                double const before = out.frame[g][m][kGregory2][f].seconds +
                                      waiting_seconds(gpu, counts.turns[g][m], unsorted),
                             after = frame_time(gpu, sorted, fit).seconds +
                                     waiting_seconds(gpu, counts.turns_when_sorted[g][m], sorted);
                out.sorting_gain[g][m][f] = 1 - after / before;
            }
        }
    return out;
}

PaperPlots reproduce_loop10_figure5(std::vector<ControlMesh> const& meshes,
                                    std::vector<GpuModel> const& gpus, FrameSettings const& picture,
                                    ThreadPool const& threads, PaperProgress const& progress,
                                    std::array<Figure5Scheme, kFigure5Curves> const& schemes)
{
    return Figure5(meshes, gpus, picture, threads, progress, schemes).run();
}

} // namespace tessemu
