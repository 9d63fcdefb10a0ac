// SPDX-License-Identifier: Apache-2.0
#include "io/image_writer.h"

#include "io/encoded_picture.h"

namespace tessemu {

PictureFormat picture_format(OutputFile const& out)
{
    std::string const extension = extension_of(out.path());
    if (extension == "png" || (extension.empty() && out.is_stream())) return PictureFormat::Png;
    if (extension == "exr") return PictureFormat::Exr;
    throw WriteError(out.path().string() + ": extension is '" + out.path().extension().string() +
                     "', images are .png or .exr");
}

void write_image(ColorTarget const& target, OutputFile& out)
{
    bool const png = picture_format(out) == PictureFormat::Png;
    auto const width = std::size_t(target.width());
    write_encoded(out, target.width(), target.height(), [&](OIIO::ImageOutput& file) {
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
            good = png ? file.write_scanline(y, 0, OIIO::TypeDesc::UINT8, bytes.data())
                       : file.write_scanline(y, 0, OIIO::TypeDesc::FLOAT, floats.data());
        }
        return good;
    });
}

} // namespace tessemu
