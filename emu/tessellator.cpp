// SPDX-License-Identifier: Apache-2.0
#include "emu/tessellator.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>

namespace tessemu {

namespace {

constexpr std::uint32_t kOne = kFixedOne, kHalf = kFixedOne / 2;
constexpr std::uint32_t kNever = std::numeric_limits<std::uint32_t>::max();

// Half-edge positions 0..32 of the finest level in the order in which they come into being ("ruler
// function", rule R62). rank(0) = 0, rank(1) = 32, and position 1 + (2m+1) 2^(4-b) has rank 2^b +
// m.
constexpr std::array<std::uint32_t, 33> ruler_ranks()
{
    std::array<std::uint32_t, 33> rank{};
    rank[1] = 32;
    for (std::uint32_t b = 0; b < 5; ++b)
        for (std::uint32_t m = 0; m < (1u << b); ++m)
            rank[1 + (2 * m + 1) * (1u << (4 - b))] = (1u << b) + m;
    return rank;
}
constexpr std::array<std::uint32_t, 33> kRank = ruler_ranks();

// Of each number of positions on a half edge: bit 2 (p - 1) is set where position p is one of them.
constexpr std::array<std::uint64_t, 34> positions_on_half_edges()
{
    std::array<std::uint64_t, 34> bits{};
    for (std::uint32_t n = 0; n < bits.size(); ++n)
        for (std::uint32_t p = 1; p <= 32; ++p)
            if (kRank[p] < n) bits[n] |= std::uint64_t(1) << (2 * (p - 1));
    return bits;
}
constexpr std::array<std::uint64_t, 34> kOnHalfEdge = positions_on_half_edges();

constexpr std::array<std::uint32_t, 129> reciprocals()
{
    std::array<std::uint32_t, 129> r{};
    for (std::uint32_t n = 1; n <= 128; ++n) r[n] = (2 * kOne + n) / (2 * n);
    return r;
}
constexpr std::array<std::uint32_t, 129> kReciprocal = reciprocals(); // 65536 / n, to nearest

constexpr std::uint32_t drop_highest_bit(std::uint32_t x)
{
    return x & ~std::bit_floor(x);
}

// One factor's subdivided span: N positions, symmetric about the middle.
struct Span {
    bool odd;
    std::uint32_t half_points, points; // on a half span, on the whole span
    std::uint32_t frac, floor_reciprocal, ceil_reciprocal, split;

    Span(std::uint32_t factor, bool odd_) : odd(odd_)
    {
        std::uint32_t h = (factor + 1) / 2;
        if (odd || h == kHalf) h += kHalf;
        std::uint32_t const fl = h >> 16;
        frac = h & 0xffff;
        std::uint32_t const ce = fl + (frac ? 1 : 0);
        half_points = ce;
        points = odd ? 2 * ce : 2 * ce + 1;
        floor_reciprocal = kReciprocal[2 * fl - (odd ? 1 : 0)];
        ceil_reciprocal = kReciprocal[2 * ce - (odd ? 1 : 0)];
        if (frac == 0)
            split = kNever;
        else if (odd)
            split = fl == 1 ? 0 : 2 * drop_highest_bit(fl - 1) + 1;
        else
            split = 2 * drop_highest_bit(fl) + 1;
    }

    // Interpolates between the patterns of the whole factors below and above.
    std::uint32_t position(std::uint32_t p) const
    {
        bool const mirrored = p >= half_points;
        std::uint32_t const q = mirrored ? points - 1 - p : p;
        if (q == half_points) return kHalf; // the middle of an even span
        std::uint32_t const on_ceil = q;
        std::uint32_t const on_floor = q > split ? q - 1 : q;
        std::uint32_t const x = (on_floor * floor_reciprocal * (kOne - frac) +
                                 on_ceil * ceil_reciprocal * frac + kHalf) >>
                                16;
        return mirrored ? kOne - x : x;
    }

    std::uint32_t stitch_half() const { return half_points - (odd ? 1 : 0); }
};

// All positions of a span at once, so that rings read them from a table.
struct Positions {
    Span span;
    std::array<std::uint32_t, 66> at;

    explicit Positions(std::uint32_t factor, bool odd) : span(factor, odd)
    {
        for (std::uint32_t p = 0; p < span.half_points; ++p) at[p] = span.position(p);
        if (!odd) at[span.half_points] = kHalf;
        for (std::uint32_t p = 0; p < span.half_points; ++p) at[span.points - 1 - p] = kOne - at[p];
    }
    std::uint32_t operator[](std::uint32_t p) const { return at[p]; }
};

// A row of point indices as the stitches walk it: start, start + step, ..., the last one given
// apart because the last side of a ring ends at the ring's first point.
struct Row {
    std::uint32_t first, count, last;
    std::int32_t step = 1;
    std::uint32_t operator[](std::uint32_t i) const
    {
        return i + 1 == count ? last : first + std::uint32_t(step) * i;
    }
    /// In one piece; the last once more behind it.
    std::array<std::uint32_t, 66> all() const
    {
        std::array<std::uint32_t, 66> out;
        for (std::uint32_t i = 0; i < count; ++i) out[i] = first + std::uint32_t(step) * i;
        out[count - 1] = out[count] = last;
        return out;
    }
};

class Triangles {
public:
    Triangles(std::uint32_t* indices, bool ccw) : out_(indices), ccw_(ccw) {}

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        out_[0] = a;
        out_[1] = ccw_ ? c : b;
        out_[2] = ccw_ ? b : c;
        out_ += 3;
    }

    // Rings that are both regular: n quads between two rows whose lengths differ by two. Outer
    // point k + 1 lies at inner point k.
    void regular(Row const& O, Row const& I)
    {
        std::uint32_t const n = I.count;
        add(O[0], O[1], I[0]);
        std::uint32_t const half = n / 2, plain = n < 2 ? 0 : n - 2;
        std::uint32_t k = 0;
        for (; k < std::min(half, plain); ++k) {
            std::uint32_t const o = O.first + k + 1, i = I.first + std::uint32_t(I.step) * k,
                                i1 = i + std::uint32_t(I.step);
            add(o, i1, i);
            add(o, o + 1, i1);
        }
        for (; k < plain; ++k) {
            std::uint32_t const o = O.first + k + 1, i = I.first + std::uint32_t(I.step) * k;
            add(i, o, o + 1);
            add(i, o + 1, i + std::uint32_t(I.step));
        }
        for (; k + 1 < n; ++k) // the last inner point may be the ring's first
            if (k < half) {
                add(O[k + 1], I[k + 1], I[k]);
                add(O[k + 1], O[k + 2], I[k + 1]);
            } else {
                add(I[k], O[k + 1], O[k + 2]);
                add(I[k], O[k + 2], I[k + 1]);
            }
        add(O[n], O[n + 1], I[n - 1]);
    }

    // The frame between an edge, with its own factor, and the first inner ring (rule R71).
    void transition(Row const& O, Span const& outer, Row const& I, Span const& inner)
    {
        std::uint32_t const ho = outer.stitch_half(), hi = inner.stitch_half();
        std::array<std::uint32_t, 66> const outer_row = O.all(), inner_row = I.all();
        std::uint32_t o = 0, i = 0;
        // A triangle on the outer or the inner row, by selects: nobody can predict which is next.
        auto const advance = [&](bool on_outer) {
            std::uint32_t const o0 = outer_row[o], o1 = outer_row[o + 1], i0 = inner_row[i],
                                i1 = inner_row[i + 1];
            add(on_outer ? o0 : i0, on_outer ? o1 : o0, on_outer ? i0 : i1);
            o += on_outer;
            i += !on_outer;
        };
        // By position, an inner one's bit below an outer one's: up, and down again.
        std::uint64_t const all = kOnHalfEdge[hi] | kOnHalfEdge[ho] << 1;
        if (ho > 0) advance(true);
        for (std::uint64_t bits = all; bits; bits &= bits - 1) advance(std::countr_zero(bits) & 1);
        if (inner.odd && outer.odd) {
            add(I[i], O[o], I[i + 1]);
            add(I[i + 1], O[o], O[o + 1]);
            ++i, ++o;
        } else if (outer.odd) {
            add(I[i], O[o], O[o + 1]);
            ++o;
        } else if (inner.odd) {
            advance(false);
        }
        for (std::uint64_t bits = all; bits; bits &= ~std::bit_floor(bits))
            advance(!(std::countl_zero(bits) & 1));
        if (ho > 0) advance(true);
    }

    std::uint32_t const* end() const { return out_; }

private:
    std::uint32_t* out_;
    bool ccw_;
};

// Where the next point goes.
class Points {
public:
    explicit Points(TessellatedPatch& out) : u_(out.u.data()), v_(out.v.data()), first_(u_) {}
    void add(std::uint32_t u, std::uint32_t v)
    {
        *u_++ = u;
        *v_++ = v;
    }
    std::uint32_t count() const { return std::uint32_t(u_ - first_); }

private:
    std::uint32_t *u_, *v_;
    std::uint32_t const* first_;
};

bool wants_triangles(TessellatorState const& s)
{
    return s.output == OutputPrimitive::TriangleCw || s.output == OutputPrimitive::TriangleCcw;
}

// The side `k` of a ring that starts at point `start`: the next side's first point is this one's
// last.
Row ring_side(std::uint32_t start, std::array<std::uint32_t, 4> const& counts, int sides, int k)
{
    std::uint32_t first = start;
    for (int s = 0; s < k; ++s) first += counts[std::size_t(s)] - 1;
    std::uint32_t const count = counts[std::size_t(k)];
    return {first, count, k + 1 == sides ? start : first + count - 1};
}

// Sizes the patch; memory that is there already is not touched again.
void set_size(TessellatedPatch& out, std::uint32_t points, std::uint32_t triangles)
{
    out.u.resize(points);
    out.v.resize(points);
    out.indices.resize(3 * std::size_t(triangles));
}

void tessellate_quad(TessellatorState const& state, FixedFactors const& f, TessellatedPatch& out)
{
    bool const minimal =
        state.partitioning != Partitioning::FractionalEven &&
        std::all_of(f.value.begin(), f.value.end(), [](std::uint32_t x) { return x == kOne; });
    bool const ccw = state.output == OutputPrimitive::TriangleCcw,
               triangulated = wants_triangles(state);
    if (minimal) {
        set_size(out, 4, triangulated ? 2 : 0);
        Points points(out);
        Triangles triangles(out.indices.data(), ccw);
        points.add(0, 0), points.add(kOne, 0), points.add(kOne, kOne), points.add(0, kOne);
        if (wants_triangles(state)) triangles.add(0, 1, 3), triangles.add(1, 2, 3);
        return;
    }

    std::array<Positions, 4> const edge{
        Positions(f.value[0], f.odd[0]), Positions(f.value[1], f.odd[1]),
        Positions(f.value[2], f.odd[2]), Positions(f.value[3], f.odd[3])};
    Positions const Pu(f.value[4], f.odd[4]), Pv(f.value[5], f.odd[5]);
    std::uint32_t const Nu = Pu.span.points, Nv = Pv.span.points;

    // Exact sizes (rule R73), m and n inside segments.
    std::uint32_t const m = Nu - 1, n = Nv - 1;
    std::uint32_t sum = 0;
    for (Positions const& e : edge) sum += e.span.points - 1;
    set_size(out, sum + (m - 1) * (n - 1),
             triangulated ? sum + 2 * (m - 2) * (n - 2) + 2 * (m - 2) + 2 * (n - 2) : 0);
    Points points(out);
    Triangles triangles(out.indices.data(), ccw);

    // Ring 0: the patch edges, walked (0,1) (0,0) (1,0) (1,1).
    for (std::uint32_t j = edge[0].span.points - 1; j >= 1; --j) points.add(0, edge[0][j]);
    for (std::uint32_t j = 0; j + 1 < edge[1].span.points; ++j) points.add(edge[1][j], 0);
    for (std::uint32_t j = 0; j + 1 < edge[2].span.points; ++j) points.add(kOne, edge[2][j]);
    for (std::uint32_t j = edge[3].span.points - 1; j >= 1; --j) points.add(edge[3][j], kOne);

    std::uint32_t const M = std::min(Nu, Nv) >> 1;
    std::array<std::uint32_t, 34> ring_start{};
    for (std::uint32_t k = 1; k < M; ++k) {
        ring_start[k] = points.count();
        std::uint32_t const eu = Nu - 1 - k, ev = Nv - 1 - k;
        for (std::uint32_t j = ev; j > k; --j) points.add(Pu[k], Pv[j]);
        for (std::uint32_t j = k; j < eu; ++j) points.add(Pu[j], Pv[k]);
        for (std::uint32_t j = k; j < ev; ++j) points.add(Pu[eu], Pv[j]);
        for (std::uint32_t j = eu; j > k; --j) points.add(Pu[j], Pv[ev]);
    }

    // The leftover row or column in the middle of an even span.
    bool const row = Nu > Nv && !f.odd[5];
    bool const column = !row && Nv >= Nu && !f.odd[4];
    std::uint32_t const leftover = points.count();
    if (row)
        for (std::uint32_t j = M; j <= Nu - 1 - M; ++j) points.add(Pu[j], kHalf);
    if (column)
        for (std::uint32_t j = Nv - M; j-- > M;) points.add(kHalf, Pv[j]);
    assert(points.count() == out.points());
    if (!triangulated) return;

    std::array<std::uint32_t, 4> outer_counts;
    for (std::size_t e = 0; e < 4; ++e) outer_counts[e] = edge[e].span.points;
    std::uint32_t outer_start = 0;
    std::uint32_t const K = std::min((Nu + 1) >> 1, (Nv + 1) >> 1);
    for (std::uint32_t k = 1; k < K; ++k) {
        std::array<std::uint32_t, 4> const counts{Nv - 2 * k, Nu - 2 * k, Nv - 2 * k, Nu - 2 * k};
        bool const last = k == M; // the leftover row or column
        for (int side = 0; side < 4; ++side) {
            Row const O = ring_side(outer_start, outer_counts, 4, side);
            Row I{};
            if (!last) {
                I = ring_side(ring_start[k], counts, 4, side);
            } else {
                std::uint32_t const length = row ? counts[1] : counts[0],
                                    end = leftover + length - 1;
                int const along =
                    row ? (side + 3) % 4 : side; // 0: as emitted, 1: end, 2: back, 3: start
                switch (along) {
                case 0:
                    I = {leftover, length, end};
                    break;
                case 1:
                    I = {end, 1, end};
                    break;
                case 2:
                    I = {end, length, leftover, -1};
                    break;
                default:
                    I = {leftover, 1, leftover};
                    break;
                }
            }
            Span const& inner = side % 2 == 0 ? Pv.span : Pu.span;
            if (k == 1)
                triangles.transition(O, edge[std::size_t(side)].span, I, inner);
            else
                triangles.regular(O, I);
        }
        outer_counts = counts;
        outer_start = ring_start[k];
    }

    // The centre strip, when the shorter axis is odd: its last ring is two points wide.
    std::uint32_t const L = M > 1 ? ring_start[M - 1] : 0;
    if (Nu > Nv && f.odd[5]) {
        std::uint32_t const Q = Nu - Nv + 1;
        auto const A = [&](std::uint32_t j) { return L + 1 + j; };
        auto const B = [&](std::uint32_t j) { return j == 0 ? L : L + 2 * Q + 2 - j; };
        for (std::uint32_t j = 0; j < Q; ++j) {
            triangles.add(B(j), A(j), A(j + 1));
            triangles.add(B(j), A(j + 1), B(j + 1));
        }
    } else if (Nv >= Nu && f.odd[4]) {
        std::uint32_t const Q = Nv - Nu + 1;
        auto const A = [&](std::uint32_t j) { return L + j; };
        auto const B = [&](std::uint32_t j) { return L + 2 * Q + 1 - j; };
        for (std::uint32_t j = 0; j < Q; ++j) {
            if (!f.odd[5]) {
                triangles.add(B(j), A(j), A(j + 1));
                triangles.add(B(j), A(j + 1), B(j + 1));
            } else if (j != (Q - 1) / 2) {
                triangles.add(A(j), A(j + 1), B(j));
                triangles.add(B(j), A(j + 1), B(j + 1));
            } else {
                triangles.add(A(j), B(j + 1), B(j));
                triangles.add(A(j), A(j + 1), B(j + 1));
            }
        }
    }
    assert(triangles.end() == out.indices.data() + out.indices.size());
}

void tessellate_tri(TessellatorState const& state, FixedFactors const& f, TessellatedPatch& out)
{
    bool const ccw = state.output == OutputPrimitive::TriangleCcw,
               triangulated = wants_triangles(state);
    bool const minimal = state.partitioning != Partitioning::FractionalEven &&
                         std::all_of(f.value.begin(), f.value.begin() + 4,
                                     [](std::uint32_t x) { return x == kOne; });
    if (minimal) {
        set_size(out, 3, triangulated ? 1 : 0);
        Points points(out);
        Triangles triangles(out.indices.data(), ccw);
        points.add(0, kOne), points.add(0, 0), points.add(kOne, 0);
        if (wants_triangles(state)) triangles.add(0, 1, 2);
        return;
    }

    std::array<Positions, 3> const edge{Positions(f.value[0], f.odd[0]),
                                        Positions(f.value[1], f.odd[1]),
                                        Positions(f.value[2], f.odd[2])};
    Positions const P(f.value[3], f.odd[3]);
    std::uint32_t const N = P.span.points;

    // Exact sizes (rule R73).
    std::uint32_t point_count = 0;
    for (Positions const& e : edge) point_count += e.span.points - 1;
    std::uint32_t triangle_count = point_count;
    for (std::uint32_t r = 1; 2 * r < N; ++r) {
        std::uint32_t const q = N - 1 - 2 * r;
        triangle_count += q == 1 ? 4 : 6 * q;
        point_count += q == 0 ? 1 : 3 * q;
    }
    set_size(out, point_count, triangulated ? triangle_count : 0);
    Points points(out);
    Triangles triangles(out.indices.data(), ccw);

    for (std::uint32_t j = edge[0].span.points - 1; j >= 1; --j) points.add(0, edge[0][j]);
    for (std::uint32_t j = 0; j + 1 < edge[1].span.points; ++j) points.add(edge[1][j], 0);
    for (std::uint32_t j = edge[2].span.points - 1; j >= 1; --j)
        points.add(edge[2][j], kOne - edge[2][j]);

    std::array<std::uint32_t, 34> ring_start{};
    std::uint32_t const rings = N >> 1;
    for (std::uint32_t k = 1; k < rings; ++k) {
        ring_start[k] = points.count();
        std::uint32_t const e = N - 1 - k;
        std::uint32_t const c = (P[k] * 0xaaaau + 0x8000u) >> 16; // two thirds of P(k)
        std::uint32_t const d = (c + 1) / 2;
        for (std::uint32_t j = e; j > k; --j) points.add(c, P[j] - d);
        for (std::uint32_t j = k; j < e; ++j) points.add(P[j] - d, c);
        for (std::uint32_t j = e; j > k; --j) {
            std::uint32_t const u = P[j] - d;
            points.add(u, kOne - u - c);
        }
    }
    if (!f.odd[3]) {
        ring_start[rings] = points.count();
        points.add(0x5555, 0x5555);
    }
    assert(points.count() == out.points());
    if (!triangulated) return;

    std::array<std::uint32_t, 4> outer_counts{edge[0].span.points, edge[1].span.points,
                                              edge[2].span.points, 0};
    std::uint32_t outer_start = 0;
    for (std::uint32_t k = 1; k < (N + 1) >> 1; ++k) {
        std::uint32_t const n = N - 2 * k;
        std::array<std::uint32_t, 4> const counts{n, n, n, 0};
        for (int side = 0; side < 3; ++side) {
            Row const O = ring_side(outer_start, outer_counts, 3, side);
            Row const I = n == 1 ? Row{ring_start[k], 1, ring_start[k]}
                                 : ring_side(ring_start[k], counts, 3, side);
            if (k == 1)
                triangles.transition(O, edge[std::size_t(side)].span, I, P.span);
            else
                triangles.regular(O, I);
        }
        outer_counts = counts;
        outer_start = ring_start[k];
    }
    if (f.odd[3]) triangles.add(outer_start, outer_start + 1, outer_start + 2);
    assert(triangles.end() == out.indices.data() + out.indices.size());
}

void tessellate_isoline(TessellatorState const& state, FixedFactors const& f, TessellatedPatch& out)
{
    Positions const lines(f.value[0], f.odd[0]), detail(f.value[1], f.odd[1]);
    std::uint32_t const density = f.value[0] >> 16;
    set_size(out, density * detail.span.points, 0);
    Points points(out);
    for (std::uint32_t l = 0; l < density; ++l) {
        std::uint32_t const start = points.count();
        for (std::uint32_t j = 0; j < detail.span.points; ++j) points.add(detail[j], lines[l]);
        if (state.output == OutputPrimitive::Point) continue;
        for (std::uint32_t j = 0; j + 1 < detail.span.points; ++j) {
            out.indices.push_back(start + j);
            out.indices.push_back(start + j + 1);
        }
    }
}

} // namespace

void tessellate(TessellatorState const& state, FixedFactors const& factors, TessellatedPatch& out)
{
    if (factors.culled) return set_size(out, 0, 0);
    switch (state.domain) {
    case TessellatorDomain::Quad:
        tessellate_quad(state, factors, out);
        break;
    case TessellatorDomain::Tri:
        tessellate_tri(state, factors, out);
        break;
    case TessellatorDomain::Isoline:
        tessellate_isoline(state, factors, out);
        break;
    }
    auto const n = std::uint32_t(out.points());
    if (state.output == OutputPrimitive::Point) {
        for (std::uint32_t i = 0; i < n; ++i) out.indices.push_back(i);
    } else if (state.output == OutputPrimitive::Line &&
               state.domain != TessellatorDomain::Isoline) {
        for (std::uint32_t i = 0; i + 1 < n; ++i) {
            out.indices.push_back(i);
            out.indices.push_back(i + 1);
        }
    }
}

std::vector<std::uint32_t> span_positions(std::uint32_t factor, bool odd)
{
    Span const span(factor, odd);
    std::vector<std::uint32_t> p(span.points);
    for (std::uint32_t i = 0; i < span.points; ++i) p[i] = span.position(i);
    return p;
}

} // namespace tessemu
