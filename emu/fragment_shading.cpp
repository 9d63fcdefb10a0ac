// SPDX-License-Identifier: Apache-2.0
#include "emu/fragment_shading.h"

#include <bit>

namespace tessemu {

void FragmentShading::bind(RasterSetup const& setup, TileGrid const& tiles)
{
    setup_ = &setup;
    tiles_ = tiles;
    pitch_ = int(setup.target.depth->pitch());
    wide_color_ = setup.target.color[0]->format() == Format::R32G32B32A32_FLOAT;
    modes_ = setup.pixel_shader->info().interpolation;
    attributes_ = setup.pixel_shader->input_floats();
    attribute_storage_.resize(std::size_t(attributes_) * kRow);
    std::fill_n(zeros_, kRow, 0);
    std::fill_n(ones_, kRow, 1);
    attribute_rows_.clear();
    for (std::size_t k = 0; k < std::size_t(attributes_); ++k)
        attribute_rows_.push_back(attribute(k));
    for (int k = 0; k < 4; ++k) color_rows_[k] = color_[k];
}

void FragmentShading::begin(FragmentBins& bins)
{
    bins_ = &bins;
    bins.reset(tiles_.size(), wide_color_);
}

void FragmentShading::shade()
{
    if (waiting_ == 0) return;
    FragmentBatch batch{};
    batch.count = waiting_;
    for (int k = 0; k < 4; ++k) batch.position[k] = position[k];
    batch.attributes = attribute_rows_.data();
    batch.primitive_id = primitive_id;
    batch.front_face = front_face;
    batch.sample_index = zeros_;
    batch.coverage = ones_;
    batch.color = color_rows_;
    setup_->pixel_shader.run_uncounted(batch);

    using F = Lanes<N>;
    using I = IntLanes<N>;
    Viewport const& viewport = setup_->target.viewports[0];
    I const shift(kTileShift), pitch(pitch_), columns(tiles_.columns), first(tiles_.number(0, 0));
    bool const wide_color = wide_color_;
    for (std::size_t q = 0, shaded = waiting_; q < shaded; q += std::size_t(N)) {
        int const n = int(std::min(std::size_t(N), shaded - q));
        I const depth = depth_code(viewport, F::load(position[2] + q));
        I const px = load_lanes<N>(x + q), py = load_lanes<N>(y + q);
        I const texel = py * pitch + px;
        I const tiles = (py >> shift) * columns + (px >> shift) + first;
        I color[4];
        if (wide_color) {
            for (int k = 0; k < 4; ++k) {
                F const c = F::load(color_[k] + q);
                color[k] = select(c == c, I(I::Raw(c.raw)), I(kCanonicalNan));
            }
        } else {
            color[0] = I(0);
            for (int k = 0; k < 4; ++k)
                color[0] = color[0] | (unorm8_from_float(F::load(color_[k] + q)) << I(8 * k));
        }
        std::uint32_t rest = Mask<N>::first(n).bits();
        if (((tiles == I(tiles.raw[0])).bits() & rest) == rest) {
            bins_->append(std::size_t(tiles.raw[0]), n, texel, depth, color);
            continue;
        }
        while (rest) {
            std::int32_t const t = tiles.raw[std::countr_zero(rest)];
            std::uint32_t const here = (tiles == I(t)).bits() & rest;
            I some[4];
            for (int k = 0; k < (wide_color ? 4 : 1); ++k) some[k] = compress(color[k], here);
            bins_->append(std::size_t(t), std::popcount(here), compress(texel, here),
                          compress(depth, here), some);
            rest &= ~here;
        }
    }
    waiting_ = 0;
}

} // namespace tessemu
