// SPDX-License-Identifier: Apache-2.0
#include "io/image_reader.h"

#include "emu/error.h"

#include <fmt/format.h> // before OpenImageIO, which brings its own, header-only

#include <OpenImageIO/imageio.h>

#include <cmath>

namespace tessemu {

namespace {

// The first line of what a reader says, or what it most likely means by saying nothing.
std::string reason(std::string const& said)
{
    return said.empty() ? "the file is cut off or damaged" : said.substr(0, said.find('\n'));
}

} // namespace

HeightImage read_height_image(std::filesystem::path const& path)
{
    std::string const name = path.string();
    std::error_code error;
    if (!std::filesystem::exists(path, error))
        throw FormatError(name, 0, error ? error.message() : "no such file");
    if (!std::filesystem::is_regular_file(path))
        throw FormatError(name, 0, "is no regular file, which an image must be");
    OIIO::ImageSpec raw; // what asks for numbers as they are
    raw["oiio:UnassociatedAlpha"] = 1;
    raw["oiio:RawColor"] = 1;
    auto const file = OIIO::ImageInput::open(name, &raw);
    if (!file) throw FormatError(name, 0, "is no picture: " + reason(OIIO::geterror()));
    OIIO::ImageSpec const& spec = file->spec();
    HeightImage out;
    out.width = spec.width;
    out.height = spec.height;
    if (std::max(spec.width, spec.height) > kMaxHeightMapSize)
        throw FormatError(name, 0,
                          fmt::format("is {} x {} texels, the limit is {} either way", spec.width,
                                      spec.height, kMaxHeightMapSize));
    if (spec.depth > 1)
        throw FormatError(name, 0,
                          fmt::format("is {} texels deep, a height map is flat", spec.depth));
    bool const has_alpha = spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels;
    if (has_alpha && file->format_name() == std::string_view("webp"))
        throw FormatError(name, 0,
                          "is a WebP with alpha, which multiplies its heights; PNG and TIFF keep "
                          "them");
    int const channel = spec.alpha_channel == 0 && spec.nchannels > 1 ? 1 : 0;
    out.heights.resize(std::size_t(spec.width) * std::size_t(spec.height));
    bool const is_read =
        file->read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT, out.heights.data());
    // Some readers report what they could not decode and go on.
    if (!is_read || file->has_error())
        throw FormatError(name, 0, "cannot be read: " + reason(file->geterror()));
    for (std::size_t i = 0; i < out.heights.size(); ++i)
        if (!std::isfinite(out.heights[i]))
            throw FormatError(name, 0,
                              fmt::format("texel {}, {} is {}, heights must be finite",
                                          i % std::size_t(spec.width), i / std::size_t(spec.width),
                                          out.heights[i]));
    return out;
}

} // namespace tessemu
