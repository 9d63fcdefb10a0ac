// All schemes in one picture: the page's table is what the program gives, and what it says holds.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/schemes/figure.h"

#include "analysis/compare.h"
#include "io/gpu_file.h"
#include "io/model.h"
#include "io/report.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/printed.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>

namespace tessemu {
namespace {

// The table's factor, and half of it: the finer curves take longer.
constexpr int kFactors[] = {4, 8};

PaperPlots of_golem()
{
    return reproduce_schemes(load_model("golem").mesh, load_gpu_model("gtx480"), {}, ThreadPool(),
                             {}, kFactors, 8);
}

using Numbers = std::map<std::string, double>; // by column

std::map<std::string, Numbers> by_scheme(NumberTable const& table)
{
    std::map<std::string, Numbers> out;
    for (NumberTable::Row const& r : table.rows)
        for (std::size_t i = 0; i < table.columns.size(); ++i)
            out[r.name][table.columns[i]] = r.numbers[i];
    return out;
}

// Of what is on the limit surface the triangles alone err, and their distance from it has the
// length of an edge squared: a quarter, but for the terms beyond.
void expect_limit_surface(std::string const& scheme, Numbers const& n)
{
    EXPECT_GE(n.at("falls"), 3.8) << scheme;
    EXPECT_LE(n.at("falls"), 4.1) << scheme;
}

TEST(SchemesFigure, ThePagesTableIsWhatTheProgramGivesAndWhatItSaysHolds)
{
    if (test::kSlow) GTEST_SKIP() << "14 schemes: too many for instrumented code";
    PaperPlots const p = of_golem();
    auto const page = test::table_of("docs/schemes.md", "| scheme | points |");
    ASSERT_EQ(page.size(), p.table.rows.size());
    ASSERT_EQ(page.size(), schemes().size()) << "every scheme takes the cage";
    for (std::size_t i = 0; i < page.size(); ++i) {
        NumberTable::Row const& row = p.table.rows[i];
        EXPECT_EQ(row.name, schemes()[i]->info().name);
        ASSERT_EQ(page[i].size(), row.numbers.size() + 2);
        EXPECT_EQ(page[i].front(), "`" + row.name + "`");
        EXPECT_EQ(page[i].back(), std::regex_replace(row.note, std::regex(" shader"), ""))
            << row.name;
        for (std::size_t k = 0; k < row.numbers.size(); ++k) {
            std::string cell = page[i][k + 1];
            std::erase(cell, ',');
            EXPECT_TRUE(test::printed(cell).rounds_from(row.numbers[k]))
                << row.name << ", " << p.table.columns[k] << ": " << cell << ", program "
                << row.numbers[k];
        }
    }

    auto const of = by_scheme(p.table);
    auto const error = [&](char const* scheme) { return of.at(scheme).at("error"); };
    auto const time = [&](char const* scheme) { return of.at(scheme).at("us"); };
    for (char const* scheme :
         {"stam", "bolz", "biseptic", "tables-catmull-clark", "tables-loop", "tables-butterfly"})
        expect_limit_surface(scheme, of.at(scheme));
    for (char const* scheme : {"bolz", "tables-catmull-clark"})
        EXPECT_NEAR(error(scheme), error("stam"), 0.01 * error("stam")) << "one surface";
    for (char const* scheme : {"gregory-two-stage", "bolz", "tables-catmull-clark"})
        EXPECT_LT(time(scheme),
                  time(scheme == std::string("gregory-two-stage") ? "gregory-stencil" : "stam"));
    auto const said =
        test::said_in("docs/schemes.md", R"(takes ([\d.]+) to ([\d.]+) times `gregory-stencil`)");
    ASSERT_EQ(said.size(), 2u);
    EXPECT_TRUE(said[0].rounds_from(time("bolz") / time("gregory-stencil")));
    EXPECT_TRUE(said[1].rounds_from(time("stam") / time("gregory-stencil")));
    EXPECT_NEAR(of.at("tables-catmull-clark").at("fetches") / of.at("bolz").at("fetches"), 3, 0.1);
    EXPECT_NEAR(error("gregory-two-stage"), error("gregory-stencil"),
                1e-3 * error("gregory-stencil"));
    for (char const* scheme : {"gregory-two-stage", "pm", "acc"})
        EXPECT_GT(error(scheme), error("stam"));
    EXPECT_GT(error("acc"), 2 * error("pm"));
    // Three that go through the cage's vertices, which Loop's surface does not.
    for (char const* scheme : {"pn-triangles", "phong"}) {
        EXPECT_GT(error(scheme), error("flat"));
        EXPECT_LT(of.at(scheme).at("falls"), 1) << "finer is farther";
    }
    EXPECT_NEAR(of.at("flat").at("falls"), 1, 0.01);
    EXPECT_LT(9 * error("qas"), error("flat"));
    for (auto const& [scheme, numbers] : of) {
        EXPECT_LE(of.at("flat").at("us"), numbers.at("us")) << scheme;
        EXPECT_LE(of.at("flat").at("FLOPs"), numbers.at("FLOPs")) << scheme;
    }
}

TEST(SchemesFigure, HasAPanelOfQuadsAndOneOfTrianglesAndLeavesOutWhatDoesNotTakeTheCage)
{
    constexpr int kOne[] = {2};
    std::size_t done = 0, all = 0;
    PaperPlots const p = reproduce_schemes(
        load_model("saddle_star").mesh, load_gpu_model("gtx480"), {}, ThreadPool(2),
        [&](std::size_t n, std::size_t of) {
            EXPECT_GT(n, done);
            done = n, all = of;
        },
        kOne, 2);
    EXPECT_EQ(done, all);
    ASSERT_EQ(p.sheet.panels.size(), 2u);
    EXPECT_EQ(p.sheet.panels[0].title, "Quads: Catmull-Clark's limit surface");
    EXPECT_EQ(p.sheet.panels[1].title, "Triangles: Loop's limit surface");
    std::size_t curves = 0;
    for (Plot const& panel : p.sheet.panels) {
        for (PlotSeries const& s : panel.series) {
            std::string const name = s.name.substr(0, s.name.find(' '));
            SchemeInfo const info = find_scheme(name).info();
            EXPECT_EQ(info.takes.quads, &panel == &p.sheet.panels[0]) << name;
            // Two steps and more leave no patch of a segment.
            EXPECT_EQ(s.points.size(), info.takes.steps < 2 ? 1u : 0u) << name;
            EXPECT_EQ(s.name != name, name == "tables-butterfly") << s.name;
        }
        curves += panel.series.size();
    }
    EXPECT_EQ(curves + 1, schemes().size()) << "pm draws closed meshes only";
    EXPECT_EQ(std::count_if(p.remarks.begin(), p.remarks.end(),
                            [](std::string const& r) { return r.starts_with("Left out: pm "); }),
              1);
}

// The same points, drawn and sampled alike.
TEST(DrawnErrors, OfTheComparisonsFactorIsTheComparison)
{
    SchemeOnMesh const on =
        build_scheme(find_scheme("gregory-stencil"), load_model("saddle_star").mesh);
    ThreadPool const threads(2);
    FrameSettings settings;
    settings.tess_factor = 8;
    settings.partitioning = Partitioning::Integer;
    DrawnErrors const limit(*on.mesh, 3);
    DrawnError const drawn = limit.of(*on.patches, settings, threads);
    SurfaceComparison const whole = compare_with_limit(*on.patches, {}, 3, threads);
    EXPECT_EQ(drawn.position.rms, whole.from_limit.rms);
    EXPECT_EQ(drawn.position.max, whole.from_limit.max);
    EXPECT_EQ(drawn.normal.rms, whole.normal_from_limit.rms);
    EXPECT_EQ(drawn.points, drawn.counts.total.pipeline.DSInvocations);
    settings.tess_factor = 4;
    EXPECT_GT(limit.of(*on.patches, settings, threads).position.rms, 2 * drawn.position.rms);
}

TEST(PlotsReport, HasATableOfNumbersAndBothCoordinatesOfCurvesThatShareNone)
{
    PlotSheet const sheet{{"time"}, {"error"}, {{"panel", {{"a", {{1, 9}}}, {"b", {{2, 7}}}}}}};
    NumberTable const table{"scheme",
                            "why",
                            {"points", "falls"},
                            {{"one", {5670, NAN}, "fetch"}, {"two", {1, 3.938}, "memory"}}};
    std::string const text = plots_table("title", sheet, {}, {}, table);
    for (char const* line : {"scheme  points  falls  why\n", "one      5,670      -  fetch\n",
                             "two          1   3.94  memory\n"})
        EXPECT_NE(text.find(line), std::string::npos) << text;
    EXPECT_NE(text.find("  b "), std::string::npos);
    for (char const* number : {" 1\n", " 9\n", " 2\n", " 7\n"})
        EXPECT_NE(text.find(number), std::string::npos) << number;
    auto const j = nlohmann::json::parse(
        plots_report({"reproduce", {}, {}, {}, {}}, "title", sheet, {}, {}, table));
    EXPECT_EQ(j["table"][1]["falls"], 3.938);
    EXPECT_FALSE(j["table"][0].contains("falls"));
    EXPECT_EQ(j["table"][0]["scheme"], "one");
    EXPECT_EQ(j["table"][0]["why"], "fetch");
}

} // namespace
} // namespace tessemu
