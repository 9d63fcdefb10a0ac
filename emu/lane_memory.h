// Lanes and memory: gather, compress, permute, by the instruction where the build has it (in its
// masked form: g++ 12 warns about the plain one's unused source).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/lanes.h"

#include <algorithm>
#include <array>
#include <bit>

namespace tessemu {

/// memory[index] per lane, of 32 bits each; all indices are in range.
template <int N> IntLanes<N> gather(void const* memory, IntLanes<N> index)
{
#if defined(__AVX512F__)
    if constexpr (N == 16)
        return typename IntLanes<N>::Raw(_mm512_mask_i32gather_epi32(
            _mm512_setzero_si512(), __mmask16(-1), __m512i(index.raw), memory, 4));
#endif
#if defined(__AVX2__)
    if constexpr (N == 8)
        return typename IntLanes<N>::Raw(
            _mm256_i32gather_epi32(static_cast<int const*>(memory), __m256i(index.raw), 4));
#endif
    std::int32_t r[N];
    for (int i = 0; i < N; ++i)
        __builtin_memcpy(&r[i], static_cast<char const*>(memory) + 4 * std::ptrdiff_t(index.raw[i]),
                         4);
    IntLanes<N> out;
    __builtin_memcpy(&out.raw, r, sizeof r);
    return out;
}
template <int N> Lanes<N> gather(float const* memory, IntLanes<N> index)
{
    IntLanes<N> const r = gather<N>(static_cast<void const*>(memory), index);
    return typename Lanes<N>::Raw(r.raw);
}

/// memory[index] per lane, of 32 bits each, and 0 where the index is not below `size`.
template <int N> IntLanes<N> gather_or_zero(void const* memory, std::size_t size, IntLanes<N> index)
{
    if (size == 0) return 0;
    auto const n = std::int32_t(std::min<std::size_t>(size, 0x7fffffff));
    Mask<N> const inside = (IntLanes<N>(-1) < index) & (index < IntLanes<N>(n));
    IntLanes<N> const r = gather<N>(memory, select(inside, index, IntLanes<N>(0)));
    return select(inside, r, IntLanes<N>(0));
}

template <int N> IntLanes<N> load_lanes(std::int32_t const* p)
{
    IntLanes<N> r;
    __builtin_memcpy(&r.raw, p, sizeof r.raw);
    return r;
}
template <int N> void store_lanes(IntLanes<N> v, std::int32_t* p)
{
    __builtin_memcpy(p, &v.raw, sizeof v.raw);
}

namespace detail {
template <int N> using Floats = typename Raw<N>::f32;

// Four records of four as four columns of four, and back.
inline void transpose(Floats<4> (&r)[4])
{
    Floats<4> const a = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5),
                    b = __builtin_shufflevector(r[2], r[3], 0, 4, 1, 5),
                    c = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7),
                    d = __builtin_shufflevector(r[2], r[3], 2, 6, 3, 7);
    r[0] = __builtin_shufflevector(a, b, 0, 1, 4, 5);
    r[1] = __builtin_shufflevector(a, b, 2, 3, 6, 7);
    r[2] = __builtin_shufflevector(c, d, 0, 1, 4, 5);
    r[3] = __builtin_shufflevector(c, d, 2, 3, 6, 7);
}

// N lanes from pieces of four; in registers: a whole load of what was stored in pieces waits.
template <int N> Floats<N> joined(Floats<4> const* p)
{
    if constexpr (N == 4) {
        return p[0];
    } else if constexpr (N == 8) {
        return __builtin_shufflevector(p[0], p[1], 0, 1, 2, 3, 4, 5, 6, 7);
    } else {
        static_assert(N == 16);
        return __builtin_shufflevector(joined<8>(p), joined<8>(p + 2), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9,
                                       10, 11, 12, 13, 14, 15);
    }
}
} // namespace detail

/// Three floats from memory[index[l]] on in each lane l. Four are read.
template <int N> void load_vectors(float const* memory, IntLanes<N> index, Lanes<N> (&out)[3])
{
    std::int32_t at[N];
    store_lanes<N>(index, at);
    detail::Floats<4> column[3][N / 4];
    for (int g = 0; g < N / 4; ++g) {
        detail::Floats<4> r[4];
        for (int l = 0; l < 4; ++l) __builtin_memcpy(&r[l], memory + at[4 * g + l], sizeof r[l]);
        detail::transpose(r);
        for (int k = 0; k < 3; ++k) column[k][g] = r[k];
    }
    for (int k = 0; k < 3; ++k) out[k].raw = detail::joined<N>(column[k]);
}

/// memory[index] per lane, where lanes 2 l and 2 l + 1 have neighbours: their indices are those of
/// even lanes and one more.
template <int N> Lanes<N> load_pairs(float const* memory, IntLanes<N> index)
{
    detail::Floats<4> parts[N / 4];
    for (int q = 0; q < N / 4; ++q) {
        std::int64_t pair[2];
        for (int i = 0; i < 2; ++i)
            __builtin_memcpy(&pair[i], memory + index.raw[4 * q + 2 * i], sizeof pair[i]);
        parts[q] = detail::Floats<4>(detail::Raw<4>::i64{pair[0], pair[1]});
    }
    return typename Lanes<N>::Raw(detail::joined<N>(parts));
}

#if defined(__AVX2__)
namespace detail {
// By mask of eight lanes: which of them come to the front.
inline constexpr auto kCompressed8 = [] {
    std::array<std::array<std::uint8_t, 8>, 256> table{};
    for (std::size_t mask = 0; mask < table.size(); ++mask) {
        std::size_t n = 0;
        for (std::uint8_t lane = 0; lane < 8; ++lane)
            if (mask >> lane & 1) table[mask][n++] = lane;
    }
    return table;
}();
} // namespace detail
#endif

/// The lanes whose bit is set, moved to the front in order. What follows them is unspecified.
template <int N> IntLanes<N> compress(IntLanes<N> v, std::uint32_t bits)
{
#if defined(__AVX512F__)
    if constexpr (N == 16)
        return
            typename IntLanes<N>::Raw(_mm512_maskz_compress_epi32(__mmask16(bits), __m512i(v.raw)));
#endif
#if defined(__AVX2__)
    if constexpr (N == 8) {
        auto const* const lanes =
            reinterpret_cast<__m128i const*>(detail::kCompressed8[bits & 0xff].data());
        return typename IntLanes<N>::Raw(_mm256_permutevar8x32_epi32(
            __m256i(v.raw), _mm256_cvtepu8_epi32(_mm_loadl_epi64(lanes))));
    }
#endif
    IntLanes<N> r(0);
    int n = 0;
    for (; bits; bits &= bits - 1) r.raw[n++] = v.raw[std::countr_zero(bits)];
    return r;
}
template <int N> Lanes<N> compress(Lanes<N> v, std::uint32_t bits)
{
    using Int = typename IntLanes<N>::Raw;
    return typename Lanes<N>::Raw(compress(IntLanes<N>(Int(v.raw)), bits).raw);
}

/// v[index] per lane, indices 0 to N-1.
template <int N> IntLanes<N> permute(IntLanes<N> v, IntLanes<N> index)
{
#if defined(__AVX512F__)
    if constexpr (N == 16)
        return typename IntLanes<N>::Raw(_mm512_mask_permutexvar_epi32(
            __m512i(v.raw), __mmask16(-1), __m512i(index.raw), __m512i(v.raw)));
#endif
#if defined(__AVX2__)
    if constexpr (N == 8)
        return typename IntLanes<N>::Raw(
            _mm256_permutevar8x32_epi32(__m256i(v.raw), __m256i(index.raw)));
#endif
    IntLanes<N> r;
    for (int i = 0; i < N; ++i) r.raw[i] = v.raw[index.raw[i]];
    return r;
}
template <int N> Lanes<N> permute(Lanes<N> v, IntLanes<N> index)
{
    using Int = typename IntLanes<N>::Raw;
    return typename Lanes<N>::Raw(permute(IntLanes<N>(Int(v.raw)), index).raw);
}

/// Lane i takes element index[i] of a and b laid end to end.
template <int N> IntLanes<N> permute2(IntLanes<N> a, IntLanes<N> b, IntLanes<N> index)
{
#if defined(__AVX512F__)
    if constexpr (N == 16)
        return typename IntLanes<N>::Raw(
            _mm512_permutex2var_epi32(__m512i(a.raw), __m512i(index.raw), __m512i(b.raw)));
#endif
#if defined(__AVX2__)
    if constexpr (N == 8) {
        // Three bits choose in each, the fourth between both.
        IntLanes<N> const in_a = permute(a, index), in_b = permute(b, index);
        return typename IntLanes<N>::Raw(
            _mm256_blendv_ps(__m256(in_a.raw), __m256(in_b.raw), __m256((index << 28).raw)));
    }
#endif
    return select(index < IntLanes<N>(N), permute(a, index & IntLanes<N>(N - 1)),
                  permute(b, index & IntLanes<N>(N - 1)));
}

template <int N> IntLanes<N> min(IntLanes<N> a, IntLanes<N> b)
{
    return typename IntLanes<N>::Raw(a.raw < b.raw ? a.raw : b.raw);
}
template <int N> IntLanes<N> max(IntLanes<N> a, IntLanes<N> b)
{
    return typename IntLanes<N>::Raw(a.raw > b.raw ? a.raw : b.raw);
}

/// The smallest lane and the largest.
template <int N> struct LaneRange {
    std::int32_t low, high;

    explicit LaneRange(IntLanes<N> v) : LaneRange(v, v) {}
    /// Of the lanes of both.
    LaneRange(IntLanes<N> least, IntLanes<N> most)
    {
        for (int half = N / 2; half > 0; half /= 2) {
            IntLanes<N> const other = IntLanes<N>::iota() ^ IntLanes<N>(half);
            least = min(least, permute(least, other));
            most = max(most, permute(most, other));
        }
        low = least.raw[0], high = most.raw[0];
    }
};

/// The lanes whose bit is set; the others are like one of these.
template <int N> IntLanes<N> only(IntLanes<N> v, std::uint32_t bits)
{
    return select(Mask<N>::of(bits), v, IntLanes<N>(v.raw[std::countr_zero(bits) % N]));
}

/// Bytes as lanes.
template <int N> IntLanes<N> load_bytes(std::uint8_t const* p)
{
#if defined(__AVX512F__)
    if constexpr (N == 16)
        return typename IntLanes<N>::Raw(_mm512_maskz_cvtepu8_epi32(
            __mmask16(-1), _mm_loadu_si128(reinterpret_cast<__m128i const*>(p))));
#endif
#if defined(__AVX2__)
    if constexpr (N == 8)
        return typename IntLanes<N>::Raw(
            _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<__m128i const*>(p))));
#endif
    typedef std::uint8_t Bytes __attribute__((vector_size(N)));
    Bytes b;
    __builtin_memcpy(&b, p, N);
    return __builtin_convertvector(b, typename IntLanes<N>::Raw);
}

/// Numbers of 16 bits as lanes.
template <int N> IntLanes<N> load_words(std::uint16_t const* p)
{
#if defined(__AVX512F__)
    if constexpr (N == 16)
        return typename IntLanes<N>::Raw(_mm512_maskz_cvtepu16_epi32(
            __mmask16(-1), _mm256_loadu_si256(reinterpret_cast<__m256i const*>(p))));
#endif
#if defined(__AVX2__)
    if constexpr (N == 8)
        return typename IntLanes<N>::Raw(
            _mm256_cvtepu16_epi32(_mm_loadu_si128(reinterpret_cast<__m128i const*>(p))));
#endif
    typedef std::uint16_t Words __attribute__((vector_size(2 * N)));
    Words w;
    __builtin_memcpy(&w, p, 2 * N);
    return __builtin_convertvector(w, typename IntLanes<N>::Raw);
}

/// The low byte of each lane.
template <int N> void store_bytes(IntLanes<N> v, std::uint8_t* p)
{
#if defined(__AVX512F__)
    if constexpr (N == 16)
        return _mm_storeu_si128(reinterpret_cast<__m128i*>(p),
                                _mm512_maskz_cvtepi32_epi8(__mmask16(-1), __m512i(v.raw)));
#endif
    typedef std::uint8_t Bytes __attribute__((vector_size(N)));
    Bytes const b = __builtin_convertvector(v.raw, Bytes);
    __builtin_memcpy(p, &b, N);
}

} // namespace tessemu
