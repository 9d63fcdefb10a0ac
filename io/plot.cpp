// SPDX-License-Identifier: Apache-2.0
#include "io/plot.h"

#include "io/canvas.h"

#include <fmt/format.h>

#include <cmath>

namespace tessemu {

namespace {

using Align = Canvas::Align;

constexpr int kLeft = 84, kRight = 18, kGap = 18, kTitle = 30, kTicks = 24, kAxisName = 24,
              kLegend = 34, kInset = 12, kText = 14;
constexpr float kGrid[4] = {0.87f, 0.88f, 0.90f, 1}, kFrame[4] = {0.45f, 0.46f, 0.5f, 1},
                kGuide[4] = {0.8f, 0.2f, 0.15f, 1};
// Okabe and Ito's colours, which colour-blind readers tell apart.
constexpr float kColors[][4] = {{0.00f, 0.45f, 0.70f, 1}, {0.84f, 0.37f, 0.00f, 1},
                                {0.00f, 0.62f, 0.45f, 1}, {0.80f, 0.47f, 0.65f, 1},
                                {0.90f, 0.62f, 0.00f, 1}, {0.34f, 0.71f, 0.91f, 1},
                                {0.15f, 0.16f, 0.20f, 1}, {0.55f, 0.36f, 0.20f, 1}};

struct Extent {
    double low = 0, high = 0;
    void add(double v)
    {
        low = high == 0 ? v : std::min(low, v);
        high = std::max(high, v);
    }
};

// Of all panels; `value` takes a point's.
template <class Value>
LogScale scale_of(PlotSheet const& sheet, PlotAxis const& axis, Value const& value)
{
    Extent extent;
    bool any = false;
    for (Plot const& panel : sheet.panels)
        for (PlotSeries const& s : panel.series) {
            if (s.style == PlotSeries::Style::Guide) continue;
            for (PlotPoint const& p : s.points) {
                double const v = value(p);
                if (!(v > 0) || !std::isfinite(v))
                    throw Error(fmt::format("{}: a point of '{}' has {} {}; a logarithmic axis "
                                            "shows what is above 0 and finite",
                                            panel.title, s.name, axis.name, v));
                extent.add(v);
                any = true;
            }
        }
    if (!any) throw Error("a plot has no point to show");
    for (double v : axis.includes) extent.add(v);
    return {axis.base, extent.low, extent.high};
}

void line(Canvas& canvas, Rect const& clip, float const (&color)[4], double width, double xa,
          double ya, double xb, double yb)
{
    double const dx = xb - xa, dy = yb - ya, squared = dx * dx + dy * dy, reach = width / 2 + 1;
    auto const pixel = [](double v, int low, int high) {
        return int(std::clamp(std::floor(v), double(low), double(high)));
    };
    Rect const near{pixel(std::min(xa, xb) - reach, clip.left, clip.right),
                    pixel(std::min(ya, yb) - reach, clip.top, clip.bottom),
                    pixel(std::max(xa, xb) + reach + 1, clip.left, clip.right),
                    pixel(std::max(ya, yb) + reach + 1, clip.top, clip.bottom)};
    canvas.paint(near, color, [&](double x, double y) {
        double const t =
            squared == 0 ? 0 : std::clamp(((x - xa) * dx + (y - ya) * dy) / squared, 0.0, 1.0);
        double const ex = x - xa - t * dx, ey = y - ya - t * dy;
        return std::sqrt(ex * ex + ey * ey) - width / 2;
    });
}

// Of marker and line: where curves run on each other, those below can be seen at both sides.
double shrunk(std::size_t which)
{
    return 1 - 0.13 * double(std::min<std::size_t>(which % std::size(kColors), 4));
}

// Disc, square, triangle, diamond, downward triangle: in turn.
void marker(Canvas& canvas, std::size_t which, double cx, double cy)
{
    double const r = 5.4 * shrunk(which);
    auto const triangle = [r](double x, double y) { // an edge below, a corner on top
        return std::max(y - 0.6 * r, 0.88 * std::abs(x) - 0.47 * y - 0.62 * r);
    };
    Rect const near{int(cx) - 8, int(cy) - 8, int(cx) + 9, int(cy) + 9};
    canvas.paint(near, kColors[which % std::size(kColors)], [&](double px, double py) {
        double const x = px - cx, y = py - cy;
        switch (which % 5) {
        case 0:
            return std::sqrt(x * x + y * y) - 0.95 * r;
        case 1:
            return std::max(std::abs(x), std::abs(y)) - 0.85 * r;
        case 2:
            return triangle(x, y);
        case 3:
            return (std::abs(x) + std::abs(y) - 1.25 * r) / std::sqrt(2.0);
        default:
            return triangle(x, -y);
        }
    });
}

int width_of(std::string const& text)
{
    return Canvas::text_width(text, kText);
}

constexpr int kSample = 34; // of a curve, in a legend

void draw_sample(Canvas& canvas, std::size_t which, int x, int y, std::string const& name)
{
    Rect const all{0, 0, canvas.width(), canvas.height()};
    line(canvas, all, kColors[which % std::size(kColors)], 2.6 * shrunk(which), x, y, x + kSample,
         y);
    marker(canvas, which, x + kSample / 2.0, y);
    canvas.text(x + kSample + 6, y, name, Align::Left, kText);
}

class Panel {
public:
    Panel(Canvas& canvas, PlotSheet const& sheet, PlotLayout const& layout, std::size_t number)
        : canvas_(canvas),
          sheet_(sheet),
          layout_(layout),
          number_(number),
          frame_{layout.left(number), layout.top(number), layout.left(number) + sheet.panel_width,
                 layout.top(number) + sheet.panel_height}
    {
    }

    void draw() const
    {
        Plot const& plot = sheet_.panels[number_];
        grid();
        for (PlotSeries const& s : plot.series) lines(s);
        for (PlotSeries const& s : plot.series) markers(s);
        if (sheet_.legend == PlotSheet::Legend::Inside) legend();
        box();
        canvas_.text((frame_.left + frame_.right) / 2, frame_.top - kTitle / 2, plot.title,
                     Align::Center);
        std::size_t const below = number_ + std::size_t(sheet_.columns);
        if (below >= sheet_.panels.size()) name_x();
        if (number_ % std::size_t(sheet_.columns) == 0) name_y();
    }

private:
    double x(double value) const { return layout_.x(number_, value); }
    double y(double value) const { return layout_.y(number_, value); }

    void grid() const
    {
        for (double t : layout_.x_scale().ticks())
            line(canvas_, frame_, kGrid, 1, x(t), frame_.top, x(t), frame_.bottom);
        for (double t : layout_.y_scale().ticks())
            line(canvas_, frame_, kGrid, 1, frame_.left, y(t), frame_.right, y(t));
    }
    void box() const
    {
        double const x0 = frame_.left + 0.5, x1 = frame_.right - 0.5, y0 = frame_.top + 0.5,
                     y1 = frame_.bottom - 0.5;
        line(canvas_, frame_, kFrame, 1, x0, y0, x1, y0);
        line(canvas_, frame_, kFrame, 1, x0, y1, x1, y1);
        line(canvas_, frame_, kFrame, 1, x0, y0, x0, y1);
        line(canvas_, frame_, kFrame, 1, x1, y0, x1, y1);
        for (double t : layout_.y_scale().minor_ticks())
            line(canvas_, frame_, kFrame, 1, x0, y(t), x0 + 3.5, y(t));
        for (double t : layout_.y_scale().ticks())
            line(canvas_, frame_, kFrame, 1, x0, y(t), x0 + 6.5, y(t));
        for (double t : layout_.x_scale().minor_ticks())
            line(canvas_, frame_, kFrame, 1, x(t), y1 - 3.5, x(t), y1);
        for (double t : layout_.x_scale().ticks())
            line(canvas_, frame_, kFrame, 1, x(t), y1 - 6.5, x(t), y1);
    }
    void lines(PlotSeries const& s) const
    {
        if (s.style == PlotSeries::Style::Labels) return;
        bool const guide = s.style == PlotSeries::Style::Guide;
        for (std::size_t i = 1; i < s.points.size(); ++i) {
            PlotPoint const &a = s.points[i - 1], &b = s.points[i];
            line(canvas_, frame_, guide ? kGuide : kColors[place(s) % std::size(kColors)],
                 guide ? 1.5 : 2.6 * shrunk(place(s)), x(a.x), y(a.y), x(b.x), y(b.y));
        }
    }
    void markers(PlotSeries const& s) const
    {
        if (s.style == PlotSeries::Style::Guide) return;
        for (PlotPoint const& p : s.points) {
            marker(canvas_, place(s), x(p.x), y(p.y));
            if (s.style == PlotSeries::Style::Labels) label(p);
        }
    }
    void label(PlotPoint const& p) const
    {
        int const at = int(x(p.x)), room = frame_.right - at;
        bool const at_left = width_of(p.label) + 20 > room;
        canvas_.text(at_left ? at - 10 : at + 10, int(y(p.y)), p.label,
                     at_left ? Align::Right : Align::Left, kText);
    }
    bool in_legend(PlotSeries const& s) const
    {
        auto const& names = layout_.names();
        return std::find(names.begin(), names.end(), s.name) != names.end();
    }
    void legend() const
    {
        constexpr int kLine = 20;
        auto const& series = sheet_.panels[number_].series;
        int y = frame_.bottom - kInset - kLine / 2;
        for (auto s = series.rbegin(); s != series.rend(); ++s) {
            if (!in_legend(*s)) continue;
            draw_sample(canvas_, place(*s), frame_.left + kInset, y, s->name);
            y -= kLine;
        }
    }
    std::size_t place(PlotSeries const& s) const
    {
        auto const& names = layout_.names();
        auto const it = std::find(names.begin(), names.end(), s.name);
        return it == names.end() ? 0 : std::size_t(it - names.begin());
    }
    void name_x() const
    {
        for (double t : layout_.x_scale().ticks())
            canvas_.text(int(x(t)), frame_.bottom + kTicks / 2, LogScale::label(t), Align::Center,
                         kText);
        canvas_.text((frame_.left + frame_.right) / 2, frame_.bottom + kTicks + kAxisName / 2 - 2,
                     sheet_.x.name, Align::Center, kText);
    }
    void name_y() const
    {
        for (double t : layout_.y_scale().ticks())
            canvas_.text(frame_.left - 8, int(y(t)), LogScale::label(t), Align::Right, kText);
        canvas_.upright_text(kAxisName / 2 + 2, (frame_.top + frame_.bottom) / 2, sheet_.y.name,
                             kText, kAxisName);
    }

    Canvas& canvas_;
    PlotSheet const& sheet_;
    PlotLayout const& layout_;
    std::size_t number_;
    Rect frame_;
};

void draw_legend(Canvas& canvas, PlotLayout const& layout)
{
    constexpr int kBetween = 26;
    int length = -kBetween;
    for (std::string const& name : layout.names())
        length += kSample + 6 + width_of(name) + kBetween;
    int x = (layout.width() - length) / 2;
    int const y = layout.height() - kLegend / 2 - 4;
    for (std::size_t i = 0; i < layout.names().size(); ++i) {
        std::string const& name = layout.names()[i];
        draw_sample(canvas, i, x, y, name);
        x += kSample + 6 + width_of(name) + kBetween;
    }
}

} // namespace

LogScale::LogScale(double base, double low, double high) : base_(base)
{
    if (!(low > 0 && low <= high && std::isfinite(high) && base > 1))
        throw Error(
            fmt::format("a logarithmic scale of base {} cannot go from {} to {}", base, low, high));
    double first = 1;
    while (first > low) first /= base;
    while (first * base <= low) first *= base;
    ticks_.push_back(first);
    while (ticks_.back() < high || ticks_.size() < 2) ticks_.push_back(ticks_.back() * base);
}

double LogScale::position(double value) const
{
    return std::log(value / ticks_.front()) / std::log(ticks_.back() / ticks_.front());
}

std::vector<double> LogScale::minor_ticks() const
{
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < ticks_.size(); ++i)
        for (int k = 2; k < base_; ++k) out.push_back(k * ticks_[i]);
    return out;
}

std::string LogScale::label(double tick)
{
    double const exponent = std::round(std::log10(tick));
    if (exponent >= 6 || exponent < -3) return fmt::format("1e{}", exponent);
    return fmt::format("{:.6g}", tick);
}

PlotLayout::PlotLayout(PlotSheet const& sheet)
    : columns_(sheet.columns),
      panel_width_(sheet.panel_width),
      panel_height_(sheet.panel_height),
      x_scale_(scale_of(sheet, sheet.x, [](PlotPoint const& p) { return p.x; })),
      y_scale_(scale_of(sheet, sheet.y, [](PlotPoint const& p) { return p.y; }))
{
    if (columns_ < 1 || panel_width_ < 2 * kInset + 1 || panel_height_ < 2 * kInset + 1)
        throw Error(fmt::format("a sheet of {} columns of {} x {} pixels has no room for a plot",
                                columns_, panel_width_, panel_height_));
    for (Plot const& panel : sheet.panels)
        for (PlotSeries const& s : panel.series)
            if (!s.name.empty() && s.style != PlotSeries::Style::Guide &&
                std::find(names_.begin(), names_.end(), s.name) == names_.end())
                names_.push_back(s.name);
    int const rows = (int(sheet.panels.size()) + columns_ - 1) / columns_;
    width_ = kLeft + columns_ * (panel_width_ + kGap) - kGap + kRight;
    height_ =
        rows * (kTitle + panel_height_) + kTicks + kAxisName +
        (names_.empty() || sheet.legend == PlotSheet::Legend::Inside ? kGap / 2 : kLegend + 6);
}

int PlotLayout::left(std::size_t panel) const
{
    return kLeft + int(panel) % columns_ * (panel_width_ + kGap);
}

int PlotLayout::top(std::size_t panel) const
{
    return kTitle + int(panel) / columns_ * (kTitle + panel_height_);
}

double PlotLayout::x(std::size_t panel, double value) const
{
    return left(panel) + kInset + x_scale_.position(value) * (panel_width_ - 2 * kInset);
}

double PlotLayout::y(std::size_t panel, double value) const
{
    return top(panel) + panel_height_ - kInset -
           y_scale_.position(value) * (panel_height_ - 2 * kInset);
}

void write_plots(PlotSheet const& sheet, OutputFile& out)
{
    PlotLayout const layout(sheet);
    Canvas canvas(layout.width(), layout.height());
    for (std::size_t i = 0; i < sheet.panels.size(); ++i) Panel(canvas, sheet, layout, i).draw();
    if (sheet.legend == PlotSheet::Legend::Below) draw_legend(canvas, layout);
    canvas.write(out);
}

PlotSheet plot_of(Roofline const& r)
{
    if (r.points.empty()) throw Error(r.title + ": no stage has operations to show");
    PlotSheet sheet{{"operations a fetched byte"}, {"operations a second"}, {}, 1, 780, 500};
    PlotSeries stages{"", {}, PlotSeries::Style::Labels};
    for (Roofline::Point const& p : r.points)
        stages.points.push_back({p.operations_per_byte, p.operations_per_second, p.label});
    // Far enough to leave the frame on both sides.
    constexpr double kFar = 1e12;
    bool const flat = std::isfinite(r.operations_per_second),
               sloped = std::isfinite(r.bytes_per_second);
    double const ridge =
        flat && sloped ? r.operations_per_second / r.bytes_per_second : stages.points[0].x;
    double const height = flat ? r.operations_per_second : r.bytes_per_second * ridge;
    PlotSeries roof{"", {}, PlotSeries::Style::Guide};
    if (flat || sloped)
        roof.points = {{ridge / kFar, sloped ? height / kFar : height},
                       {ridge, height},
                       {ridge * kFar, flat ? height : height * kFar}};
    if (flat && sloped) {
        sheet.x.includes = {ridge};
        sheet.y.includes = {height};
    }
    sheet.panels.push_back({r.title, {std::move(roof), std::move(stages)}});
    return sheet;
}

} // namespace tessemu
