// Lanes<N>: one float per shader invocation, N invocations in step, on the compilers' vector
// extension.
//
// Mask<N> is the result of a comparison and is not a bool: a shader cannot branch on lanes, it
// selects. IntLanes<N> holds indices. Every operation is the IEEE one lane by lane, so a lane's
// bits do not depend on N.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/scalar.h"

#include <utility>

#if defined(__AVX__)
#include <immintrin.h>
#endif

namespace tessemu {

namespace detail {
// Through a helper struct: g++ drops the attribute on a dependent typedef at its point of use.
template <int N> struct Raw {
    typedef float f32 __attribute__((vector_size(4 * N)));
    typedef std::int32_t i32 __attribute__((vector_size(4 * N)));
    typedef std::uint32_t u32 __attribute__((vector_size(4 * N)));
    typedef std::int64_t i64 __attribute__((vector_size(4 * N)));
};

// Bit i is the sign of lane i.
template <int N> std::uint32_t signs(typename Raw<N>::i32 raw)
{
#if defined(__AVX512DQ__)
    if constexpr (N == 16) return _mm512_movepi32_mask(__m512i(raw));
#endif
#if defined(__AVX__)
    if constexpr (N == 8) return std::uint32_t(_mm256_movemask_ps(__m256(raw)));
#endif
    if constexpr (N == 4) return std::uint32_t(_mm_movemask_ps(__m128(raw)));
    std::uint32_t b = 0;
    for (int i = 0; i < N; ++i) b |= std::uint32_t(raw[i] < 0) << i;
    return b;
}
} // namespace detail

/// A bit for each of N lanes.
template <int N> constexpr std::uint32_t all_lanes()
{
    return N == 32 ? ~0u : (1u << N) - 1;
}

template <int N> struct Mask {
    using Raw = typename detail::Raw<N>::i32;
    Raw raw; // 0 or -1

    Mask() = default;
    Mask(Raw r) : raw(r) {}
    explicit Mask(bool b) : raw(Raw{} - int(b)) {}
    friend Mask operator&(Mask a, Mask b) { return Raw(a.raw & b.raw); }
    friend Mask operator|(Mask a, Mask b) { return Raw(a.raw | b.raw); }
    friend Mask operator!(Mask a) { return Raw(~a.raw); }

    /// Bit i is lane i.
    std::uint32_t bits() const { return detail::signs<N>(raw); }

    /// Lane i is bit i.
    static Mask of(std::uint32_t bits)
    {
        Raw bit;
        for (int i = 0; i < N; ++i) bit[i] = 1 << i;
        return Raw(((std::int32_t(bits) - Raw{}) & bit) != 0);
    }
    /// The first n lanes.
    static Mask first(int n)
    {
        Raw lane;
        for (int i = 0; i < N; ++i) lane[i] = i;
        return Raw(lane < n - Raw{});
    }
    friend bool any(Mask m) { return m.bits() != 0; }
    friend bool all(Mask m) { return m.bits() == all_lanes<N>(); }
};

template <int N> struct IntLanes {
    using Raw = typename detail::Raw<N>::i32;
    using Wrap = typename detail::Raw<N>::u32;
    Raw raw;

    IntLanes() = default;
    IntLanes(Raw r) : raw(r) {}
    IntLanes(std::int32_t x) : raw(x - Raw{}) {}
    /// 0, 1, 2, ...
    static IntLanes iota()
    {
        Raw r;
        for (int i = 0; i < N; ++i) r[i] = i;
        return r;
    }
    /// Bit i is set where lane i is below 0.
    std::uint32_t negative() const { return detail::signs<N>(raw); }
    // Shader integers wrap.
    friend IntLanes operator+(IntLanes a, IntLanes b) { return Raw(Wrap(a.raw) + Wrap(b.raw)); }
    friend IntLanes operator-(IntLanes a, IntLanes b) { return Raw(Wrap(a.raw) - Wrap(b.raw)); }
    friend IntLanes operator*(IntLanes a, IntLanes b) { return Raw(Wrap(a.raw) * Wrap(b.raw)); }
    friend IntLanes operator&(IntLanes a, IntLanes b) { return a.raw & b.raw; }
    friend IntLanes operator|(IntLanes a, IntLanes b) { return a.raw | b.raw; }
    friend IntLanes operator^(IntLanes a, IntLanes b) { return a.raw ^ b.raw; }
    friend IntLanes operator<<(IntLanes a, IntLanes b) { return Raw(Wrap(a.raw) << Wrap(b.raw)); }
    friend IntLanes operator>>(IntLanes a, IntLanes b) { return a.raw >> b.raw; }
    friend Mask<N> operator==(IntLanes a, IntLanes b) { return Mask<N>(a.raw == b.raw); }
    friend Mask<N> operator!=(IntLanes a, IntLanes b) { return Mask<N>(a.raw != b.raw); }
    friend Mask<N> operator<(IntLanes a, IntLanes b) { return Mask<N>(a.raw < b.raw); }
    friend Mask<N> operator>(IntLanes a, IntLanes b) { return Mask<N>(a.raw > b.raw); }
    friend Mask<N> operator<=(IntLanes a, IntLanes b) { return Mask<N>(a.raw <= b.raw); }
    friend Mask<N> operator>=(IntLanes a, IntLanes b) { return Mask<N>(a.raw >= b.raw); }
    friend IntLanes select(Mask<N> m, IntLanes a, IntLanes b)
    {
        return Raw((a.raw & m.raw) | (b.raw & ~m.raw));
    }
};

template <int N> struct Lanes {
    using Raw = typename detail::Raw<N>::f32;
    using Bits = typename detail::Raw<N>::i32;
    Raw raw;

    Lanes() = default;
    Lanes(Raw r) : raw(r) {}
    Lanes(float x) : raw(x - Raw{}) {} // minus: x + 0 would lose the sign of -0
    explicit Lanes(IntLanes<N> i) : raw(__builtin_convertvector(i.raw, Raw)) {}

    static Lanes load(float const* p)
    {
        Lanes l;
        __builtin_memcpy(&l.raw, p, sizeof l.raw);
        return l;
    }
    void store(float* p) const { __builtin_memcpy(p, &raw, sizeof raw); }

    friend Lanes operator+(Lanes a, Lanes b) { return a.raw + b.raw; }
    friend Lanes operator-(Lanes a, Lanes b) { return a.raw - b.raw; }
    friend Lanes operator*(Lanes a, Lanes b) { return a.raw * b.raw; }
    friend Lanes operator/(Lanes a, Lanes b) { return a.raw / b.raw; }
    friend Lanes operator-(Lanes a) { return -a.raw; }
    friend Mask<N> operator<(Lanes a, Lanes b) { return Mask<N>(a.raw < b.raw); }
    friend Mask<N> operator>(Lanes a, Lanes b) { return Mask<N>(a.raw > b.raw); }
    friend Mask<N> operator<=(Lanes a, Lanes b) { return Mask<N>(a.raw <= b.raw); }
    friend Mask<N> operator>=(Lanes a, Lanes b) { return Mask<N>(a.raw >= b.raw); }
    friend Mask<N> operator==(Lanes a, Lanes b) { return Mask<N>(a.raw == b.raw); }
    friend Mask<N> operator!=(Lanes a, Lanes b) { return Mask<N>(a.raw != b.raw); }

    friend Lanes select(Mask<N> m, Lanes a, Lanes b) { return Lanes(Raw(m.raw ? a.raw : b.raw)); }
    // These round correctly, so one instruction gives the loop's bits.
    friend Lanes sqrt(Lanes a)
    {
#if defined(__AVX512F__)
        if constexpr (N == 16) return Raw(_mm512_maskz_sqrt_ps(__mmask16(-1), __m512(a.raw)));
#endif
#if defined(__AVX__)
        if constexpr (N == 8) return Raw(_mm256_sqrt_ps(__m256(a.raw)));
        if constexpr (N == 4) return Raw(_mm_sqrt_ps(__m128(a.raw)));
#endif
        Lanes r;
        for (int i = 0; i < N; ++i) r.raw[i] = __builtin_sqrtf(a.raw[i]);
        return r;
    }
    friend Lanes floor(Lanes a)
    {
#if defined(__AVX512F__)
        if constexpr (N == 16)
            return Raw(_mm512_maskz_roundscale_ps(__mmask16(-1), __m512(a.raw), _MM_FROUND_FLOOR));
#endif
#if defined(__AVX__)
        if constexpr (N == 8) return Raw(_mm256_floor_ps(__m256(a.raw)));
        if constexpr (N == 4) return Raw(_mm_floor_ps(__m128(a.raw)));
#endif
        Lanes r;
        for (int i = 0; i < N; ++i) r.raw[i] = __builtin_floorf(a.raw[i]);
        return r;
    }
    friend Lanes abs(Lanes a)
    {
        return Raw(Bits(a.raw) & 0x7fffffff);
    }
    // One instruction orders as HLSL does, -0 below +0 too, once signalling NaNs are quiet.
    friend Lanes min(Lanes a, Lanes b)
    {
#if defined(__AVX512DQ__)
        if constexpr (N == 16) {
            Lanes const zero(detail::minus_zero);
            return Raw(_mm512_range_ps(__m512((b + zero).raw), __m512((a + zero).raw), 4));
        }
#endif
#if defined(__AVX__)
        if constexpr (N == 8) {
            __m256 const x(a.raw), y(b.raw);
            if (b.is_known_above(0))
                return Lanes(Raw(_mm256_min_ps(x, y))) + Lanes(detail::minus_zero);
            return ordered(x, y, _mm256_or_ps(_mm256_min_ps(y, x), _mm256_min_ps(x, y)));
        }
#endif
        Lanes const equal = Raw(Bits(a.raw) | Bits(b.raw));
        return select(a < b, a, select(b < a, b, select(a == b, equal, select(a == a, a, b)))) +
               Lanes(detail::minus_zero);
    }
    friend Lanes max(Lanes a, Lanes b)
    {
#if defined(__AVX512DQ__)
        if constexpr (N == 16) {
            Lanes const zero(detail::minus_zero);
            return Raw(_mm512_range_ps(__m512((b + zero).raw), __m512((a + zero).raw), 5));
        }
#endif
#if defined(__AVX__)
        if constexpr (N == 8) {
            __m256 const x(a.raw), y(b.raw);
            if (b.is_known_above(-1)) return Raw(_mm256_max_ps(x, y));
            return ordered(x, y, _mm256_and_ps(_mm256_max_ps(y, x), _mm256_max_ps(x, y)));
        }
#endif
        Lanes const equal = Raw(Bits(a.raw) & Bits(b.raw));
        return select(a > b, a, select(b > a, b, select(a == b, equal, select(a == a, a, b)))) +
               Lanes(detail::minus_zero);
    }
    friend Lanes mad(Lanes a, Lanes b, Lanes c)
    {
#if defined(__AVX512F__)
        if constexpr (N == 16)
            return Raw(_mm512_fmadd_ps(__m512(a.raw), __m512(b.raw), __m512(c.raw)));
#endif
#if defined(__FMA__)
        if constexpr (N == 8)
            return Raw(_mm256_fmadd_ps(__m256(a.raw), __m256(b.raw), __m256(c.raw)));
        if constexpr (N == 4) return Raw(_mm_fmadd_ps(__m128(a.raw), __m128(b.raw), __m128(c.raw)));
#endif
        Lanes r;
        for (int i = 0; i < N; ++i) r.raw[i] = fused_multiply_add(a.raw[i], b.raw[i], c.raw[i]);
        return r;
    }

private:
#if defined(__AVX__)
    // Whether the compiler knows all lanes, and they are 0 or normal numbers whose bits are above
    // `bits`. Then an instruction with them as the second operand needs no help: it gives them where
    // the first is none, and a maximum with them is never a denormal.
    bool is_known_above(std::int32_t bits) const
    {
        return [&]<int... i>(std::integer_sequence<int, i...>)
        {
            return ((__builtin_constant_p(raw[i]) && std::bit_cast<std::int32_t>(raw[i]) > bits &&
                     (raw[i] == 0 || (raw[i] >= 0x1p-126f && raw[i] <= 0x1p127f))) &&
                    ...);
        }
        (std::make_integer_sequence<int, N>());
    }

    // The instruction's minimum or maximum where both are numbers, else the one that is: it gives its
    // second operand for equals and for none, so `both` are the results of either order as one.
    static Lanes ordered(__m256 x, __m256 y, __m256 both)
    {
        __m256 const number = _mm256_blendv_ps(x, y, _mm256_cmp_ps(x, x, _CMP_UNORD_Q));
        return Lanes(Raw(_mm256_blendv_ps(both, number, _mm256_cmp_ps(x, y, _CMP_UNORD_Q)))) +
               Lanes(detail::minus_zero);
    }
#endif
};

template <int N> struct ScalarTraits<Lanes<N>> {
    using Storage = float;
    using Mask = tessemu::Mask<N>;
    using Int = IntLanes<N>;
    static constexpr int kLanes = N;
    static constexpr bool kCounted = false, kTally = false, kSites = false;
};

/// The widest lanes that the build's instruction set fills.
#if defined(__AVX512F__)
inline constexpr int kNativeLanes = 16;
#elif defined(__AVX__)
inline constexpr int kNativeLanes = 8;
#else
inline constexpr int kNativeLanes = 4;
#endif
/// Of the fixed-function stages, whose tables are laid out for 8 or 16.
inline constexpr int kRasterLanes = kNativeLanes == 16 ? 16 : 8;

} // namespace tessemu
