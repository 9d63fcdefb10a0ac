// Pictures through OpenImageIO.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "io/output_file.h"

namespace tessemu {

enum class PictureFormat { Png, Exr };

/// By the extension, .png or .exr in any case; a stream without one gets PNG. Throws WriteError
/// otherwise: for checking before long work.
PictureFormat picture_format(OutputFile const& out);

/// Writes a colour target of one sample: .png as 8-bit RGBA (float to UNORM by rule R21), .exr as
/// 32-bit float RGBA. The caller commits.
void write_image(ColorTarget const& target, OutputFile& out);

} // namespace tessemu
