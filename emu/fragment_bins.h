// Shaded fragments on their way from the geometry side to the tiles, and the depth test that merges
// them (see emu/triangle_stream.h for when a draw goes this way).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "emu/lanes.h"

#include <cstdint>
#include <vector>

namespace tessemu {

/// Shaded fragments of one chunk by tile, in submission order.
class FragmentBins {
public:
    static constexpr int kBlock = 256 - 16, kRow = 256; // whole groups are written
    struct Block {
        std::uint32_t count = 0, next = 0xffffffffu;
        std::uint32_t texel[kRow]; ///< y * pitch + x of the targets
        std::uint32_t depth[kRow]; ///< code
        std::uint32_t color[kRow]; ///< packed; or the red component, and the others in `rest`
    };

    void reset(std::size_t tiles, bool wide_color);
    bool empty(std::size_t tile) const { return head_[tile] == kNone; }
    /// Appends the first n fragments of a group of one tile.
    /// \param color  packed; or four components
    template <int N>
    void append(std::size_t tile, int n, IntLanes<N> texel, IntLanes<N> depth,
                IntLanes<N> const* color)
    {
        Block& block = block_for(tile, std::uint32_t(n));
        std::uint32_t const at = block.count;
        __builtin_memcpy(block.texel + at, &texel.raw, sizeof texel.raw);
        __builtin_memcpy(block.depth + at, &depth.raw, sizeof depth.raw);
        __builtin_memcpy(block.color + at, &color[0].raw, sizeof color[0].raw);
        if (wide_color_) {
            std::size_t const b = std::size_t(&block - blocks_.data());
            for (std::size_t k = 0; k < 3; ++k)
                __builtin_memcpy(rest_.data() + (b * 3 + k) * kRow + at, &color[k + 1].raw,
                                 sizeof color[0].raw);
        }
        block.count = at + std::uint32_t(n);
    }

    /// Asks for a tile's first block to be brought near.
    void prefetch(std::size_t tile) const
    {
        if (head_[tile] != kNone) prefetch_block(head_[tile]);
    }

    template <class Work> void for_each_block(std::size_t tile, Work&& work) const
    {
        for (std::uint32_t b = head_[tile]; b != kNone; b = blocks_[b].next) {
            if (blocks_[b].next != kNone) prefetch_block(blocks_[b].next);
            work(blocks_[b], wide_color_ ? rest_.data() + std::size_t(b) * 3 * kRow : nullptr);
        }
    }

private:
    Block& block_for(std::size_t tile, std::uint32_t n)
    {
        std::uint32_t const b = tail_[tile];
        if (b != kNone && blocks_[b].count + n <= kBlock) return blocks_[b];
        return fresh_block(tile);
    }
    Block& fresh_block(std::size_t tile);
    void prefetch_block(std::uint32_t b) const
    {
        auto const* const p = reinterpret_cast<char const*>(&blocks_[b]);
        for (std::size_t at = 0; at < sizeof(Block); at += 64) __builtin_prefetch(p + at);
    }

    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> head_, tail_;
    std::vector<std::uint32_t> touched_;
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> rest_;
    std::size_t used_ = 0;
    bool wide_color_ = false;
};

/// The depth test of a tile's fragments, in order. Returns how many passed.
std::uint64_t merge_fragments(RasterTarget const& target, FragmentBins const& bins,
                              std::size_t tile);

} // namespace tessemu
