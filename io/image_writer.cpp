// SPDX-License-Identifier: Apache-2.0
#include "io/image_writer.h"

#include "io/picture_library.h"

namespace tessemu {

PictureFormat picture_format(OutputFile const& out)
{
    std::string const extension = extension_of(out.path());
    bool const is_exr = extension == "exr";
    if (!is_exr && extension != "png" && !(extension.empty() && out.is_stream()))
        throw WriteError(out.path().string() + ": extension is '" +
                         out.path().extension().string() + "', images are .png or .exr");
    picture_library();
    return is_exr ? PictureFormat::Exr : PictureFormat::Png;
}

void write_image(PixelRows const& rows, OutputFile& out)
{
    std::vector<unsigned char> file;
    PictureLibrary const& library = picture_library();
    std::string const failed = picture_format(out) == PictureFormat::Png
                                   ? library.encode_png(rows.width, rows.height, rows.bytes, file)
                                   : library.encode_exr(rows.width, rows.height, rows.floats, file);
    if (!failed.empty()) throw WriteError(out.path().string() + ": " + failed);
    out.write({reinterpret_cast<char const*>(file.data()), file.size()});
}

void write_image(ColorTarget const& target, OutputFile& out)
{
    auto const for_each = [&](int y, auto const& put) {
        for (int x = 0; x < target.width(); ++x)
            for (float c : target.load(x, y)) put(c);
    };
    write_image({target.width(), target.height(),
                 [&](int y, std::uint8_t* row) {
                     for_each(y, [&](float c) { *row++ = std::uint8_t(unorm_from_float(c, 8)); });
                 },
                 [&](int y, float* row) { for_each(y, [&](float c) { *row++ = c; }); }},
                out);
}

} // namespace tessemu
