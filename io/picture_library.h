// OpenImageIO as the rest of the library sees it: a module that is opened at the first picture, for
// its 250 shared libraries take a third of a second to load.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace tessemu {

/// What the module has. It knows nothing else of tessemu. Functions that can fail give the reason,
/// "" where they have not. Pictures are rows from the top, pixels of four channels: RGBA.
class PictureLibrary {
public:
    virtual ~PictureLibrary() = default;

    template <class T> using Rows = std::function<void(int y, T* row)>; ///< makes a row
    /// A picture's file, one for any hour.
    virtual std::string encode_png(int width, int height, Rows<std::uint8_t> const& rows,
                                   std::vector<unsigned char>& file) const = 0;
    virtual std::string encode_exr(int width, int height, Rows<float> const& rows,
                                   std::vector<unsigned char>& file) const = 0;

    struct Channel {
        int width = 0, height = 0;
        std::vector<float> values;
    };
    /// The first channel that is not alpha, of a file's first picture, as read_height_image() says.
    /// \param most  texels either way
    virtual std::string read_channel(std::string const& path, int most, Channel& out) const = 0;

    enum class Align { Left, Center, Right };
    struct Text {
        std::string line;
        int size;         ///< pixels
        char const* font; ///< by name
    };
    /// Onto a picture; the text's middle is at height y.
    virtual std::string draw_text(float* pixels, int width, int height, int x, int y,
                                  Text const& text, float const (&ink)[4], Align align) const = 0;
    virtual int text_width(Text const& text) const = 0;
};

/// Opens the module at the first call. Throws Error that names the module where it cannot.
PictureLibrary const& picture_library();

/// The module's one symbol.
extern "C" PictureLibrary const* tessemu_picture_library();

} // namespace tessemu
