// SPDX-License-Identifier: Apache-2.0
#include "io/canvas.h"

namespace tessemu {

namespace {

constexpr char kFont[] = "DejaVuSans";

} // namespace

Canvas::Canvas(int width, int height) : width_(width), height_(height)
{
    for (std::size_t i = 0; i < std::size_t(width) * std::size_t(height); ++i)
        pixels_.insert(pixels_.end(), std::begin(kPaper), std::end(kPaper));
}

void Canvas::text(int x, int y, std::string const& line, Align align, int size)
{
    std::string const failed = picture_library().draw_text(pixels_.data(), width_, height_, x, y,
                                                           {line, size, kFont}, kInk, align);
    if (!failed.empty())
        throw WriteError("captions need the font DejaVu Sans (fonts-dejavu-core): " + failed);
}

int Canvas::text_width(std::string const& line, int size)
{
    return picture_library().text_width({line, size, kFont});
}

void Canvas::upright_text(int x, int y, std::string const& line, int size, int strip)
{
    int const length = text_width(line, size) + 8;
    Canvas flat(length, strip);
    flat.text(length / 2, strip / 2, line, Align::Center, size);
    for (int i = 0; i < strip; ++i)
        for (int j = 0; j < length; ++j)
            set(x - strip / 2 + i, y - length / 2 + j, flat.pixel(length - 1 - j, i));
}

void Canvas::write(OutputFile& out) const
{
    auto const n = 4 * std::size_t(width_);
    write_image({width_, height_,
                 [&](int y, std::uint8_t* row) {
                     std::transform(pixel(0, y), pixel(0, y) + n, row, [](float c) {
                         return std::uint8_t(std::clamp(c * 255.0f, 0.0f, 255.0f) + 0.5f);
                     });
                 },
                 [&](int y, float* row) { std::copy_n(pixel(0, y), n, row); }},
                out);
}

} // namespace tessemu
