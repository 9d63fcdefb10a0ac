// SPDX-License-Identifier: Apache-2.0
#include "io/image_reader.h"

#include "emu/error.h"

#include <fmt/format.h> // before OpenImageIO, which brings its own, header-only

#include <OpenImageIO/imageio.h>

#include <cmath>

namespace tessemu {

HeightImage read_height_image(std::filesystem::path const& path)
{
    std::string const name = path.string();
    if (!std::filesystem::exists(path)) throw FormatError(name, 0, "no such file");
    OIIO::ImageSpec raw; // what asks for numbers as they are
    raw["oiio:UnassociatedAlpha"] = 1;
    raw["oiio:RawColor"] = 1;
    auto const file = OIIO::ImageInput::open(name, &raw);
    if (!file) {
        std::string why = OIIO::geterror();
        throw FormatError(name, 0, "is no picture: " + why.substr(0, why.find('\n')));
    }
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
    if (!file->read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT, out.heights.data()))
        throw FormatError(name, 0, "cannot be read: " + file->geterror());
    for (std::size_t i = 0; i < out.heights.size(); ++i)
        if (!std::isfinite(out.heights[i]))
            throw FormatError(name, 0,
                              fmt::format("texel {}, {} is {}, heights must be finite",
                                          i % std::size_t(spec.width), i / std::size_t(spec.width),
                                          out.heights[i]));
    return out;
}

} // namespace tessemu
