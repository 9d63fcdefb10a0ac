// Pictures as hashes of what they show, whatever the file around it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/image_reader.h"
#include "io/sha256.h"

namespace tessemu::test {

/// Of a picture's size and its first channel, 16 digits.
inline std::string picture_hash(std::filesystem::path const& path)
{
    HeightImage const image = read_height_image(path);
    int const size[] = {image.width, image.height};
    Sha256 hash;
    hash.add(size, sizeof size);
    hash.add(image.heights.data(), image.heights.size() * sizeof(float));
    return hash.hex().substr(0, 16);
}

} // namespace tessemu::test
