// Pictures whose channels are data, written as other programs write them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tessemu::test {

/// Rows from the top, channel by channel; "A" is alpha, beside which the others stay as they are.
template <class Number>
void write_raw_image(std::filesystem::path const& path, int width, int height,
                     std::vector<std::string> const& channels, std::vector<Number> const& numbers,
                     OIIO::TypeDesc as = OIIO::BaseTypeFromC<Number>::value)
{
    ASSERT_EQ(numbers.size(), std::size_t(width * height) * channels.size());
    OIIO::ImageSpec spec(width, height, int(channels.size()), as);
    spec.channelnames = channels;
    spec.alpha_channel = -1;
    for (std::size_t c = 0; c < channels.size(); ++c)
        if (channels[c] == "A") spec.alpha_channel = int(c);
    spec["oiio:UnassociatedAlpha"] = 1;
    auto const file = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(file && file->open(path.string(), spec)) << path;
    OIIO::TypeDesc const from = OIIO::BaseTypeFromC<Number>::value;
    ASSERT_TRUE(file->write_image(from, numbers.data()) && file->close()) << file->geterror();
}

} // namespace tessemu::test
