// Pictures through OpenImageIO.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "io/output_file.h"

#include <functional>

namespace tessemu {

enum class PictureFormat { Png, Exr };

/// By the extension, .png or .exr in any case; a stream without one gets PNG. Throws WriteError
/// otherwise, and Error where the module of pictures is missing: for checking before long work.
PictureFormat picture_format(OutputFile const& out);

/// Writes a colour target of one sample: .png as 8-bit RGBA (float to UNORM by rule R21), .exr as
/// 32-bit float RGBA. The caller commits.
void write_image(ColorTarget const& target, OutputFile& out);

/// RGBA pixels that are made row after row, from the top.
struct PixelRows {
    int width, height;
    std::function<void(int y, std::uint8_t* row)> bytes; ///< of a .png
    std::function<void(int y, float* row)> floats;       ///< of an .exr
};
void write_image(PixelRows const& rows, OutputFile& out);

} // namespace tessemu
