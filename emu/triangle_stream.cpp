// SPDX-License-Identifier: Apache-2.0
#include "emu/triangle_stream.h"

#include <array>
#include <bit>

namespace tessemu {

bool TriangleStream::supports(RasterSetup const& setup, bool triangles)
{
    RasterTarget const& t = setup.target;
    if (!triangles || !setup.pixel_shader || t.samples() != 1 || t.coverage ||
        setup.inclusive_edges || t.color.size() != 1 || !t.color[0] || !t.depth ||
        t.viewports.size() != 1)
        return false;
    PixelShaderInfo const& ps = setup.pixel_shader->info();
    bool const pure = setup.pixel_cost.features == 0 && !ps.writes_depth && !ps.writes_coverage &&
                      !ps.discards && !ps.sample_frequency && ps.color_targets == 1;
    RasterizerState const& r = t.rasterizer;
    bool const plain = r.fill == FillMode::Solid && r.depth_bias == 0 &&
                       r.slope_scaled_depth_bias == 0 && setup.layout.clip_distances == 0 &&
                       setup.layout.cull_distances == 0;
    DepthStencilState const& d = t.depth_stencil;
    bool const depth = d.depth_enable && d.depth_write && !t.depth_read_only && !d.stencil_enable &&
                       t.depth->format() == Format::D32_FLOAT &&
                       (d.depth_func == Comparison::Less || d.depth_func == Comparison::LessEqual);
    BlendState const& b = t.blend;
    Format const f = t.color[0]->format();
    bool const overwritten = !b.alpha_to_coverage && !b.target[0].enable &&
                             b.target[0].write_mask == 0xf && (b.sample_mask & 1);
    return pure && plain && depth && overwritten &&
           (f == Format::R8G8B8A8_UNORM || f == Format::R32G32B32A32_FLOAT);
}

void TriangleStream::bind(RasterSetup const& setup, PrimitiveAssembler const& assembler,
                          TileGrid const& tiles)
{
    setup_ = &setup;
    assembler_ = &assembler;
    tiles_ = tiles;
    pitch_ = int(setup.target.depth->pitch());
    attributes_ = setup.pixel_shader->input_floats();
    bounds_ = setup.bounds[0];
    wide_color_ = setup.target.color[0]->format() == Format::R32G32B32A32_FLOAT;
    CullMode const cull = assembler.state().cull;
    bool const clockwise = assembler.front_is_clockwise();
    cull_clockwise_ = cull == (clockwise ? CullMode::Front : CullMode::Back);
    cull_counter_clockwise_ = cull == (clockwise ? CullMode::Back : CullMode::Front);
    modes_ = setup.pixel_shader->info().interpolation;
    table_.resize((std::size_t(kAttributes) + 3 * std::size_t(attributes_)) * kTableRow);
    attribute_storage_.resize(std::size_t(attributes_) * kShadeRow);
    std::fill_n(zeros_, kShadeRow, 0);
    std::fill_n(ones_, kShadeRow, 1);
    attribute_rows_.clear();
    for (int k = 0; k < attributes_; ++k)
        attribute_rows_.push_back(attribute_storage_.data() + std::size_t(k) * kShadeRow);
    for (int k = 0; k < 4; ++k) color_rows_[k] = color_[k];
}

void TriangleStream::begin(AssembledVertices& vertices, FragmentBins& bins)
{
    vertices_ = &vertices;
    bins_ = &bins;
    fragments_ = 0;
    bins.reset(tiles_.size(), wide_color_);
}

void TriangleStream::add_patch(DomainPoints const& pattern, std::int32_t primitive_id,
                               AssemblyCounters& counters)
{
    std::size_t const points = pattern.patch.points(), triangles = pattern.patch.indices.size() / 3;
    if (triangles == 0) return;
    AssembledVertices const& vs = *vertices_;
    I min_x(0x7fffffff), min_y(0x7fffffff), max_x(-0x7fffffff), max_y(-0x7fffffff);
    unsigned codes = 0;
    std::size_t const padded = (points + 15) / 16 * 16;
    I const lane = I::iota(), last(std::int32_t(points - 1));
    for (std::size_t i = 0; i < points; i += std::size_t(N)) {
        // Past the last point lies padding: those lanes repeat it.
        I const at = min(lane + I(std::int32_t(i)), last);
        I const x =
            i + std::size_t(N) <= points ? load_lanes<N>(vs.x.data() + i) : gather(vs.x.data(), at);
        I const y =
            i + std::size_t(N) <= points ? load_lanes<N>(vs.y.data() + i) : gather(vs.y.data(), at);
        min_x = min(min_x, x), max_x = max(max_x, x);
        min_y = min(min_y, y), max_y = max(max_y, y);
    }
    for (std::size_t i = 0; i < points; ++i) codes |= vs.outcode[i];
    std::int32_t low_x = min_x.raw[0], high_x = max_x.raw[0], low_y = min_y.raw[0],
                 high_y = max_y.raw[0];
    for (int l = 1; l < N; ++l) {
        low_x = std::min(low_x, min_x.raw[l]), high_x = std::max(high_x, max_x.raw[l]);
        low_y = std::min(low_y, min_y.raw[l]), high_y = std::max(high_y, max_y.raw[l]);
    }
    origin_x_ = low_x >> 8;
    origin_y_ = low_y >> 8;
    bool const fits =
        (high_x >> 8) - origin_x_ < kMaxPatchPixels && (high_y >> 8) - origin_y_ < kMaxPatchPixels;
    // A pixel whose centre lies on the right or bottom bound is never covered.
    bool const inside = origin_x_ >= bounds_.left && origin_y_ >= bounds_.top &&
                        (high_x + 127) >> 8 <= bounds_.right &&
                        (high_y + 127) >> 8 <= bounds_.bottom;
    if (codes || !fits || !inside) {
        for (std::size_t t = 0; t < triangles; ++t) {
            std::uint32_t const v[3] = {pattern.corner[0][t], pattern.corner[1][t],
                                        pattern.corner[2][t]};
            add_triangle(v, primitive_id, counters);
        }
        return;
    }
    counters.clip_invocations += triangles;
    counters.clip_primitives += triangles;
    DepthTarget const& depth = *setup_->target.depth;
    depths_ =
        reinterpret_cast<std::int32_t const*>(depth.codes()) + depth.index(origin_x_, origin_y_);
    for (std::int32_t y = 0; y <= (high_y >> 8) - origin_y_; ++y)
        for (std::int32_t x = 0; x <= (high_x >> 8) - origin_x_ + 15; x += 16)
            __builtin_prefetch(depths_ + std::size_t(y) * std::size_t(pitch_) + x);
    // Runs of points may be read past the last one.
    if (packed_.size() < padded + 16) packed_.resize(padded + 16);
    I const ox(origin_x_ * 256), oy(origin_y_ * 256);
    for (std::size_t i = 0; i < padded; i += std::size_t(N)) {
        I const x = load_lanes<N>(vs.x.data() + i) - ox, y = load_lanes<N>(vs.y.data() + i) - oy;
        store_lanes(x | (y << I(16)), packed_.data() + i);
    }
    primitive_id_ = primitive_id;
    pattern_ = &pattern;
    auto const& strips = [&]() -> auto const&
    {
        if constexpr (N == 16)
            return pattern.strips16;
        else
            return pattern.strips8;
    }
    ();
    std::int32_t const* const packed = packed_.data();
    I triangle = I::iota();
    for (auto const& s : strips) {
        I const p0 = load_bytes<N>(s.place[0]), p1 = load_bytes<N>(s.place[1]),
                p2 = load_bytes<N>(s.place[2]);
        if (!s.gather) {
            I const a = load_lanes<N>(packed + s.run[0]), b = load_lanes<N>(packed + s.run[1]);
            set_up(permute2(a, b, p0), permute2(a, b, p1), permute2(a, b, p2), triangle);
        } else {
            std::size_t const t = std::size_t(triangle.raw[0]);
            auto const corner = [&](std::size_t k) {
                return gather(packed, load_lanes<N>(reinterpret_cast<std::int32_t const*>(
                                          pattern.corner[k].data() + t)));
            };
            set_up(corner(0), corner(1), corner(2), triangle);
        }
        triangle = triangle + I(N);
    }
    cover_survivors();
}

// Rejects what is culled or covers no pixel centre; keeps the rest in order.
inline void TriangleStream::set_up(I v0, I v1, I v2, I triangle)
{
    I const k16(16), mask(0xffff);
    I const x0 = v0 & mask, x1 = v1 & mask, x2 = v2 & mask;
    I const y0 = v0 >> k16, y1 = v1 >> k16, y2 = v2 >> k16;
    I const dx1 = x1 - x0, dy1 = y1 - y0, dx2 = x2 - x0, dy2 = y2 - y0;
    I const area = dx1 * dy2 - dx2 * dy1;
    I const k8(8), up(127), down(-129);
    I const left = (min(min(x0, x1), x2) + up) >> k8, top = (min(min(y0, y1), y2) + up) >> k8;
    I const right = (max(max(x0, x1), x2) + down) >> k8,
            bottom = (max(max(y0, y1), y2) + down) >> k8;
    Mask<N> keep = (left <= right) & (top <= bottom) & (area != I(0));
    Mask<N> const clockwise = area > I(0);
    if (cull_clockwise_) keep = keep & !clockwise;
    if (cull_counter_clockwise_) keep = keep & clockwise;
    std::uint32_t const bits = keep.bits();
    std::size_t const at = survivors_;
    store_lanes(compress(v0, bits), survivor_[0] + at);
    store_lanes(compress(select(clockwise, v1, v2), bits), survivor_[1] + at);
    store_lanes(compress(select(clockwise, v2, v1), bits), survivor_[2] + at);
    // The triangle's number, and whether its corners 1 and 2 were exchanged.
    store_lanes(compress((triangle << I(1)) | (I(I::Raw(clockwise.raw)) + I(1)), bits),
                survivor_[3] + at);
    survivors_ += std::size_t(std::popcount(bits));
    if (survivors_ > kSurvivors - std::size_t(N)) cover_survivors();
}

namespace {

// Pixel k of a row of four and those below it, as y << 16 | x.
template <int N> IntLanes<N> unit_offsets()
{
    IntLanes<N> r;
    for (int i = 0; i < N; ++i) r.raw[i] = (i >> 2) << 16 | (i & 3);
    return r;
}

} // namespace

// Queues those of N pixels, in rows of four from `corner` on, whose bit is set; entries are written in
// full and kept as far as bits go.
inline void TriangleStream::queue_unit(std::int32_t corner, std::uint32_t bits)
{
    std::int32_t const* const depths =
        depths_ + std::ptrdiff_t(corner >> 16) * pitch_ + (corner & 0xffff);
    store_lanes(I(corner) + compress(unit_offsets<N>(), bits), queue_pixel_ + queued_);
    store_lanes(I(std::int32_t(covered_)), queue_triangle_ + queued_);
    store_lanes(compress(load_rows_of_four<N>(depths, std::size_t(pitch_)), bits),
                queue_depth_ + queued_);
    queued_ += std::size_t(std::popcount(bits));
}

void TriangleStream::cover_survivors()
{
    for (std::size_t first = 0; first < survivors_; first += std::size_t(N))
        cover_group(first, int(std::min(std::size_t(N), survivors_ - first)));
    finish_covered();
    survivors_ = 0;
}

void TriangleStream::cover_group(std::size_t first, int count)
{
    if (queued_ + 2 * std::size_t(N) > kQueue) finish_covered();
    I const v0 = load_lanes<N>(survivor_[0] + first), v1 = load_lanes<N>(survivor_[1] + first),
            v2 = load_lanes<N>(survivor_[2] + first);
    I const k16(16), low(0xffff), k8(8), up(127), down(-129);
    I const x[3] = {v0 & low, v1 & low, v2 & low}, y[3] = {v0 >> k16, v1 >> k16, v2 >> k16};
    I const left = (min(min(x[0], x[1]), x[2]) + up) >> k8,
            top = (min(min(y[0], y[1]), y[2]) + up) >> k8;
    I const right = (max(max(x[0], x[1]), x[2]) + down) >> k8,
            bottom = (max(max(y[0], y[1]), y[2]) + down) >> k8;
    std::uint32_t const valid = Mask<N>::first(count).bits();
    // Strict edges are moved by one unit, so that >= 0 holds for both kinds. 32 bits hold the values
    // about boxes of up to 60 pixels.
    I const cx = (left << k8) + I(128), cy = (top << k8) + I(128);
    Group g{{}, {}, {}, left | (top << k16), right - left, bottom - top};
    for (int i = 0; i < 3; ++i) {
        int const a = (i + 1) % 3, b = (i + 2) % 3;
        I const dx = x[b] - x[a], dy = y[b] - y[a];
        Mask<N> const top_left = (dy < I(0)) | ((dy == I(0)) & (dx > I(0)));
        g.edge[i] = dx * (cy - y[a]) - dy * (cx - x[a]) - select(top_left, I(0), I(1));
        g.step_x[i] = I(0) - (dy << k8);
        g.step_y[i] = dx << k8;
    }
    I const longest = max(g.columns, g.rows);
    if (((longest > I(0)).bits() & valid) == 0) return cover_pixels(first, valid, g);
    std::uint32_t const large = (longest > I(3)).bits() & valid,
                        huge = (longest > I(59)).bits() & valid;
    std::int32_t blocks[N], corners[N];
    I const covered = cover_blocks(g, valid & ~large);
    int const parts = N == 16 || (covered > I(all_lanes<N>())).bits() & valid ? 16 : N;
    store_lanes(covered, blocks);
    store_lanes(g.corner, corners);
    GroupRows rows;
    if (large) rows = GroupRows(g);
    for (std::uint32_t bits = ((covered != I(0)).bits() & valid) | large; bits; bits &= bits - 1) {
        int const l = std::countr_zero(bits);
        std::size_t const survivor = first + std::size_t(l);
        if (huge >> l & 1) {
            cover_huge(survivor);
            continue;
        }
        if (large >> l & 1) {
            cover_large(survivor, rows, l);
            continue;
        }
        if (queued_ + 32 > kQueue) finish_covered();
        for (int part = 0; part < parts; part += N)
            queue_unit(corners[l] + (part >> 2 << 16),
                       std::uint32_t(blocks[l]) >> part & all_lanes<N>());
        covered_survivor_[covered_++] = std::int32_t(survivor);
    }
}

// Triangles whose box holds one pixel centre.
inline void TriangleStream::cover_pixels(std::size_t first, std::uint32_t valid, Group const& g)
{
    std::uint32_t const covers = ~(g.edge[0] | g.edge[1] | g.edge[2]).negative() & valid;
    I const texel = (g.corner >> I(16)) * I(pitch_) + (g.corner & I(0xffff));
    I const depth = gather(depths_, select(Mask<N>::of(valid), texel, I(0)));
    store_lanes(compress(g.corner, covers), queue_pixel_ + queued_);
    store_lanes(compress(depth, covers), queue_depth_ + queued_);
    store_lanes(I(std::int32_t(covered_)) + I::iota(), queue_triangle_ + queued_);
    store_lanes(compress(I::iota() + I(std::int32_t(first)), covers), covered_survivor_ + covered_);
    queued_ += std::size_t(std::popcount(covers));
    covered_ += std::size_t(std::popcount(covers));
}

// Of those within 4x4 pixels: bit 4 y + x says whether pixel (x, y) of the box is covered.
inline TriangleStream::I TriangleStream::cover_blocks(Group const& g, std::uint32_t small)
{
    I masks(0);
    if (small == 0) return masks;
    // Pixels right of a box or below it are never inside its triangle.
    auto const last = [&](I of) {
        return (of > I(2)).bits() & small ? 3 : (of > I(1)).bits() & small ? 2 : 1;
    };
    int const last_column = last(g.columns), last_row = last(g.rows);
    I e[3] = {g.edge[0], g.edge[1], g.edge[2]};
    for (int r = 0; r <= last_row; ++r) {
        I f[3] = {e[0], e[1], e[2]};
        for (int c = 0; c <= last_column; ++c) {
            I const outside = (f[0] | f[1] | f[2]) >> I(31);
            masks = masks | (((outside + I(1)) << I(4 * r + c)));
            for (int i = 0; i < 3; ++i) f[i] = f[i] + g.step_x[i];
        }
        for (int i = 0; i < 3; ++i) e[i] = e[i] + g.step_y[i];
    }
    return masks;
}

// A larger one, in units of N pixels: lanes over units tell which of them an edge leaves out, lanes
// over pixels what the others cover.
inline void TriangleStream::cover_large(std::size_t survivor, GroupRows const& g, int l)
{
    constexpr std::int32_t kRows = N / 4;
    // u * kReciprocal[n] >> 16 is u / n for all units of a box of 15 x 15 blocks.
    static constexpr auto kReciprocal = [] {
        std::array<std::int32_t, 16> inverse{};
        for (std::int32_t n = 1; n < 16; ++n) inverse[std::size_t(n)] = (65536 + n - 1) / n;
        return inverse;
    }();
    std::int32_t const across = (g.columns[l] >> 2) + 1, units = across * (g.rows[l] / kRows + 1);
    if (queued_ + std::size_t(units * N) + 32 > kQueue) finish_covered();
    I const offset = unit_offsets<N>(), offset_x = offset & I(0xffff), offset_y = offset >> I(16);
    I pixel[3]; // what a pixel of a unit adds
    std::int32_t most[3];
    for (int i = 0; i < 3; ++i) {
        std::int32_t const x = g.step_x[i][l], y = g.step_y[i][l];
        pixel[i] = I(x) * offset_x + I(y) * offset_y;
        most[i] = std::max(0, 3 * x) + std::max(0, (kRows - 1) * y);
    }
    std::size_t const before = queued_;
    for (std::int32_t from = 0; from < units; from += N) {
        I const u = I::iota() + I(from);
        I const row = (u * I(kReciprocal[std::size_t(across)])) >> I(16);
        I const x = (u - row * I(across)) << I(2), y = row * I(kRows);
        std::int32_t edge[3][N], corners[N];
        I outside(0);
        for (int i = 0; i < 3; ++i) {
            I const value = I(g.edge[i][l]) + I(g.step_x[i][l]) * x + I(g.step_y[i][l]) * y;
            store_lanes(value, edge[i]);
            outside = outside | (value + I(most[i]));
        }
        store_lanes(I(g.corner[l]) + (x | (y << I(16))), corners);
        std::uint32_t const reached =
            ~outside.negative() & Mask<N>::first(std::min(N, units - from)).bits();
        for (std::uint32_t bits = reached; bits; bits &= bits - 1) {
            int const k = std::countr_zero(bits);
            I out(0);
            for (int i = 0; i < 3; ++i) out = out | (pixel[i] + I(edge[i][k]));
            queue_unit(corners[k], ~out.negative() & all_lanes<N>());
        }
    }
    covered_survivor_[covered_] = std::int32_t(survivor);
    covered_ += queued_ != before;
}

// A triangle whose edge values need 64 bits: pixel by pixel.
void TriangleStream::cover_huge(std::size_t s)
{
    std::int32_t x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        x[k] = survivor_[k][s] & 0xffff;
        y[k] = survivor_[k][s] >> 16;
    }
    std::int64_t dx[3], dy[3], c[3];
    for (int i = 0; i < 3; ++i) {
        int const a = (i + 1) % 3, b = (i + 2) % 3;
        dx[i] = x[b] - x[a];
        dy[i] = y[b] - y[a];
        bool const top_left = dy[i] < 0 || (dy[i] == 0 && dx[i] > 0);
        c[i] = dx[i] * (128 - y[a]) - dy[i] * (128 - x[a]) - (top_left ? 0 : 1);
    }
    bool entered = false;
    for (std::int32_t py = (std::min({y[0], y[1], y[2]}) + 127) >> 8;
         py <= (std::max({y[0], y[1], y[2]}) - 129) >> 8; ++py)
        for (std::int32_t px = (std::min({x[0], x[1], x[2]}) + 127) >> 8;
             px <= (std::max({x[0], x[1], x[2]}) - 129) >> 8; ++px) {
            bool in = true;
            for (int i = 0; i < 3; ++i) in = in && c[i] + dx[i] * 256 * py - dy[i] * 256 * px >= 0;
            if (!in) continue;
            if (queued_ + 32 > kQueue) {
                finish_covered();
                entered = false;
            }
            if (!entered) covered_survivor_[covered_++] = std::int32_t(s);
            entered = true;
            queue_pixel_[queued_] = py << 16 | px;
            queue_depth_[queued_] = depths_[std::ptrdiff_t(py) * pitch_ + px];
            queue_triangle_[queued_++] = std::int32_t(covered_ - 1);
        }
}

void TriangleStream::add_triangle(std::uint32_t const* v, std::int32_t primitive_id,
                                  AssemblyCounters& counters)
{
    assembled_.clear();
    assembler_->assemble(*vertices_, v, 3, primitive_id, 0, counters, assembled_);
    for (AssembledPrimitive const& p : assembled_) draw_assembled(p);
}

// A triangle alone, of any size, cut to the bounds: eight pixels of a row at a time in 64 bits.
void TriangleStream::draw_assembled(AssembledPrimitive const& p)
{
    typedef std::int64_t I64 __attribute__((vector_size(64)));
    using F8 = Lanes<8>;
    AssembledVertices const& vs = *vertices_;
    auto const& [a, b, c] = p.v;
    std::int32_t const x[3] = {vs.x[a], vs.x[b], vs.x[c]}, y[3] = {vs.y[a], vs.y[b], vs.y[c]};
    Rect const pixels = pixel_bounds(x, y).intersect(bounds_);
    if (pixels.empty()) return;
    std::int64_t e0[3], dx[3], dy[3], strict[3];
    for (int i = 0; i < 3; ++i) {
        int const from = (i + 1) % 3, to = (i + 2) % 3;
        dx[i] = x[to] - x[from];
        dy[i] = y[to] - y[from];
        strict[i] = dy[i] < 0 || (dy[i] == 0 && dx[i] > 0) ? 0 : 1;
        e0[i] = dx[i] * (pixels.top * 256 + 128 - std::int64_t(y[from])) -
                dy[i] * (pixels.left * 256 + 128 - std::int64_t(x[from]));
    }
    std::int64_t const area =
        std::int64_t(x[1] - x[0]) * (y[2] - y[0]) - std::int64_t(x[2] - x[0]) * (y[1] - y[0]);
    F8 const inverse(1.0f / float(area));
    float const z0 = vs.z[a], dz1 = vs.z[b] - z0, dz2 = vs.z[c] - z0;
    float const w0 = vs.inverse_w[a], w1 = vs.inverse_w[b], w2 = vs.inverse_w[c];
    float const dw1 = w1 - w0, dw2 = w2 - w0;
    constexpr I64 kRamp{0, 256, 512, 768, 1024, 1280, 1536, 1792};
    for (int py = pixels.top; py < pixels.bottom; ++py)
        for (int px = pixels.left; px < pixels.right; px += 8) {
            I64 e[3], in = I64{} - 1;
            for (int i = 0; i < 3; ++i) {
                std::int64_t const here =
                    e0[i] + dx[i] * 256 * (py - pixels.top) - dy[i] * 256 * (px - pixels.left);
                e[i] = here - dy[i] * kRamp;
                in &= e[i] >= strict[i] + I64{};
            }
            std::uint32_t bits = 0;
            for (int l = 0; l < 8; ++l) bits |= std::uint32_t(in[l] & 1) << l;
            bits &= (1u << std::min(8, pixels.right - px)) - 1;
            if (bits == 0) continue;
            fragments_ += std::size_t(std::popcount(bits));
            if (shaded_ + 8 > kShade) shade();
            F8 const b1 = F8(__builtin_convertvector(e[1], F8::Raw)) * inverse,
                     b2 = F8(__builtin_convertvector(e[2], F8::Raw)) * inverse;
            F8 const z = F8(z0) + (b1 * F8(dz1) + b2 * F8(dz2));
            F8 const w = F8(1.0f) / (F8(w0) + (b1 * F8(dw1) + b2 * F8(dw2)));
            F8 const p1 = b1 * F8(w1) * w, p2 = b2 * F8(w2) * w;
            std::size_t const at = shaded_;
            compress(z, bits).store(position_[2] + at);
            compress(w, bits).store(position_[3] + at);
            for (int k = 0; k < attributes_; ++k) {
                Interpolation const mode = modes_[std::size_t(k)];
                float const a0 = vs.component(a, k + 4), da1 = vs.component(b, k + 4) - a0,
                            da2 = vs.component(c, k + 4) - a0;
                bool const flat = mode == Interpolation::LinearNoperspective ||
                                  mode == Interpolation::LinearNoperspectiveCentroid;
                F8 const v = mode == Interpolation::Constant ? F8(vs.component(p.leading, k + 4))
                             : flat ? F8(a0) + (b1 * F8(da1) + b2 * F8(da2))
                                    : F8(a0) + (p1 * F8(da1) + p2 * F8(da2));
                compress(v, bits).store(attribute_storage_.data() + std::size_t(k) * kShadeRow +
                                        at);
            }
            for (std::size_t q = at; bits; bits &= bits - 1, ++q) {
                int const l = std::countr_zero(bits);
                pixel_x_[q] = px + l;
                pixel_y_[q] = py;
                id_[q] = p.primitive_id;
                front_[q] = p.front_face ? -1 : 0;
                position_[0][q] = float(px + l) + 0.5f;
                position_[1][q] = float(py) + 0.5f;
                shaded_ = q + 1;
            }
        }
}

} // namespace tessemu
