// Figures: layout, scales, and files that are whole or not there.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/figure.h"

#include "io/image_reader.h"
#include "shaders_cpp/pixel/colored_view.h"

#include <gtest/gtest.h>

#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

fs::path scratch()
{
    fs::path const p =
        fs::temp_directory_path() / ("tessemu_figure_test_" + std::to_string(getpid()));
    fs::create_directories(p);
    return p;
}

void write(Figure const& figure, fs::path const& path)
{
    OutputFile out(path);
    write_figure(figure, out);
    out.commit();
}

TEST(HeatColor, RunsFromBlueToRed)
{
    auto const is = [](float t, float r, float g, float b) {
        float3<float> const c = heat_color(t);
        EXPECT_FLOAT_EQ(c.x, r) << t;
        EXPECT_FLOAT_EQ(c.y, g) << t;
        EXPECT_FLOAT_EQ(c.z, b) << t;
    };
    is(-1, 0, 0, 1);
    is(0, 0, 0, 1);
    is(0.25f, 0, 1, 1);
    is(0.5f, 0, 1, 0);
    is(0.75f, 1, 1, 0);
    is(1, 1, 0, 0);
    is(7, 1, 0, 0);
}

TEST(Figure, HoldsItsPanelsAndScales)
{
    ColorTarget red(40, 30), dark(40, 30), other(20, 30);
    red.clear({1, 0, 0, 1}, ThreadPool(1));
    dark.clear({0, 0, 0, 1}, ThreadPool(1));
    fs::path const path = scratch() / "figure.exr";
    write(Figure{2, {{&red, "a"}, {&dark, "b"}, {&dark, "c"}}, {{"x", 1}, {"y", 2}}}, path);
    HeightImage const image = read_height_image(path); // the red channel
    EXPECT_EQ(image.width, 12 + 2 * (40 + 12));
    EXPECT_EQ(image.height, 12 + 2 * (30 + 28 + 12) + 46);
    auto const at = [&](int x, int y) {
        return image.heights[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
    };
    EXPECT_EQ(at(12, 12), 1);           // red
    EXPECT_EQ(at(12 + 52, 12), 0);      // dark
    EXPECT_EQ(at(12, 12 + 70), 0);      // second row
    EXPECT_EQ(at(12 + 52, 12 + 70), 1); // no fourth panel: paper
    int const bar = image.height - 46;
    EXPECT_EQ(at(12, bar), 0);      // blue
    EXPECT_EQ(at(12 + 39, bar), 1); // red
    EXPECT_THROW(write(Figure{2, {{&red, "a"}, {&other, "b"}}, {}}, path), WriteError);
    EXPECT_THROW(write(Figure{1, {}, {}}, path), WriteError);
    EXPECT_THROW(write(Figure{1, {{&red, "a"}}, {}}, scratch() / "a.bmp"), WriteError);
    fs::remove_all(scratch());
}

} // namespace
} // namespace tessemu
