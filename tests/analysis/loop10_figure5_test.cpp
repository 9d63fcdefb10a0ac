// LOOP10's figure 5: what decides its claims, on frames that nobody predicted; and frames of other
// meshes.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop10/figure5.h"

#include "io/gpu_file.h"
#include "io/model.h"
#include "io/report.h"
#include "pipeline/mesh/catmull_clark.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <sstream>

namespace tessemu {
namespace {

using Verdict = PaperClaim::Verdict;

constexpr std::size_t kBigguy = 1, kCat = 3;

struct Figures {
    Figure5Times times;
    Figure5Measures measures;

    void set(std::size_t gpu, std::size_t model, std::size_t curve, std::size_t factor, double rate)
    {
        times.frame[gpu][model][curve][factor] = {1 / rate, 0.05 / rate, "rasterizer"};
    }
    std::map<std::string, Verdict> verdicts() const
    {
        std::map<std::string, Verdict> out;
        for (PaperClaim const& c : loop10_claims(times, measures)) out[c.letter] = c.verdict;
        return out;
    }
    Verdict verdict(std::string const& letter) const { return verdicts().at(letter); }
};

// Frames under which every claim holds.
Figures as_claimed()
{
    Figures out;
    // Frames a second of Gregory1, Gregory2, Stam, biseptic: at 1 and 2, at 4 and 8, at 16 and 32.
    constexpr double kRates[kFigure5Gpus][3][kFigure5Curves] = {
        {{2000, 1500, 1000, 900}, {1000, 1100, 600, 550}, {100, 105, 60, 20}},
        {{2000, 1500, 1000, 900}, {1500, 1200, 700, 650}, {700, 700, 420, 410}}};
    for (std::size_t g = 0; g < kFigure5Gpus; ++g)
        for (std::size_t m = 0; m < kFigure5Models; ++m) {
            for (std::size_t c = 0; c < kFigure5Curves; ++c)
                for (std::size_t f = 0; f < kFigure5Factors; ++f)
                    out.set(g, m, c, f, kRates[g][f / 2][c]);
            out.measures.step[g][m].seconds = g == kRadeon5870 ? 0.30e-3 : 0.33e-3;
            out.measures.bspline_gain[g][m] = {1.2, 1.1, 1.05, 1, 0.95, 0.9};
            out.measures.sorting_gain[g][m].fill(0);
            out.measures.lost_lanes[g][m] = 0.3;
            out.measures.samples[m] = {3, 4};
        }
    return out;
}

TEST(Loop10Claims, AllHoldOnFramesLikeThePapers)
{
    std::string letters;
    for (auto const& [letter, verdict] : as_claimed().verdicts()) {
        EXPECT_EQ(verdict, Verdict::Holds) << letter;
        letters += letter;
    }
    EXPECT_EQ(letters, "abcdefghijklm");
}

TEST(Loop10Claims, OneFrameAgainstAClaimTurnsIt)
{
    struct Against {
        char const* letter;
        std::size_t gpu, model, curve, factor;
        double rate;
    };
    for (Against const& a : {Against{"a", kGtx480, kCat, kGregory2, 1, 2000},
                             {"b", kRadeon5870, kBigguy, kGregory2, 3, 1000},
                             {"c", kGtx480, kBigguy, kGregory2, 2, 1501},
                             {"c", kGtx480, kBigguy, kGregory2, 4, 594},
                             {"c", kGtx480, kBigguy, kGregory2, 5, 806},
                             {"d", kRadeon5870, kCat, kStam, 5, 100},
                             {"d", kGtx480, kCat, kBiseptic, 0, 1500},
                             {"e", kGtx480, kCat, kGregory1, 5, 499},
                             {"e", kRadeon5870, kCat, kStam, 4, 41},
                             {"f", kRadeon5870, kCat, kBiseptic, 1, 1000},
                             {"g", kGtx480, kCat, kBiseptic, 4, 356},
                             {"l", kRadeon5870, kCat, kGregory2, 4, 84},
                             {"l", kGtx480, kCat, kGregory2, 5, 806}}) {
        Figures figures = as_claimed();
        figures.set(a.gpu, a.model, a.curve, a.factor, a.rate);
        EXPECT_EQ(figures.verdict(a.letter), Verdict::DoesNot) << a.letter << " " << a.rate;
    }
}

TEST(Loop10Claims, FramesThatAClaimIsNotAboutDoNotTurnIt)
{
    Figures figures = as_claimed();
    figures.set(kRadeon5870, kCat, kGregory2, 3, 900);    // (b) is about Bigguy and Monsterfrog
    figures.set(kGtx480, kCat, kGregory2, 4, 594);        // (c) is
    figures.set(kRadeon5870, kBigguy, kGregory2, 1, 500); // (b) from factor 4 on
    figures.set(kRadeon5870, kBigguy, kBiseptic, 4, 10);  // (e) leaves biseptic to (g)
    figures.set(kGtx480, kBigguy, kBiseptic, 3, 699);     // (g) at 16 and 32, (f) at 1 and 2
    for (char const* letter : {"a", "b", "c", "e", "f", "g"})
        EXPECT_EQ(figures.verdict(letter), Verdict::Holds) << letter;
}

TEST(Loop10Claims, WhatNoCounterHasIsNotDecided)
{
    Figures spills = as_claimed();
    spills.set(kRadeon5870, kCat, kBiseptic, 5, 31); // of Stam's 60
    EXPECT_EQ(spills.verdict("g"), Verdict::CannotFollow);
    spills.set(kGtx480, kCat, kBiseptic, 5, 300);
    EXPECT_EQ(spills.verdict("g"), Verdict::DoesNot) << "whatever the Radeon does";

    Figures step = as_claimed();
    for (auto& s : step.measures.step[kGtx480]) s.seconds = 0.309e-3;
    EXPECT_EQ(step.verdict("i"), Verdict::CannotFollow) << "below the table's last digit";
    step.measures.step[kGtx480][kCat].seconds = 0.28e-3;
    EXPECT_EQ(step.verdict("i"), Verdict::DoesNot);
}

TEST(Loop10Claims, MeasuresTurnTheirs)
{
    auto const turned = [](char const* letter, auto const& change) {
        Figures figures = as_claimed();
        change(figures);
        return figures.verdict(letter) == Verdict::DoesNot;
    };
    EXPECT_TRUE(turned("h", [](Figures& f) {
        f.times.frame[kGtx480][kCat][kStam][0] = {1e-3, 0.101e-3, ""};
    }));
    EXPECT_TRUE(turned("j", [](Figures& f) { f.measures.bspline_gain[0][kCat][1] = 0.99; }));
    EXPECT_TRUE(turned("j", [](Figures& f) { f.measures.bspline_gain[1][kCat][5] = 1.01; }));
    EXPECT_TRUE(turned("k", [](Figures& f) { f.measures.samples[kCat] = {63, 100}; }));
    EXPECT_FALSE(turned("k", [](Figures& f) { f.measures.samples[kCat] = {64, 100}; }));
    EXPECT_TRUE(turned("m", [](Figures& f) { f.measures.sorting_gain[1][kCat][0] = 0.011; }));
    EXPECT_FALSE(turned("m", [](Figures& f) { f.measures.sorting_gain[1][kCat][0] = -0.2; }));
}

// Frames of one draw, whose multiplications name the factor of a patch: a second each.
Figure5Counts named_frames()
{
    Figure5Counts out;
    for (auto& model : out.frames)
        for (std::size_t c = 0; c < kFigure5Curves; ++c)
            for (std::size_t f = 0; f < kFigure5Factors; ++f) {
                CommandStatistics draw{"draw", "patches", 1, {}};
                draw.statistics.stages.resize(1);
                draw.statistics.stages[0].stage = "domain_shader";
                draw.statistics.stages[0].flops.mul = std::uint64_t(kFigure5Factor[f]);
                model[c][f] = {draw};
                if (c == kGregory1) continue;
                CommandStatistics step{"dispatch", "edge points, step 1", 1, {}};
                step.statistics.stages.resize(1);
                step.statistics.stages[0].stage = "compute_shader";
                model[c][f].insert(model[c][f].begin(), step);
            }
    return out;
}

TEST(Figure5Times, PatchesAfterStepsHaveTheirPartOfAFacesFactor)
{
    GpuModel gpu;
    gpu.arithmetic = 1;
    SubdivisionFit const fit{0.25, 0.125};
    Figure5Times const faces = figure5_times(named_frames(), {gpu, gpu}, fit, FactorOf::Face),
                       patches = figure5_times(named_frames(), {gpu, gpu}, fit, FactorOf::Patch);
    for (std::size_t f = 0; f < kFigure5Factors; ++f) {
        double const factor = kFigure5Factor[f], step = 0.25 + 0.125;
        auto const seconds = [&](Figure5Times const& t, std::size_t model, std::size_t curve) {
            return t.frame[kGtx480][model][curve][f].seconds;
        };
        EXPECT_EQ(seconds(faces, kBigguy, kGregory1), factor);
        EXPECT_EQ(seconds(faces, kBigguy, kGregory2), std::max(1.0, factor / 2) + step);
        EXPECT_EQ(seconds(faces, kCat, kStam), std::max(1.0, factor / 4) + step) << "two steps";
        EXPECT_EQ(seconds(patches, kCat, kStam), factor + step);
        EXPECT_EQ(patches.frame[0][kCat][kStam][f].subdivision, step);
        EXPECT_EQ(patches.frame[0][kCat][kStam][f].bound, "domain shader, arithmetic");
    }
}

// A cube; what a step makes of it, of which each face has one vertex of valence 3; quads of many
// kinds; triangles where the paper's Cat is.
std::vector<ControlMesh> stand_ins()
{
    ControlMesh const cube = test::cube().mesh;
    return {cube, catmull_clark_step(Topology(cube)).mesh, load_model("golem").mesh,
            test::ico_sphere(1).mesh};
}

FrameSettings small()
{
    FrameSettings s;
    s.width = 80;
    s.height = 64;
    return s;
}

TEST(Loop10Figure5, APanelForEachModelAndGpuAndAllClaims)
{
    std::size_t done = 0, all = 0, calls = 0;
    PaperPlots const p = reproduce_loop10_figure5(
        stand_ins(), {load_gpu_model("radeon5870"), load_gpu_model("gtx480")}, small(),
        ThreadPool(2), [&](std::size_t n, std::size_t of) {
            EXPECT_GT(n, done);
            done = n, all = of, ++calls;
        });
    EXPECT_EQ(done, all);
    EXPECT_GT(calls, 50u);
    ASSERT_EQ(p.sheet.panels.size(), 8u);
    EXPECT_EQ(p.sheet.panels[0].title, "Twohole*, Radeon HD 5870");
    EXPECT_EQ(p.sheet.panels[5].title, "Bigguy, GeForce GTX 480");
    for (Plot const& panel : p.sheet.panels) {
        ASSERT_EQ(panel.series.size(), 4u);
        for (PlotSeries const& curve : panel.series) {
            ASSERT_EQ(curve.points.size(), 6u);
            for (std::size_t f = 0; f < 6; ++f) {
                EXPECT_EQ(curve.points[f].x, kFigure5Factor[f]);
                EXPECT_FALSE(curve.points[f].label.empty());
                if (f) {
                    EXPECT_LE(curve.points[f].y, curve.points[f - 1].y) << curve.name;
                }
            }
        }
    }
    std::string letters;
    for (PaperClaim const& c : p.claims) {
        letters += c.letter;
        EXPECT_FALSE(c.criterion.empty()) << c.letter;
        EXPECT_FALSE(c.ours.empty()) << c.letter;
        if (c.letter != "k") {
            EXPECT_FALSE(c.bound.empty()) << c.letter;
        } else { // 24 and 96 children of 17 x 17 points, of which 24 and 24 stay extraordinary
            EXPECT_TRUE(c.ours.starts_with("Twohole 0.0 % of 6936, Bigguy 75.0 % of 27744, "))
                << c.ours;
        }
    }
    EXPECT_EQ(letters, "abcdefghijklm");
}

TEST(Loop10Figure5, RefusesOtherModelsAndGpusThanTheFigures)
{
    GpuModel const gpu = load_gpu_model("gtx480");
    EXPECT_THROW(reproduce_loop10_figure5({}, {gpu, gpu}, small(), ThreadPool(1), {}), Error);
    EXPECT_THROW(reproduce_loop10_figure5(stand_ins(), {gpu}, small(), ThreadPool(1), {}), Error);
    GpuModel other = gpu;
    other.vertex_cache = vertex_cache_from_name("none");
    EXPECT_THROW(reproduce_loop10_figure5(stand_ins(), {gpu, other}, small(), ThreadPool(1), {}),
                 Error);
}

TEST(PlotsReport, HasEachPointAndClaimAsTextAndAsJson)
{
    PlotSheet const sheet{{"factor", 2}, {"frames"}, {{"a", {{"s", {{1, 2500, "rate"}, {2, 9}}}}}}};
    std::string const words = "words that go on for longer than a line of the terminal has room "
                              "and on and on and on and on and on";
    std::vector<ClaimRow> const claims{{"a", words, "holds", words, words, words, {words, "short"}},
                                       {"b", "c", "v", "", "", "", {}}};
    std::string const table = plots_table("title", sheet, claims, {words});
    std::istringstream lines(table);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100u) << line;
    for (char const* part : {"title", "2500", "(a) words", "    verdict    holds",
                             "otherwise  short", "(b) c", "* words"})
        EXPECT_NE(table.find(part), std::string::npos) << part;

    auto const j = nlohmann::json::parse(
        plots_report({"reproduce", {}, {}, {}, {}}, "title", sheet, claims, {words}));
    EXPECT_EQ(j["plots"][0]["curves"][0]["points"][0]["y"], 2500);
    EXPECT_EQ(j["plots"][0]["curves"][0]["points"][0]["bound"], "rate");
    EXPECT_EQ(j["claims"][0]["verdict"], "holds");
    EXPECT_EQ(j["claims"][0]["other_readings"][1], "short");
    EXPECT_EQ(j["remarks"].size(), 1u);
}

} // namespace
} // namespace tessemu
