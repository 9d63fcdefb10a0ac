// LOOP09's figure 11: the error of a scheme painted on its surface, blue to red.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/compare.h"

namespace tessemu {

/// Two pictures of one surface.
struct ErrorView {
    ColorTarget position, normal;
};

/// \param settings      size, camera, background, machine
/// \param position_max  what is red, in diagonals; \param normal_max in radians
ErrorView draw_error(EqualParameterErrors const& errors, FrameSettings const& settings,
                     double position_max, double normal_max, ThreadPool const& threads);

} // namespace tessemu
