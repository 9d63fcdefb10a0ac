// SPDX-License-Identifier: Apache-2.0
#include "io/image_reader.h"

#include "emu/error.h"
#include "io/picture_library.h"

#include <fmt/format.h>

#include <cmath>

namespace tessemu {

HeightImage read_height_image(std::filesystem::path const& path)
{
    std::string const name = path.string();
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw FormatError(name, 0, error ? error.message() : "no such file");
    if (!std::filesystem::is_regular_file(path))
        throw FormatError(name, 0, "is no regular file, which an image must be");
    PictureLibrary::Channel channel;
    std::string const failed = picture_library().read_channel(name, kMaxHeightMapSize, channel);
    if (!failed.empty()) throw FormatError(name, 0, failed);
    HeightImage out{std::move(channel.values), channel.width, channel.height};
    for (std::size_t i = 0; i < out.heights.size(); ++i)
        if (!std::isfinite(out.heights[i]))
            throw FormatError(name, 0,
                              fmt::format("texel {}, {} is {}, heights must be finite",
                                          i % std::size_t(out.width), i / std::size_t(out.width),
                                          out.heights[i]));
    return out;
}

} // namespace tessemu
