// SPDX-License-Identifier: Apache-2.0
#include "emu/triangle_stream.h"

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

// In two passes: the first branches little, and what the second branches on is known by then.
void TriangleStream::cover_survivors()
{
    for (std::size_t first = 0; first < survivors_; first += std::size_t(N))
        mask_group(first, Mask<N>::first(int(std::min(std::size_t(N), survivors_ - first))).bits());
    for (std::size_t first = 0; first < survivors_; first += std::size_t(N)) queue_group(first);
    finish_covered();
    survivors_ = 0;
}

void TriangleStream::mask_group(std::size_t first, std::uint32_t valid)
{
    I const k16(16), low(0xffff), k8(8), up(127), down(-129);
    I x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        I const packed = load_lanes<N>(survivor_[k] + first);
        x[k] = packed & low;
        y[k] = packed >> k16;
    }
    I const left = (min(min(x[0], x[1]), x[2]) + up) >> k8,
            top = (min(min(y[0], y[1]), y[2]) + up) >> k8;
    I const columns = ((max(max(x[0], x[1]), x[2]) + down) >> k8) - left,
            rows = ((max(max(y[0], y[1]), y[2]) + down) >> k8) - top;
    store_lanes(left | (top << k16), box_ + first);
    store_lanes(top * I(pitch_) + left, texel_ + first);
    I const cx = (left << k8) + I(128), cy = (top << k8) + I(128);
    Edges e; // strict ones are moved by one unit, so that both kinds hold from 0 on
    for (int i = 0; i < 3; ++i) {
        int const a = (i + 1) % 3, b = (i + 2) % 3;
        I const dx = x[b] - x[a], dy = y[b] - y[a];
        Mask<N> const top_left = (dy < I(0)) | ((dy == I(0)) & (dx > I(0)));
        e.outside[i] = dy * (cx - x[a]) - dx * (cy - y[a]) - select(top_left, I(1), I(0));
        e.step_x[i] = dy << k8;
        e.step_y[i] = I(0) - (dx << k8);
    }
    Mask<N> const large = max(columns, rows) > I(3);
    std::uint32_t const small = valid & ~large.bits();
    I masks(0);
    if (small) {
        auto const last = [&](I of) {
            return (of > I(2)).bits() & small   ? 3
                   : (of > I(1)).bits() & small ? 2
                                                : int(((of > I(0)).bits() & small) != 0);
        };
        int const last_row = last(rows);
        switch (last(columns)) {
        case 0:
            masks = small_masks<1>(e, last_row);
            break;
        case 1:
            masks = small_masks<2>(e, last_row);
            break;
        case 2:
            masks = small_masks<3>(e, last_row);
            break;
        default:
            masks = small_masks<4>(e, last_row);
        }
    }
    if (small != valid) {
        for (int i = 0; i < 3; ++i) {
            store_lanes(e.outside[i], outside_[i] + first);
            store_lanes(e.step_x[i], step_x_[i] + first);
            store_lanes(e.step_y[i], step_y_[i] + first);
        }
        store_lanes(columns, columns_ + first);
        store_lanes(rows, rows_ + first);
    }
    store_lanes(select(Mask<N>::of(valid), select(large, I(kLarge), masks), I(0)), mask_ + first);
}

// Of triangles within 4x4 pixels. Pixels right of a box or below it are never inside its triangle.
template <int kColumns>
inline TriangleStream::I TriangleStream::small_masks(Edges const& edges, int rows)
{
    I masks(0);
    I e[3] = {edges.outside[0], edges.outside[1], edges.outside[2]};
    for (int r = 0;; ++r) {
        I f[3] = {e[0], e[1], e[2]};
        I row(0);
#pragma GCC unroll 4
        for (int c = 0; c < kColumns; ++c) {
            row = row | (((f[0] & f[1] & f[2]) >> I(31)) & I(1 << c));
            for (int i = 0; i < 3; ++i) f[i] = f[i] + edges.step_x[i];
        }
        masks = masks | (row << I(4 * r));
        if (r == rows) return masks;
        for (int i = 0; i < 3; ++i) e[i] = e[i] + edges.step_y[i];
    }
}

namespace {

// Eight pixels in rows of kAcross, by mask: those whose bit is set, as 64 y + x.
template <int kAcross>
constexpr auto kUnitPlaces = [] {
    std::array<std::array<std::uint8_t, 8>, 256> table{};
    for (std::size_t mask = 0; mask < table.size(); ++mask) {
        std::size_t n = 0;
        for (int i = 0; i < 8; ++i)
            if (mask >> i & 1) table[mask][n++] = std::uint8_t(64 * (i / kAcross) + i % kAcross);
    }
    return table;
}();

} // namespace

// Writes to the queue, from `at` on, those of a unit of eight pixels whose bit is set; its first one
// lies at `corner` of the owner's box. Eight are written. Returns where the queue ends now.
template <int kAcross>
inline std::size_t TriangleStream::queue_unit(std::size_t at, std::uint32_t bits, Words corner,
                                              Words owner)
{
    typedef std::uint8_t Bytes __attribute__((vector_size(8)));
    Bytes places;
    __builtin_memcpy(&places, kUnitPlaces<kAcross>[bits].data(), sizeof places);
    Words const of_box = __builtin_convertvector(places, Words) + corner;
    __builtin_memcpy(queue_place_ + at, &of_box, sizeof of_box);
    __builtin_memcpy(queue_owner_ + at, &owner, sizeof owner);
    return at + std::size_t(std::popcount(bits));
}

// Puts these of N survivors into the table.
inline void TriangleStream::keep(std::size_t first, std::uint32_t lanes)
{
    for (int k = 0; k < 4; ++k)
        store_lanes(compress(load_lanes<N>(survivor_[k] + first), lanes),
                    row(kPacked + k) + covered_);
    store_lanes(compress(load_lanes<N>(box_ + first), lanes), row(kBox) + covered_);
    covered_ += std::size_t(std::popcount(lanes));
}

void TriangleStream::queue_group(std::size_t first)
{
    if (queued_ + kSmallPixels > kQueue) finish_covered();
    I const masks = load_lanes<N>(mask_ + first);
    if (masks.negative()) return queue_mixed_group(first, (masks > I(0xff)).bits());
    std::uint32_t const covering = (masks != I(0)).bits();
    if ((masks > I(1)).bits() == 0) { // the first pixel of each at most
        for (std::size_t i = 0; i < std::size_t(N); i += 8) {
            constexpr Words kRamp{0, 1, 2, 3, 4, 5, 6, 7};
            Words const places{}, owners = kRamp + std::uint16_t(covered_ + i);
            __builtin_memcpy(queue_place_ + queued_ + i, &places, sizeof places);
            __builtin_memcpy(queue_owner_ + queued_ + i, &owners, sizeof owners);
        }
        for (std::size_t l = 0; l < std::size_t(N); ++l)
            __builtin_prefetch(depths_ + texel_[first + l]);
        queued_ += std::size_t(std::popcount(covering));
    } else {
        bool const both = (masks > I(0xff)).bits();
        auto owner = std::uint16_t(covered_);
        std::size_t queued = queued_;
        for (std::size_t s = first; s < first + std::size_t(N); ++s) {
            queued = queue_small(queued, s, owner, both);
            owner = std::uint16_t(owner + (mask_[s] != 0));
        }
        queued_ = queued;
    }
    keep(first, covering);
}

// Some of them large.
void TriangleStream::queue_mixed_group(std::size_t first, bool both)
{
    std::uint32_t covering = 0;
    auto owner = std::uint16_t(covered_);
    std::size_t queued = queued_;
    for (std::size_t l = 0; l < std::size_t(N); ++l) {
        std::size_t const s = first + l;
        std::size_t before = queued;
        if (mask_[s] != kLarge) {
            queued = queue_small(queued, s, owner, both);
        } else {
            bool const huge = std::max(columns_[s], rows_[s]) >= kWidestBox;
            std::size_t const most =
                std::size_t((columns_[s] | 7) + 1) * std::size_t((rows_[s] | 1) + 1);
            if (huge || queued + most + kSmallPixels > kQueue) {
                queued_ = queued;
                keep(first, covering);
                finish_covered();
                before = queued = covering = owner = 0;
            }
            if (huge)
                cover_huge(std::size_t(survivor_[3][s] >> 1));
            else
                queued = columns_[s] < 4 ? queue_large<4>(queued, s, owner)
                                         : queue_large<8>(queued, s, owner);
        }
        bool const covers = queued != before;
        covering |= std::uint32_t(covers) << l;
        owner = std::uint16_t(owner + covers);
    }
    queued_ = queued;
    keep(first, covering);
}

// One within 4x4 pixels; `both`: their lower half too.
inline std::size_t TriangleStream::queue_small(std::size_t at, std::size_t survivor,
                                               std::uint16_t owner, bool both)
{
    std::size_t const pitch = std::size_t(pitch_);
    std::int32_t const* const depths = depths_ + texel_[survivor];
    auto const mask = std::uint32_t(mask_[survivor]);
    __builtin_prefetch(depths);
    __builtin_prefetch(depths + pitch);
    at = queue_unit<4>(at, mask & 0xff, Words{}, Words{} + owner);
    if (!both) return at;
    __builtin_prefetch(depths + 2 * pitch);
    __builtin_prefetch(depths + 3 * pitch);
    return queue_unit<4>(at, mask >> 8, Words{} + std::uint16_t(128), Words{} + owner);
}

// A larger one, in units of eight pixels, down and then to the right.
template <int kAcross>
inline std::size_t TriangleStream::queue_large(std::size_t at, std::size_t survivor,
                                               std::uint16_t owner)
{
    constexpr std::int32_t kDown = 8 / kAcross;
    constexpr typename I8::Raw kPixel{0, 1, 2, 3, 4, 5, 6, 7};
    I8 const x = I8(kPixel & (kAcross - 1)), y = I8(kPixel / kAcross);
    std::size_t const pitch = std::size_t(pitch_);
    std::int32_t const columns = columns_[survivor], rows = rows_[survivor];
    I8 first[3], step_x[3], step_y[3];
    for (int i = 0; i < 3; ++i) {
        step_x[i] = I8(step_x_[i][survivor]);
        step_y[i] = I8(step_y_[i][survivor]);
        first[i] = I8(outside_[i][survivor]) + step_x[i] * x + (kDown > 1 ? step_y[i] * y : I8(0));
        step_y[i] = step_y[i] * I8(kDown);
        step_x[i] = step_x[i] * I8(kAcross);
    }
    for (std::int32_t from = 0; from <= columns; from += kAcross) {
        I8 e[3] = {first[0], first[1], first[2]};
        Words corner = Words{} + std::uint16_t(from);
        std::int32_t const* depths = depths_ + texel_[survivor] + from;
        for (std::int32_t row = 0; row <= rows; row += kDown) {
            at = queue_unit<kAcross>(at, (e[0] & e[1] & e[2]).negative(), corner, Words{} + owner);
            for (std::size_t r = 0; r < std::size_t(kDown); ++r)
                __builtin_prefetch(depths + r * pitch);
            for (int i = 0; i < 3; ++i) e[i] = e[i] + step_y[i];
            corner += std::uint16_t(64 * kDown);
            depths += kDown * pitch;
        }
        for (int i = 0; i < 3; ++i) first[i] = first[i] + step_x[i];
    }
    return at;
}

// A triangle whose edge values need 64 bits. It has been counted with its patch.
void TriangleStream::cover_huge(std::size_t triangle)
{
    std::uint32_t const v[3] = {pattern_->corner[0][triangle], pattern_->corner[1][triangle],
                                pattern_->corner[2][triangle]};
    AssemblyCounters counted;
    add_triangle(v, primitive_id_, counted);
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
