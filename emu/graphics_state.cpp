// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_state.h"

#include "emu/error.h"

#include <bit>
#include <cstring>

namespace tessemu {

namespace {

void check_size(int width, int height, int samples)
{
    for (int size : {width, height}) {
        if (size < 1)
            throw Error("render target size is " + std::to_string(size) +
                        ", at least 1 pixel is needed");
        if (size > ColorTarget::kMaxSize)
            throw LimitError("render target size in pixels", std::uint64_t(size),
                             ColorTarget::kMaxSize);
    }
    if (samples != 1 && samples != 2 && samples != 4 && samples != 8)
        throw Error("samples is " + std::to_string(samples) + ", it must be 1, 2, 4 or 8");
}

// Rows lie an odd number of cache lines apart, so that a column of pixels does not fall into a few
// sets of the cache.
std::size_t pitch_of(int width, int height, int samples)
{
    check_size(width, height, samples);
    return (std::size_t(width) * std::size_t(samples) + 15) / 16 * 16 | 16;
}

constexpr std::size_t kRowsPerPiece = 64;

template <class Work> void for_each_row(int height, ThreadPool const& threads, Work const& work)
{
    std::size_t const rows = std::size_t(height);
    threads.parallel_for((rows + kRowsPerPiece - 1) / kRowsPerPiece, [&](std::size_t piece) {
        for (std::size_t y = piece * kRowsPerPiece; y < std::min(rows, (piece + 1) * kRowsPerPiece);
             ++y)
            work(int(y));
    });
}

} // namespace

std::span<SampleOffset const> sample_pattern(int samples)
{
    static constexpr SampleOffset k1[] = {{0, 0}}, k2[] = {{4, 4}, {-4, -4}},
                                  k4[] = {{-2, -6}, {6, -2}, {-6, 2}, {2, 6}},
                                  k8[] = {{1, -3}, {-1, 3},  {5, 1}, {-3, -5},
                                          {-5, 5}, {-7, -1}, {3, 7}, {7, -7}};
    switch (samples) {
    case 1:
        return k1;
    case 2:
        return k2;
    case 4:
        return k4;
    default:
        return k8;
    }
}

ColorTarget::ColorTarget(int width, int height, Format format, int samples)
    : width_(width),
      height_(height),
      samples_(samples),
      format_(format),
      bytes_(info(format).bytes),
      pitch_(pitch_of(width, height, samples)),
      storage_(pitch_ * std::size_t(height) * bytes_)
{
    if (!can_be_render_target(info(format).type))
        throw Error(std::string(info(format).name) + " is not a colour format");
}

void ColorTarget::clear(std::array<float, 4> const& color, ThreadPool const& threads)
{
    std::byte texel_value[16];
    encode(format_, color, texel_value);
    std::size_t const row = row_bytes();
    if (bytes_ == 4) {
        std::uint32_t word;
        std::memcpy(&word, texel_value, 4);
        for_each_row(height_, threads, [&](int y) {
            std::fill_n(reinterpret_cast<std::uint32_t*>(texel(0, y)), row / 4, word);
        });
        return;
    }
    std::vector<std::byte> pattern(row);
    for (std::size_t i = 0; i < row; i += bytes_)
        std::memcpy(pattern.data() + i, texel_value, bytes_);
    for_each_row(height_, threads, [&](int y) { std::memcpy(texel(0, y), pattern.data(), row); });
}

void resolve(ColorTarget const& source, ColorTarget& target)
{
    float const weight = 1.0f / float(source.samples());
    for (int y = 0; y < source.height(); ++y)
        for (int x = 0; x < source.width(); ++x) {
            std::array<float, 4> sum{};
            for (int s = 0; s < source.samples(); ++s) {
                auto const c = source.load(x, y, s);
                for (std::size_t k = 0; k < 4; ++k) sum[k] += c[k];
            }
            for (float& c : sum) c *= weight;
            encode(target.format(), sum, target.texel(x, y));
        }
}

DepthTarget::DepthTarget(int width, int height, Format format, int samples)
    : width_(width),
      height_(height),
      samples_(samples),
      format_(format),
      pitch_(pitch_of(width, height, samples)),
      depth_(pitch_ * std::size_t(height))
{
    if (info(format).type != FormatType::Depth)
        throw Error(std::string(info(format).name) + " is not a depth format");
    if (format == Format::D24_UNORM_S8_UINT || format == Format::D32_FLOAT_S8X24_UINT)
        stencil_.resize(pitch_ * std::size_t(height));
}

std::uint32_t DepthTarget::code(float z) const
{
    switch (format_) {
    case Format::D16_UNORM:
        return unorm_from_float(z, 16);
    case Format::D24_UNORM_S8_UINT:
        return unorm_from_float(z, 24);
    default:
        return std::bit_cast<std::uint32_t>(z) & 0x7fffffffu; // -0 is 0
    }
}

float DepthTarget::depth(int x, int y, int s) const
{
    std::uint32_t const c = codes()[index(x, y, s)];
    switch (format_) {
    case Format::D16_UNORM:
        return float_from_unorm(c, 16);
    case Format::D24_UNORM_S8_UINT:
        return float_from_unorm(c, 24);
    default:
        return std::bit_cast<float>(c);
    }
}

void DepthTarget::clear(float depth, std::uint8_t stencil, ThreadPool const& threads)
{
    std::uint32_t const value = code(depth < 0 ? 0 : depth > 1 ? 1 : depth);
    std::size_t const row = std::size_t(width_) * std::size_t(samples_);
    for_each_row(height_, threads, [&](int y) {
        std::fill_n(depth_.get() + index(0, y), row, value);
        if (has_stencil()) std::fill_n(stencil_.data() + index(0, y), row, stencil);
    });
}

int RasterTarget::samples() const
{
    for (ColorTarget const* c : color)
        if (c) return c->samples();
    return depth ? depth->samples() : coverage ? coverage->samples : 1;
}

} // namespace tessemu
