// Plots as papers print them: curves over logarithmic axes, panels of one scale side by side.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "io/output_file.h"

#include <string>
#include <vector>

namespace tessemu {

struct PlotPoint {
    double x, y; ///< above 0
    std::string label = {};
};

struct PlotSeries {
    enum class Style {
        Curve,  ///< markers and lines between them
        Labels, ///< markers with their labels
        Guide,  ///< a line that is cut at the frame and widens no axis
    };
    std::string name; ///< in the legend; empty: not there. Equal names look alike on all panels.
    std::vector<PlotPoint> points;
    Style style = Style::Curve;
};

struct PlotAxis {
    std::string name;
    double base = 10;                  ///< ticks are its powers
    std::vector<double> includes = {}; ///< besides the points
};

struct Plot {
    std::string title;
    std::vector<PlotSeries> series;
};

/// Panels that share both axes.
struct PlotSheet {
    PlotAxis x, y;
    std::vector<Plot> panels; ///< row after row
    int columns = 1;
    int panel_width = 290, panel_height = 230; ///< pixels, of the frame
    enum class Legend {
        Below, ///< a line for all panels
        Inside ///< each panel's own curves, in its lower left corner
    };
    Legend legend = Legend::Below;
};

/// A logarithmic scale from a power of its base to another.
class LogScale {
public:
    /// From the last power at or below `low` to the first at or above `high`, and to the next one
    /// where they are the same. Throws Error unless 0 < low <= high, both finite, and base > 1.
    LogScale(double base, double low, double high);

    std::vector<double> const& ticks() const { return ticks_; }
    /// 0 at the first tick, 1 at the last.
    double position(double value) const;
    /// Between the ticks, multiples of them: 2, 3, ... 9 of a base of 10; none of a base below 3.
    std::vector<double> minor_ticks() const;
    /// "8", "0.01", "1000", "1e12"
    static std::string label(double tick);

private:
    double base_;
    std::vector<double> ticks_;
};

/// Where things are, in pixels from the top left.
class PlotLayout {
public:
    /// Throws Error where there is no panel, no point on any, or a point not above 0 or not finite.
    explicit PlotLayout(PlotSheet const& sheet);

    int width() const { return width_; }
    int height() const { return height_; }
    LogScale const& x_scale() const { return x_scale_; }
    LogScale const& y_scale() const { return y_scale_; }
    /// The upper left corner of a panel's frame.
    int left(std::size_t panel) const;
    int top(std::size_t panel) const;
    /// Of a value on a panel, as a fraction of pixels.
    double x(std::size_t panel, double value) const;
    double y(std::size_t panel, double value) const;
    /// Names of the legend, in order of appearance; a curve's marker and colour go by its place.
    std::vector<std::string> const& names() const { return names_; }

private:
    int columns_, panel_width_, panel_height_;
    LogScale x_scale_, y_scale_;
    std::vector<std::string> names_;
    int width_ = 0, height_ = 0;
};

/// Writes the panels as .png or .exr; the caller commits. Throws as PlotLayout, and WriteError,
/// among other things on a computer without the font DejaVu Sans.
void write_plots(PlotSheet const& sheet, OutputFile& out);

/// Arithmetic against fetches: what stages do, under what the GPU can.
struct Roofline {
    struct Point {
        std::string label;
        double operations_per_byte, operations_per_second;
    };
    std::string title;
    double operations_per_second; ///< the flat roof; infinite where it is not known
    double bytes_per_second;      ///< the slope; infinite where it is not known
    std::vector<Point> points;
};
/// Throws Error where no stage has operations to show.
PlotSheet plot_of(Roofline const& roofline);

} // namespace tessemu
