// Fragments that wait for the pixel shader, and what it makes of them, sorted into tiles.
//
// For a pixel shader of straight-line arithmetic (see emu/triangle_stream.h): it runs on dense
// groups, whatever triangles they are of, and nothing is counted.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/fragment_bins.h"
#include "emu/lane_memory.h"
#include "emu/rasterizer.h"

namespace tessemu {

/// A depth as a 32-bit float target holds it, clamped to the viewport (R135).
template <int N> IntLanes<N> depth_code(Viewport const& viewport, Lanes<N> z)
{
    Lanes<N> const low(viewport.min_depth), high(viewport.max_depth);
    Lanes<N> const clamped = select(z >= low, select(z <= high, z, high), low);
    return IntLanes<N>(typename IntLanes<N>::Raw(clamped.raw)) & IntLanes<N>(0x7fffffff);
}

/// The pixel shader's inputs in rows, a fragment a column. Whoever adds fragments asks for room,
/// writes their columns and says how many; whole groups of lanes may be written.
class FragmentShading {
public:
    static constexpr std::size_t kFragments = 512, kRow = kFragments + 16;

    /// Starts a draw, whose `setup` must outlive it. Memory serves draw after draw.
    void bind(RasterSetup const& setup, TileGrid const& tiles);
    /// Starts a chunk whose fragments go to `bins`.
    void begin(FragmentBins& bins);

    /// The column of the first of n more; what waits is shaded where they would not fit.
    std::size_t room(std::size_t n)
    {
        if (waiting_ + n > kFragments) shade();
        return waiting_;
    }
    void add(std::size_t n) { waiting_ += n; }
    /// Runs the pixel shader and sorts the results into tiles.
    void shade();

    /// How attribute k, after SV_Position, is interpolated.
    std::vector<Interpolation> const& modes() const { return modes_; }
    int attributes() const { return attributes_; }
    float* attribute(std::size_t k) { return attribute_storage_.data() + k * kRow; }

    std::int32_t x[kRow], y[kRow], primitive_id[kRow], front_face[kRow]; ///< front_face: -1 or 0
    float position[4][kRow];                                             ///< SV_Position

private:
    static constexpr int N = kRasterLanes;

    RasterSetup const* setup_ = nullptr;
    TileGrid tiles_;
    FragmentBins* bins_ = nullptr;
    std::vector<Interpolation> modes_;
    int pitch_ = 0, attributes_ = 0;
    bool wide_color_ = false;
    std::size_t waiting_ = 0;
    std::int32_t zeros_[kRow], ones_[kRow];
    float color_[4][kRow];
    std::vector<float> attribute_storage_;
    std::vector<float const*> attribute_rows_;
    float* color_rows_[4];
};

} // namespace tessemu
