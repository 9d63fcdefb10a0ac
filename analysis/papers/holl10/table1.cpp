// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/holl10/table1.h"

#include "analysis/papers/holl10/frames.h"
#include "analysis/papers/timed_cell.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>

namespace tessemu {

namespace {

constexpr std::size_t kModels = std::size(kHoll10Models), kSchemes = std::size(kHoll10Schemes),
                      kLevels = std::size(kHoll10Levels), kLast = kLevels - 1;
// At the last level, in the order of kHoll10Schemes.
constexpr double kPrinted[kSchemes][kModels] = {
    {103, 50, 24, 21}, {80, 53, 44, 23}, {109, 69, 41, 35}, {120, 77, 48, 40}, {137, 85, 52, 45}};
enum Which : std::size_t { kSm, kQas, kPn };

struct Cell : TimedCell {
    std::string row() const { return fmt::format("{}, level {}, {}", model, level, scheme); }
    int level = 0;
    std::size_t triangles = 0; // scaled to the paper's
};

// Schemes from the most frames a second to the fewest.
template <class FramesOf> std::string order(FramesOf const& frames_of)
{
    std::array<std::size_t, kSchemes> by{};
    for (std::size_t i = 0; i < kSchemes; ++i) by[i] = i;
    std::stable_sort(by.begin(), by.end(),
                     [&](std::size_t a, std::size_t b) { return frames_of(a) > frames_of(b); });
    std::vector<std::string> out;
    for (std::size_t i : by)
        out.push_back(fmt::format("{} {:.0f}", kHoll10Schemes[i].paper, frames_of(i)));
    return fmt::format("{}", fmt::join(out, " > "));
}

// Pairs of schemes that the print orders one way on some models and the other way on others.
std::string contradicting_orders()
{
    std::string out;
    for (std::size_t a = 0; a < kSchemes; ++a)
        for (std::size_t b = a + 1; b < kSchemes; ++b) {
            std::vector<std::string> faster[2];
            for (std::size_t m = 0; m < kModels; ++m) {
                double const fa = kPrinted[a][m], fb = kPrinted[b][m];
                faster[fa > fb].push_back(
                    fmt::format("{} ({:.0f} to {:.0f})", kHoll10Models[m].paper, fa, fb));
            }
            if (faster[0].empty() || faster[1].empty()) continue;
            out += fmt::format("\n  {} has more frames than {} on {}, and fewer on {}",
                               kHoll10Schemes[a].paper, kHoll10Schemes[b].paper,
                               fmt::join(faster[1], ", "), fmt::join(faster[0], ", "));
        }
    return out;
}

// Where time grows by more than triangles do, or falls where they grow, whatever the last digit
// was rounded from.
std::string contradicting_growth()
{
    std::string out;
    auto const compare = [&](std::string const& row, double const(&fps)[kModels]) {
        for (std::size_t m = 1; m < kModels; ++m) {
            double const triangles =
                double(kHoll10Models[m].triangles) / kHoll10Models[m - 1].triangles;
            double const least = (fps[m - 1] - 0.5) / (fps[m] + 0.5),
                         most = (fps[m - 1] + 0.5) / (fps[m] - 0.5);
            if (least <= triangles && most >= 1) continue;
            out += fmt::format("\n  {}: from {} ({:.0f}) to {} ({:.0f}) {:.3g} times the time, "
                               "within rounding {:.3g} at least, for {:.3g} times the triangles",
                               row, kHoll10Models[m - 1].paper, fps[m - 1], kHoll10Models[m].paper,
                               fps[m], fps[m - 1] / fps[m], least, triangles);
        }
    };
    for (std::size_t l = 0; l < kLast; ++l)
        compare(fmt::format("SM, level {}", kHoll10Levels[l]), kHoll10Printed[l]);
    for (std::size_t s = 0; s < kSchemes; ++s) compare(kHoll10Schemes[s].paper, kPrinted[s]);
    return out;
}

class Table1 {
public:
    Table1(std::vector<ControlMesh> const& meshes, GpuModel const& gpu, Machine const& machine,
           ThreadPool const& threads, PaperProgress const& progress)
        : gpu_(gpu)
    {
        FrameSettings s;
        s.machine = machine;
        s.vertex_cache = gpu.vertex_cache;
        for (std::size_t m = 0; m < kModels; ++m)
            for (std::size_t k = 0; k < kSchemes; ++k) {
                SchemeOnMesh const on = build_holl10(kHoll10Schemes[k], meshes.at(m));
                for (std::size_t l = k == kSm ? 0 : kLast; l < kLevels; ++l)
                    count(m, k, l, count_frame(on, s, kHoll10Levels[l], threads));
                if (progress) progress(m * kSchemes + k + 1, kModels * kSchemes);
            }
        for (Cell const& c : sm_) timed_.push_back(c);
        fitted_ = fitted_to(timed_, gpu);
    }

    Holl10Table table() const
    {
        Holl10Table out;
        out.gpu = fitted_;
        out.table.title =
            "HOLL10 table I: output triangles and frames a second on a GeForce GTX 295";
        for (std::size_t m = 0; m < kModels; ++m) {
            for (std::size_t l = 0; l < kLevels; ++l) add_sm(out.table, m * kLevels + l);
            for (std::size_t k = kSm + 1; k < kSchemes; ++k) add_substitute(out.table, m, k);
        }
        out.table.remarks = remarks();
        return out;
    }

private:
    void count(std::size_t m, std::size_t k, std::size_t l, Holl10Frame const& frame)
    {
        Holl10Model const& model = kHoll10Models[m];
        Cell c;
        c.model = model.caption();
        c.scheme = kHoll10Schemes[k].paper;
        c.level = kHoll10Levels[l];
        c.seconds = 1 / (k == kSm ? kHoll10Printed[l][m] : kPrinted[k][m]);
        c.scale = double(model.triangles) / double(frame.triangles_of_m0);
        c.triangles = frame.triangles / frame.triangles_of_m0 * std::size_t(model.triangles);
        c.statistics = frame.all;
        (k == kSm ? sm_ : substitutes_).push_back(std::move(c));
    }

    double seconds(Cell const& c) const { return predicted_seconds(fitted_, c); }
    Cell const& cell(std::size_t m, std::size_t k) const
    {
        return k == kSm ? sm_[m * kLevels + kLast] : substitutes_[m * (kSchemes - 1) + k - 1];
    }

    void add_sm(PaperTable& to, std::size_t i) const
    {
        Cell const& c = sm_[i];
        // The print cuts thousands off.
        std::size_t const printed = kTriangles[i / kLevels][i % kLevels];
        if (c.level == 2)
            to.cells.push_back({c.row(), "output triangles", double(printed), double(c.triangles)});
        else
            to.cells.push_back({c.row(), "output triangles, whole thousands", double(printed),
                                double(c.triangles / 1000)});
        double const fps = 1 / c.seconds;
        to.cells.push_back({c.row(), "frames a second", fps, 1 / seconds(c)});
        to.cells.push_back({c.row(), "frames a second, cell left out of the fit", fps,
                            1 / predicted_seconds(fitted_to(timed_, gpu_, i), c)});
    }
    void add_substitute(PaperTable& to, std::size_t m, std::size_t k) const
    {
        Cell const& c = cell(m, k);
        Cell const& sm = cell(m, kSm);
        to.cells.push_back(
            {c.row(), "frames a second, by SM's fit", 1 / c.seconds, 1 / seconds(c)});
        to.cells.push_back(
            {c.row(), "time / SM's", c.seconds / sm.seconds, seconds(c) / seconds(sm)});
    }

    // Where print and counters place QAS.
    std::string places_of_qas() const
    {
        std::string out;
        for (std::size_t m = 0; m < kModels; ++m) {
            out += fmt::format("\n  {}:", kHoll10Models[m].caption());
            for (std::size_t other : {kSm, kPn}) {
                bool const below = kPrinted[kQas][m] < kPrinted[other][m];
                bool const ours = seconds(cell(m, kQas)) > seconds(cell(m, other));
                out += fmt::format("{} {} {} {}", other == kSm ? "" : ",",
                                   below ? "below" : "above", kHoll10Schemes[other].paper,
                                   below == ours ? "follows" : "does not follow");
            }
        }
        return out;
    }

    std::string bounds() const
    {
        std::map<std::string, std::vector<std::string>> cells;
        for (auto const* some : {&sm_, &substitutes_})
            for (Cell const& c : *some)
                cells[in_words(estimate_cost(fitted_, c.statistics))].push_back(c.row());
        if (cells.size() == 1)
            return fmt::format("Every cell is bound by one stage: {}.", cells.begin()->first);
        std::string out = "What bounds each cell:";
        for (auto const& [bound, rows] : cells)
            out += fmt::format("\n  {}: {}", bound, fmt::join(rows, "; "));
        return out;
    }

    std::vector<std::string> remarks() const
    {
        std::string orders;
        for (std::size_t m = 0; m < kModels; ++m)
            orders += fmt::format("\n  {}\n    paper {}\n    ours  {}", kHoll10Models[m].caption(),
                                  order([&](std::size_t k) { return kPrinted[k][m]; }),
                                  order([&](std::size_t k) { return 1 / seconds(cell(m, k)); }));
        return {
            in_words_of_fit(fitted_) + " SM's cells alone are fitted.",
            bounds(),
            "Counted: all passes on uniform patterns without rasterization, whose share the "
            "paper does not tell. Every vertex of a pattern runs once. The print cuts "
            "thousands of triangles off.",
            "At level 5, frames a second:" + orders,
            "Substitutes come out too fast. By the print a triangle of Flat takes about half "
            "of the time of one of SM, whose vertices read five times as much: a triangle has "
            "a cost that is not among the counters, and SM's fit has put it on fetches.",
            "QAS in the print:" + places_of_qas() +
                "\n  By counters it lies between PT and PN: a vertex of QAS reads 12 vectors, of "
                "PT 6, of PN 16, of SM a weight, a position and a normal for each of some 12 "
                "points. Both QAS and SM have a pass over vertices before.",
            "No model that counts can have both of each of these, for it orders schemes alike "
            "on all models:" +
                contradicting_orders(),
            "Nor these, for in it a frame takes an overhead and so much a triangle:" +
                contradicting_growth(),
            holl10_models_remark()};
    }

    static constexpr std::size_t kTriangles[kModels][kLevels] = {
        {8384, 134, 536}, {18688, 299, 1196}, {41344, 661, 2646}, {46400, 742, 2969}};
    GpuModel const& gpu_;
    std::vector<Cell> sm_, substitutes_; // by model, then by level or scheme
    std::vector<TimedCell> timed_;       // sm_
    GpuModel fitted_;
};

} // namespace

Holl10Table reproduce_holl10_table1(std::vector<ControlMesh> const& meshes, GpuModel const& gpu,
                                    Machine const& machine, ThreadPool const& threads,
                                    PaperProgress const& progress)
{
    return Table1(meshes, gpu, machine, threads, progress).table();
}

} // namespace tessemu
