// The pixels that a patch's triangles cover, on their way to the pixel shader: hidden ones dropped,
// attributes fetched once a triangle that is left.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_points.h"
#include "emu/fragment_shading.h"

#include <array>

namespace tessemu {

/// A tessellated patch of which no triangle must be clipped.
struct PatchOnScreen {
    DomainPoints const* pattern = nullptr;
    AssembledVertices* vertices = nullptr; ///< the pattern's points
    std::int32_t primitive_id = 0;
    std::int32_t origin_x = 0, origin_y = 0; ///< pixel from which pixels and positions count
    std::int32_t const* depths = nullptr;    ///< the target's codes, from the origin on
};

/// A table of triangles, and a queue of pixels that name their triangle in it.
class CoveredPixels {
public:
    static constexpr int N = kRasterLanes;
    using I = IntLanes<N>;
    static constexpr std::size_t kTriangles = 512, kPixels = 4096; ///< for which there is room

    explicit CoveredPixels(FragmentShading& shading) : shading_(shading) {}

    /// Starts a draw, whose `setup` must outlive it. Memory serves draw after draw.
    void bind(RasterSetup const& setup, bool front_is_clockwise);
    /// Starts a chunk.
    void begin() { fragments_ = 0; }
    /// Starts a patch, which must last until the next finish(). Nothing may be left of another.
    void begin(PatchOnScreen const& patch) { patch_ = &patch; }

    /// Triangles of a group of lanes.
    struct Group {
        I position[3]; ///< of the corners, relative to the patch's origin: y << 16 | x, 8.8
        I tag;         ///< 2 * triangle of the pattern + whether corners 1 and 2 are exchanged
        I box;         ///< the first pixel of its box, y << 16 | x
    };
    /// Puts the lanes whose bit is set into the table. There must be room.
    void add_triangles(Group const& g, std::uint32_t bits)
    {
        for (int k = 0; k < 3; ++k)
            store_lanes(compress(g.position[k], bits), row(kPosition + k) + triangles);
        store_lanes(compress(g.tag, bits), row(kTag) + triangles);
        store_lanes(compress(g.box, bits), row(kBox) + triangles);
        triangles += std::size_t(std::popcount(bits));
    }
    /// Passes on what is there, and empties table and queue.
    void finish();
    /// Pixels of the chunk, hidden ones too.
    std::uint64_t fragments() const { return fragments_; }

    std::size_t triangles = 0; ///< in the table
    std::size_t pixels = 0;    ///< in the queue
    /// A pixel as 64 y + x in the box of its triangle, and that triangle's number in the table;
    /// triangles follow each other. Whole groups may be written.
    std::uint16_t place[kPixels + 32], owner[kPixels + 32];

private:
    using F = Lanes<N>;
    static constexpr std::size_t kTableRow = kTriangles + 32;
    enum Row {
        kPosition, // three, as Group's
        kTag = kPosition + 3,
        kBox,
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
    // Where n pixels from q on look into the table: they are of at most N triangles that follow each
    // other, so that what they need of a row is one load and one permutation.
    struct Columns {
        std::int32_t const* first;
        I index; ///< behind `first`
        I ints(int r) const
        {
            return permute(load_lanes<N>(first + std::size_t(r) * kTableRow), index);
        }
        F floats(int r) const { return F(typename F::Raw(ints(r).raw)); }
    };

    void tabulate_depth();
    void drop_hidden();
    void tabulate_attributes();
    void interpolate();
    void store_differences(int row, std::array<F, 3> const& corner, std::size_t t);
    std::int32_t* row(int r) { return table_.data() + std::size_t(r) * kTableRow; }
    float* float_row(int r) { return reinterpret_cast<float*>(row(r)); }

    FragmentShading& shading_;
    RasterSetup const* setup_ = nullptr;
    bool front_is_clockwise_ = false;
    int pitch_ = 0;
    PatchOnScreen const* patch_ = nullptr;
    std::uint64_t fragments_ = 0;
    std::vector<std::int32_t> table_;
    // What is not hidden.
    std::int32_t pixel_[kPixels + 32], triangle_[kPixels + 32]; // y << 16 | x; number in the table
    float z_[kPixels + 32], b_[2][kPixels + 32];
    std::int32_t number_[kTableRow]; // by triangle: among those that keep a pixel
};

} // namespace tessemu
