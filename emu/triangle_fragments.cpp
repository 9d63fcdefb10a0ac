// From covered pixels to shaded fragments by tile: depth, what is hidden, attributes, pixel shader.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/triangle_stream.h"

#include <bit>

namespace tessemu {

// Covered triangles and the fragments that wait for them.
void TriangleStream::finish_covered()
{
    if (queued_ == 0) return;
    fragments_ += queued_;
    tabulate_depth();
    drop_hidden();
    if (queued_ > 0) {
        tabulate_attributes();
        interpolate();
    }
    queued_ = covered_ = 0;
}

// What says how deep a triangle's pixels are.
void TriangleStream::tabulate_depth()
{
    I const k16(16), low(0xffff), k8(8);
    for (std::size_t t = 0; t < covered_; t += std::size_t(N)) {
        Mask<N> const live = Mask<N>::first(int(std::min(std::size_t(N), covered_ - t)));
        I const v0 = load_lanes<N>(row(kPacked) + t), v1 = load_lanes<N>(row(kPacked + 1) + t),
                v2 = load_lanes<N>(row(kPacked + 2) + t);
        I const x0 = v0 & low, x1 = v1 & low, x2 = v2 & low;
        I const y0 = v0 >> k16, y1 = v1 >> k16, y2 = v2 >> k16;
        // Edge functions over pixel numbers, exact modulo 2^32; inside the triangle they lie
        // between 0 and its area, which fits. Edge 1 runs from vertex 2 to 0, edge 2 from 0 to 1.
        auto const edge = [&](int r, I ax, I ay, I bx, I by) {
            I const dx = bx - ax, dy = by - ay;
            store_lanes(I(0) - (dy << k8), row(r) + t);
            store_lanes(dx << k8, row(r + 1) + t);
            store_lanes(dx * (I(128) - ay) - dy * (I(128) - ax), row(r + 2) + t);
        };
        edge(kA1, x2, y2, x0, y0);
        edge(kA2, x0, y0, x1, y1);
        I const area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
        (F(1.0f) / F(area)).store(float_row(kInverse) + t);
        I const tag = select(live, load_lanes<N>(row(kTag) + t), I(0));
        Mask<N> const exchanged = (tag & I(1)) != I(0);
        Mask<N> const front = assembler_->front_is_clockwise() ? !exchanged : exchanged;
        store_lanes(I(I::Raw(front.raw)), row(kFront) + t);
        auto const corner = [&](std::size_t k) {
            return gather(reinterpret_cast<std::int32_t const*>(pattern_->corner[k].data()),
                          tag >> I(1));
        };
        I const c1 = corner(1), c2 = corner(2);
        I const id[3] = {corner(0), select(exchanged, c2, c1), select(exchanged, c1, c2)};
        for (int k = 0; k < 3; ++k) store_lanes(id[k], row(kCorner + k) + t);
        float const* const z = vertices_->z.data();
        store_differences(kZ, {gather(z, id[0]), gather(z, id[1]), gather(z, id[2])}, t);
    }
}

inline void TriangleStream::store_differences(int r, std::array<F, 3> const& corner, std::size_t t)
{
    corner[0].store(float_row(r) + t);
    (corner[1] - corner[0]).store(float_row(r + 1) + t);
    (corner[2] - corner[0]).store(float_row(r + 2) + t);
}

// As the target holds it, clamped to the viewport (R135).
inline TriangleStream::I TriangleStream::depth_code(F z) const
{
    Viewport const& viewport = setup_->target.viewports[0];
    F const low(viewport.min_depth), high(viewport.max_depth);
    F const clamped = select(z >= low, select(z <= high, z, high), low);
    return I(I::Raw(clamped.raw)) & I(0x7fffffff);
}

// Fragments that fail against the depth target as waves before this one have left it, and triangles
// without any other.
void TriangleStream::drop_hidden()
{
    bool const or_equal = setup_->target.depth_stencil.depth_func == Comparison::LessEqual;
    I const pitch(pitch_), slack(or_equal ? 1 : 0); // codes of depths are whole numbers from 0 on
    std::size_t kept = 0;
    for (std::size_t q = 0, queued = queued_; q < queued; q += std::size_t(N)) {
        Mask<N> const live = Mask<N>::first(int(std::min(std::size_t(N), queued - q)));
        I const owner = load_words<N>(queue_owner_ + q), place = load_words<N>(queue_place_ + q);
        std::int32_t const first = owner.raw[0];
        Columns const of{table_.data() + first, select(live, owner - I(first), I(0))};
        I const pixel = of.ints(kBox) + (((place >> I(6)) << I(16)) | (place & I(63)));
        I const x = pixel & I(0xffff), y = pixel >> I(16);
        I const e1 = of.ints(kA1) * x + of.ints(kB1) * y + of.ints(kC1);
        I const e2 = of.ints(kA2) * x + of.ints(kB2) * y + of.ints(kC2);
        F const inverse = of.floats(kInverse), b1 = F(e1) * inverse, b2 = F(e2) * inverse;
        F const z = of.floats(kZ) + (b1 * of.floats(kDz1) + b2 * of.floats(kDz2));
        I const depth = gather(depths_, select(live, y * pitch + x, I(0)));
        std::uint32_t const bits = ((depth_code(z) < depth + slack) & live).bits();
        store_lanes(compress(pixel, bits), queue_pixel_ + kept);
        store_lanes(compress(owner, bits), queue_triangle_ + kept);
        compress(z, bits).store(queue_z_ + kept);
        compress(b1, bits).store(queue_b_[0] + kept);
        compress(b2, bits).store(queue_b_[1] + kept);
        kept += std::size_t(std::popcount(bits));
    }
    if (kept == queued_) return;
    queued_ = kept;
    // Numbers that are left out are closed up.
    std::int32_t last = -1, left = 0;
    std::int32_t source[kTableRow];
    for (std::size_t q = 0; q < queued_; q += std::size_t(N)) {
        std::size_t const n = std::min(std::size_t(N), queued_ - q);
        I const t = load_lanes<N>(queue_triangle_ + q);
        I before = permute(t, max(I::iota() - I(1), I(0)));
        before.raw[0] = last;
        last = t.raw[n - 1];
        std::uint32_t fresh = (t != before).bits() & ((1u << n) - 1);
        for (; fresh; fresh &= fresh - 1) {
            std::int32_t const number = t.raw[std::countr_zero(fresh)];
            number_[number] = left;
            source[left++] = number;
        }
        store_lanes(gather(number_, select(Mask<N>::first(int(n)), t, I(last))),
                    queue_triangle_ + q);
    }
    if (std::size_t(left) == covered_) return;
    covered_ = std::size_t(left);
    for (int r = kFront; r < kW; ++r)
        for (std::size_t t = 0; t < covered_; t += std::size_t(N)) {
            std::size_t const n = std::min(std::size_t(N), covered_ - t);
            I const from = select(Mask<N>::first(int(n)), load_lanes<N>(source + t), I(0));
            store_lanes(gather(row(r), from), row(r) + t);
        }
}

void TriangleStream::tabulate_attributes()
{
    AssembledVertices const& vs = *vertices_;
    for (std::size_t t = 0; t < covered_; t += std::size_t(N)) {
        Mask<N> const live = Mask<N>::first(int(std::min(std::size_t(N), covered_ - t)));
        I id[3];
        for (int k = 0; k < 3; ++k) id[k] = select(live, load_lanes<N>(row(kCorner + k) + t), I(0));
        auto const corners = [&](float const* column) {
            return std::array{gather(column, id[0]), gather(column, id[1]), gather(column, id[2])};
        };
        auto const w = corners(vs.inverse_w.data());
        store_differences(kW, w, t);
        w[1].store(float_row(kW1) + t);
        w[2].store(float_row(kW2) + t);
        for (int k = 0; k < attributes_; ++k)
            store_differences(kAttributes + 3 * k,
                              corners(vs.shaded + std::size_t(k + 4) * vs.stride), t);
    }
}

// Fragments become inputs of the pixel shader.
void TriangleStream::interpolate()
{
    I const origin_x(origin_x_), origin_y(origin_y_), id(primitive_id_);
    std::size_t const queued = queued_, attributes = std::size_t(attributes_);
    Interpolation const* const modes = modes_.data();
    float* const inputs = attribute_storage_.data();
    for (std::size_t q = 0; q < queued; q += std::size_t(N)) {
        if (shaded_ + std::size_t(N) > kShade) shade();
        std::size_t const n = std::min(std::size_t(N), queued - q), at = shaded_;
        I const triangle = load_lanes<N>(queue_triangle_ + q);
        std::int32_t const first = triangle.raw[0];
        Columns const of{table_.data() + first,
                         select(Mask<N>::first(int(n)), triangle - I(first), I(0))};
        F const b1 = F::load(queue_b_[0] + q), b2 = F::load(queue_b_[1] + q);
        F const w = F(1.0f) / (of.floats(kW) + (b1 * of.floats(kDw1) + b2 * of.floats(kDw2)));
        F const p1 = b1 * of.floats(kW1) * w, p2 = b2 * of.floats(kW2) * w;
        for (std::size_t k = 0; k < attributes; ++k) {
            int const r = kAttributes + 3 * int(k);
            F const base = of.floats(r);
            auto const linear = [&](F f1, F f2) {
                return base + (f1 * of.floats(r + 1) + f2 * of.floats(r + 2));
            };
            F const v = modes[k] == Interpolation::Constant ? base
                        : modes[k] == Interpolation::LinearNoperspective ||
                                modes[k] == Interpolation::LinearNoperspectiveCentroid
                            ? linear(b1, b2)
                            : linear(p1, p2);
            v.store(inputs + k * kShadeRow + at);
        }
        I const pixel = load_lanes<N>(queue_pixel_ + q), x = (pixel & I(0xffff)) + origin_x,
                y = (pixel >> I(16)) + origin_y;
        store_lanes(x, pixel_x_ + at);
        store_lanes(y, pixel_y_ + at);
        store_lanes(id, id_ + at);
        store_lanes(of.ints(kFront), front_ + at);
        (F(x) + F(0.5f)).store(position_[0] + at);
        (F(y) + F(0.5f)).store(position_[1] + at);
        F::load(queue_z_ + q).store(position_[2] + at);
        w.store(position_[3] + at);
        shaded_ = at + n;
    }
}

// Runs the pixel shader and sorts the results into tiles.
void TriangleStream::shade()
{
    if (shaded_ == 0) return;
    FragmentBatch batch{};
    batch.count = shaded_;
    for (int k = 0; k < 4; ++k) batch.position[k] = position_[k];
    batch.attributes = attribute_rows_.data();
    batch.primitive_id = id_;
    batch.front_face = front_;
    batch.sample_index = zeros_;
    batch.coverage = ones_;
    batch.color = color_rows_;
    setup_->pixel_shader.run_uncounted(batch);

    I const shift(kTileShift), pitch(pitch_), columns(tiles_.columns), first(tiles_.number(0, 0));
    bool const wide_color = wide_color_;
    for (std::size_t q = 0, shaded = shaded_; q < shaded; q += std::size_t(N)) {
        int const n = int(std::min(std::size_t(N), shaded - q));
        I const depth = depth_code(F::load(position_[2] + q));
        I const x = load_lanes<N>(pixel_x_ + q), y = load_lanes<N>(pixel_y_ + q);
        I const texel = y * pitch + x;
        I const tiles = (y >> shift) * columns + (x >> shift) + first;
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
    shaded_ = 0;
}

void TriangleStream::end()
{
    shade();
}

} // namespace tessemu
