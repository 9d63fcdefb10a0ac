// SPDX-License-Identifier: Apache-2.0
#include "emu/rasterizer.h"

#include <bit>
#include <cassert>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace tessemu {

namespace {

// A value for each pixel of a quad: left top, right top, left bottom, right bottom.
typedef std::int64_t I64x4 __attribute__((vector_size(32)));

// Bit l: lane l is negative.
std::uint32_t sign_bits(I64x4 v)
{
#if defined(__AVX__)
    return std::uint32_t(_mm256_movemask_pd(__m256d(v)));
#else
    std::uint32_t bits = 0;
    for (int l = 0; l < 4; ++l) bits |= std::uint32_t(v[l] < 0) << l;
    return bits;
#endif
}

// An oriented edge function, positive inside; samples on it belong to top and left edges (R102).
struct Edge {
    std::int64_t dx = 0, dy = 0, at_origin = 0;
    bool top_left = false;

    Edge() = default;
    // From a to b, clockwise on the screen.
    Edge(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by)
        : dx(bx - ax),
          dy(by - ay),
          at_origin(dy * ax - dx * ay),
          top_left(dy < 0 || (dy == 0 && dx > 0))
    {
    }
    std::int64_t operator()(std::int64_t x, std::int64_t y) const
    {
        return dx * y - dy * x + at_origin;
    }
};

std::int64_t round_half_up(double v)
{
    return std::int64_t(__builtin_floor(v + 0.5));
}

// Calls f with the number of each bit that is set, ascending.
void for_each_bit(std::uint32_t bits, auto const& f)
{
    for (; bits; bits &= bits - 1) f(std::countr_zero(bits));
}

// Does a line, going from its start to its end, leave the diamond |x| + |y| < 1/2 about a pixel's
// centre (R106)? The half-open diamond is convex: it is left where the segment meets it and the end
// lies outside. Constraints s_x x + s_y y < or <= 128 in 1/256 pixel about the centre.
bool leaves_diamond(std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1)
{
    constexpr std::int64_t kHalf = 128;
    std::int64_t const dx = x1 - x0, dy = y1 - y0;
    bool const y_major = (dy < 0 ? -dy : dy) > (dx < 0 ? -dx : dx);
    auto const contains = [&](std::int64_t x, std::int64_t y) {
        if (y_major && x == kHalf && y == 0) return true; // the right corner
        return x + y <= kHalf && -x + y <= kHalf && x - y < kHalf && -x - y < kHalf;
    };
    if (contains(x1, y1)) return false;
    if (contains(x0, y0)) return true;
    if (y_major) { // does it pass through the right corner?
        std::int64_t const cross = dx * (0 - y0) - dy * (kHalf - x0);
        std::int64_t const along = dx * (kHalf - x0) + dy * (0 - y0);
        if (cross == 0 && along >= 0 && along <= dx * dx + dy * dy) return true;
    }
    // t in [low, high], each a fraction n/d with d > 0, open or closed.
    struct Bound {
        std::int64_t n, d;
        bool open;
    };
    Bound low{0, 1, false}, high{1, 1, false};
    static constexpr struct {
        std::int64_t sx, sy;
        bool open;
    } kSides[] = {{1, 1, false}, {-1, 1, false}, {1, -1, true}, {-1, -1, true}};
    for (auto const& side : kSides) {
        std::int64_t const room = kHalf - (side.sx * x0 + side.sy * y0);
        std::int64_t const slope = side.sx * dx + side.sy * dy; // slope * t < or <= room
        if (slope == 0) {
            if (room < 0 || (room == 0 && side.open)) return false;
            continue;
        }
        if (slope > 0) {
            std::int64_t const order = room * high.d - high.n * slope;
            if (order < 0 || (order == 0 && side.open)) high = {room, slope, side.open};
        } else {
            std::int64_t const order = -room * low.d - low.n * -slope;
            if (order > 0 || (order == 0 && side.open)) low = {-room, -slope, side.open};
        }
    }
    std::int64_t const gap = high.n * low.d - low.n * high.d;
    return gap > 0 || (gap == 0 && !low.open && !high.open);
}

} // namespace

// The convex area that a primitive covers.
template <int kEdges> struct TileRasterizer::Area {
    Edge edge[kEdges];
};

// Interpolation over a primitive: attribute = a0 + b1 (a1 - a0) + b2 (a2 - a0), where b1 and b2 are
// exact linear forms times a reciprocal.
struct TileRasterizer::Weights {
    AssembledVertices const& vertices;
    AssembledPrimitive const& primitive;
    Edge form[2]; ///< value at (x, y), as an edge function
    float inverse = 0;
    float z0, dz1, dz2, w0, dw1, dw2, w1, w2;

    Weights(AssembledVertices const& vs, AssembledPrimitive const& p) : vertices(vs), primitive(p)
    {
        auto const& [a, b, c] = p.v;
        z0 = vs.z[a] + p.depth_bias;
        dz1 = (vs.z[b] + p.depth_bias) - z0;
        dz2 = (vs.z[c] + p.depth_bias) - z0;
        w0 = vs.inverse_w[a], w1 = vs.inverse_w[b], w2 = vs.inverse_w[c];
        dw1 = w1 - w0, dw2 = w2 - w0;
    }

    struct At {
        float b1, b2;
    };
    At at(std::int64_t x, std::int64_t y) const
    {
        return {float(form[0](x, y)) * inverse, float(form[1](x, y)) * inverse};
    }
    float z(At b) const { return z0 + (b.b1 * dz1 + b.b2 * dz2); }
    float w(At b) const { return 1.0f / (w0 + (b.b1 * dw1 + b.b2 * dw2)); }
    /// Weights of a/w times w (R120).
    At perspective(At b) const
    {
        float const w_here = w(b);
        return {b.b1 * w1 * w_here, b.b2 * w2 * w_here};
    }
    float attribute(At b, int component) const
    {
        float const a0 = vertices.component(primitive.v[0], component);
        float const da1 = vertices.component(primitive.v[1], component) - a0;
        float const da2 = vertices.component(primitive.v[2], component) - a0;
        return a0 + (b.b1 * da1 + b.b2 * da2);
    }
};

Rect primitive_bounds(AssembledVertices const& vs, AssembledPrimitive const& p, int samples,
                      bool multisample_lines)
{
    auto const& [a, b, c] = p.v;
    if (p.vertices == 3 && samples == 1)
        return pixel_bounds({vs.x[a], vs.x[b], vs.x[c]}, {vs.y[a], vs.y[b], vs.y[c]});
    std::int32_t const grow = p.vertices == 3   ? 0
                              : p.vertices == 2 ? (multisample_lines ? 256 : 128)
                                                : 128;
    return {(std::min({vs.x[a], vs.x[b], vs.x[c]}) - grow) >> 8,
            (std::min({vs.y[a], vs.y[b], vs.y[c]}) - grow) >> 8,
            ((std::max({vs.x[a], vs.x[b], vs.x[c]}) + grow) >> 8) + 1,
            ((std::max({vs.y[a], vs.y[b], vs.y[c]}) + grow) >> 8) + 1};
}

TileRasterizer::TileRasterizer(RasterSetup const& setup, Rect tile, RasterCounters& counters)
    : setup_(setup),
      tile_(tile),
      counters_(counters),
      merger_(setup.target),
      pattern_(sample_pattern(setup.target.samples())),
      sample_mask_(setup.target.blend.sample_mask)
{
    if (setup.pixel_shader) info_ = setup.pixel_shader->info();
    // R131: early where nobody can tell.
    early_ = info_.force_early || !(info_.writes_depth || info_.writes_coverage || info_.discards ||
                                    (setup.target.blend.alpha_to_coverage && setup.pixel_shader));
    quads_ = (setup.pixel_cost.features & kDerivatives) != 0;
    attributes_.resize(info_.interpolation.size() * kRow);
    for (std::size_t k = 0; k < info_.interpolation.size(); ++k)
        attribute_rows_.push_back(attributes_.data() + k * kRow);
    color_.resize(std::size_t(info_.color_targets) * 4 * kRow);
    for (std::size_t k = 0; k < std::size_t(info_.color_targets) * 4; ++k)
        color_rows_.push_back(color_.data() + k * kRow);
    sample_z_.resize(pattern_.size() * kRow);
}

void TileRasterizer::draw(AssembledVertices const& vs, AssembledPrimitive const& p)
{
    bool const wide_lines = setup_.target.rasterizer.multisample_enable;
    Rect const pixels = primitive_bounds(vs, p, int(pattern_.size()), wide_lines)
                            .intersect(tile_)
                            .intersect(setup_.bounds[p.viewport]);
    if (pixels.empty()) return;
    auto const& [a, b, c] = p.v;
    std::int64_t const x[3] = {vs.x[a], vs.x[b], vs.x[c]}, y[3] = {vs.y[a], vs.y[b], vs.y[c]};
    Weights weights(vs, p);
    if (p.vertices == 3) {
        Area<3> area; // edge i lies opposite vertex i
        for (std::size_t i = 0; i < 3; ++i) {
            std::size_t const j = (i + 1) % 3, k = (i + 2) % 3;
            area.edge[i] = {x[j], y[j], x[k], y[k]};
        }
        weights.form[0] = area.edge[1];
        weights.form[1] = area.edge[2];
        weights.inverse = 1.0f / float(area.edge[0](x[0], y[0]));
        return draw_area(area, weights, pixels);
    }
    if (p.vertices == 1) { // a square of one pixel (R108)
        std::int64_t const l = x[0] - 128, r = x[0] + 128, t = y[0] - 128, m = y[0] + 128;
        return draw_area(Area<4>{{{l, t, r, t}, {r, t, r, m}, {r, m, l, m}, {l, m, l, t}}}, weights,
                         pixels);
    }
    std::int64_t const dx = x[1] - x[0], dy = y[1] - y[0];
    if (dx == 0 && dy == 0) return;
    // Along the line: b1 = ((p - p0) . d) / |d|^2.
    weights.form[0].dx = dy;
    weights.form[0].dy = -dx;
    weights.form[0].at_origin = -(dx * x[0] + dy * y[0]);
    weights.inverse = 1.0f / float(dx * dx + dy * dy);
    if (!wide_lines) return draw_line(weights, vs, p, pixels);
    // A rectangle 1.4 pixels wide (R107).
    double const half = 0.7 * 256 / __builtin_sqrt(double(dx * dx + dy * dy));
    std::int64_t const nx = round_half_up(double(dy) * half),
                       ny = round_half_up(-double(dx) * half);
    std::int64_t const cx[4] = {x[0] + nx, x[1] + nx, x[1] - nx, x[0] - nx};
    std::int64_t const cy[4] = {y[0] + ny, y[1] + ny, y[1] - ny, y[0] - ny};
    Area<4> area;
    for (std::size_t i = 0; i < 4; ++i)
        area.edge[i] = {cx[i], cy[i], cx[(i + 1) % 4], cy[(i + 1) % 4]};
    draw_area(area, weights, pixels);
}

template <int kEdges>
void TileRasterizer::draw_area(Area<kEdges> const& area, Weights const& weights, Rect pixels)
{
    constexpr std::uint32_t kTop = 0b0011, kBottom = 0b1100, kLeft = 0b0101, kRight = 0b1010;
    int const samples = int(pattern_.size()), left = pixels.left & ~1, top = pixels.top & ~1;
    I64x4 row[kEdges];                 // edge functions at the centres of the row's first quad
    std::int64_t at_sample[kEdges][8]; // what a sample's offset adds
    for (int i = 0; i < kEdges; ++i) {
        Edge const& e = area.edge[i];
        int const least = e.top_left || setup_.inclusive_edges ? 0 : 1;
        std::int64_t const first = e(left * 256 + 128, top * 256 + 128) - least;
        std::int64_t const right = -256 * e.dy, down = 256 * e.dx;
        row[i] = I64x4{first, first + right, first + down, first + right + down};
        for (int s = 0; s < samples; ++s) {
            SampleOffset const o = pattern_[std::size_t(s)];
            at_sample[i][s] = 16 * (e.dx * o.y - e.dy * o.x);
        }
    }
    for (int y = top; y < pixels.bottom; y += 2) {
        std::uint32_t const rows =
            (y >= pixels.top ? kTop : 0) | (y + 1 < pixels.bottom ? kBottom : 0);
        I64x4 centre[kEdges];
        for (int i = 0; i < kEdges; ++i) {
            centre[i] = row[i];
            row[i] += 512 * area.edge[i].dx;
        }
        for (int x = left; x < pixels.right; x += 2) {
            std::uint32_t const bounded =
                rows & ((x >= pixels.left ? kLeft : 0) | (x + 1 < pixels.right ? kRight : 0));
            std::uint32_t covered[4] = {}, any = 0;
            for (int s = 0; s < samples; ++s) {
                I64x4 outside{};
                for (int i = 0; i < kEdges; ++i) outside |= centre[i] + at_sample[i][s];
                std::uint32_t const in = ~sign_bits(outside) & bounded;
                any |= in;
                for_each_bit(in, [&](int l) { covered[l] |= 1u << s; });
            }
            for (int i = 0; i < kEdges; ++i) centre[i] -= 512 * area.edge[i].dy;
            if (any) draw_quad(weights, x, y, covered);
        }
    }
}

void TileRasterizer::draw_line(Weights const& weights, AssembledVertices const& vs,
                               AssembledPrimitive const& p, Rect pixels)
{
    std::int64_t const x0 = vs.x[p.v[0]], y0 = vs.y[p.v[0]], x1 = vs.x[p.v[1]], y1 = vs.y[p.v[1]];
    std::uint32_t const all = (1u << pattern_.size()) - 1;
    auto const quad = [&](int x, int y) {
        std::uint32_t covered[4] = {};
        bool any = false;
        for (int l = 0; l < 4; ++l) {
            int const px = x + (l & 1), py = y + (l >> 1);
            if (px < pixels.left || px >= pixels.right || py < pixels.top || py >= pixels.bottom)
                continue;
            std::int64_t const cx = std::int64_t(px) * 256 + 128, cy = std::int64_t(py) * 256 + 128;
            if (leaves_diamond(x0 - cx, y0 - cy, x1 - cx, y1 - cy)) covered[l] = all, any = true;
        }
        if (any) draw_quad(weights, x, y, covered);
    };
    // Quads that the line passes, column by column, or row by row where it is steeper.
    std::int64_t const dx = x1 - x0, dy = y1 - y0;
    bool const steep = (dy < 0 ? -dy : dy) > (dx < 0 ? -dx : dx);
    int const first = (steep ? pixels.top : pixels.left) & ~1,
              end = steep ? pixels.bottom : pixels.right;
    int const other_first = (steep ? pixels.left : pixels.top) & ~1,
              other_end = steep ? pixels.right : pixels.bottom;
    double const slope = steep ? double(dx) / double(dy) : double(dy) / double(dx);
    double const m0 = double(steep ? y0 : x0), o0 = double(steep ? x0 : y0);
    for (int m = first; m < end; m += 2) {
        double const from = o0 + (m * 256.0 - m0) * slope, to = o0 + ((m + 2) * 256.0 - m0) * slope;
        int const low = std::max(other_first, int(__builtin_floor(std::min(from, to) / 256)) - 1);
        int const high = std::min(other_end, int(__builtin_floor(std::max(from, to) / 256)) + 2);
        for (int o = low & ~1; o < high; o += 2) steep ? quad(o, m) : quad(m, o);
    }
}

// `covered` holds the samples of each pixel of the quad.
void TileRasterizer::draw_quad(Weights const& weights, int x, int y,
                               std::uint32_t const (&covered)[4])
{
    AssembledPrimitive const& p = weights.primitive;
    RasterTarget const& target = setup_.target;
    int const clips = setup_.layout.clip_distances;
    bool const test = early_ && merger_.depth_or_stencil();
    std::uint32_t mask[4], pass[4];
    std::uint32_t any = 0;
    std::uint64_t covered_samples = 0, passed_samples = 0;
    for (int l = 0; l < 4; ++l) {
        int const px = x + (l & 1), py = y + (l >> 1);
        auto const at = [&](int s) {
            SampleOffset const o = pattern_[std::size_t(s)];
            return weights.at(std::int64_t(px) * 256 + 128 + o.x * 16,
                              std::int64_t(py) * 256 + 128 + o.y * 16);
        };
        mask[l] = covered[l];
        if (clips) { // R93
            int const first = setup_.layout.floats - setup_.layout.cull_distances - clips;
            for_each_bit(covered[l], [&](int s) {
                auto const here = weights.perspective(at(s));
                for (int k = first; k < first + clips; ++k)
                    if (!(weights.attribute(here, k) >= 0)) mask[l] &= ~(1u << s);
            });
        }
        if (target.coverage)
            for_each_bit(mask[l], [&](int s) { target.coverage->add(px, py, s, p.front_face); });
        mask[l] &= sample_mask_;
        pass[l] = mask[l];
        if (test)
            for_each_bit(mask[l], [&](int s) {
                if (!merger_.test(px, py, s, weights.z(at(s)), p.front_face,
                                  target.viewports[p.viewport]))
                    pass[l] &= ~(1u << s);
            });
        covered_samples += std::uint64_t(std::popcount(mask[l]));
        passed_samples += std::uint64_t(std::popcount(pass[l]));
        any |= pass[l];
    }
    counters_.covered_samples += covered_samples;
    if (early_) counters_.passed_samples += passed_samples;
    if (!any || !setup_.pixel_shader) return;
    if (!info_.sample_frequency) {
        for (int l = 0; l < 4; ++l)
            if (quads_ || pass[l])
                push(weights, x + (l & 1), y + (l >> 1), -1, mask[l], pass[l], pass[l] != 0);
    } else {
        for_each_bit(any, [&](int s) {
            for (int l = 0; l < 4; ++l)
                if (quads_ || (pass[l] >> s & 1))
                    push(weights, x + (l & 1), y + (l >> 1), s, mask[l], pass[l] & (1u << s),
                         (pass[l] >> s & 1) != 0);
            if (queued_ + 4 > kQueue) shade_and_merge();
        });
    }
    if (queued_ + 4 > kQueue) shade_and_merge();
}

// A fragment at pixel frequency (sample < 0) or of one sample.
void TileRasterizer::push(Weights const& weights, int x, int y, int sample, std::uint32_t covered,
                          std::uint32_t passed, bool live)
{
    AssembledPrimitive const& p = weights.primitive;
    std::size_t const q = queued_++;
    std::int64_t const cx = std::int64_t(x) * 256 + 128, cy = std::int64_t(y) * 256 + 128;
    SampleOffset const here = sample < 0 ? SampleOffset{0, 0} : pattern_[std::size_t(sample)];
    auto const b = weights.at(cx + here.x * 16, cy + here.y * 16);
    pixel_x_[q] = x;
    pixel_y_[q] = y;
    position_[0][q] = float(x) + 0.5f + float(here.x) * (1 / 16.0f);
    position_[1][q] = float(y) + 0.5f + float(here.y) * (1 / 16.0f);
    position_[2][q] = weights.z(b);
    position_[3][q] = weights.w(b);
    primitive_id_[q] = p.primitive_id;
    front_face_[q] = p.front_face ? -1 : 0;
    sample_index_[q] = std::max(0, sample);
    covered_[q] = std::int32_t(covered);
    passed_[q] = std::int32_t(passed);
    live_[q] = live ? -1 : 0;
    viewport_[q] = p.viewport;

    // R117: the centre where all samples are covered, else the first covered one; a helper takes
    // the mask's first sample if the mask is partial.
    auto centroid = b;
    std::uint32_t const all = (1u << pattern_.size()) - 1;
    if (sample < 0 && covered != all) {
        std::uint32_t const from = covered ? covered : sample_mask_ & all;
        if (covered || from != all) {
            SampleOffset const o =
                from ? pattern_[std::size_t(std::countr_zero(from))] : SampleOffset{0, 0};
            centroid = weights.at(cx + o.x * 16, cy + o.y * 16);
        }
    }
    auto const persp = weights.perspective(b);
    auto const persp_centroid = weights.perspective(centroid);
    for (std::size_t k = 0; k < info_.interpolation.size(); ++k) {
        int const component = int(k) + 4;
        float v;
        switch (info_.interpolation[k]) {
        case Interpolation::Constant:
            v = weights.vertices.component(p.leading, component);
            break;
        case Interpolation::LinearNoperspective:
        case Interpolation::LinearNoperspectiveSample:
            v = weights.attribute(b, component);
            break;
        case Interpolation::LinearCentroid:
            v = weights.attribute(persp_centroid, component);
            break;
        case Interpolation::LinearNoperspectiveCentroid:
            v = weights.attribute(centroid, component);
            break;
        default:
            v = weights.attribute(persp, component);
        }
        attributes_[k * kRow + q] = v;
    }
    if (!early_)
        for (std::size_t s = 0; s < pattern_.size(); ++s)
            sample_z_[s * kRow + q] =
                weights.z(weights.at(cx + pattern_[s].x * 16, cy + pattern_[s].y * 16));
}

void TileRasterizer::shade_and_merge()
{
    if (queued_ == 0) return;
    FragmentBatch batch{};
    batch.count = queued_;
    for (int k = 0; k < 4; ++k) batch.position[k] = position_[k];
    batch.attributes = attribute_rows_.data();
    batch.primitive_id = primitive_id_;
    batch.front_face = front_face_;
    batch.sample_index = sample_index_;
    batch.coverage = covered_;
    batch.viewport_index = viewport_;
    batch.live = quads_ ? live_ : nullptr;
    batch.color = color_rows_.data();
    batch.depth = depth_;
    batch.out_coverage = out_coverage_;
    batch.discard = discard_;
    setup_.pixel_shader.run(batch, counters_.pixel, setup_.buffers);

    RasterTarget const& target = setup_.target;
    int const colors = info_.color_targets;
    for (std::size_t q = 0; q < queued_; ++q) {
        if (!live_[q] || (info_.discards && discard_[q])) continue;
        float color[4 * kMaxRenderTargets];
        for (int k = 0; k < 4 * colors; ++k) color[k] = color_rows_[std::size_t(k)][q];
        auto mask = std::uint32_t(passed_[q]);
        if (info_.writes_coverage)
            mask &= std::uint32_t(out_coverage_[q]);
        else if (target.blend.alpha_to_coverage && colors > 0)
            mask &= alpha_to_coverage(color[3], int(pattern_.size()));
        for (; mask; mask &= mask - 1) {
            int const s = std::countr_zero(mask);
            if (!early_) {
                float const z =
                    info_.writes_depth ? depth_[q] : sample_z_[std::size_t(s) * kRow + q];
                if (!merger_.test(pixel_x_[q], pixel_y_[q], s, z, front_face_[q] != 0,
                                  target.viewports[std::size_t(viewport_[q])]))
                    continue;
                ++counters_.passed_samples;
            }
            merger_.write(pixel_x_[q], pixel_y_[q], s, color, colors);
        }
    }
    queued_ = 0;
}

void TileRasterizer::flush()
{
    shade_and_merge();
}

} // namespace tessemu
