// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/timed_cell.h"

#include "emu/error.h"

#include <fmt/format.h>

namespace tessemu {

double predicted_seconds(GpuModel const& m, TimedCell const& c)
{
    return m.overhead + c.scale * (estimate_cost(m, c.statistics).seconds - m.overhead);
}

// Least squares of (overhead + fetches / rate + rest - seconds) / seconds.
GpuModel fitted_to(std::span<TimedCell const> cells, GpuModel m, std::size_t left_out)
{
    GpuModel rest = m;
    rest.any_fetch = GpuModel::kUnknown;
    rest.overhead = 0;
    double s1 = 0, sx = 0, sxx = 0, sy = 0, sxy = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (i == left_out) continue;
        TimedCell const& c = cells[i];
        DrawCost const without = estimate_cost(rest, c.statistics);
        double x = 0;
        for (StageCost const& s : without.stages)
            if (s.stage.ends_with("_shader")) x += c.scale * s.fetches;
        double const w = 1 / (c.seconds * c.seconds);
        double const y = c.seconds - c.scale * without.shaders;
        s1 += w, sx += w * x, sxx += w * x * x, sy += w * y, sxy += w * x * y;
    }
    double const d = s1 * sxx - sx * sx;
    double const per_fetch = (s1 * sxy - sx * sy) / d;
    m.overhead = (sy * sxx - sx * sxy) / d;
    if (!(per_fetch > 0 && m.overhead >= 0))
        throw Error(fmt::format("the fit gives {} seconds a fetch and an overhead of {}: the GPU "
                                "does not fit the table",
                                per_fetch, m.overhead));
    m.any_fetch = 1 / per_fetch;
    return m;
}

std::string in_words_of_fit(GpuModel const& m)
{
    return fmt::format(
        "Fitted to the table: {:.3g} ms a frame whatever is drawn, {:.3g} fetches of "
        "up to 16 bytes a second. GPU: {}.",
        1e3 * m.overhead, m.any_fetch, m.name);
}

} // namespace tessemu
