// SPDX-License-Identifier: Apache-2.0
#include "emu/formats.h"

#include "emu/floating_point.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace tessemu {

namespace {

constexpr FormatInfo kTable[] = {
    {"R32G32B32A32_FLOAT", FormatType::Float, 4, 16, {32, 32, 32, 32}},
    {"R32G32B32A32_UINT", FormatType::Uint, 4, 16, {32, 32, 32, 32}},
    {"R32G32B32A32_SINT", FormatType::Sint, 4, 16, {32, 32, 32, 32}},
    {"R32G32B32_FLOAT", FormatType::Float, 3, 12, {32, 32, 32}},
    {"R32G32B32_UINT", FormatType::Uint, 3, 12, {32, 32, 32}},
    {"R32G32B32_SINT", FormatType::Sint, 3, 12, {32, 32, 32}},
    {"R32G32_FLOAT", FormatType::Float, 2, 8, {32, 32}},
    {"R32G32_UINT", FormatType::Uint, 2, 8, {32, 32}},
    {"R32G32_SINT", FormatType::Sint, 2, 8, {32, 32}},
    {"R32_FLOAT", FormatType::Float, 1, 4, {32}},
    {"R32_UINT", FormatType::Uint, 1, 4, {32}},
    {"R32_SINT", FormatType::Sint, 1, 4, {32}},
    {"R16G16B16A16_FLOAT", FormatType::Float, 4, 8, {16, 16, 16, 16}},
    {"R16G16B16A16_UNORM", FormatType::Unorm, 4, 8, {16, 16, 16, 16}},
    {"R16G16B16A16_SNORM", FormatType::Snorm, 4, 8, {16, 16, 16, 16}},
    {"R16G16B16A16_UINT", FormatType::Uint, 4, 8, {16, 16, 16, 16}},
    {"R16G16B16A16_SINT", FormatType::Sint, 4, 8, {16, 16, 16, 16}},
    {"R16G16_FLOAT", FormatType::Float, 2, 4, {16, 16}},
    {"R16G16_UNORM", FormatType::Unorm, 2, 4, {16, 16}},
    {"R16G16_SNORM", FormatType::Snorm, 2, 4, {16, 16}},
    {"R16G16_UINT", FormatType::Uint, 2, 4, {16, 16}},
    {"R16G16_SINT", FormatType::Sint, 2, 4, {16, 16}},
    {"R16_FLOAT", FormatType::Float, 1, 2, {16}},
    {"R16_UNORM", FormatType::Unorm, 1, 2, {16}},
    {"R16_SNORM", FormatType::Snorm, 1, 2, {16}},
    {"R16_UINT", FormatType::Uint, 1, 2, {16}},
    {"R16_SINT", FormatType::Sint, 1, 2, {16}},
    {"R11G11B10_FLOAT", FormatType::Float, 3, 4, {11, 11, 10}},
    {"R10G10B10A2_UNORM", FormatType::Unorm, 4, 4, {10, 10, 10, 2}},
    {"R10G10B10A2_UINT", FormatType::Uint, 4, 4, {10, 10, 10, 2}},
    {"R8G8B8A8_UNORM", FormatType::Unorm, 4, 4, {8, 8, 8, 8}},
    {"R8G8B8A8_UNORM_SRGB", FormatType::Srgb, 4, 4, {8, 8, 8, 8}},
    {"R8G8B8A8_SNORM", FormatType::Snorm, 4, 4, {8, 8, 8, 8}},
    {"R8G8B8A8_UINT", FormatType::Uint, 4, 4, {8, 8, 8, 8}},
    {"R8G8B8A8_SINT", FormatType::Sint, 4, 4, {8, 8, 8, 8}},
    {"B8G8R8A8_UNORM", FormatType::Unorm, 4, 4, {8, 8, 8, 8}, true},
    {"B8G8R8A8_UNORM_SRGB", FormatType::Srgb, 4, 4, {8, 8, 8, 8}, true},
    {"B8G8R8X8_UNORM", FormatType::Unorm, 3, 4, {8, 8, 8}, true},
    {"R8G8_UNORM", FormatType::Unorm, 2, 2, {8, 8}},
    {"R8G8_SNORM", FormatType::Snorm, 2, 2, {8, 8}},
    {"R8G8_UINT", FormatType::Uint, 2, 2, {8, 8}},
    {"R8G8_SINT", FormatType::Sint, 2, 2, {8, 8}},
    {"R8_UNORM", FormatType::Unorm, 1, 1, {8}},
    {"R8_SNORM", FormatType::Snorm, 1, 1, {8}},
    {"R8_UINT", FormatType::Uint, 1, 1, {8}},
    {"R8_SINT", FormatType::Sint, 1, 1, {8}},
    {"D16_UNORM", FormatType::Depth, 1, 2, {16}},
    {"D24_UNORM_S8_UINT", FormatType::Depth, 1, 4, {24}},
    {"D32_FLOAT", FormatType::Depth, 1, 4, {32}},
    {"D32_FLOAT_S8X24_UINT", FormatType::Depth, 1, 8, {32}},
};
static_assert(std::size(kTable) == kFormats);

constexpr std::uint32_t kSign = 0x80000000u, kInfinity = 0x7f800000u;

std::uint32_t bits_of(float v)
{
    return std::bit_cast<std::uint32_t>(v);
}
bool is_nan(float v)
{
    return (bits_of(v) & ~kSign) > kInfinity;
}

// The sRGB curve in double. x^0.4 is the fifth root of x^2; Newton's iteration from above falls
// until it is exact to the last bits, so that it needs no libm.
double fifth_root(double x)
{
    if (x == 0) return 0;
    double y = 1;
    for (;;) {
        double const y4 = y * y * y * y;
        double const next = (4 * y + x / y4) / 5;
        if (!(next < y)) return y;
        y = next;
    }
}
double srgb_decode(double c)
{
    if (c <= 0.04045) return c / 12.92;
    double const x = (c + 0.055) / 1.055;
    return x * x * fifth_root(x * x);
}

struct SrgbTables {
    float decoded[256];
    double threshold[256]; // the least linear value that encodes to code i or more
    SrgbTables()
    {
        DenormalMode const ieee(DenormalMode::Keep);
        for (int i = 0; i < 256; ++i) {
            decoded[i] = float(srgb_decode(i / 255.0));
            threshold[i] = i ? srgb_decode((i - 0.5) / 255.0) : 0;
        }
        decoded[255] = 1;
    }
};
SrgbTables const& srgb_tables()
{
    static SrgbTables const tables;
    return tables;
}

// An element with components of less than 32 bits, as one number.
std::uint64_t load_word(FormatInfo const& f, std::byte const* e)
{
    std::uint64_t word = 0;
    std::memcpy(&word, e, f.bytes);
    return word;
}

// The register of component i.
std::size_t place(FormatInfo const& f, std::size_t i)
{
    return f.bgr && i < 3 ? 2 - i : i;
}

std::int32_t sign_extended(std::uint32_t code, int bits)
{
    return std::int32_t(code << (32 - bits)) >> (32 - bits);
}

float from_code(FormatInfo const& f, std::size_t i, std::uint32_t code)
{
    int const bits = f.bits[i];
    switch (f.type) {
    case FormatType::Float:
        return bits == 16 ? float_from_half(std::uint16_t(code))
                          : float_from_small_float(code, 5, bits - 5, false);
    case FormatType::Srgb:
        return i < 3 ? linear_from_srgb8(std::uint8_t(code)) : float_from_unorm(code, bits);
    case FormatType::Snorm:
        return float_from_snorm(sign_extended(code, bits), bits);
    case FormatType::Sint:
        return std::bit_cast<float>(sign_extended(code, bits));
    case FormatType::Uint:
        return std::bit_cast<float>(code);
    default:
        return float_from_unorm(code, bits);
    }
}

// May have bits above the component's.
std::uint32_t to_code(FormatInfo const& f, std::size_t i, float c)
{
    int const bits = f.bits[i];
    switch (f.type) {
    case FormatType::Float:
        return bits == 16 ? half_from_float(c) : small_float_from_float(c, 5, bits - 5, false);
    case FormatType::Srgb:
        return i < 3 ? srgb8_from_linear(c) : unorm_from_float(c, bits);
    case FormatType::Snorm:
        return std::uint32_t(snorm_from_float(c, bits));
    case FormatType::Sint: {
        std::int32_t const most = (1 << (bits - 1)) - 1;
        return std::uint32_t(std::clamp(std::bit_cast<std::int32_t>(c), -most - 1, most));
    }
    case FormatType::Uint:
        return std::min(bits_of(c), (1u << bits) - 1);
    default:
        return unorm_from_float(c, bits);
    }
}

} // namespace

FormatInfo const& info(Format format)
{
    return kTable[std::size_t(format)];
}

std::uint32_t small_float_from_float(float value, int exponent_bits, int mantissa_bits,
                                     bool is_signed)
{
    std::uint32_t const all = bits_of(value), magnitude = all & ~kSign;
    int const bias = (1 << (exponent_bits - 1)) - 1;
    std::uint32_t const special = ((1u << exponent_bits) - 1) << mantissa_bits;
    std::uint32_t const sign =
        is_signed && (all & kSign) ? 1u << (exponent_bits + mantissa_bits) : 0;
    if (magnitude > kInfinity) return sign | special | (1u << (mantissa_bits - 1));
    if (!is_signed && (all & kSign)) return 0;
    if (magnitude == kInfinity) return sign | special;
    int const exponent = int(magnitude >> 23) - 127 + bias;
    std::uint32_t const mantissa = magnitude & 0x7fffffu;
    if (exponent >= (1 << exponent_bits) - 1) return sign | (special - 1);
    if (exponent >= 1)
        return sign | std::uint32_t(exponent) << mantissa_bits | mantissa >> (23 - mantissa_bits);
    int const shift = 23 - mantissa_bits + 1 - exponent; // a denormal of the narrow format
    return sign | (shift > 24 ? 0 : (mantissa | 0x800000u) >> shift);
}

float float_from_small_float(std::uint32_t bits, int exponent_bits, int mantissa_bits,
                             bool is_signed)
{
    int const bias = (1 << (exponent_bits - 1)) - 1;
    std::uint32_t const sign =
        is_signed && (bits >> (exponent_bits + mantissa_bits) & 1) ? kSign : 0;
    std::uint32_t const exponent = bits >> mantissa_bits & ((1u << exponent_bits) - 1);
    std::uint32_t mantissa = bits & ((1u << mantissa_bits) - 1);
    auto const result = [&](std::uint32_t b) { return std::bit_cast<float>(sign | b); };
    if (exponent == (1u << exponent_bits) - 1)
        return result(kInfinity | mantissa << (23 - mantissa_bits));
    if (exponent)
        return result((exponent + 127 - std::uint32_t(bias)) << 23 | mantissa
                                                                         << (23 - mantissa_bits));
    if (mantissa == 0) return result(0);
    int const lead = std::countl_zero(mantissa) - (32 - mantissa_bits); // zeros above the first bit
    mantissa = (mantissa << (lead + 1)) & ((1u << mantissa_bits) - 1);
    return result(std::uint32_t(127 - bias - lead) << 23 | mantissa << (23 - mantissa_bits));
}

std::uint32_t unorm_from_float(float c, int bits)
{
    double const scale = double((1u << bits) - 1);
    if (!(c > 0)) return 0;
    if (c >= 1) return std::uint32_t(scale);
    return std::uint32_t(double(c) * scale + 0.5); // exact: 24 bits times at most 24 bits
}

float float_from_unorm(std::uint32_t i, int bits)
{
    return float(i) / float((1u << bits) - 1);
}

std::int32_t snorm_from_float(float c, int bits)
{
    double const scale = double((1 << (bits - 1)) - 1);
    if (is_nan(c)) return 0;
    double const x = std::clamp(double(c), -1.0, 1.0) * scale;
    return std::int32_t(x < 0 ? x - 0.5 : x + 0.5);
}

float float_from_snorm(std::int32_t i, int bits)
{
    std::int32_t const scale = (1 << (bits - 1)) - 1;
    return float(std::max(i, -scale)) / float(scale);
}

std::uint8_t srgb8_from_linear(float c)
{
    if (!(c > 0)) return 0;
    if (c >= 1) return 255;
    double const* const t = srgb_tables().threshold;
    return std::uint8_t(std::upper_bound(t + 1, t + 256, double(c)) - t - 1);
}

float linear_from_srgb8(std::uint8_t code)
{
    return srgb_tables().decoded[code];
}

std::int32_t fixed_from_float(float value, int integer_bits, int fraction_bits)
{
    assert(integer_bits + fraction_bits <= 31);
    if (is_nan(value)) return 0;
    std::int64_t const limit = std::int64_t(1) << (integer_bits + fraction_bits - 1);
    double const x = double(value) * double(1 << fraction_bits);
    if (x >= double(limit - 1)) return std::int32_t(limit - 1);
    if (x <= -double(limit)) return std::int32_t(-limit);
    double const magic = 6755399441055744.0; // 1.5 * 2^52: the sum's low bits are the nearest even
    return std::int32_t(std::bit_cast<std::int64_t>(x + magic) -
                        std::bit_cast<std::int64_t>(magic));
}

std::int32_t int_from_float(float v)
{
    if (is_nan(v)) return 0;
    if (v >= 2147483648.0f) return 0x7fffffff;
    if (v <= -2147483648.0f) return -0x7fffffff - 1;
    return std::int32_t(v);
}

std::uint32_t uint_from_float(float v)
{
    if (!(v > 0)) return 0;
    if (v >= 4294967296.0f) return 0xffffffffu;
    return std::uint32_t(v);
}

std::array<float, 4> decode(Format format, std::byte const* e)
{
    FormatInfo const& f = info(format);
    bool const integer = f.type == FormatType::Uint || f.type == FormatType::Sint;
    std::array<float, 4> r{0, 0, 0, integer ? std::bit_cast<float>(1u) : 1.0f};
    if (f.bits[0] == 32) {
        std::memcpy(r.data(), e, 4u * f.components);
        return r;
    }
    std::uint64_t word = load_word(f, e);
    for (std::size_t i = 0; i < f.components; ++i) {
        std::uint32_t const mask = (1u << f.bits[i]) - 1;
        r[place(f, i)] = from_code(f, i, std::uint32_t(word) & mask);
        word >>= f.bits[i];
    }
    return r;
}

void encode(Format format, std::array<float, 4> const& value, std::byte* e, unsigned write_mask)
{
    FormatInfo const& f = info(format);
    assert(f.type != FormatType::Depth);
    std::array<float, 4> v = value;
    if (f.type == FormatType::Float)
        for (float& c : v)
            if (c != c) c = std::bit_cast<float>(kCanonicalNan);
    if (f.bits[0] == 32) {
        if (f.components == 4 && write_mask == 0xf) {
            std::memcpy(e, v.data(), sizeof v);
            return;
        }
        for (std::size_t i = 0; i < f.components; ++i)
            if (write_mask >> i & 1) std::memcpy(e + 4 * i, &v[i], 4);
        return;
    }
    std::uint64_t word = write_mask == 0xf ? 0 : load_word(f, e);
    for (std::size_t i = 0, at = 0; i < f.components; at += f.bits[i++]) {
        std::size_t const k = place(f, i);
        if (!(write_mask >> k & 1)) continue;
        std::uint64_t const mask = ((std::uint64_t(1) << f.bits[i]) - 1) << at;
        word = (word & ~mask) | (std::uint64_t(to_code(f, i, v[k])) << at & mask);
    }
    std::memcpy(e, &word, f.bytes);
}

} // namespace tessemu
