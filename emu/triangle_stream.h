// Triangles in the common state, many at a time, to the bits that emu/rasterizer.h gives one by
// one.
//
// The common state: solid triangles, one sample, depth LESS or LESS_EQUAL in 32-bit float, one
// colour target that is overwritten, a pixel shader of straight-line arithmetic. Such a shader has
// no side effect and the same cost everywhere, so fragments may be shaded before their depth test;
// what counts is what passes. And depth can but fall: a fragment that fails against what its pixel
// held at any time of the draw fails in order too, and need not be shaded (R163, I-16). It counts as
// covered.
//
// On the geometry side: set-up, rejection and coverage of small triangles with lanes over triangles,
// of larger ones with lanes over pixels; fragments dropped that lie behind what earlier waves left,
// attributes fetched once a triangle that is left, fragments shaded in dense groups and sorted into
// tiles. On the raster side, tile by tile: the depth test in submission order.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_points.h"
#include "emu/fragment_bins.h"
#include "emu/lane_memory.h"
#include "emu/rasterizer.h"

#include <array>

namespace tessemu {

/// What a thread needs to turn a chunk's triangles into fragments; reused from chunk to chunk.
class TriangleStream {
public:
    /// True if draws in this state may take this way.
    /// \param triangles  whether nothing else reaches the rasterizer
    static bool supports(RasterSetup const& setup, bool triangles);

    /// Starts a draw, whose `setup` and `assembler` must outlive it. Memory serves draw after draw.
    void bind(RasterSetup const& setup, PrimitiveAssembler const& assembler, TileGrid const& tiles);

    /// Starts a chunk whose fragments go to `bins`.
    void begin(AssembledVertices& vertices, FragmentBins& bins);
    /// All triangles of a tessellated patch, whose points are the vertices.
    void add_patch(DomainPoints const& pattern, std::int32_t primitive_id,
                   AssemblyCounters& counters);
    /// One triangle of any kind.
    void add_triangle(std::uint32_t const* v, std::int32_t primitive_id,
                      AssemblyCounters& counters);
    void end();

    /// Fragments of the chunk that ended.
    std::uint64_t fragments() const { return fragments_; }

private:
    static constexpr int N = kRasterLanes;
    using F = Lanes<N>;
    using I = IntLanes<N>;
    using I8 = IntLanes<8>;
    static constexpr std::size_t kSurvivors = 512, kQueue = 4096, kShade = 512;
    static constexpr std::size_t kShadeRow = kShade + 16, kTableRow = kSurvivors + 32;
    static constexpr int kMaxPatchPixels = 126; // 16-bit 8.8 numbers hold a patch
    // Boxes of so many pixels have edge values of 32 bits; the queue takes one and N small ones.
    static constexpr int kWidestBox = 60;
    static constexpr std::size_t kSmallPixels = 16 * std::size_t(N);
    static_assert(64 * kWidestBox + kSmallPixels <= kQueue);
    // Rows of the covered triangles' table.
    enum Row {
        kPacked,            // three: the corners' positions
        kTag = kPacked + 3, // 2 * triangle + exchanged
        kBox,               // its first pixel, y << 16 | x
        kA1,
        kB1,
        kC1,
        kA2,
        kB2,
        kC2,
        kInverse,
        kZ,
        kDz1,
        kDz2,
        kFront,
        kCorner, // three: the corners' vertices
        kW = kCorner + 3,
        kDw1,
        kDw2,
        kW1,
        kW2,
        kAttributes
    };

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
    void finish_covered();
    void tabulate_depth();
    void drop_hidden();
    void tabulate_attributes();
    // Where n fragments from q on look into the table: they come from at most N triangles that follow
    // each other, so that what they need of a row is one load and one permutation.
    struct Columns {
        std::int32_t const* first;
        I index; ///< behind `first`
        I ints(int r) const
        {
            return permute(load_lanes<N>(first + std::size_t(r) * kTableRow), index);
        }
        F floats(int r) const { return F(typename F::Raw(ints(r).raw)); }
    };
    void interpolate();
    void store_differences(int row, std::array<F, 3> const& corner, std::size_t t);
    I depth_code(F z) const;
    void draw_assembled(AssembledPrimitive const& p);
    void shade();
    std::int32_t* row(int r) { return table_.data() + std::size_t(r) * kTableRow; }
    float* float_row(int r) { return reinterpret_cast<float*>(row(r)); }

    RasterSetup const* setup_ = nullptr;
    PrimitiveAssembler const* assembler_ = nullptr;
    TileGrid tiles_;
    int pitch_ = 0, attributes_ = 0;
    Rect bounds_;
    bool wide_color_ = false, cull_clockwise_ = false, cull_counter_clockwise_ = false;
    std::vector<Interpolation> modes_;
    AssembledVertices* vertices_ = nullptr;
    FragmentBins* bins_ = nullptr;
    std::uint64_t fragments_ = 0;

    // A patch: packed positions relative to its origin, and what identifies it.
    std::vector<std::int32_t> packed_;
    DomainPoints const* pattern_ = nullptr;
    std::int32_t origin_x_ = 0, origin_y_ = 0, primitive_id_ = 0;
    std::int32_t const* depths_ = nullptr; // the target's, from the patch's origin on
    std::vector<AssembledPrimitive> assembled_;

    std::size_t survivors_ = 0;
    std::int32_t survivor_[4][kSurvivors + 32]; // rows kPacked to kTag
    // Their boxes: the first pixel, as y << 16 | x and in depths_; and what a small one covers: bit
    // 4 y + x for pixel (x, y), or kLarge. Columns and rows but the first, and Edges, of large ones.
    std::int32_t box_[kSurvivors + 32], texel_[kSurvivors + 32], mask_[kSurvivors + 32],
        columns_[kSurvivors + 32], rows_[kSurvivors + 32], outside_[3][kSurvivors + 32],
        step_x_[3][kSurvivors + 32], step_y_[3][kSurvivors + 32];
    static constexpr std::int32_t kLarge = -1;
    std::size_t covered_ = 0; // of the survivors; at most kSurvivors between two finish_covered()
    std::vector<std::int32_t> table_;
    std::size_t queued_ = 0;
    // Covered pixels: 64 y + x in the box of the triangle, whose number in the table is the owner.
    std::uint16_t queue_place_[kQueue + 32], queue_owner_[kQueue + 32];
    // What is not hidden.
    std::int32_t queue_pixel_[kQueue + 32], queue_triangle_[kQueue + 32]; // y << 16 | x
    float queue_z_[kQueue + 32], queue_b_[2][kQueue + 32];
    std::int32_t number_[kTableRow]; // by covered triangle: among those that keep a fragment
    std::size_t shaded_ = 0;
    std::int32_t pixel_x_[kShadeRow], pixel_y_[kShadeRow], id_[kShadeRow], front_[kShadeRow],
        zeros_[kShadeRow], ones_[kShadeRow];
    float position_[4][kShadeRow], color_[4][kShadeRow];
    std::vector<float> attribute_storage_;
    std::vector<float const*> attribute_rows_;
    float* color_rows_[4];
};

} // namespace tessemu
