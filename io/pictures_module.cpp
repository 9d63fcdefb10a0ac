// The module of pictures: OpenImageIO behind PictureLibrary.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/picture_library.h"

#include <fmt/format.h> // before OpenImageIO, which brings its own, header-only

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <string_view>

namespace tessemu {

namespace {

namespace Algo = OIIO::ImageBufAlgo;

// In memory: a stream cannot be sought in, as EXR needs, and what OpenImageIO itself writes to a
// full disk it takes for written.
template <class T>
std::string encode(char const* name, OIIO::TypeDesc type, int width, int height,
                   PictureLibrary::Rows<T> const& rows, std::vector<unsigned char>& out)
{
    out.clear();
    OIIO::Filesystem::IOVecOutput memory(out);
    auto const file = OIIO::ImageOutput::create(name);
    OIIO::ImageSpec spec(width, height, 4, type);
    if (type == OIIO::TypeDesc::FLOAT) // else EXR gets the hour
        spec.attribute("DateTime", "1970:01:01 00:00:00");
    if (!file || !file->set_ioproxy(&memory) || !file->open(name, spec))
        return file ? file->geterror() : OIIO::geterror();
    bool good = true;
    std::vector<T> row(std::size_t(width) * 4);
    for (int y = 0; y < height && good; ++y) {
        rows(y, row.data());
        good = file->write_scanline(y, 0, type, row.data());
    }
    good = file->close() && good;
    return good ? std::string() : file->geterror();
}

// The first line of what a reader says, or what it most likely means by saying nothing.
std::string reason(std::string const& said)
{
    return said.empty() ? "the file is cut off or damaged" : said.substr(0, said.find('\n'));
}

class OpenImageIO final : public PictureLibrary {
public:
    std::string encode_png(int width, int height, Rows<std::uint8_t> const& rows,
                           std::vector<unsigned char>& file) const override
    {
        return encode("a.png", OIIO::TypeDesc::UINT8, width, height, rows, file);
    }
    std::string encode_exr(int width, int height, Rows<float> const& rows,
                           std::vector<unsigned char>& file) const override
    {
        return encode("a.exr", OIIO::TypeDesc::FLOAT, width, height, rows, file);
    }

    std::string read_channel(std::string const& path, int most, Channel& out) const override
    {
        OIIO::ImageSpec raw; // what asks for numbers as they are
        raw["oiio:UnassociatedAlpha"] = 1;
        raw["oiio:RawColor"] = 1;
        auto const file = OIIO::ImageInput::open(path, &raw);
        if (!file) return "is no picture: " + reason(OIIO::geterror());
        OIIO::ImageSpec const& spec = file->spec();
        if (std::max(spec.width, spec.height) > most)
            return fmt::format("is {} x {} texels, the limit is {} either way", spec.width,
                               spec.height, most);
        if (spec.depth > 1)
            return fmt::format("is {} texels deep, a height map is flat", spec.depth);
        bool const has_alpha = spec.alpha_channel >= 0 && spec.alpha_channel < spec.nchannels;
        if (has_alpha && file->format_name() == std::string_view("webp"))
            return "is a WebP with alpha, which multiplies its heights; PNG and TIFF keep them";
        int const channel = spec.alpha_channel == 0 && spec.nchannels > 1 ? 1 : 0;
        out.width = spec.width;
        out.height = spec.height;
        out.values.resize(std::size_t(spec.width) * std::size_t(spec.height));
        bool const is_read =
            file->read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::FLOAT, out.values.data());
        // Some readers report what they could not decode and go on.
        if (!is_read || file->has_error()) return "cannot be read: " + reason(file->geterror());
        return {};
    }

    std::string draw_text(float* pixels, int width, int height, int x, int y, Text const& text,
                          float const (&ink)[4], Align align) const override
    {
        OIIO::ImageBuf image(OIIO::ImageSpec(width, height, 4, OIIO::TypeDesc::FLOAT), pixels);
        Algo::TextAlignX const at = align == Align::Left     ? Algo::TextAlignX::Left
                                    : align == Align::Center ? Algo::TextAlignX::Center
                                                             : Algo::TextAlignX::Right;
        return Algo::render_text(image, x, y, text.line, text.size, text.font, ink, at,
                                 Algo::TextAlignY::Center)
                   ? std::string()
                   : image.geterror();
    }
    int text_width(Text const& text) const override
    {
        return Algo::text_size(text.line, text.size, text.font).width();
    }
};

} // namespace

extern "C" PictureLibrary const* tessemu_picture_library()
{
    static OpenImageIO const library;
    return &library;
}

} // namespace tessemu
