// SPDX-License-Identifier: Apache-2.0
#include "io/image_writer.h"

#include "io/atomic_file.h"

#include <OpenImageIO/imageio.h>

namespace tessemu {

namespace {
// R21: NaN gives 0; clamp; truncate c * 255 + 0.5.
std::uint8_t to_unorm8(float c)
{
    if (!(c > 0)) return 0;
    if (c >= 1) return 255;
    return std::uint8_t(c * 255.0f + 0.5f);
}
} // namespace

void check_image_path(std::filesystem::path const& path)
{
    auto const extension = path.extension();
    if (extension != ".png" && extension != ".exr")
        throw WriteError(path.string() + ": extension is '" + extension.string() +
                         "', images are .png or .exr");
}

void write_image(RenderTarget const& target, std::filesystem::path const& path)
{
    check_image_path(path);
    bool const png = path.extension() == ".png";
    auto const width = std::size_t(target.width());
    write_atomically(path, [&](std::filesystem::path const& temporary) {
        auto const file = OIIO::ImageOutput::create(temporary.string());
        OIIO::ImageSpec spec(target.width(), target.height(), 4,
                             png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
        if (!file || !file->open(temporary.string(), spec))
            throw WriteError(path.string() + ": " + (file ? file->geterror() : OIIO::geterror()));
        bool good = true;
        std::vector<std::uint8_t> row(width * 4);
        for (int y = 0; y < target.height() && good; ++y) {
            std::array<float, 4> const* const pixels = target.color_row(y);
            if (png) {
                for (std::size_t i = 0; i < row.size(); ++i)
                    row[i] = to_unorm8(pixels[i / 4][i % 4]);
                good = file->write_scanline(y, 0, OIIO::TypeDesc::UINT8, row.data());
            } else {
                good = file->write_scanline(y, 0, OIIO::TypeDesc::FLOAT, pixels);
            }
        }
        good = file->close() && good;
        if (!good) throw WriteError(path.string() + ": " + file->geterror());
    });
}

} // namespace tessemu
