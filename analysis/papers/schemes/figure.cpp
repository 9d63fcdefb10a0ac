// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/schemes/figure.h"

#include "analysis/compare.h"
#include "analysis/cost.h"
#include "pipeline/schemes/scheme.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>

namespace tessemu {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Drawn {
    double error = 0;
    std::size_t points = 0;
    DrawCost cost;

    double microseconds() const { return 1e6 * cost.seconds; }
};

struct Curve {
    std::string scheme;
    RefinementStep step;
    bool quads;
    std::map<int, Drawn> drawn; ///< by factor
};

double sum(DrawCost const& cost, double StageCost::*what)
{
    double all = 0;
    for (StageCost const& s : cost.stages) all += s.*what;
    return all;
}

// Four samples on the edge of a drawn triangle, where there may be so many.
int level_of(int factor)
{
    return std::min(6, int(std::bit_width(unsigned(factor))) + 1);
}

class Schemes {
public:
    Schemes(ControlMesh const& mesh, GpuModel const& gpu, Machine const& machine,
            ThreadPool const& threads, PaperProgress const& progress, std::span<int const> factors,
            int table_factor)
        : mesh_(mesh),
          gpu_(gpu),
          machine_(machine),
          threads_(threads),
          progress_(progress),
          factors_(factors),
          table_factor_(table_factor)
    {
    }

    PaperPlots run()
    {
        for (auto const& scheme : schemes()) {
            measure(*scheme);
            done_ += factors_.size();
            report();
        }
        PaperPlots out;
        out.title =
            fmt::format("All schemes on {} and a {}: error against cost", mesh_.name, gpu_.name);
        out.sheet.x.name = "predicted microseconds";
        out.sheet.y.name = "rms distance, diagonals";
        out.sheet.columns = 2;
        out.sheet.panel_width = 470;
        out.sheet.panel_height = 440;
        out.sheet.legend = PlotSheet::Legend::Inside;
        for (bool quads : {true, false}) add_panel(out.sheet, quads);
        out.table = table();
        out.remarks = remarks();
        return out;
    }

private:
    void report()
    {
        if (progress_) progress_(done_, schemes().size() * factors_.size());
    }

    void measure(Scheme const& scheme)
    {
        SchemeInfo const info = scheme.info();
        SchemeOnMesh on;
        try {
            on = build_scheme(scheme, mesh_);
        } catch (MeshError const& e) {
            left_out_.push_back(e.what());
            return;
        }
        Curve curve{info.name, info.takes.step, info.takes.quads, {}};
        FrameSettings settings;
        settings.machine = machine_;
        settings.vertex_cache = gpu_.vertex_cache;
        settings.partitioning = Partitioning::Integer;
        for (int factor : factors_) {
            int const of_patch = factor >> on.mesh->steps();
            if (of_patch == 0) continue;
            settings.tess_factor = float(of_patch);
            DrawnError const d =
                limit(curve.step, level_of(factor)).of(*on.patches, settings, threads_);
            curve.drawn[factor] = {d.position.rms, d.points,
                                   estimate_cost(gpu_, d.counts.commands)};
        }
        curves_.push_back(std::move(curve));
    }

    // Of the cage, cut into triangles where the step keeps them.
    DrawnErrors const& limit(RefinementStep const& step, int level)
    {
        auto& found = limits_[{step.name, level}];
        if (!found)
            found =
                std::make_unique<DrawnErrors>(*refine_for_no_scheme(step, mesh_, {}).mesh, level);
        return *found;
    }

    // The rules that most of a panel's schemes have name it; of others the legend says so.
    void add_panel(PlotSheet& sheet, bool quads) const
    {
        std::map<std::string, int> rules;
        for (Curve const& c : curves_)
            if (c.quads == quads) ++rules[c.step.name];
        if (rules.empty()) return;
        std::string const most =
            std::max_element(rules.begin(), rules.end(), [](auto const& a, auto const& b) {
                return a.second < b.second;
            })->first;
        Plot panel{fmt::format("{}: {}'s limit surface", quads ? "Quads" : "Triangles", most), {}};
        for (Curve const& c : curves_) {
            if (c.quads != quads) continue;
            PlotSeries series{c.scheme, {}};
            if (c.step.name != most) series.name += fmt::format(" ({}'s)", c.step.name);
            for (auto const& [factor, d] : c.drawn)
                series.points.push_back({d.microseconds(), d.error, in_words(d.cost)});
            panel.series.push_back(std::move(series));
        }
        sheet.panels.push_back(std::move(panel));
    }

    NumberTable table() const
    {
        NumberTable out{"scheme",
                        "bound by",
                        {"points", "FLOPs", "fetches", "bytes", "us", "error", "falls"},
                        {}};
        for (Curve const& c : curves_) {
            auto const at = c.drawn.find(table_factor_), before = c.drawn.find(table_factor_ / 2);
            if (at == c.drawn.end()) continue;
            Drawn const& d = at->second;
            auto const a_point = [&](double StageCost::*what) {
                return sum(d.cost, what) / double(d.points);
            };
            out.rows.push_back(
                {c.scheme,
                 {double(d.points), a_point(&StageCost::operations), a_point(&StageCost::fetches),
                  a_point(&StageCost::fetched_bytes), d.microseconds(), d.error,
                  before == c.drawn.end() ? kNone : before->second.error / d.error},
                 in_words(d.cost)});
        }
        return out;
    }

    std::vector<std::string> remarks() const
    {
        std::string factors;
        for (int f : factors_) factors += fmt::format("{}{}", factors.empty() ? "" : ", ", f);
        std::vector<std::string> out{
            fmt::format(
                "Curves have a point for each number of segments on an edge of a face of the cage: "
                "{}. Where a scheme takes k steps of subdivision first its patches have the 2^k-th "
                "part, and the curve begins where that is 1.",
                factors),
            fmt::format("The table is of {} segments. FLOPs, fetches of up to 16 bytes and bytes "
                        "fetched are those of all shaders and passes of a frame, steps of "
                        "subdivision among them, by its points. \"falls\" is the error with half "
                        "the segments by this one: 4 where the surface is the limit surface, 1 "
                        "where it keeps a distance of its own.",
                        table_factor_),
            "The error is that of the triangles drawn: from points of the limit surface of the "
            "scheme's own rules to the closest point of them, in diagonals of the cage's box.",
            "Times are of geometry alone, without rasterization of the surface, lighting and what "
            "a frame costs whatever it draws. A scheme without a tessellator has its passes "
            "counted, their rasterization too, and the draw of the vertices that they made.",
            "All parameters are the schemes' defaults, the partitioning is integer. Schemes of "
            "triangles draw the cage cut by diagonals, which is another surface: errors compare "
            "within a rule of subdivision."};
        for (std::string const& why : left_out_) out.push_back("Left out: " + why + ".");
        return out;
    }

    ControlMesh const& mesh_;
    GpuModel const& gpu_;
    Machine const& machine_;
    ThreadPool const& threads_;
    PaperProgress const& progress_;
    std::span<int const> factors_;
    int table_factor_;
    std::size_t done_ = 0;
    std::map<std::pair<std::string, int>, std::unique_ptr<DrawnErrors>> limits_;
    std::vector<Curve> curves_;
    std::vector<std::string> left_out_;
};

} // namespace

PaperPlots reproduce_schemes(ControlMesh const& mesh, GpuModel const& gpu, Machine const& machine,
                             ThreadPool const& threads, PaperProgress const& progress,
                             std::span<int const> factors, int table_factor)
{
    return Schemes(mesh, gpu, machine, threads, progress, factors, table_factor).run();
}

} // namespace tessemu
