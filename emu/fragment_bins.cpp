// SPDX-License-Identifier: Apache-2.0
#include "emu/fragment_bins.h"

#include <algorithm>

namespace tessemu {

void FragmentBins::reset(std::size_t tiles, bool wide_color)
{
    if (head_.size() == tiles) {
        for (std::uint32_t t : touched_) head_[t] = tail_[t] = kNone;
    } else { // another target's draw used this memory before
        head_.assign(tiles, kNone);
        tail_.assign(tiles, kNone);
    }
    touched_.clear();
    if (wide_color) rest_.resize(blocks_.size() * 3 * kRow);
    used_ = 0;
    wide_color_ = wide_color;
}

FragmentBins::Block& FragmentBins::fresh_block(std::size_t tile)
{
    auto const fresh = std::uint32_t(used_++);
    if (fresh == blocks_.size()) {
        blocks_.emplace_back();
        if (wide_color_) rest_.resize(blocks_.size() * 3 * kRow);
    }
    blocks_[fresh].count = 0;
    blocks_[fresh].next = kNone;
    if (tail_[tile] == kNone) {
        head_[tile] = fresh;
        touched_.push_back(std::uint32_t(tile));
    } else {
        blocks_[tail_[tile]].next = fresh;
    }
    tail_[tile] = fresh;
    return blocks_[fresh];
}

std::uint64_t merge_fragments(RasterTarget const& target, FragmentBins const& bins,
                              std::size_t tile)
{
    std::uint32_t* const codes = target.depth->codes();
    auto* const pixels = reinterpret_cast<std::uint32_t*>(target.color[0]->texel(0, 0));
    bool const or_equal = target.depth_stencil.depth_func == Comparison::LessEqual;
    std::uint32_t const slack = or_equal ? 1 : 0; // a <= b is a < b + 1 in integers
    std::size_t const words = target.color[0]->format() == Format::R32G32B32A32_FLOAT ? 4 : 1;
    std::uint64_t passed = 0;
    // Nearly all pass, for what lies behind earlier waves is not here: a branch that predicts, and
    // no old colour to load.
    auto const merge = [&](FragmentBins::Block const& b, auto const& write) {
        constexpr std::uint32_t kAhead = 32, kStep = 4; // a row of a 4x4 block at most
        auto const one = [&](std::uint32_t i) {
            std::size_t const at = b.texel[i];
            if (std::uint32_t const z = b.depth[i]; z < codes[at] + slack) {
                codes[at] = z;
                write(at, i);
                ++passed;
            }
        };
        std::uint32_t i = 0;
        for (; i + kStep <= b.count; i += kStep) {
            std::size_t const next = b.texel[std::min(i + kAhead, b.count - 1)];
            __builtin_prefetch(codes + next, 1);
            __builtin_prefetch(pixels + words * next, 1);
            for (std::uint32_t k = 0; k < kStep; ++k) one(i + k);
        }
        for (; i < b.count; ++i) one(i);
    };
    bins.for_each_block(tile, [&](FragmentBins::Block const& b, std::uint32_t const* rest) {
        if (!rest)
            return merge(b, [&](std::size_t at, std::uint32_t i) { pixels[at] = b.color[i]; });
        merge(b, [&](std::size_t at, std::uint32_t i) {
            std::uint32_t* const p = pixels + 4 * at;
            p[0] = b.color[i];
            for (std::size_t k = 0; k < 3; ++k) p[k + 1] = rest[k * FragmentBins::kRow + i];
        });
    });
    return passed;
}

} // namespace tessemu
