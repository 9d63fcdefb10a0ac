// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop10/figure5.h"

#include "analysis/divergence.h"
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

DrawStatistics draws_of(std::vector<CommandStatistics> const& commands)
{
    DrawStatistics out;
    for (CommandStatistics const& c : commands)
        if (c.kind == "draw") out += c.statistics;
    return out;
}

std::string in_words(DrawCost const& cost)
{
    for (StageCost const& s : cost.stages)
        if (s.stage == cost.bound) {
            std::string stage = s.stage;
            std::replace(stage.begin(), stage.end(), '_', ' ');
            return s.bound() == "rate" ? stage : stage + ", " + s.bound();
        }
    return cost.bound;
}

double step_seconds(SubdivisionTime const& time, SubdivisionFit const& fit)
{
    return time.dispatches ? fit.frame + fit.dispatch * double(time.dispatches) + time.seconds : 0;
}

FrameTime frame_time(GpuModel const& gpu, std::vector<CommandStatistics> const& commands,
                     SubdivisionFit const& fit)
{
    DrawCost const draws = estimate_cost(gpu, draws_of(commands));
    FrameTime out;
    out.subdivision = step_seconds(subdivision_time(gpu, commands), fit);
    out.seconds = draws.seconds + out.subdivision;
    out.bound = out.subdivision > draws.seconds ? "subdivision step" : in_words(draws);
    return out;
}

// Lanes that wait in the kernels of a mesh's steps, on a GPU.
class Waiting {
public:
    Waiting(GpuModel const& gpu, std::span<SubdivisionTables const> tables)
    {
        for (std::size_t i = 0; i < tables.size(); ++i) {
            StepDivergence const d = divergence(tables[i], gpu.group_width);
            std::string const step = fmt::format(" points, step {}", i + 1);
            kernels_["face" + step] = d.face_points;
            kernels_["vertex" + step] = d.vertex_points;
            kernels_["blended" + step] = d.blended_points;
        }
    }
    double most_lost() const
    {
        double most = 0;
        for (auto const& [name, turns] : kernels_) most = std::max(most, turns.lost());
        return most;
    }
    // Seconds by which waiting makes the kernels longer, at most: as if all of them were loop.
    double seconds(GpuModel const& gpu, std::vector<CommandStatistics> const& commands) const
    {
        double out = 0;
        for (CommandStatistics const& c : commands) {
            auto const it = kernels_.find(c.name);
            if (it == kernels_.end() || it->second.needed == 0) continue;
            double const longer = double(it->second.run) / double(it->second.needed) - 1;
            out += longer * estimate_cost(gpu, c.statistics).shaders;
        }
        return out;
    }

private:
    std::map<std::string, LoopTurns> kernels_;
};

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
            measure_step(m);
            measure_sorting(m);
            measure_bsplines(m);
            measure_samples(m);
        }
        PaperPlots out;
        out.title = "LOOP10 figure 5: frames a second by tess factor";
        Figure5Times const times = figure5_times(counts_, gpus_, fit_, FactorOf::Face);
        out.sheet = sheet(times);
        out.claims = claims(times);
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
        for (std::size_t f = 0; f < kFigure5Factors; ++f) {
            counts_.frames[m][c][f] = frame(on, f);
            done(1);
        }
    }
    std::vector<CommandStatistics> frame(SchemeOnMesh const& on, std::size_t f)
    {
        draw_frame(*on.patches, frame_of(picture_, on, kFigure5Factor[f]), threads_, frame_);
        return frame_.commands;
    }

    void measure_step(std::size_t m)
    {
        for (std::size_t g = 0; g < gpus_.size(); ++g) {
            SubdivisionTime const t = subdivision_time(gpus_[g], counts_.frames[m][kGregory2][0]);
            measures_.step[g][m] = {step_seconds(t, fit_), t.seconds,
                                    t.bound_name + ", " + t.bound};
        }
    }

    void measure_sorting(std::size_t m)
    {
        SchemeOnMesh const as_is = build(schemes_[kGregory2], meshes_[m], steps(m)),
                           sorted = build(schemes_[kGregory2], meshes_[m], steps(m),
                                          {{"sort", "valence"}});
        for (std::size_t f = 0; f < kFigure5Factors; ++f) {
            auto const& before = counts_.frames[m][kGregory2][f];
            auto const after = frame(sorted, f);
            for (std::size_t g = 0; g < gpus_.size(); ++g) {
                GpuModel const& gpu = gpus_[g];
                Waiting const waits(gpu, as_is.mesh->tables()),
                    waits_sorted(gpu, sorted.mesh->tables());
                double const unsorted =
                    frame_time(gpu, before, fit_).seconds + waits.seconds(gpu, before);
                double const with_sorting =
                    frame_time(gpu, after, fit_).seconds + waits_sorted.seconds(gpu, after);
                measures_.sorting_gain[g][m][f] = 1 - with_sorting / unsorted;
                measures_.lost_lanes[g][m] = waits.most_lost();
            }
            done(1);
        }
    }

    // Stam's regular patches are the ones that all curves but Gregory1 draw.
    void measure_bsplines(std::size_t m)
    {
        std::array<SchemeOnMesh, 2> const ways{
            build(schemes_[kStam], meshes_[m], steps(m), {{"regular", "bezier"}}),
            build(schemes_[kStam], meshes_[m], steps(m), {{"regular", "bspline"}})};
        for (std::size_t f = 0; f < kFigure5Factors; ++f) {
            std::array<DrawStatistics, 2> draws;
            for (std::size_t way : {0u, 1u}) {
                draws[way] = draws_of(
                    visit_surface(*ways[way].patches,
                                  frame_of(picture_, ways[way], kFigure5Factor[f]), threads_, {})
                        .commands);
                done(1);
            }
            for (std::size_t g = 0; g < gpus_.size(); ++g) {
                DrawCost const bezier = estimate_cost(gpus_[g], draws[0]),
                               bspline = estimate_cost(gpus_[g], draws[1]);
                measures_.bspline_gain[g][m][f] = bezier.shaders / bspline.shaders;
                measures_.bspline_bound[g] = in_words(bspline);
            }
        }
    }

    // Patches of one factor have the same number of points: the children of the last step's faces.
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
        std::uint64_t const all = extraordinary(steps(m) - 1).children,
                            left = extraordinary(steps(m)).number;
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
    std::vector<PaperClaim> claims(Figure5Times const& times) const
    {
        std::vector<PaperClaim> out = loop10_claims(times, measures_);
        auto const also = [&](Figure5Times const& others, char const* where,
                              std::string_view letters) {
            std::vector<PaperClaim> const other = loop10_claims(others, measures_);
            for (std::size_t i = 0; i < out.size(); ++i)
                if (other[i].verdict != out[i].verdict ||
                    letters.find(out[i].letter) != std::string_view::npos)
                    out[i].other_readings.push_back(fmt::format(
                        "{} it {}: {}", where, name_of(other[i].verdict), other[i].ours));
        };
        also(figure5_times(counts_, gpus_, fit_, FactorOf::Patch),
             "with factors of patches instead of faces", "bcl");
        also(figure5_times(counts_, gpus_, {}, FactorOf::Face),
             "with the counted work of the subdivision step alone", "bcdel");
        std::vector<GpuModel> unbounded = gpus_;
        unbounded[kRadeon5870].tessellated_triangles = GpuModel::kUnknown;
        also(figure5_times(counts_, unbounded, fit_, FactorOf::Face),
             "with no limit to the Radeon's tessellator", "be");
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
            "The Radeon's rate of tessellated triangles is what reviewers measured, not AMD's "
            "word; that of the GTX 480 is not known and bounds nothing. A claim says so where it "
            "hangs on that.",
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
        for (std::size_t m = 0; m < kFigure5Models; ++m)
            for (std::size_t c = 0; c < kFigure5Curves; ++c)
                for (std::size_t f = 0; f < kFigure5Factors; ++f) {
                    bool const halved = factors == FactorOf::Face && c != kGregory1;
                    auto const k = std::size_t(halved ? kLoop10Models[m].steps : 0);
                    out.frame[g][m][c][f] =
                        frame_time(gpus[g], counts.frames[m][c][f - std::min(f, k)], fit);
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
