// SPDX-License-Identifier: Apache-2.0
#include "io/image_writer.h"

#include "io/atomic_file.h"

#include <fmt/format.h> // before OpenImageIO, which brings its own, header-only

#include <OpenImageIO/imageio.h>

namespace tessemu {

void check_image_path(std::filesystem::path const& path)
{
    auto const extension = path.extension();
    if (extension != ".png" && extension != ".exr")
        throw WriteError(path.string() + ": extension is '" + extension.string() +
                         "', images are .png or .exr");
}

void write_image(ColorTarget const& target, std::filesystem::path const& path)
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
        std::vector<std::uint8_t> bytes(width * 4);
        std::vector<float> floats(width * 4);
        for (int y = 0; y < target.height() && good; ++y) {
            for (std::size_t x = 0; x < width; ++x) {
                auto const c = target.load(int(x), y);
                for (std::size_t k = 0; k < 4; ++k) {
                    floats[4 * x + k] = c[k];
                    bytes[4 * x + k] = std::uint8_t(unorm_from_float(c[k], 8));
                }
            }
            good = png ? file->write_scanline(y, 0, OIIO::TypeDesc::UINT8, bytes.data())
                       : file->write_scanline(y, 0, OIIO::TypeDesc::FLOAT, floats.data());
        }
        good = file->close() && good;
        if (!good) throw WriteError(path.string() + ": " + file->geterror());
    });
}

} // namespace tessemu
