// Which pixels a patch's triangles cover: small ones with lanes over triangles, larger ones with
// lanes over pixels.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/covered_pixels.h"
#include "emu/single_triangles.h"

namespace tessemu {

class TriangleCoverage {
    static constexpr int N = kRasterLanes;
    using I = IntLanes<N>;
    using I8 = IntLanes<8>;

public:
    static constexpr int kMaxPatchPixels = 126; ///< so wide and high may a patch be: 8.8 in 16 bits

    /// \param single  takes what needs more than 32 bits
    TriangleCoverage(CoveredPixels& covered, SingleTriangles& single)
        : covered_(covered),
          single_(single)
    {
    }

    /// Starts a draw.
    void bind(RasterSetup const& setup, PrimitiveAssembler const& assembler);
    /// All triangles of a patch, which lies within the target, the viewport and kMaxPatchPixels.
    void add_patch(PatchOnScreen const& patch);

private:
    static constexpr std::size_t kSurvivors = CoveredPixels::kTriangles, kRow = kSurvivors + 32;
    // Boxes of so many pixels have edge values of 32 bits; the queue takes one and N small ones.
    static constexpr int kWidestBox = 60;
    static constexpr std::size_t kSmallPixels = 16 * std::size_t(N);
    static_assert(64 * kWidestBox + kSmallPixels <= CoveredPixels::kPixels);

    void set_up(I v0, I v1, I v2, I triangle);
    void cover_survivors();
    // Edge i lies opposite vertex i: the complement of its value at the centre of the box's first pixel,
    // which is negative inside, and what a pixel to the right or below adds.
    struct Edges {
        I outside[3], step_x[3], step_y[3];
    };
    void mask_group(std::size_t first, std::uint32_t valid);
    template <int kColumns> static I small_masks(Edges const& edges, int rows);
    void queue_group(std::size_t first);
    void queue_mixed_group(std::size_t first, bool both);
    typedef std::uint16_t Words __attribute__((vector_size(16)));
    template <int kAcross>
    std::size_t queue_unit(std::size_t at, std::uint32_t bits, Words corner, Words owner);
    std::size_t queue_small(std::size_t at, std::size_t survivor, std::uint16_t owner, bool both);
    template <int kAcross>
    std::size_t queue_large(std::size_t at, std::size_t survivor, std::uint16_t owner);
    void keep(std::size_t first, std::uint32_t lanes);
    void cover_huge(std::size_t triangle);

    CoveredPixels& covered_;
    SingleTriangles& single_;
    int pitch_ = 0;
    bool cull_clockwise_ = false, cull_counter_clockwise_ = false;
    PatchOnScreen const* patch_ = nullptr;
    std::vector<std::int32_t> packed_; // the points' positions, as CoveredPixels has them

    // Triangles that are not culled and whose box holds the centre of a pixel.
    std::size_t survivors_ = 0;
    std::int32_t position_[3][kRow], tag_[kRow];
    // Their boxes: the first pixel, as y << 16 | x and in the depth target; and what a small one
    // covers: bit 4 y + x for pixel (x, y), or kLarge. Columns and rows but the first, and Edges, of
    // large ones.
    std::int32_t box_[kRow], texel_[kRow], mask_[kRow], columns_[kRow], rows_[kRow],
        outside_[3][kRow], step_x_[3][kRow], step_y_[3][kRow];
    static constexpr std::int32_t kLarge = -1;
};

} // namespace tessemu
