// A picture's file in memory. A stream cannot be sought in, as EXR needs, and what OpenImageIO
// itself writes to a full disk it takes for written.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/image_writer.h"

#include <fmt/format.h> // before OpenImageIO, which brings its own, header-only

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace tessemu {

/// 4 channels, 8 bits or float by the format of `out`.
/// \param write_pixels  (ImageOutput&) gives false where that fails
template <class WritePixels>
void write_encoded(OutputFile& out, int width, int height, WritePixels const& write_pixels)
{
    bool const png = picture_format(out) == PictureFormat::Png;
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    auto const file = OIIO::ImageOutput::create(png ? "a.png" : "a.exr");
    OIIO::ImageSpec spec(width, height, 4, png ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
    if (!png) spec.attribute("DateTime", "1970:01:01 00:00:00"); // else EXR gets the hour
    if (!file || !file->set_ioproxy(&memory) || !file->open(png ? "a.png" : "a.exr", spec))
        throw WriteError(out.path().string() + ": " + (file ? file->geterror() : OIIO::geterror()));
    bool good = write_pixels(*file);
    good = file->close() && good;
    if (!good) throw WriteError(out.path().string() + ": " + file->geterror());
    out.write({reinterpret_cast<char const*>(bytes.data()), bytes.size()});
}

} // namespace tessemu
