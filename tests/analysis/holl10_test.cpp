// HOLL10's table I and figures 5 to 8.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/holl10/figure8.h"
#include "analysis/papers/holl10/figures.h"
#include "analysis/papers/holl10/frames.h"
#include "analysis/papers/holl10/items.h"
#include "analysis/papers/holl10/table1.h"
#include "io/gpu_file.h"
#include "io/model.h"
#include "io/report.h"
#include "tests/support/files.h"
#include "tests/support/fitted_table.h"
#include "tests/support/printed.h"

#include <gtest/gtest.h>

#include <cstring>

namespace tessemu {
namespace {

// The specification is of the card, whose two GPUs share nothing: 1788.48 GFLOPS, a multiply-add
// and a multiplication a clock; 223.8 GB/s; 92.2 billion texels of 4 bytes a second. Near: half of the first one's last digit.
TEST(Gpu, OneOfTheGtx295IsHalfOfItsMakersNumbers)
{
    GpuModel const m = load_gpu_model("gtx295");
    EXPECT_NEAR(2 * 3 * m.arithmetic, 1788.48e9, 5e6);
    EXPECT_DOUBLE_EQ(2 * m.bandwidth, 223.8e9);
    EXPECT_LT(m.any_fetch, 92.2e9 / 2 / 4) << "a fit beyond what one can do asks for both";
    for (auto const& [place, source] : m.sources) EXPECT_GT(source.size(), 20u) << place;
}

TEST(Holl10Frame, LevelLMakes4ToTheLTrianglesOfEachInEveryScheme)
{
    ControlMesh const mesh = load_model("golem").mesh;
    for (Holl10Scheme const& scheme : kHoll10Schemes) {
        SCOPED_TRACE(scheme.paper);
        SchemeOnMesh const on = build_holl10(scheme, mesh);
        for (int level : {1, 2, 3}) {
            Holl10Frame const f = count_frame(on, {}, level, ThreadPool(2));
            EXPECT_EQ(f.triangles_of_m0, 140u); // 70 quads
            EXPECT_EQ(f.triangles, f.triangles_of_m0 << 2 * level);
        }
    }
}

std::vector<ControlMesh> stand_ins()
{
    return std::vector<ControlMesh>(std::size(kHoll10Models), load_model("golem").mesh);
}

double ours(std::map<std::string, PaperCell> const& cells, std::string const& row)
{
    auto const found = cells.find(row);
    if (found != cells.end()) return found->second.ours;
    ADD_FAILURE() << "no row " << row;
    return 0;
}

void expect_triangles_and_order(PaperTable const& t)
{
    std::size_t triangles = 0;
    for (PaperCell const& c : t.cells)
        if (c.column.starts_with("output triangles")) {
            EXPECT_EQ(c.ours, c.paper) << c.row;
            ++triangles;
        }
    EXPECT_EQ(triangles, 12u);
    auto const fps = test::by_row(t, "frames a second, by SM's fit");
    EXPECT_EQ(fps.size(), 16u);
    for (Holl10Model const& m : kHoll10Models) {
        auto const of = [&](char const* scheme) {
            return ours(fps, m.caption() + ", level 5, " + scheme);
        };
        EXPECT_LT(of("PN-Tri."), of("PT")) << m.paper;
        EXPECT_LT(of("PT"), of("Flat")) << m.paper;
    }
}

TEST(Holl10Table1, HasThePapersTrianglesAndItsOrderOfLocalSchemes)
{
    Holl10Table const t =
        reproduce_holl10_table1(stand_ins(), load_gpu_model("gtx295"), {}, ThreadPool(2), {});
    expect_triangles_and_order(t.table);
}

// A table of the page holds three figures of a model in a row, or two pairs.
TEST(Holl10Table1, IsWhatThePageSays)
{
    std::vector<ControlMesh> meshes;
    for (Holl10Model const& m : kHoll10Models) {
        std::string const path = "models/" + std::string(m.ours) + ".obj";
        TESSEMU_NEEDS_SHARED(path);
        meshes.push_back(load_model(test::shared(path).string()).mesh);
    }
    Holl10Table const t =
        reproduce_holl10_table1(meshes, load_gpu_model("gtx295"), {}, ThreadPool(2), {});
    test::expect_stored("gtx295", t.gpu);
    expect_triangles_and_order(t.table);
    constexpr char const* kPage = "docs/holl10.md";
    auto const fps = test::by_row(t.table, "frames a second"),
               left_out = test::by_row(t.table, "frames a second, cell left out of the fit"),
               substitutes = test::by_row(t.table, "frames a second, by SM's fit"),
               ratios = test::by_row(t.table, "time / SM's");

    auto const sm = test::table_of(kPage, "| SM, level | Head*");
    ASSERT_EQ(sm.size(), std::size(kHoll10Levels));
    for (auto const& cells : sm)
        for (std::size_t m = 0; m < std::size(kHoll10Models); ++m) {
            std::string const row = kHoll10Models[m].caption() + ", level " + cells[0] + ", SM";
            ASSERT_TRUE(fps.contains(row)) << row;
            EXPECT_NEAR(test::printed(cells[1 + 3 * m]).value, fps.at(row).paper, 1e-9) << row;
            EXPECT_TRUE(test::printed(cells[2 + 3 * m]).rounds_from(ours(fps, row))) << row;
            EXPECT_TRUE(test::printed(cells[3 + 3 * m]).rounds_from(ours(left_out, row))) << row;
        }
    auto const level5 = test::table_of(kPage, "| paper / ours | Head*");
    ASSERT_EQ(level5.size(), std::size(kHoll10Schemes) - 1);
    for (auto const& cells : level5)
        for (std::size_t m = 0; m < std::size(kHoll10Models); ++m) {
            std::string const row = kHoll10Models[m].caption() + ", level 5, " + cells[0];
            ASSERT_TRUE(substitutes.contains(row)) << row;
            for (auto const& [column, of] :
                 {std::pair(1 + 2 * m, &substitutes), std::pair(2 + 2 * m, &ratios)}) {
                auto const pair = test::printed_numbers(cells[column]);
                ASSERT_EQ(pair.size(), 2u) << row;
                EXPECT_TRUE(pair[0].rounds_from(of->at(row).paper)) << row;
                EXPECT_TRUE(pair[1].rounds_from(of->at(row).ours)) << row << " " << ours(*of, row);
            }
        }

    // Frog's and Big Guy's cells but one.
    auto const within =
        test::said_in(kPage, R"(left out within (\d+) % but for Big Guy at level 2, (\d+) %)");
    auto const fit =
        test::said_in(kPage, R"((\d[\d.]+) ms a frame and (\d[\d.e]+) fetches a second)");
    ASSERT_EQ(within.size() + fit.size(), 4u);
    for (auto const& [row, c] : left_out) {
        double const percent = 100 * std::abs(c.ours / c.paper - 1);
        if (row == "Big Guy, level 2, SM") {
            EXPECT_TRUE(within[1].rounds_from(percent)) << percent;
        } else if (row.starts_with("Frog") || row.starts_with("Big Guy")) {
            EXPECT_LE(percent, within[0].value) << row;
        }
    }
    EXPECT_TRUE(fit[0].rounds_from(1e3 * t.gpu.overhead)) << t.gpu.overhead;
    EXPECT_TRUE(fit[1].rounds_from(t.gpu.any_fetch)) << t.gpu.any_fetch;
}

TEST(Holl10Figure8, ATriangleCostsLessWithEachLevelAndTheInitialStepLittle)
{
    PaperPlots const p =
        reproduce_holl10_figure8(stand_ins(), load_gpu_model("gtx295"), {}, ThreadPool(2), {});
    ASSERT_EQ(p.claims.size(), 2u);
    for (PaperClaim const& c : p.claims) {
        EXPECT_EQ(c.verdict, PaperClaim::Verdict::Holds) << c.claim;
        EXPECT_EQ(c.bound, "vertex shader, fetch");
    }
    ASSERT_EQ(p.sheet.panels.size(), std::size(kHoll10Models));
    for (Plot const& panel : p.sheet.panels)
        for (PlotSeries const& s : panel.series)
            for (std::size_t i = 1; i < s.points.size(); ++i)
                EXPECT_LT(s.points[i].y, s.points[i - 1].y) << panel.title << ", " << s.name;
}

// Frog's rows of "Figure 8": ns a triangle; per cent of operations, bytes and time.
TEST(Holl10Figure8, IsWhatThePageSays)
{
    std::vector<ControlMesh> meshes;
    for (Holl10Model const& m : kHoll10Models) {
        std::string const path = "models/" + std::string(m.ours) + ".obj";
        TESSEMU_NEEDS_SHARED(path);
        meshes.push_back(load_model(test::shared(path).string()).mesh);
    }
    PaperPlots const p =
        reproduce_holl10_figure8(meshes, load_gpu_model("gtx295"), {}, ThreadPool(2), {});
    auto const page = test::table_of("docs/holl10.md", "| Frog, level |");
    ASSERT_EQ(page.size(), 3u);
    Plot const& frog = p.sheet.panels[2];
    ASSERT_EQ(frog.title, "Frog");
    for (std::size_t s : {0u, 1u})
        for (std::size_t level = 0; level < 6; ++level) {
            double const y = frog.series[s].points[level].y;
            EXPECT_TRUE(test::printed(page[s].at(1 + level)).rounds_from(y)) << s << ": " << y;
        }
    // The claim has two digits of levels 1, 2, 4 and 5.
    std::string const shares = p.claims[1].ours;
    for (std::size_t level : {1u, 2u, 4u, 5u}) {
        std::string const cell = page[2].at(level);
        std::string const wanted = "level " + std::to_string(level) + " " + cell + " %";
        EXPECT_NE(shares.find(wanted), std::string::npos) << wanted << " in " << shares;
    }
}

// A curve that lacks points of the first one is printed below the points that it has.
TEST(Holl10Figure8, ItsTablePutsPrintedLevelsBelowTheirs)
{
    PlotSheet sheet{{"4^level", 4, {}}, {"ns", 10, {}}, {}, 1};
    sheet.panels = {{"panel", {{"ours", {{4, 1}, {16, 2}, {64, 3}}}, {"paper", {{16, 7}}}}}};
    std::string const text = plots_table("title", sheet, {}, {});
    auto const column = [&](std::string const& line, std::string const& number) {
        std::size_t const begin = text.find(line);
        return text.find(number, begin) + number.size() - text.rfind('\n', begin);
    };
    EXPECT_EQ(column("  paper", " 7"), column("panel", " 16"));
    EXPECT_EQ(text.find(" \n"), std::string::npos);
}

FrameSettings panel_settings()
{
    FrameSettings s;
    s.width = s.height = 96;
    s.samples = 4;
    s.background = {1, 1, 1, 1};
    return s;
}

// No two panels are alike, and each shows something.
void expect_different_panels(PaperFigure const& f)
{
    auto const bytes = [](ColorTarget const& c) {
        std::string out;
        for (int y = 0; y < c.height(); ++y)
            out.append(reinterpret_cast<char const*>(c.texel(0, y)), c.row_bytes());
        return out;
    };
    std::map<std::string, std::string> seen;
    for (PaperFigure::Panel const& p : f.panels) {
        std::string const picture = bytes(p.picture);
        EXPECT_NE(picture.find_first_not_of(picture[0]), std::string::npos) << p.caption;
        auto const [at, is_new] = seen.emplace(picture, p.caption);
        EXPECT_TRUE(is_new) << p.caption << " is " << at->second;
    }
}

TEST(Holl10Figures, HaveAPanelForEachOfTheirs)
{
    FrameSettings const s = panel_settings();
    PaperFigure const five = reproduce_holl10_figure5(s, ThreadPool(2)),
                      six = reproduce_holl10_figure6(s, ThreadPool(2), {}),
                      seven = reproduce_holl10_figure7({load_model("golem").mesh}, s, ThreadPool(2),
                                                       {});
    PaperFigure const four =
        reproduce_holl10_figure4({load_model("golem").mesh}, s, ThreadPool(2), {});
    EXPECT_EQ(four.panels.size(), 4u);
    EXPECT_EQ(five.panels.size(), 6u);
    EXPECT_EQ(six.panels.size(), 12u);
    EXPECT_EQ(seven.panels.size(), 5u);
    for (PaperFigure const* f : {&four, &five, &six, &seven}) expect_different_panels(*f);
}

TEST(TriangleStar, HasOneExtraordinaryVertex)
{
    for (int valence : {3, 4, 8, 12}) {
        ControlMesh const mesh = triangle_star(valence);
        Topology const t(mesh);
        EXPECT_EQ(t.ring(0).size(), std::size_t(valence));
        EXPECT_EQ(mesh.faces(), std::size_t(valence * 16)); // 1 + 3 + 5 + 7 a sector
        for (std::uint32_t v = 1; v < mesh.positions.size(); ++v)
            EXPECT_TRUE(t.is_boundary(v) || t.ring(v).size() == 6) << v;
    }
}

} // namespace
} // namespace tessemu
