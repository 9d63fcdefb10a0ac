// Pictures through OpenImageIO.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"

#include <filesystem>

namespace tessemu {

/// Writes a colour target of one sample: .png as 8-bit RGBA (float to UNORM by rule R21), .exr as
/// 32-bit float RGBA. Atomic. Throws WriteError for another extension or when writing fails.
void write_image(ColorTarget const& target, std::filesystem::path const& path);

/// Throws WriteError unless write_image knows the extension; for checking before long work.
void check_image_path(std::filesystem::path const& path);

} // namespace tessemu
