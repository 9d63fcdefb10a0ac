// SPDX-License-Identifier: Apache-2.0
#include "emu/formats.h"

#include "emu/floating_point.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

namespace tessemu {

namespace {

constexpr FormatInfo kFormats[] = {
    {"R32G32B32A32_FLOAT", FormatType::Float, 4, 16},
    {"R32G32B32A32_UINT", FormatType::Uint, 4, 16},
    {"R32G32B32A32_SINT", FormatType::Sint, 4, 16},
    {"R32G32B32_FLOAT", FormatType::Float, 3, 12},
    {"R32G32_FLOAT", FormatType::Float, 2, 8},
    {"R32_FLOAT", FormatType::Float, 1, 4},
    {"R32_UINT", FormatType::Uint, 1, 4},
    {"R32_SINT", FormatType::Sint, 1, 4},
    {"R16G16B16A16_FLOAT", FormatType::Float, 4, 8},
    {"R16G16B16A16_UNORM", FormatType::Unorm, 4, 8},
    {"R16G16B16A16_SNORM", FormatType::Snorm, 4, 8},
    {"R16G16B16A16_UINT", FormatType::Uint, 4, 8},
    {"R16G16B16A16_SINT", FormatType::Sint, 4, 8},
    {"R16G16_FLOAT", FormatType::Float, 2, 4},
    {"R11G11B10_FLOAT", FormatType::Float, 3, 4},
    {"R8G8B8A8_UNORM", FormatType::Unorm, 4, 4},
    {"R8G8B8A8_UNORM_SRGB", FormatType::Srgb, 4, 4},
    {"R8G8B8A8_SNORM", FormatType::Snorm, 4, 4},
    {"R8G8B8A8_UINT", FormatType::Uint, 4, 4},
    {"R16_UNORM", FormatType::Unorm, 1, 2},
    {"R8_UNORM", FormatType::Unorm, 1, 1},
    {"D16_UNORM", FormatType::Depth, 1, 2},
    {"D24_UNORM_S8_UINT", FormatType::Depth, 1, 4},
    {"D32_FLOAT", FormatType::Depth, 1, 4},
    {"D32_FLOAT_S8X24_UINT", FormatType::Depth, 1, 8},
};

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

template <class I> I read(std::byte const* at, int i)
{
    I v;
    std::memcpy(&v, at + std::size_t(i) * sizeof(I), sizeof(I));
    return v;
}
template <class I> void write(std::byte* at, int i, I v)
{
    std::memcpy(at + std::size_t(i) * sizeof(I), &v, sizeof(I));
}
std::uint32_t clamp_uint(float bits, std::uint32_t limit)
{
    return std::min(bits_of(bits), limit);
}
std::int32_t clamp_sint(float bits, std::int32_t limit)
{
    return std::clamp(std::bit_cast<std::int32_t>(bits), -limit - 1, limit);
}

} // namespace

FormatInfo const& info(Format format)
{
    return kFormats[std::size_t(format)];
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
    int const n = f.components, width = f.bytes / n; // bytes of a component
    switch (format) {
    case Format::R11G11B10_FLOAT: {
        auto const v = read<std::uint32_t>(e, 0);
        r[0] = float_from_small_float(v & 0x7ff, 5, 6, false);
        r[1] = float_from_small_float(v >> 11 & 0x7ff, 5, 6, false);
        r[2] = float_from_small_float(v >> 22, 5, 5, false);
        return r;
    }
    case Format::D24_UNORM_S8_UINT:
        r[0] = float_from_unorm(read<std::uint32_t>(e, 0) & 0xffffff, 24);
        return r;
    case Format::D32_FLOAT_S8X24_UINT:
        r[0] = read<float>(e, 0);
        return r;
    default:
        break;
    }
    for (int i = 0; i < n; ++i) {
        float& c = r[std::size_t(i)];
        if (width == 4) {
            std::memcpy(&c, e + 4 * i, 4);
            continue;
        }
        bool const wide = width == 2;
        switch (f.type) {
        case FormatType::Float:
            c = float_from_half(read<std::uint16_t>(e, i));
            break;
        case FormatType::Srgb:
            c = i < 3 ? linear_from_srgb8(read<std::uint8_t>(e, i))
                      : float_from_unorm(read<std::uint8_t>(e, i), 8);
            break;
        case FormatType::Snorm:
            c = wide ? float_from_snorm(read<std::int16_t>(e, i), 16)
                     : float_from_snorm(read<std::int8_t>(e, i), 8);
            break;
        case FormatType::Sint:
            c = std::bit_cast<float>(wide ? std::int32_t(read<std::int16_t>(e, i))
                                          : std::int32_t(read<std::int8_t>(e, i)));
            break;
        case FormatType::Uint:
            c = std::bit_cast<float>(wide ? std::uint32_t(read<std::uint16_t>(e, i))
                                          : std::uint32_t(read<std::uint8_t>(e, i)));
            break;
        default:
            c = wide ? float_from_unorm(read<std::uint16_t>(e, i), 16)
                     : float_from_unorm(read<std::uint8_t>(e, i), 8);
        }
    }
    return r;
}

void encode(Format format, std::array<float, 4> const& value, std::byte* e)
{
    FormatInfo const& f = info(format);
    std::array<float, 4> v = value;
    if (f.type == FormatType::Float)
        for (float& c : v)
            if (c != c) c = std::bit_cast<float>(kCanonicalNan);
    int const n = f.components, width = f.bytes / n;
    if (format == Format::R11G11B10_FLOAT) {
        write(e, 0,
              small_float_from_float(v[0], 5, 6, false) |
                  small_float_from_float(v[1], 5, 6, false) << 11 |
                  small_float_from_float(v[2], 5, 5, false) << 22);
        return;
    }
    assert(f.type != FormatType::Depth);
    for (int i = 0; i < n; ++i) {
        float const c = v[std::size_t(i)];
        bool const wide = width == 2;
        if (width == 4) {
            write(e, i, c);
            continue;
        }
        switch (f.type) {
        case FormatType::Float:
            write(e, i, half_from_float(c));
            break;
        case FormatType::Srgb:
            write(e, i, i < 3 ? srgb8_from_linear(c) : std::uint8_t(unorm_from_float(c, 8)));
            break;
        case FormatType::Snorm:
            if (wide)
                write(e, i, std::int16_t(snorm_from_float(c, 16)));
            else
                write(e, i, std::int8_t(snorm_from_float(c, 8)));
            break;
        case FormatType::Sint:
            if (wide)
                write(e, i, std::int16_t(clamp_sint(c, 0x7fff)));
            else
                write(e, i, std::int8_t(clamp_sint(c, 0x7f)));
            break;
        case FormatType::Uint:
            if (wide)
                write(e, i, std::uint16_t(clamp_uint(c, 0xffff)));
            else
                write(e, i, std::uint8_t(clamp_uint(c, 0xff)));
            break;
        default:
            if (wide)
                write(e, i, std::uint16_t(unorm_from_float(c, 16)));
            else
                write(e, i, std::uint8_t(unorm_from_float(c, 8)));
        }
    }
}

} // namespace tessemu
