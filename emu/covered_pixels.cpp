// SPDX-License-Identifier: Apache-2.0
#include "emu/covered_pixels.h"

#include <bit>

namespace tessemu {

void CoveredPixels::bind(RasterSetup const& setup, bool front_is_clockwise)
{
    setup_ = &setup;
    front_is_clockwise_ = front_is_clockwise;
    pitch_ = int(setup.target.depth->pitch());
    table_.resize((std::size_t(kAttributes) + 3 * std::size_t(shading_.attributes())) * kTableRow);
}

void CoveredPixels::finish()
{
    if (pixels == 0) return;
    fragments_ += pixels;
    tabulate_depth();
    drop_hidden();
    if (pixels > 0) {
        tabulate_attributes();
        interpolate();
    }
    pixels = triangles = 0;
}

// What says how deep a triangle's pixels are.
void CoveredPixels::tabulate_depth()
{
    I const k16(16), low(0xffff), k8(8);
    for (std::size_t t = 0; t < triangles; t += std::size_t(N)) {
        Mask<N> const live = Mask<N>::first(int(std::min(std::size_t(N), triangles - t)));
        I const v0 = load_lanes<N>(row(kPosition) + t), v1 = load_lanes<N>(row(kPosition + 1) + t),
                v2 = load_lanes<N>(row(kPosition + 2) + t);
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
        Mask<N> const front = front_is_clockwise_ ? !exchanged : exchanged;
        store_lanes(I(I::Raw(front.raw)), row(kFront) + t);
        auto const corner = [&](std::size_t k) {
            return gather(reinterpret_cast<std::int32_t const*>(patch_->pattern->corner[k].data()),
                          tag >> I(1));
        };
        I const c1 = corner(1), c2 = corner(2);
        I const id[3] = {corner(0), select(exchanged, c2, c1), select(exchanged, c1, c2)};
        for (int k = 0; k < 3; ++k) store_lanes(id[k], row(kCorner + k) + t);
        float const* const z = patch_->vertices->z.data();
        store_differences(kZ, {gather(z, id[0]), gather(z, id[1]), gather(z, id[2])}, t);
    }
}

inline void CoveredPixels::store_differences(int r, std::array<F, 3> const& corner, std::size_t t)
{
    corner[0].store(float_row(r) + t);
    (corner[1] - corner[0]).store(float_row(r + 1) + t);
    (corner[2] - corner[0]).store(float_row(r + 2) + t);
}

// Fragments that fail against the depth target as waves before this one have left it, and triangles
// without any other.
void CoveredPixels::drop_hidden()
{
    bool const or_equal = setup_->target.depth_stencil.depth_func == Comparison::LessEqual;
    I const pitch(pitch_), slack(or_equal ? 1 : 0); // codes of depths are whole numbers from 0 on
    Viewport const& viewport = setup_->target.viewports[0];
    std::int32_t const* const depths = patch_->depths;
    std::size_t kept = 0;
    for (std::size_t q = 0, queued = pixels; q < queued; q += std::size_t(N)) {
        Mask<N> const live = Mask<N>::first(int(std::min(std::size_t(N), queued - q)));
        I const number = load_words<N>(owner + q), in_box = load_words<N>(place + q);
        std::int32_t const first = number.raw[0];
        Columns const of{table_.data() + first, select(live, number - I(first), I(0))};
        I const pixel = of.ints(kBox) + (((in_box >> I(6)) << I(16)) | (in_box & I(63)));
        I const x = pixel & I(0xffff), y = pixel >> I(16);
        I const e1 = of.ints(kA1) * x + of.ints(kB1) * y + of.ints(kC1);
        I const e2 = of.ints(kA2) * x + of.ints(kB2) * y + of.ints(kC2);
        F const inverse = of.floats(kInverse), b1 = F(e1) * inverse, b2 = F(e2) * inverse;
        F const z = of.floats(kZ) + (b1 * of.floats(kDz1) + b2 * of.floats(kDz2));
        I const depth = gather(depths, select(live, y * pitch + x, I(0)));
        std::uint32_t const bits = ((depth_code(viewport, z) < depth + slack) & live).bits();
        store_lanes(compress(pixel, bits), pixel_ + kept);
        store_lanes(compress(number, bits), triangle_ + kept);
        compress(z, bits).store(z_ + kept);
        compress(b1, bits).store(b_[0] + kept);
        compress(b2, bits).store(b_[1] + kept);
        kept += std::size_t(std::popcount(bits));
    }
    if (kept == pixels) return;
    pixels = kept;
    // Numbers that are left out are closed up.
    std::int32_t last = -1, left = 0;
    std::int32_t source[kTableRow];
    for (std::size_t q = 0; q < pixels; q += std::size_t(N)) {
        std::size_t const n = std::min(std::size_t(N), pixels - q);
        I const t = load_lanes<N>(triangle_ + q);
        I before = permute(t, max(I::iota() - I(1), I(0)));
        before.raw[0] = last;
        last = t.raw[n - 1];
        std::uint32_t fresh = (t != before).bits() & ((1u << n) - 1);
        for (; fresh; fresh &= fresh - 1) {
            std::int32_t const number = t.raw[std::countr_zero(fresh)];
            number_[number] = left;
            source[left++] = number;
        }
        store_lanes(gather(number_, select(Mask<N>::first(int(n)), t, I(last))), triangle_ + q);
    }
    if (std::size_t(left) == triangles) return;
    triangles = std::size_t(left);
    for (int r = kFront; r < kW; ++r)
        for (std::size_t t = 0; t < triangles; t += std::size_t(N)) {
            std::size_t const n = std::min(std::size_t(N), triangles - t);
            I const from = select(Mask<N>::first(int(n)), load_lanes<N>(source + t), I(0));
            store_lanes(gather(row(r), from), row(r) + t);
        }
}

void CoveredPixels::tabulate_attributes()
{
    AssembledVertices const& vs = *patch_->vertices;
    for (std::size_t t = 0; t < triangles; t += std::size_t(N)) {
        Mask<N> const live = Mask<N>::first(int(std::min(std::size_t(N), triangles - t)));
        I id[3];
        for (int k = 0; k < 3; ++k) id[k] = select(live, load_lanes<N>(row(kCorner + k) + t), I(0));
        auto const corners = [&](float const* column) {
            return std::array{gather(column, id[0]), gather(column, id[1]), gather(column, id[2])};
        };
        auto const w = corners(vs.inverse_w.data());
        store_differences(kW, w, t);
        w[1].store(float_row(kW1) + t);
        w[2].store(float_row(kW2) + t);
        for (int k = 0; k < shading_.attributes(); ++k)
            store_differences(kAttributes + 3 * k,
                              corners(vs.shaded + std::size_t(k + 4) * vs.stride), t);
    }
}

// Pixels become inputs of the pixel shader.
void CoveredPixels::interpolate()
{
    FragmentShading& out = shading_;
    I const origin_x(patch_->origin_x), origin_y(patch_->origin_y), id(patch_->primitive_id);
    std::size_t const queued = pixels, attributes = std::size_t(out.attributes());
    Interpolation const* const modes = out.modes().data();
    float* const inputs = out.attribute(0);
    for (std::size_t q = 0; q < queued; q += std::size_t(N)) {
        std::size_t const n = std::min(std::size_t(N), queued - q), at = out.room(std::size_t(N));
        I const triangle = load_lanes<N>(triangle_ + q);
        std::int32_t const first = triangle.raw[0];
        Columns const of{table_.data() + first,
                         select(Mask<N>::first(int(n)), triangle - I(first), I(0))};
        F const b1 = F::load(b_[0] + q), b2 = F::load(b_[1] + q);
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
            v.store(inputs + k * FragmentShading::kRow + at);
        }
        I const pixel = load_lanes<N>(pixel_ + q), x = (pixel & I(0xffff)) + origin_x,
                y = (pixel >> I(16)) + origin_y;
        store_lanes(x, out.x + at);
        store_lanes(y, out.y + at);
        store_lanes(id, out.primitive_id + at);
        store_lanes(of.ints(kFront), out.front_face + at);
        (F(x) + F(0.5f)).store(out.position[0] + at);
        (F(y) + F(0.5f)).store(out.position[1] + at);
        F::load(z_ + q).store(out.position[2] + at);
        w.store(out.position[3] + at);
        out.add(n);
    }
}

} // namespace tessemu
