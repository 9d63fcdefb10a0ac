// Height maps through OpenImageIO.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/displacement.h"

#include <filesystem>

namespace tessemu {

inline constexpr int kMaxHeightMapSize = 16384; // D3D11's limit of a texture

/// The first channel that is not alpha, of the first picture in any file that OpenImageIO reads, as
/// the file has it: neither multiplied by alpha nor turned from one colour space into another. Whole
/// numbers without sign become [0, 1], those with one [-1, 1]; floats stay. Throws FormatError for a
/// file that is missing or no picture, that is too large, that has a depth, whose numbers are lost
/// on the way (WebP with alpha), or that holds a height that is not finite in single precision.
HeightImage read_height_image(std::filesystem::path const& path);

} // namespace tessemu
