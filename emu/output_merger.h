// Output merger: depth and stencil tests, blending, writes (rules R130 to R140).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"

namespace tessemu {

/// (a FUNC b) on depth codes and stencil values (R133).
bool compare(Comparison func, std::uint32_t a, std::uint32_t b);

/// A stencil operation on 8 bits (R133).
std::uint8_t apply(StencilOp op, std::uint8_t value, std::uint8_t ref);

/// One target's blend in float32: source * factor, then dest * factor, then the operation (I-20).
/// \param type     of the target's format: normalised ones clamp inputs and result (R136)
/// \param source1  o1, for the dual-source factors
std::array<float, 4> blend(RenderTargetBlend const& state, std::array<float, 4> const& blend_factor,
                           FormatType type, std::array<float, 4> source,
                           std::array<float, 4> const& source1, std::array<float, 4> const& dest);

/// Samples that alpha lets through: round(alpha * samples) lowest ones; NaN and below 0 none (R118,
/// I-17).
std::uint32_t alpha_to_coverage(float alpha, int samples);

class OutputMerger {
public:
    explicit OutputMerger(RasterTarget const& target);

    bool depth_or_stencil() const { return depth_test_ || stencil_test_; }
    /// Tests sample s of pixel (x, y) and updates depth and stencil. True if it passes (R130 to
    /// R135).
    bool test(int x, int y, int s, float z, bool front_face, Viewport const& viewport);
    /// Blends and writes the shader's colours. color[4 * i + k]: component k of o(i).
    void write(int x, int y, int s, float const* color, int color_targets);

private:
    RasterTarget const& target_;
    DepthTarget* depth_;
    bool depth_test_, depth_write_, stencil_test_, stencil_write_;
};

} // namespace tessemu
