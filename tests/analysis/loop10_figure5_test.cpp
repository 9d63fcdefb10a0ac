// LOOP10's figure 5: what decides its claims, on frames that nobody predicted; and frames of other
// meshes.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop10/figure5.h"

#include "io/gpu_file.h"
#include "io/model.h"
#include "io/report.h"
#include "pipeline/mesh/catmull_clark.h"
#include "tests/support/files.h"
#include "tests/support/printed.h"
#include "tests/support/sanitized.h"
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
    Figure5Times fitted, counted; ///< with a step's overheads, and without
    Figure5Measures measures;

    static FrameTime frame(std::size_t factor, double rate)
    {
        return {1 / rate, 0.05 / rate, "rasterizer", kFigure5Factor[factor]};
    }
    void set(std::size_t gpu, std::size_t model, std::size_t curve, std::size_t factor, double rate)
    {
        for (Figure5Times* t : {&fitted, &counted})
            t->frame[gpu][model][curve][factor] = frame(factor, rate);
    }
    std::map<std::string, PaperClaim> claims() const
    {
        std::map<std::string, PaperClaim> out;
        for (PaperClaim& c : loop10_claims(fitted, counted, measures)) out[c.letter] = std::move(c);
        return out;
    }
    Verdict verdict(std::string const& letter) const { return claims().at(letter).verdict; }
};

// Frames under which every claim holds.
Figures as_claimed()
{
    Figures out;
    // Frames a second of Gregory1, Gregory2, Stam, biseptic: at 1 and 2, at 4 and 8, at 16 and 32.
    constexpr double kRates[kFigure5Gpus][3][kFigure5Curves] = {
        {{2000, 1500, 1000, 900}, {1000, 1100, 600, 550}, {100, 105, 60, 20}},
        {{2000, 1500, 1000, 900}, {1500, 1200, 700, 650}, {700, 700, 420, 410}}};
    constexpr double kGains[kFigure5Factors] = {1.2, 1.1, 1.05, 1, 0.95, 0.9};
    for (std::size_t g = 0; g < kFigure5Gpus; ++g)
        for (std::size_t m = 0; m < kFigure5Models; ++m) {
            for (std::size_t c = 0; c < kFigure5Curves; ++c)
                for (std::size_t f = 0; f < kFigure5Factors; ++f)
                    out.set(g, m, c, f, kRates[g][f / 2][c]);
            for (std::size_t f = 0; f < kFigure5Factors; ++f)
                out.measures.regular_quads[g][m][f] = {kGains[f], ""};
            for (Figure5Times* t : {&out.fitted, &out.counted}) {
                t->step[g][m].seconds = g == kRadeon5870 ? 0.30e-3 : 0.33e-3;
                t->sorting_gain[g][m].fill(0);
            }
            out.measures.lost_lanes[g][m] = 0.3;
            out.measures.samples[m] = {3, 4};
        }
    return out;
}

TEST(Loop10Claims, AllHoldOnFramesLikeThePapers)
{
    std::string letters;
    for (auto const& [letter, claim] : as_claimed().claims()) {
        EXPECT_EQ(claim.verdict, Verdict::Holds) << letter;
        letters += letter;
    }
    EXPECT_EQ(letters, "abcdefghijklm");
}

struct Against {
    char const* letter;
    std::size_t gpu, model, curve, factor;
    double rate;
};

TEST(Loop10Claims, OneFrameAgainstAClaimTurnsIt)
{
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

// Frames without a step have no overhead, for nobody knows it: what the overhead of a step turns is
// not decided.
TEST(Loop10Claims, WhatFailsWithTheFittedOverheadsAloneIsNotDecided)
{
    for (Against const& a : {Against{"a", kGtx480, kCat, kGregory2, 1, 2000},
                             {"b", kRadeon5870, kBigguy, kGregory2, 3, 1000},
                             {"c", kGtx480, kBigguy, kGregory2, 4, 594},
                             {"d", kRadeon5870, kCat, kStam, 5, 100},
                             {"l", kRadeon5870, kCat, kGregory2, 4, 84}}) {
        Figures figures = as_claimed();
        FrameTime const against = Figures::frame(a.factor, a.rate);
        figures.counted.frame[a.gpu][a.model][a.curve][a.factor] = against;
        EXPECT_EQ(figures.verdict(a.letter), Verdict::Holds) << a.letter;
        std::swap(figures.counted, figures.fitted);
        EXPECT_EQ(figures.verdict(a.letter), Verdict::CannotFollow) << a.letter;
        figures.counted = figures.fitted;
        EXPECT_EQ(figures.verdict(a.letter), Verdict::DoesNot) << a.letter;
    }
    Figures figures = as_claimed();
    figures.fitted.frame[kGtx480][kCat][kStam][0].subdivision = 0.11e-3; // of 1 ms
    EXPECT_EQ(figures.verdict("h"), Verdict::CannotFollow);
    figures.counted = figures.fitted;
    EXPECT_EQ(figures.verdict("h"), Verdict::DoesNot);
}

// After a step the factors 1 and 2 are one frame, after two 1, 2 and 4.
TEST(Loop10Claims, AFrameThatIsDrawnAgainCountsOnce)
{
    Figures figures = as_claimed();
    auto const expect = [&](std::map<std::string, std::string> const& counts) {
        auto const claims = figures.claims();
        for (auto const& [letter, count] : counts)
            EXPECT_NE(claims.at(letter).ours.find(count + ": "), std::string::npos)
                << letter << ": " << claims.at(letter).ours;
    };
    expect({{"a", "16 of 16"},
            {"d", "48 of 48"},
            {"f", "16 of 16"},
            {"h", "144 of 144"},
            {"m", "48 of 48"}});
    for (Figure5Times* t : {&figures.fitted, &figures.counted})
        for (auto& models : t->frame)
            for (std::size_t m = 0; m < kFigure5Models; ++m)
                for (std::size_t c : {kGregory2, kStam, kBiseptic})
                    for (std::size_t f = 0; f < kFigure5Factors; ++f)
                        models[m][c][f].factor =
                            std::max(1, kFigure5Factor[f] / (m == kCat ? 4 : 2));
    // Of a GPU and curve 1 frame of 6 less on three models, 2 on Cat. Gregory1's are all different,
    // and (d) has one of them as the slower of two: Cat at 4 on the Radeon.
    expect({{"a", "16 of 16"},
            {"d", "39 of 39"},
            {"f", "8 of 8"},
            {"h", "114 of 114"},
            {"m", "38 of 38"}});
}

TEST(Loop10Claims, AClaimAboutTwoKindsOfFramesSaysWhatBoundsEach)
{
    Figures figures = as_claimed();
    for (std::size_t g = 0; g < kFigure5Gpus; ++g)
        for (std::size_t m = 0; m < kFigure5Models; ++m)
            for (std::size_t f = 0; f < kFigure5Factors; ++f) {
                auto& frame = figures.fitted.frame[g][m];
                frame[kGregory2][f].bound = f < 4 ? "low" : "dense";
                frame[kBiseptic][f].bound = g == kGtx480 ? "arithmetic" : "memory";
                figures.measures.regular_quads[g][m][f].bound = f < 3 ? "hull" : "domain";
            }
    EXPECT_EQ(figures.claims().at("c").bound, "at 4 and 8: low (4); at 16 and 32: dense (4)");
    EXPECT_EQ(figures.claims().at("g").bound, "Radeon: memory (8); GTX 480: arithmetic (8)");
    EXPECT_EQ(figures.claims().at("j").bound,
              "Radeon: hull (12); domain (12); GTX 480: hull (12); domain (12)");
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
    for (auto& s : step.fitted.step[kGtx480]) s.seconds = 0.309e-3;
    EXPECT_EQ(step.verdict("i"), Verdict::CannotFollow) << "below the table's last digit";
    for (Figure5Times* t : {&step.fitted, &step.counted}) t->step[kGtx480][kCat].seconds = 0.28e-3;
    EXPECT_EQ(step.verdict("i"), Verdict::DoesNot);
}

TEST(Loop10Claims, MeasuresTurnTheirs)
{
    auto const turned = [](char const* letter, auto const& change) {
        Figures figures = as_claimed();
        change(figures);
        return figures.verdict(letter) == Verdict::DoesNot;
    };
    EXPECT_TRUE(turned("j", [](Figures& f) { f.measures.regular_quads[0][kCat][1].gain = 0.99; }));
    EXPECT_TRUE(turned("j", [](Figures& f) { f.measures.regular_quads[1][kCat][5].gain = 1.01; }));
    EXPECT_FALSE(turned("j", [](Figures& f) { f.measures.regular_quads[1][kCat] = {}; }))
        << "no regular quads";
    EXPECT_TRUE(turned("k", [](Figures& f) { f.measures.samples[kCat] = {72, 100}; }));
    EXPECT_TRUE(turned("k", [](Figures& f) { f.measures.samples[kCat] = {78, 100}; }));
    EXPECT_FALSE(turned("k", [](Figures& f) { f.measures.samples[kCat] = {73, 100}; }));
    auto const sorting = [](double gain) {
        return [gain](Figures& f) {
            for (Figure5Times* t : {&f.fitted, &f.counted}) t->sorting_gain[1][kCat][0] = gain;
        };
    };
    EXPECT_TRUE(turned("m", sorting(0.011)));
    EXPECT_FALSE(turned("m", sorting(-0.2)));
}

TEST(Loop10Claims, ModelsAgainstThreeOfFourSamplesAreNamed)
{
    Figures figures = as_claimed();
    EXPECT_EQ(figures.claims().at("k").ours.find("against"), std::string::npos);
    figures.measures.samples[kBigguy] = {67, 100};
    figures.measures.samples[kCat] = {0, 100};
    EXPECT_TRUE(figures.claims().at("k").ours.ends_with(
        "; against it: Bigguy, Cat (stand-in knight_tri_1k)"));
}

// Frames of one draw, whose multiplications name the factor of a patch: a second each.
Figure5Counts named_frames()
{
    Figure5Counts out;
    for (std::size_t m = 0; m < kFigure5Models; ++m) {
        auto& model = out.frames[m];
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
        out.sorted[m] = model[kGregory2];
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
        EXPECT_EQ(faces.frame[0][kCat][kStam][f].factor, std::max(1, kFigure5Factor[f] / 4));
        EXPECT_EQ(faces.frame[0][kCat][kGregory1][f].factor, kFigure5Factor[f]);
    }
}

// Draws of patches of factor F take F s unsorted and half of it sorted; kernels of no time do not
// wait.
TEST(Figure5Times, WhatSortingSavesIsOfTheFrameOfTheSameReading)
{
    GpuModel gpu;
    gpu.arithmetic = 2;
    Figure5Counts counts = named_frames();
    for (auto& model : counts.frames)
        for (auto& frame : model[kGregory2]) frame[1].statistics.stages[0].flops.mul *= 2;
    auto const times = [&](SubdivisionFit const& fit, FactorOf factors) {
        return figure5_times(counts, {gpu, gpu}, fit, factors);
    };
    for (std::size_t f = 0; f < kFigure5Factors; ++f) {
        double const factor = kFigure5Factor[f], part = std::max(1.0, factor / 2);
        auto const gain = [&](Figure5Times const& t) { return t.sorting_gain[0][kBigguy][f]; };
        EXPECT_EQ(gain(times({}, FactorOf::Face)), 0.5);
        EXPECT_EQ(gain(times({1, 0}, FactorOf::Face)), 1 - (part / 2 + 1) / (part + 1));
        EXPECT_EQ(gain(times({1, 0}, FactorOf::Patch)), 1 - (factor / 2 + 1) / (factor + 1));
    }
    EXPECT_EQ(times({1, 0}, FactorOf::Face).step[0][kBigguy].seconds, 1);
    EXPECT_EQ(times({}, FactorOf::Face).step[0][kBigguy].seconds, 0);
}

// 30 of 60 lanes wait in a kernel of 1 s, which takes another second for it; sorted they do not.
TEST(Figure5Times, LanesThatWaitMakeAKernelLonger)
{
    GpuModel gpu;
    gpu.arithmetic = 1;
    Figure5Counts counts = named_frames();
    for (auto* frames : {&counts.frames[kBigguy][kGregory2], &counts.sorted[kBigguy]})
        for (auto& frame : *frames) {
            frame[0].name = "vertex points, step 1";
            frame[0].statistics.stages[0].flops.mul = 1;
        }
    counts.turns[kGtx480][kBigguy]["vertex points, step 1"] = {30, 60};
    counts.turns_when_sorted[kGtx480][kBigguy]["vertex points, step 1"] = {30, 30};
    Figure5Times const t = figure5_times(counts, {gpu, gpu}, {}, FactorOf::Patch);
    for (std::size_t f = 0; f < kFigure5Factors; ++f) {
        double const draw = kFigure5Factor[f];
        EXPECT_EQ(t.sorting_gain[kGtx480][kBigguy][f], 1 - (draw + 1) / (draw + 2));
        EXPECT_EQ(t.sorting_gain[kRadeon5870][kBigguy][f], 0);
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
        if (c.letter == "e") {
            EXPECT_EQ(c.other_readings.size(), 3u) << "counted work, 600 million, no limit";
            EXPECT_NE(c.ours.find("; Stam "), std::string::npos) << c.ours;
        }
        if (c.letter == "j") {
            EXPECT_NE(c.ours.find("at 1 and 2: 12 of 12: "), std::string::npos)
                << c.ours << ": a step leaves no regular quad of a cube";
        }
        if (c.letter == "a" || c.letter == "f") {
            EXPECT_TRUE(std::any_of(c.other_readings.begin(), c.other_readings.end(),
                                    [](std::string const& other) {
                                        return other.starts_with("with the counted work");
                                    }))
                << c.letter;
        }
        if (c.letter != "k") {
            EXPECT_FALSE(c.bound.empty()) << c.letter;
        } else { // 24 and 96 children of 17 x 17 points, of which 24 and 24 stay extraordinary
            EXPECT_TRUE(c.ours.starts_with("Twohole 0.0 % of 6936, Bigguy 75.0 % of 27744, "))
                << c.ours;
            EXPECT_NE(c.ours.find(", Cat 0.0 % of 69360; against it: "), std::string::npos)
                << c.ours << ": 80 triangles leave their middles, of valence 3, at each child";
        }
    }
    EXPECT_EQ(letters, "abcdefghijklm");
}

// Every verdict, and every number as the rounded one of some that the program prints.
TEST(Loop10Figure5, ThePagesTableIsWhatTheProgramGives)
{
    if (test::kSlow) GTEST_SKIP() << "672 frames: too many for instrumented code";
    std::vector<ControlMesh> meshes;
    for (Loop10Model const& m : kLoop10Models) {
        std::string const file = std::string("models/") + m.ours + ".obj";
        TESSEMU_NEEDS_SHARED(file);
        meshes.push_back(load_model(test::shared(file).string()).mesh);
    }
    FrameSettings s;
    s.width = 1280;
    s.height = 1024;
    PaperPlots const p = reproduce_loop10_figure5(
        meshes, {load_gpu_model("radeon5870"), load_gpu_model("gtx480")}, s, ThreadPool(), {});
    auto const rows = test::table_of("docs/loop10.md", "| | the paper's claim | verdict |");
    ASSERT_EQ(rows.size(), p.claims.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        PaperClaim const& c = p.claims[i];
        ASSERT_EQ(rows[i].size(), 5u) << c.letter;
        EXPECT_EQ(rows[i][0], c.letter);
        EXPECT_EQ(rows[i][2], name_of(c.verdict)) << c.letter;
        std::string text = c.ours;
        for (std::string const& other : c.other_readings) text += "\n" + other;
        auto const ours = test::printed_numbers(text);
        auto const said = test::printed_numbers(rows[i][3]);
        EXPECT_FALSE(said.empty()) << c.letter;
        for (test::Printed const& number : said)
            EXPECT_TRUE(std::any_of(ours.begin(), ours.end(),
                                    [&](auto const& n) { return number.rounds_from(n.value); }))
                << "(" << c.letter << ") " << number.value << " is none of: " << text;
    }
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
