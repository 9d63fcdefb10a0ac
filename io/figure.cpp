// SPDX-License-Identifier: Apache-2.0
#include "io/figure.h"

#include "io/encoded_picture.h"
#include "shaders_cpp/pixel/colored_view.h"

#include <OpenImageIO/imagebufalgo.h>

#include <cmath>

namespace tessemu {

namespace {

using OIIO::ImageBuf;
namespace Algo = OIIO::ImageBufAlgo;

constexpr int kGap = 12, kCaption = 28, kScale = 46, kBar = 12;
constexpr float kInk[4] = {0.15f, 0.16f, 0.2f, 1}, kPaper[4] = {1, 1, 1, 1};

void text(ImageBuf& image, int x, int y, std::string const& line, Algo::TextAlignX align)
{
    if (!Algo::render_text(image, x, y, line, 15, "DejaVuSans", kInk, align,
                           Algo::TextAlignY::Center))
        throw WriteError("captions need the font DejaVu Sans (fonts-dejavu-core): " +
                         image.geterror());
}

void place(ImageBuf& image, int left, int top, ColorTarget const& picture)
{
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            image.setpixel(left + x, top + y, picture.load(x, y).data());
}

void write(ImageBuf const& image, OutputFile& out)
{
    write_encoded(out, image.spec().width, image.spec().height,
                  [&](OIIO::ImageOutput& file) { return image.write(&file); });
}

} // namespace

void write_figure(Figure const& f, OutputFile& out)
{
    if (f.panels.empty() || f.columns < 1) throw WriteError("a figure has no picture");
    int const rows = (int(f.panels.size()) + f.columns - 1) / f.columns;
    int const w = f.panels[0].picture->width(), h = f.panels[0].picture->height();
    int const height = kGap + rows * (h + kCaption + kGap) + (f.scales.empty() ? 0 : kScale);
    ImageBuf image(
        OIIO::ImageSpec(kGap + f.columns * (w + kGap), height, 4, OIIO::TypeDesc::FLOAT));
    Algo::fill(image, kPaper);
    auto const left = [&](int column) { return kGap + column * (w + kGap); };
    for (int i = 0; i < int(f.panels.size()); ++i) {
        Figure::Panel const& p = f.panels[std::size_t(i)];
        if (p.picture->width() != w || p.picture->height() != h)
            throw WriteError("the pictures of a figure differ in size");
        int const top = kGap + i / f.columns * (h + kCaption + kGap);
        place(image, left(i % f.columns), top, *p.picture);
        text(image, left(i % f.columns) + w / 2, top + h + kCaption / 2, p.caption,
             Algo::TextAlignX::Center);
    }
    for (int c = 0; c < int(f.scales.size()); ++c) {
        ColorScale const& scale = f.scales[std::size_t(c)];
        int const x0 = left(c), y0 = height - kScale;
        for (int x = 0; x < w; ++x) {
            float3<float> const color = heat_color(float(x) / float(w - 1));
            float const pixel[4] = {color.x, color.y, color.z, 1};
            for (int y = 0; y < kBar; ++y) image.setpixel(x0 + x, y0 + y, pixel);
        }
        int const y = y0 + kBar + 14;
        text(image, x0, y, "0", Algo::TextAlignX::Left);
        text(image, x0 + w / 2, y, scale.label, Algo::TextAlignX::Center);
        text(image, x0 + w, y, fmt::format("{:.3g}", scale.max), Algo::TextAlignX::Right);
    }
    write(image, out);
}

void write_roofline(Roofline const& r, OutputFile& out)
{
    constexpr int kWidth = 900, kHeight = 620, kLeft = 90, kRight = 40, kTop = 60, kBottom = 60;
    ImageBuf image(OIIO::ImageSpec(kWidth, kHeight, 4, OIIO::TypeDesc::FLOAT));
    Algo::fill(image, kPaper);
    // Decades that hold all points, and the ridge where there is one.
    double low_x = 1e300, high_x = 0, low_y = 1e300, high_y = 0;
    auto const include = [&](double x, double y) {
        low_x = std::min(low_x, x), high_x = std::max(high_x, x);
        low_y = std::min(low_y, y), high_y = std::max(high_y, y);
    };
    for (Roofline::Point const& p : r.points)
        include(p.operations_per_byte, p.operations_per_second);
    if (std::isfinite(r.operations_per_second) && std::isfinite(r.bytes_per_second))
        include(r.operations_per_second / r.bytes_per_second, r.operations_per_second);
    if (high_x == 0) throw WriteError(out.path().string() + ": no stage has operations to show");
    int const x0 = int(std::floor(std::log10(low_x))), x1 = int(std::floor(std::log10(high_x))) + 1;
    int const y0 = int(std::floor(std::log10(low_y))), y1 = int(std::floor(std::log10(high_y))) + 1;
    auto const px = [&](double x) {
        return kLeft + int((std::log10(x) - x0) / (x1 - x0) * (kWidth - kLeft - kRight));
    };
    auto const py = [&](double y) {
        return kHeight - kBottom -
               int((std::log10(y) - y0) / (y1 - y0) * (kHeight - kTop - kBottom));
    };
    auto const line = [&](double xa, double ya, double xb, double yb, float const(&color)[4]) {
        Algo::render_line(image, px(xa), py(ya), px(xb), py(yb), color);
    };
    double const left = std::pow(10, x0), right = std::pow(10, x1), bottom = std::pow(10, y0),
                 top = std::pow(10, y1);
    constexpr float kGrid[4] = {0.86f, 0.87f, 0.9f, 1}, kRoof[4] = {0.8f, 0.2f, 0.15f, 1};
    for (int d = x0; d <= x1; ++d) {
        line(std::pow(10, d), bottom, std::pow(10, d), top, kGrid);
        text(image, px(std::pow(10, d)), kHeight - kBottom + 14, fmt::format("1e{}", d),
             Algo::TextAlignX::Center);
    }
    for (int d = y0; d <= y1; ++d) {
        line(left, std::pow(10, d), right, std::pow(10, d), kGrid);
        text(image, kLeft - 8, py(std::pow(10, d)), fmt::format("1e{}", d),
             Algo::TextAlignX::Right);
    }
    // The roof, in pieces so that it stays within the frame.
    constexpr int kSteps = 400;
    double before_x = 0, before_y = 0;
    for (int i = 0; i <= kSteps; ++i) {
        double const x = left * std::pow(right / left, double(i) / kSteps);
        double const y = std::min(r.operations_per_second, r.bytes_per_second * x);
        bool const inside = y >= bottom && y <= top;
        if (inside && before_x > 0) line(before_x, before_y, x, y, kRoof);
        before_x = inside ? x : 0;
        before_y = y;
    }
    constexpr float kPoint[4] = {0.15f, 0.35f, 0.75f, 1};
    for (Roofline::Point const& p : r.points) {
        int const x = px(p.operations_per_byte), y = py(p.operations_per_second);
        Algo::fill(image, kPoint, OIIO::ROI(x - 4, x + 5, y - 4, y + 5));
        bool const at_right = x > kWidth - 200;
        text(image, at_right ? x - 9 : x + 9, y, p.label,
             at_right ? Algo::TextAlignX::Right : Algo::TextAlignX::Left);
    }
    text(image, kWidth / 2, 24, r.title, Algo::TextAlignX::Center);
    text(image, kWidth / 2, kHeight - 16, "operations a fetched byte", Algo::TextAlignX::Center);
    text(image, 10, kTop - 18, "operations a second", Algo::TextAlignX::Left);
    write(image, out);
}

} // namespace tessemu
