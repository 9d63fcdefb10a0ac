// Height maps through OpenImageIO.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/displacement.h"

#include <filesystem>

namespace tessemu {

inline constexpr int kMaxHeightMapSize = 16384; // D3D11's limit of a texture

/// The first channel of any picture that OpenImageIO reads; whole numbers become [0, 1]. Throws
/// FormatError for a file that is missing or no picture, that is too large, or that holds a height
/// that is not finite.
HeightImage read_height_image(std::filesystem::path const& path);

} // namespace tessemu
