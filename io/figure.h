// Figures: pictures side by side with captions and colour scales.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "io/output_file.h"

namespace tessemu {

/// A scale from blue, 0, to red, `max`, under a column of pictures.
struct ColorScale {
    std::string label; ///< what is shown, with its unit
    double max;
};

struct Figure {
    struct Panel {
        ColorTarget const* picture; ///< of one sample; all of one size
        std::string caption;
    };
    int columns = 1;
    std::vector<Panel> panels;      ///< row after row
    std::vector<ColorScale> scales; ///< one a column, or none
};

/// Writes a figure as .png or .exr; the caller commits. Throws WriteError, among other things on a
/// computer without the font DejaVu Sans.
void write_figure(Figure const& figure, OutputFile& out);

} // namespace tessemu
