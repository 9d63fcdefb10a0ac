// Plots: where ticks and markers lie, and that ink is there.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/plot.h"

#include <OpenImageIO/imageio.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A written picture, with what the layout says of it.
class Drawn {
public:
    explicit Drawn(PlotSheet const& sheet) : layout_(sheet)
    {
        fs::path const path =
            fs::temp_directory_path() / ("tessemu_plot_test_" + std::to_string(getpid()) + ".exr");
        OutputFile out(path);
        write_plots(sheet, out);
        out.commit();
        auto const file = OIIO::ImageInput::open(path.string());
        EXPECT_EQ(file->spec().width, layout_.width());
        EXPECT_EQ(file->spec().height, layout_.height());
        pixels_.resize(std::size_t(layout_.width() * layout_.height()));
        EXPECT_TRUE(file->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, pixels_.data()));
        fs::remove(path);
    }
    PlotLayout const& layout() const { return layout_; }
    std::array<float, 4> pixel(double x, double y) const
    {
        return pixels_.at(std::size_t(y) * std::size_t(layout_.width()) + std::size_t(x));
    }
    std::array<float, 4> at(std::size_t panel, double x, double y) const
    {
        return pixel(layout_.x(panel, x), layout_.y(panel, y));
    }

private:
    PlotLayout layout_;
    std::vector<std::array<float, 4>> pixels_;
};

bool is_blue(std::array<float, 4> const& c) // the first series
{
    return c[0] == 0 && c[2] == 0.7f;
}
bool is_paper(std::array<float, 4> const& c) // or the grid on it
{
    return c[0] > 0.8f && c[1] > 0.8f && c[2] > 0.8f;
}

PlotSheet sheet_of(std::vector<Plot> panels, int columns = 1)
{
    return {{"factor", 2}, {"frames a second"}, std::move(panels), columns};
}

TEST(LogScale, TicksArePowersThatHoldTheValues)
{
    using Ticks = std::vector<double>;
    EXPECT_EQ(LogScale(2, 1, 32).ticks(), (Ticks{1, 2, 4, 8, 16, 32}));
    EXPECT_EQ(LogScale(10, 1000, 1000).ticks(), (Ticks{1000, 10000})) << "a single value";
    EXPECT_EQ(LogScale(10, 3, 1001).ticks(), (Ticks{1, 10, 100, 1000, 10000}));
    EXPECT_EQ(LogScale(2, 0.3, 0.5).ticks(), (Ticks{0.25, 0.5}));
    LogScale const s(10, 3, 900);
    EXPECT_EQ(s.position(1), 0);
    EXPECT_EQ(s.position(1000), 1);
    // Two logarithms and a division, each within an ulp of a value at most 7.
    EXPECT_NEAR(s.position(10), 1. / 3, 0x1p-51);
    EXPECT_EQ(s.minor_ticks().size(), 3u * 8);
    EXPECT_EQ(s.minor_ticks()[8], 20);
    EXPECT_TRUE(LogScale(2, 1, 32).minor_ticks().empty());
}

TEST(LogScale, LabelsAreAsPrinted)
{
    EXPECT_EQ(LogScale::label(1), "1");
    EXPECT_EQ(LogScale::label(32), "32");
    EXPECT_EQ(LogScale::label(0.25), "0.25");
    EXPECT_EQ(LogScale::label(100000), "100000");
    EXPECT_EQ(LogScale::label(1e6), "1e6");
    EXPECT_EQ(LogScale::label(1e12), "1e12");
    EXPECT_EQ(LogScale::label(1e-4), "1e-4");
}

TEST(LogScale, RefusesWhatHasNoLogarithm)
{
    EXPECT_THROW(LogScale(10, 0, 1), Error);
    EXPECT_THROW(LogScale(10, -1, 1), Error);
    EXPECT_THROW(LogScale(10, 2, 1), Error);
    EXPECT_THROW(LogScale(10, 1, kInfinite), Error);
    EXPECT_THROW(LogScale(10, std::nan(""), 1), Error);
    EXPECT_THROW(LogScale(1, 1, 2), Error);
}

TEST(Plot, PointsLieWhereTheirLogarithmsDo)
{
    PlotLayout const l(
        sheet_of({{"a", {{"s", {{1, 10}, {32, 1000}}}}}, {"b", {{"s", {{4, 100}}}}}}, 2));
    // Both panels have the axes of both: 32 is 5 of 5 powers of 2, 100 half of 10 to 1000.
    for (std::size_t panel : {0u, 1u}) {
        double const length = l.x(panel, 32) - l.x(panel, 1);
        EXPECT_NEAR(l.x(panel, 4) - l.x(panel, 1), length * 2 / 5, 1e-9);
        EXPECT_NEAR(l.y(panel, 100), (l.y(panel, 10) + l.y(panel, 1000)) / 2, 1e-9);
        EXPECT_LT(l.y(panel, 1000), l.y(panel, 10)) << "upwards";
        EXPECT_GT(l.x(panel, 1), l.left(panel));
        EXPECT_LT(l.x(panel, 32), l.left(panel) + 290);
    }
    EXPECT_EQ(l.y(0, 10), l.y(1, 10)) << "side by side";
    EXPECT_GE(l.left(1), l.left(0) + 290);
    EXPECT_EQ(l.names(), (std::vector<std::string>{"s"})) << "once in the legend";
}

TEST(Plot, DrawsAMarkerAtEachPointAndALineBetweenThem)
{
    Drawn const d(sheet_of({{"a", {{"s", {{1, 10}, {16, 1000}}}}}}));
    EXPECT_TRUE(is_blue(d.at(0, 1, 10)));
    EXPECT_TRUE(is_blue(d.at(0, 16, 1000)));
    // A line of 2.6 pixels covers half of a pixel that it passes through, at least.
    EXPECT_LE(d.at(0, 4, 100)[0], 0.5f) << "the middle of the line";
    EXPECT_TRUE(is_paper(d.at(0, 2, 300)));
    // A marker is wider than the line.
    double const x = d.layout().x(0, 16), y = d.layout().y(0, 1000);
    EXPECT_TRUE(is_blue(d.pixel(x, y + 3)));
    EXPECT_TRUE(is_paper(d.pixel(x, y + 8)));
}

TEST(Plot, SeriesDifferInColourAndKeepItOnAllPanels)
{
    Drawn const d(sheet_of(
        {{"a", {{"one", {{1, 10}}}, {"two", {{2, 10}}}}}, {"b", {{"two", {{2, 100}}}}}}, 2));
    EXPECT_TRUE(is_blue(d.at(0, 1, 10)));
    EXPECT_FALSE(is_blue(d.at(0, 2, 10)));
    EXPECT_FALSE(is_paper(d.at(0, 2, 10)));
    EXPECT_EQ(d.at(0, 2, 10), d.at(1, 2, 100));
}

// The second panel's only curve is the second of the sheet: its sample lies where the first's would.
TEST(Plot, ALegendInsideAPanelHasItsOwnCurves)
{
    PlotSheet sheet =
        sheet_of({{"a", {{"one", {{1, 10}, {8, 90}}}}}, {"b", {{"two", {{1, 10}, {8, 90}}}}}}, 2);
    int const below = PlotLayout(sheet).height();
    sheet.legend = PlotSheet::Legend::Inside;
    Drawn const d(sheet);
    EXPECT_LT(d.layout().height(), below) << "no line for it";
    auto const sample = [&](std::size_t panel) {
        return d.pixel(d.layout().left(panel) + 18,
                       d.layout().top(panel) + sheet.panel_height - 22);
    };
    EXPECT_TRUE(is_blue(sample(0)));
    EXPECT_FALSE(is_paper(sample(1)));
    EXPECT_FALSE(is_blue(sample(1)));
}

TEST(Plot, ASinglePointIsDrawnAndNoneIsRefused)
{
    EXPECT_TRUE(is_blue(Drawn(sheet_of({{"a", {{"s", {{4, 100}}}}}})).at(0, 4, 100)));
    EXPECT_NO_THROW(PlotLayout(sheet_of({{"a", {{"s", {{4, 100}}}, {"t", {}}}}}))) << "one of two";
    EXPECT_THROW(PlotLayout(sheet_of({})), Error);
    EXPECT_THROW(PlotLayout(sheet_of({{"a", {{"s", {}}}}})), Error);
    EXPECT_THROW(PlotLayout(sheet_of({{"a", {{"s", {{4, 100}}}}}}, 0)), Error);
}

TEST(Plot, RefusesPointsThatALogarithmicAxisCannotShow)
{
    for (double v : {0.0, -1.0, kInfinite, std::nan("")}) {
        EXPECT_THROW(PlotLayout(sheet_of({{"a", {{"s", {{1, v}}}}}})), Error) << v;
        EXPECT_THROW(PlotLayout(sheet_of({{"a", {{"s", {{v, 1}}}}}})), Error) << v;
    }
}

// Stages at 0.5 and 30 operations a byte; the roof's ridge at 10 where both parts are known.
TEST(Roofline, StagesLieUnderARoofOfSlopeAndPeak)
{
    std::vector<Roofline::Point> const stages{{"a", 0.5, 4e9}, {"b", 30, 9e10}};
    Drawn const both(plot_of({"t", 1e11, 1e10, stages}));
    for (Roofline::Point const& p : stages)
        EXPECT_TRUE(is_blue(both.at(0, p.operations_per_byte, p.operations_per_second)));
    auto const is_roof = [](Drawn const& d, double x, double y) { // red, within a pixel
        double const px = d.layout().x(0, x), py = d.layout().y(0, y);
        for (int dy : {-1, 0, 1}) {
            auto const c = d.pixel(px, py + dy);
            if (c[0] > 0.75f && c[1] < 0.65f && c[2] < 0.65f) return true;
        }
        return false;
    };
    EXPECT_TRUE(is_roof(both, 3, 3e10));
    EXPECT_TRUE(is_roof(both, 50, 1e11));
    EXPECT_FALSE(is_roof(both, 50, 5e10));
    Drawn const sloped(plot_of({"t", kInfinite, 1e10, stages}));
    EXPECT_TRUE(is_roof(sloped, 3, 3e10));
    EXPECT_FALSE(is_roof(sloped, 20, 1e11));
    Drawn const flat(plot_of({"t", 1e11, kInfinite, stages}));
    EXPECT_TRUE(is_roof(flat, 3, 1e11));
    EXPECT_NO_THROW(Drawn(plot_of({"t", kInfinite, kInfinite, stages}))) << "no roof";
    EXPECT_THROW(plot_of({"t", 1e11, 1e10, {}}), Error);
}

} // namespace
} // namespace tessemu
