// What a shader's scalar type T must tell about itself, and the plain scalars float and double.
//
// A shader is a template on T. The traits below are all that stages and memory views ask of it, so
// a new kind of machine is one header that specialises ScalarTraits.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/floating_point.h"

#include <bit>
#include <concepts>
#include <cstdint>

namespace tessemu {

/// Traits of a shader scalar.
///
/// Storage    the element type memory holds (float or double)
/// Mask       the result of a comparison
/// Int        the matching integer, for indices
/// kLanes     invocations that advance in step
/// kCounted   whether arithmetic and fetches are counted
/// kTally     whether the type only counts, at compile time
/// kSites     whether the type numbers its places in the source (emu/contracted.h)
/// Recording  of a type that records its expression, and only there: what it records into
template <class T> struct ScalarTraits;

template <class T> using storage_of = typename ScalarTraits<T>::Storage;
template <class T> using mask_of = typename ScalarTraits<T>::Mask;
template <class T> using int_of = typename ScalarTraits<T>::Int;
template <class T> inline constexpr int lanes_of = ScalarTraits<T>::kLanes;

template <class T>
concept ShaderScalar = requires
{
    typename ScalarTraits<T>::Storage;
};

/// A scalar that stands for an expression (emu/graph.h): views of memory ask it for new_view(),
/// fetch() and load() in place of values.
template <class T>
concept RecordingScalar = requires
{
    typename ScalarTraits<T>::Recording;
};

template <std::floating_point F> struct ScalarTraits<F> {
    using Storage = F;
    using Mask = bool;
    using Int = std::int32_t;
    static constexpr int kLanes = 1;
    static constexpr bool kCounted = false, kTally = false, kSites = false;
};

// HLSL intrinsics on plain scalars. They are templates on the floating type only, so that a wrapper
// type never falls into them through a conversion.

template <std::floating_point F> F sqrt(F x)
{
    return __builtin_sqrt(x);
}
template <> inline float sqrt(float x)
{
    return __builtin_sqrtf(x);
}
template <std::floating_point F> F floor(F x)
{
    return __builtin_floor(x);
}
template <std::floating_point F> F abs(F x)
{
    return x < F(0) ? -x : x + F(0);
}

template <class V>
requires std::floating_point<V> || std::integral<V>
constexpr V select(bool mask, V yes, V no)
{
    return mask ? yes : no;
}

constexpr bool any(bool mask)
{
    return mask;
}
constexpr bool all(bool mask)
{
    return mask;
}

namespace detail {
/// -0, which the compiler must not know: x + -0 is x but for the flush of a denormal x, and
/// compilers drop the addition of a constant -0.
constinit inline float minus_zero = -0.0f;

template <class F> using bits_of = std::conditional_t<sizeof(F) == 4, std::uint32_t, std::uint64_t>;
} // namespace detail

/// HLSL min: NaN loses against a number (R12), -0 is below +0 (I-5), a denormal result is flushed
/// in the flushing mode (adding -0 changes nothing else).
template <std::floating_point F> F min(F a, F b)
{
    using Bits = detail::bits_of<F>;
    F const equal = std::bit_cast<F>(std::bit_cast<Bits>(a) | std::bit_cast<Bits>(b));
    F const r = a < b ? a : b < a ? b : a == b ? equal : a == a ? a : b;
    return r + F(detail::minus_zero);
}

/// HLSL max, see min.
template <std::floating_point F> F max(F a, F b)
{
    using Bits = detail::bits_of<F>;
    F const equal = std::bit_cast<F>(std::bit_cast<Bits>(a) & std::bit_cast<Bits>(b));
    F const r = a > b ? a : b > a ? b : a == b ? equal : a == a ? a : b;
    return r + F(detail::minus_zero);
}

/// a * b + c with one rounding, by the instruction where the processor has it and exactly in double
/// elsewhere: the product of two floats is exact in double; the sum is rounded to odd there, which
/// makes the second rounding, to float, the only one that counts.
inline float fused_multiply_add_exact(float a, float b, float c)
{
    double const product = double(a) * double(b);
    double const addend = double(c);
    double sum = product + addend;
    double const back = sum - product;
    double const error = (product - (sum - back)) + (addend - back);
    auto bits = std::bit_cast<std::uint64_t>(sum);
    if (error != 0 && (bits & 1) == 0 && sum - sum == 0) {
        bits += (error > 0) == (sum > 0) ? 1 : std::uint64_t(-1);
        sum = std::bit_cast<double>(bits);
    }
    return float(sum);
}

inline float fused_multiply_add(float a, float b, float c)
{
#ifdef __FMA__
    return __builtin_fmaf(a, b, c);
#else
    return fused_multiply_add_exact(a, b, c);
#endif
}

/// HLSL mad, by choice I-6 fused where it is written out.
inline float mad(float a, float b, float c)
{
    return fused_multiply_add(a, b, c);
}
inline double mad(double a, double b, double c)
{
    return __builtin_fma(a, b, c);
}

} // namespace tessemu
