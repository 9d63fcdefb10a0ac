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
    auto const file = OIIO::ImageInput::open(name);
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
    out.heights.resize(std::size_t(spec.width) * std::size_t(spec.height));
    if (!file->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, out.heights.data()))
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
