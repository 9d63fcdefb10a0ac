// SPDX-License-Identifier: Apache-2.0
#include "io/figure.h"

#include "io/canvas.h"
#include "shaders_cpp/pixel/colored_view.h"

#include <fmt/format.h>

namespace tessemu {

namespace {

using Align = Canvas::Align;

constexpr int kGap = 12, kCaption = 28, kScale = 46, kBar = 12;

void place(Canvas& canvas, int left, int top, ColorTarget const& picture)
{
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            canvas.set(left + x, top + y, picture.load(x, y).data());
}

} // namespace

void write_figure(Figure const& f, OutputFile& out)
{
    if (f.panels.empty() || f.columns < 1) throw WriteError("a figure has no picture");
    int const rows = (int(f.panels.size()) + f.columns - 1) / f.columns;
    int const w = f.panels[0].picture->width(), h = f.panels[0].picture->height();
    int const height = kGap + rows * (h + kCaption + kGap) + (f.scales.empty() ? 0 : kScale);
    Canvas canvas(kGap + f.columns * (w + kGap), height);
    auto const left = [&](int column) { return kGap + column * (w + kGap); };
    for (int i = 0; i < int(f.panels.size()); ++i) {
        Figure::Panel const& p = f.panels[std::size_t(i)];
        if (p.picture->width() != w || p.picture->height() != h)
            throw WriteError("the pictures of a figure differ in size");
        int const top = kGap + i / f.columns * (h + kCaption + kGap);
        place(canvas, left(i % f.columns), top, *p.picture);
        canvas.text(left(i % f.columns) + w / 2, top + h + kCaption / 2, p.caption, Align::Center);
    }
    for (int c = 0; c < int(f.scales.size()); ++c) {
        ColorScale const& scale = f.scales[std::size_t(c)];
        int const x0 = left(c), y0 = height - kScale;
        for (int x = 0; x < w; ++x) {
            float3<float> const color = heat_color(float(x) / float(w - 1));
            float const pixel[4] = {color.x, color.y, color.z, 1};
            for (int y = 0; y < kBar; ++y) canvas.set(x0 + x, y0 + y, pixel);
        }
        int const y = y0 + kBar + 14;
        canvas.text(x0, y, "0", Align::Left);
        canvas.text(x0 + w / 2, y, scale.label, Align::Center);
        canvas.text(x0 + w, y, fmt::format("{:.3g}", scale.max), Align::Right);
    }
    canvas.write(out);
}

} // namespace tessemu
