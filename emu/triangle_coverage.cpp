// SPDX-License-Identifier: Apache-2.0
#include "emu/triangle_coverage.h"

#include <bit>

namespace tessemu {

void TriangleCoverage::bind(RasterSetup const& setup, PrimitiveAssembler const& assembler)
{
    pitch_ = int(setup.target.depth->pitch());
    CullMode const cull = assembler.state().cull;
    bool const clockwise = assembler.front_is_clockwise();
    cull_clockwise_ = cull == (clockwise ? CullMode::Front : CullMode::Back);
    cull_counter_clockwise_ = cull == (clockwise ? CullMode::Back : CullMode::Front);
}

void TriangleCoverage::add_patch(PatchOnScreen const& patch)
{
    patch_ = &patch;
    covered_.begin(patch);
    DomainPoints const& pattern = *patch.pattern;
    AssembledVertices const& vs = *patch.vertices;
    std::size_t const padded = (pattern.patch.points() + 15) / 16 * 16;
    // Runs of points may be read past the last one.
    if (packed_.size() < padded + 16) packed_.resize(padded + 16);
    I const ox(patch.origin_x * 256), oy(patch.origin_y * 256);
    for (std::size_t i = 0; i < padded; i += std::size_t(N)) {
        I const x = load_lanes<N>(vs.x.data() + i) - ox, y = load_lanes<N>(vs.y.data() + i) - oy;
        store_lanes(x | (y << I(16)), packed_.data() + i);
    }
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
inline void TriangleCoverage::set_up(I v0, I v1, I v2, I triangle)
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
    store_lanes(compress(v0, bits), position_[0] + at);
    store_lanes(compress(select(clockwise, v1, v2), bits), position_[1] + at);
    store_lanes(compress(select(clockwise, v2, v1), bits), position_[2] + at);
    // The triangle's number, and whether its corners 1 and 2 were exchanged.
    store_lanes(compress((triangle << I(1)) | (I(I::Raw(clockwise.raw)) + I(1)), bits), tag_ + at);
    survivors_ += std::size_t(std::popcount(bits));
    if (survivors_ > kSurvivors - std::size_t(N)) cover_survivors();
}

// In two passes: the first branches little, and what the second branches on is known by then.
void TriangleCoverage::cover_survivors()
{
    for (std::size_t first = 0; first < survivors_; first += std::size_t(N))
        mask_group(first, Mask<N>::first(int(std::min(std::size_t(N), survivors_ - first))).bits());
    for (std::size_t first = 0; first < survivors_; first += std::size_t(N)) queue_group(first);
    covered_.finish();
    survivors_ = 0;
}

void TriangleCoverage::mask_group(std::size_t first, std::uint32_t valid)
{
    I const k16(16), low(0xffff), k8(8), up(127), down(-129);
    I x[3], y[3];
    for (int k = 0; k < 3; ++k) {
        I const packed = load_lanes<N>(position_[k] + first);
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
inline TriangleCoverage::I TriangleCoverage::small_masks(Edges const& edges, int rows)
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
inline std::size_t TriangleCoverage::queue_unit(std::size_t at, std::uint32_t bits, Words corner,
                                                Words owner)
{
    typedef std::uint8_t Bytes __attribute__((vector_size(8)));
    Bytes places;
    __builtin_memcpy(&places, kUnitPlaces<kAcross>[bits].data(), sizeof places);
    Words const of_box = __builtin_convertvector(places, Words) + corner;
    __builtin_memcpy(covered_.place + at, &of_box, sizeof of_box);
    __builtin_memcpy(covered_.owner + at, &owner, sizeof owner);
    return at + std::size_t(std::popcount(bits));
}

// Puts these of N survivors into the table.
inline void TriangleCoverage::keep(std::size_t first, std::uint32_t lanes)
{
    covered_.add_triangles(
        {{load_lanes<N>(position_[0] + first), load_lanes<N>(position_[1] + first),
          load_lanes<N>(position_[2] + first)},
         load_lanes<N>(tag_ + first),
         load_lanes<N>(box_ + first)},
        lanes);
}

void TriangleCoverage::queue_group(std::size_t first)
{
    if (covered_.pixels + kSmallPixels > CoveredPixels::kPixels) covered_.finish();
    I const masks = load_lanes<N>(mask_ + first);
    if (masks.negative()) return queue_mixed_group(first, (masks > I(0xff)).bits());
    std::uint32_t const covering = (masks != I(0)).bits();
    if ((masks > I(1)).bits() == 0) { // the first pixel of each at most
        for (std::size_t i = 0; i < std::size_t(N); i += 8) {
            constexpr Words kRamp{0, 1, 2, 3, 4, 5, 6, 7};
            Words const places{}, owners = kRamp + std::uint16_t(covered_.triangles + i);
            __builtin_memcpy(covered_.place + covered_.pixels + i, &places, sizeof places);
            __builtin_memcpy(covered_.owner + covered_.pixels + i, &owners, sizeof owners);
        }
        for (std::size_t l = 0; l < std::size_t(N); ++l)
            __builtin_prefetch(patch_->depths + texel_[first + l]);
        covered_.pixels += std::size_t(std::popcount(covering));
    } else {
        bool const both = (masks > I(0xff)).bits();
        auto owner = std::uint16_t(covered_.triangles);
        std::size_t queued = covered_.pixels;
        for (std::size_t s = first; s < first + std::size_t(N); ++s) {
            queued = queue_small(queued, s, owner, both);
            owner = std::uint16_t(owner + (mask_[s] != 0));
        }
        covered_.pixels = queued;
    }
    keep(first, covering);
}

// Some of them large.
void TriangleCoverage::queue_mixed_group(std::size_t first, bool both)
{
    std::uint32_t covering = 0;
    auto owner = std::uint16_t(covered_.triangles);
    std::size_t queued = covered_.pixels;
    for (std::size_t l = 0; l < std::size_t(N); ++l) {
        std::size_t const s = first + l;
        std::size_t before = queued;
        if (mask_[s] != kLarge) {
            queued = queue_small(queued, s, owner, both);
        } else {
            bool const huge = std::max(columns_[s], rows_[s]) >= kWidestBox;
            std::size_t const most =
                std::size_t((columns_[s] | 7) + 1) * std::size_t((rows_[s] | 1) + 1);
            if (huge || queued + most + kSmallPixels > CoveredPixels::kPixels) {
                covered_.pixels = queued;
                keep(first, covering);
                covered_.finish();
                before = queued = covering = owner = 0;
            }
            if (huge)
                cover_huge(std::size_t(tag_[s] >> 1));
            else
                queued = columns_[s] < 4 ? queue_large<4>(queued, s, owner)
                                         : queue_large<8>(queued, s, owner);
        }
        bool const covers = queued != before;
        covering |= std::uint32_t(covers) << l;
        owner = std::uint16_t(owner + covers);
    }
    covered_.pixels = queued;
    keep(first, covering);
}

// One within 4x4 pixels; `both`: their lower half too.
inline std::size_t TriangleCoverage::queue_small(std::size_t at, std::size_t survivor,
                                                 std::uint16_t owner, bool both)
{
    std::size_t const pitch = std::size_t(pitch_);
    std::int32_t const* const depths = patch_->depths + texel_[survivor];
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
inline std::size_t TriangleCoverage::queue_large(std::size_t at, std::size_t survivor,
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
        std::int32_t const* depths = patch_->depths + texel_[survivor] + from;
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
void TriangleCoverage::cover_huge(std::size_t triangle)
{
    auto const& corner = patch_->pattern->corner;
    std::uint32_t const v[3] = {corner[0][triangle], corner[1][triangle], corner[2][triangle]};
    AssemblyCounters counted;
    single_.add(*patch_->vertices, v, patch_->primitive_id, counted);
}

} // namespace tessemu
