// Resource formats and the conversions between shader floats and memory (rules R20 to R26).
//
// Every conversion is the exact ideal formula of the specification (choice I-8), in integers or in
// double, without libm: the same bits on every machine and in every denormal mode.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/lanes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tessemu {

/// DXGI formats, under their names; docs/conformance.md says what each can be.
enum class Format : std::uint8_t {
    R32G32B32A32_FLOAT,
    R32G32B32A32_UINT,
    R32G32B32A32_SINT,
    R32G32B32_FLOAT,
    R32G32B32_UINT,
    R32G32B32_SINT,
    R32G32_FLOAT,
    R32G32_UINT,
    R32G32_SINT,
    R32_FLOAT,
    R32_UINT,
    R32_SINT,
    R16G16B16A16_FLOAT,
    R16G16B16A16_UNORM,
    R16G16B16A16_SNORM,
    R16G16B16A16_UINT,
    R16G16B16A16_SINT,
    R16G16_FLOAT,
    R16G16_UNORM,
    R16G16_SNORM,
    R16G16_UINT,
    R16G16_SINT,
    R16_FLOAT,
    R16_UNORM,
    R16_SNORM,
    R16_UINT,
    R16_SINT,
    R11G11B10_FLOAT,
    R10G10B10A2_UNORM,
    R10G10B10A2_UINT,
    R8G8B8A8_UNORM,
    R8G8B8A8_UNORM_SRGB,
    R8G8B8A8_SNORM,
    R8G8B8A8_UINT,
    R8G8B8A8_SINT,
    B8G8R8A8_UNORM,
    B8G8R8A8_UNORM_SRGB,
    B8G8R8X8_UNORM,
    R8G8_UNORM,
    R8G8_SNORM,
    R8G8_UINT,
    R8G8_SINT,
    R8_UNORM,
    R8_SNORM,
    R8_UINT,
    R8_SINT,
    D16_UNORM,
    D24_UNORM_S8_UINT,
    D32_FLOAT,
    D32_FLOAT_S8X24_UINT,
};
inline constexpr std::size_t kFormats = std::size_t(Format::D32_FLOAT_S8X24_UINT) + 1;

enum class FormatType : std::uint8_t { Float, Unorm, Srgb, Snorm, Uint, Sint, Depth };

struct FormatInfo {
    std::string_view name;
    FormatType type;
    std::uint8_t components;
    std::uint8_t bytes; ///< of one element
    /// Of each component, from the element's lowest bit on; 32 alone passes untouched.
    std::array<std::uint8_t, 4> bits;
    bool bgr = false; ///< blue comes first, red third
};
FormatInfo const& info(Format format);

/// Elements of a vertex are of any colour format but sRGB, render targets of any colour format,
/// depth targets of any depth format.
constexpr bool can_be_vertex_element(FormatType t)
{
    return t != FormatType::Depth && t != FormatType::Srgb;
}
constexpr bool can_be_render_target(FormatType t)
{
    return t != FormatType::Depth;
}

/// The NaN that float targets hold: which one arithmetic makes depends on the processor and on how
/// a compiler orders operands.
inline constexpr std::uint32_t kCanonicalNan = 0x7fc00000;

/// One element as four shader registers: missing components are 0, a missing fourth is 1 (R36).
/// Integer formats give their bits, as in a shader register. 32-bit components pass untouched.
std::array<float, 4> decode(Format format, std::byte const* element);

/// Four registers as one element. Float formats round toward zero to fewer bits (R20), normalised
/// ones round to nearest (R21), integer ones clamp to their range (R26). A float format has one NaN
/// (I-4). Only the components that `write_mask` names (bit i: register i) change, and with all four
/// the bits of no component become 0.
void encode(Format format, std::array<float, 4> const& value, std::byte* element,
            unsigned write_mask = 0xf);

/// The range that blending clamps to, [0,1] or [-1,1]; float formats have none (R136).
constexpr bool is_clamped(FormatType t)
{
    return t == FormatType::Unorm || t == FormatType::Srgb || t == FormatType::Snorm;
}

// Scalars.

/// Float to a narrower float with `exponent_bits` and `mantissa_bits`, rounding toward zero; too
/// large gives the largest finite value, infinity and NaN stay (R20); unsigned formats turn
/// negative numbers into 0 (and -infinity too). Denormals of the narrow format are kept (R10).
std::uint32_t small_float_from_float(float value, int exponent_bits, int mantissa_bits,
                                     bool is_signed);
float float_from_small_float(std::uint32_t bits, int exponent_bits, int mantissa_bits,
                             bool is_signed);
inline std::uint16_t half_from_float(float v)
{
    return std::uint16_t(small_float_from_float(v, 5, 10, true));
}
inline float float_from_half(std::uint16_t bits)
{
    return float_from_small_float(bits, 5, 10, true);
}

/// trunc(c (2^n - 1) + 0.5) of c clamped to [0,1]; NaN gives 0 (R21). 1 <= bits <= 24.
std::uint32_t unorm_from_float(float c, int bits);
/// unorm_from_float(c, 8) lane by lane, in integers: with n = c * 2^31, trunc(255 c + 1/2) is
/// (255 n + 2^30) / 2^31 = (n - (n - 2^30) / 256) / 2^23, the inner quotient rounded up. From c = 2^-8
/// on n is whole. Below only c = (2^22 + 2^14 + 2^6 + 1/2) / 2^31 has another result than the whole
/// number beneath n, and a quarter more rounds n up there.
template <int N> inline IntLanes<N> unorm8_from_float(Lanes<N> c)
{
    using Int = IntLanes<N>;
    // The number below 1 gives 255 too, and 2^31 would not fit.
    Lanes<N> const in = min(max(c, Lanes<N>(0.0f)), Lanes<N>(0x1.fffffep-1f));
    Int const n =
        __builtin_convertvector((in * Lanes<N>(0x1p31f) + Lanes<N>(0.25f)).raw, typename Int::Raw);
    return (n - ((n - Int(0x40000000) + Int(255)) >> Int(8))) >> Int(23);
}
/// i / (2^n - 1), correctly rounded (R22).
float float_from_unorm(std::uint32_t i, int bits);
/// Scale 2^(n-1) - 1, half away from zero (R21).
std::int32_t snorm_from_float(float c, int bits);
/// Both of the lowest codes are -1.
float float_from_snorm(std::int32_t i, int bits);
/// The 8-bit code nearest to the sRGB curve of linear c (R23).
std::uint8_t srgb8_from_linear(float c);
float linear_from_srgb8(std::uint8_t code);
/// Nearest i.f fixed-point number, ties to even, clamped to its range; NaN gives 0 (R24).
std::int32_t fixed_from_float(float value, int integer_bits, int fraction_bits);
/// Toward zero, clamped; NaN gives 0 (R19).
std::int32_t int_from_float(float value);
std::uint32_t uint_from_float(float value);

} // namespace tessemu
