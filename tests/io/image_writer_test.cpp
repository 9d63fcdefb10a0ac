// SPDX-License-Identifier: Apache-2.0
#include "io/image_writer.h"

#include "io/image_reader.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

fs::path scratch()
{
    fs::path const p =
        fs::temp_directory_path() / ("tessemu_image_test_" + std::to_string(getpid()));
    fs::remove_all(p);
    fs::create_directories(p);
    return p;
}

void write(ColorTarget const& target, fs::path const& path)
{
    OutputFile out(path);
    write_image(target, out);
    out.commit();
}

TEST(ImageWriter, WritesPngAndExrAndLeavesNothingElse)
{
    fs::path const folder = scratch();
    ColorTarget target(5, 3, Format::R32G32B32A32_FLOAT);
    target.clear({0.25f, 0.5f, 1.0f, 1.0f}, ThreadPool(1));
    write(target, folder / "a.png");
    write(target, folder / "a.exr");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2);
    for (auto const& [name, red] : {std::pair("a.png", 64.0f / 255), {"a.exr", 0.25f}}) {
        HeightImage const image = read_height_image(folder / name);
        EXPECT_EQ(image.width, 5) << name;
        EXPECT_EQ(image.height, 3) << name;
        EXPECT_EQ(image.heights, std::vector<float>(15, red)) << name;
    }
    EXPECT_EQ(test::read_text(folder / "a.png").substr(1, 3), "PNG");
}

// The same bytes at any time: no date is in them.
TEST(ImageWriter, WritesTheSameBytesASecondLater)
{
    fs::path const folder = scratch();
    ColorTarget target(5, 3);
    target.clear({}, ThreadPool(1));
    for (char const* name : {"a.png", "a.exr"}) write(target, folder / name);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    for (char const* name : {"b.png", "b.exr"}) write(target, folder / name);
    EXPECT_TRUE(test::read_text(folder / "a.png") == test::read_text(folder / "b.png"));
    EXPECT_TRUE(test::read_text(folder / "a.exr") == test::read_text(folder / "b.exr"));
}

TEST(ImageWriter, RefusesOtherExtensionsAndMissingFolders)
{
    ColorTarget target(4, 4);
    target.clear({}, ThreadPool(1));
    EXPECT_THROW(write(target, scratch() / "a.bmp"), WriteError);
    EXPECT_THROW(write(target, scratch() / "missing" / "a.png"), WriteError);
}

TEST(ColorTarget, NamesItsLimit)
{
    try {
        ColorTarget const target(16385, 4);
        FAIL();
    } catch (LimitError const& e) {
        EXPECT_EQ(e.value, 16385u);
        EXPECT_EQ(e.limit, 16384u);
    }
    EXPECT_THROW(ColorTarget(0, 4), Error);
}

TEST(ImageReader, ReadsHeightsRowsFromTheTop)
{
    fs::path const folder = scratch();
    ColorTarget target(5, 3, Format::R32G32B32A32_FLOAT);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x)
            encode(target.format(), {float(x + 5 * y) / 15, 1, 1, 1}, target.texel(x, y));
    write(target, folder / "a.exr");
    write(target, folder / "a.png");
    HeightImage const exact = read_height_image(folder / "a.exr");
    HeightImage const rounded = read_height_image(folder / "a.png");
    for (HeightImage const* image : {&exact, &rounded}) {
        ASSERT_EQ(image->width, 5);
        ASSERT_EQ(image->height, 3);
    }
    for (std::size_t i = 0; i < 15; ++i) {
        EXPECT_EQ(exact.heights[i], float(i) / 15);
        EXPECT_NEAR(rounded.heights[i], float(i) / 15, 0.5 / 255 + 1e-7);
    }
}

TEST(ImageReader, RefusesWhatIsNoHeightMap)
{
    fs::path const folder = scratch();
    EXPECT_THROW(read_height_image(folder / "missing.png"), FormatError);
    write_file(folder / "text.png", "no picture");
    EXPECT_THROW(read_height_image(folder / "text.png"), FormatError);
    ColorTarget target(2, 2, Format::R32G32B32A32_FLOAT);
    target.clear({INFINITY, 0, 0, 0}, ThreadPool(1));
    write(target, folder / "infinite.exr");
    EXPECT_THROW(read_height_image(folder / "infinite.exr"), FormatError);
}

} // namespace
} // namespace tessemu
