// Channels of height maps are data: what the file says is what the reader gives.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/image_reader.h"

#include "emu/error.h"
#include "tests/io/raw_image.h"

#include <cmath>
#include <fstream>

#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

class HeightImages : public testing::Test {
protected:
    HeightImages() { fs::create_directories(here); }
    ~HeightImages() override { fs::remove_all(here); }

    std::string refusal(fs::path const& path) const
    {
        try {
            read_height_image(path);
        } catch (FormatError const& e) {
            return e.what();
        }
        return "";
    }

    fs::path const here =
        fs::temp_directory_path() / ("tessemu_image_reader_" + std::to_string(getpid()));
};

template <class Number> std::vector<float> shares_of(std::vector<Number> const& numbers)
{
    std::vector<float> out;
    for (Number n : numbers)
        out.push_back(float(double(n) / double(std::numeric_limits<Number>::max())));
    return out;
}

void expect_heights(HeightImage const& image, std::vector<float> const& expected,
                    std::string const& name)
{
    ASSERT_EQ(image.heights.size(), expected.size()) << name;
    // One rounding here, two there.
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_NEAR(image.heights[i], expected[i], 1.5 * 0x1p-24) << name << ", texel " << i;
}

TEST_F(HeightImages, KeepsChannelsBesideAnySmallAlpha)
{
    std::vector<std::uint16_t> const heights{1000, 2001, 40003, 65535};
    std::vector<std::uint8_t> const bytes{3, 20, 100, 255};
    std::vector<std::uint16_t> gray, colour;
    std::vector<std::uint8_t> gray8;
    std::uint16_t const alpha[] = {300, 10, 0, 65535};
    for (std::size_t i = 0; i < 4; ++i) {
        gray.insert(gray.end(), {heights[i], alpha[i]});
        colour.insert(colour.end(), {heights[i], 7, 60000, alpha[i]});
        gray8.insert(gray8.end(), {bytes[i], std::uint8_t(alpha[i])});
    }
    for (std::string name : {"a.png", "a.tif"}) {
        test::write_raw_image(here / name, 2, 2, {"Y", "A"}, gray);
        expect_heights(read_height_image(here / name), shares_of(heights), "gray " + name);
        test::write_raw_image(here / name, 2, 2, {"R", "G", "B", "A"}, colour);
        expect_heights(read_height_image(here / name), shares_of(heights), "colour " + name);
        test::write_raw_image(here / name, 2, 2, {"Y", "A"}, gray8);
        expect_heights(read_height_image(here / name), shares_of(bytes), "8 bits " + name);
    }
    std::vector<std::uint8_t> bgra;
    for (std::size_t i = 0; i < 4; ++i)
        bgra.insert(bgra.end(), {bytes[i], 1, 2, std::uint8_t(alpha[i])});
    test::write_raw_image(here / "a.tga", 2, 2, {"R", "G", "B", "A"}, bgra);
    expect_heights(read_height_image(here / "a.tga"), shares_of(bytes), "a.tga");
}

TEST_F(HeightImages, KeepsThirtyTwoBitsAndFloatsOfAnySize)
{
    std::vector<std::uint32_t> const whole{1, 1u << 20, 3000000000u, 0xffffffffu};
    test::write_raw_image(here / "u.tif", 2, 2, {"Y"}, whole);
    expect_heights(read_height_image(here / "u.tif"), shares_of(whole), "32 bits");
    std::vector<float> const floats{-812.5f, 0x1p-100f, 8848.86f, 3e38f};
    for (char const* name : {"f.exr", "f.tif"}) {
        test::write_raw_image(here / name, 2, 2, {"Y"}, floats);
        EXPECT_EQ(read_height_image(here / name).heights, floats) << name;
    }
    test::write_raw_image(here / "h.exr", 2, 2, {"Y"}, std::vector<float>{-0.5f, 1.5f, 1024, 0},
                          OIIO::TypeDesc::HALF);
    EXPECT_EQ(read_height_image(here / "h.exr").heights,
              (std::vector<float>{-0.5f, 1.5f, 1024, 0}));
}

// An .exr has its channels by the alphabet.
TEST_F(HeightImages, PassesOverAlphaWhereItComesFirst)
{
    test::write_raw_image(here / "a.exr", 2, 1, {"A", "height"},
                          std::vector<float>{0.25f, 7, 0.5f, -8});
    EXPECT_EQ(read_height_image(here / "a.exr").heights, (std::vector<float>{7, -8}));
}

TEST_F(HeightImages, NamesTheTexelThatIsNoHeight)
{
    test::write_raw_image(here / "nan.exr", 3, 2, {"Y"},
                          std::vector<float>{0, 1, 2, 3, 4, std::nanf("")});
    EXPECT_NE(refusal(here / "nan.exr").find("texel 2, 1 is "), std::string::npos)
        << refusal(here / "nan.exr");
}

// The TIFF reader tells of a strip that it cannot decode, and goes on with what memory holds.
TEST_F(HeightImages, RefusesWhatAReaderCouldNotDecode)
{
    std::vector<float> heights; // that compress
    for (int i = 0; i < 64 * 64; ++i) heights.push_back(float(i % 61 * (i % 7)));
    fs::path const path = here / "damaged.tif";
    test::write_raw_image<float>(path, 64, 64, {"Y"}, heights);
    EXPECT_EQ(refusal(path), "");
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(std::streamoff(fs::file_size(path) / 8));
    file << std::string(fs::file_size(path) / 8, '\xff');
    file.close();
    EXPECT_NE(refusal(path).find("damaged.tif: cannot be read: "), std::string::npos)
        << refusal(path);
    EXPECT_NE(refusal(here).find("is no regular file"), std::string::npos);
}

TEST_F(HeightImages, NamesTheLimitOfItsSize)
{
    test::write_raw_image(here / "wide.png", 16385, 1, {"Y"}, std::vector<std::uint8_t>(16385));
    EXPECT_NE(refusal(here / "wide.png").find("16385 x 1 texels, the limit is 16384"),
              std::string::npos)
        << refusal(here / "wide.png");
}

// Its reader has multiplied before anybody asks.
TEST_F(HeightImages, RefusesAlphaThatCannotBeUndone)
{
    auto const writer = OIIO::ImageOutput::create("a.webp");
    if (!writer) GTEST_SKIP() << "this OpenImageIO writes no WebP";
    std::vector<std::uint8_t> numbers;
    for (int i = 0; i < 64; ++i) numbers.insert(numbers.end(), {200, 200, 200, 9});
    test::write_raw_image(here / "a.webp", 8, 8, {"R", "G", "B", "A"}, numbers);
    EXPECT_NE(refusal(here / "a.webp").find("WebP"), std::string::npos);
}

} // namespace
} // namespace tessemu
