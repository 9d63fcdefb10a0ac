// SPDX-License-Identifier: Apache-2.0
#include "emu/texture.h"

#include "emu/error.h"

#include <bit>

namespace tessemu {

std::pair<std::vector<float>, int> make_mip_levels(std::span<float const> texels, int width,
                                                   int height)
{
    std::vector<float> all(texels.begin(), texels.end());
    int levels = 1;
    std::size_t from = 0;
    while (width > 1 || height > 1) {
        int const w = std::max(1, width / 2), h = std::max(1, height / 2);
        int const step_x = width > 1 ? 2 : 1, step_y = height > 1 ? 2 : 1;
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                for (std::size_t k = 0; k < 4; ++k) {
                    float sum = 0;
                    for (int j = 0; j < step_y; ++j)
                        for (int i = 0; i < step_x; ++i)
                            sum += all[from +
                                       4 * (std::size_t(y * step_y + j) * std::size_t(width) +
                                            std::size_t(x * step_x + i)) +
                                       k];
                    all.push_back(sum * (1.0f / float(step_x * step_y)));
                }
        from += 4 * std::size_t(width) * std::size_t(height);
        width = w, height = h;
        ++levels;
    }
    return {std::move(all), levels};
}

Texture2D texture_of(ColorTarget const& target, int slot, std::string name)
{
    if (target.samples() != 1)
        throw Error("the target '" + name + "' has " + std::to_string(target.samples()) +
                    " samples a pixel, a texture has 1: resolve it first");
    std::size_t const texels =
        target.pitch() * std::size_t(target.height() - 1) + std::size_t(target.width());
    return Texture2D(std::span(target.texel(0, 0), texels * target.texel_bytes()), target.format(),
                     target.width(), target.height(), target.pitch(), slot, std::move(name));
}

std::int32_t log2_fixed8(double x)
{
    if (!(x == x) || x > 1e300) return 32767;
    if (!(x > 1e-300)) return -32768;
    auto const bits = std::bit_cast<std::uint64_t>(x);
    std::int32_t result = std::int32_t(bits >> 52) - 1023;
    double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u); // in [1, 2)
    for (int i = 0; i < 8; ++i) { // a bit of the logarithm a squaring
        m *= m;
        bool const two = m >= 2;
        result = 2 * result + two;
        if (two) m *= 0.5;
    }
    return result;
}

namespace detail {

std::array<float, 4> texel_out_of_range(Format format)
{
    static constexpr std::byte kZeros[16]{}; // a code of zeros is 0 in every format
    return decode(format, kZeros);
}

float lod_of(float dudx, float dvdx, float dudy, float dvdy)
{
    double const x = double(dudx) * dudx + double(dvdx) * dvdx;
    double const y = double(dudy) * dudy + double(dvdy) * dvdy;
    return float(log2_fixed8(std::max(x, y))) * (0.5f / 256);
}

namespace {

// R146. -1: the border colour.
int address(AddressMode mode, std::int32_t i, int size)
{
    auto const modulo = [](std::int32_t a, std::int32_t n) { return ((a % n) + n) % n; };
    switch (mode) {
    case AddressMode::Wrap:
        return modulo(i, size);
    case AddressMode::Mirror: {
        int const m = modulo(i, 2 * size);
        return m < size ? m : 2 * size - 1 - m;
    }
    case AddressMode::MirrorOnce:
        return std::min(i < 0 ? -(i + 1) : i, size - 1);
    case AddressMode::Clamp:
        return std::clamp(i, 0, size - 1);
    default:
        return i < 0 || i >= size ? -1 : i;
    }
}

class Fetcher {
public:
    Fetcher(Texture2D const& texture, Sampler const& sampler, SampleRequest const& request,
            TexelReader read, void* context)
        : t_(texture),
          s_(sampler),
          r_(request),
          slice_(std::clamp(request.slice, 0, texture.slices() - 1)),
          read_(read),
          context_(context)
    {
    }

    std::array<float, 4> texel(int level, std::int32_t x, std::int32_t y)
    {
        int const i = address(s_.address_u, x, t_.width(level)),
                  j = address(s_.address_v, y, t_.height(level));
        std::array<float, 4> c = s_.border;
        if (i >= 0 && j >= 0) {
            std::size_t const at = t_.index(i, j, level, slice_);
            read_(context_, at);
            c = t_.texel(at);
        }
        if (r_.compare) {
            bool const nan = !(c[0] == c[0]) || !(r_.reference == r_.reference);
            bool const less = r_.reference < c[0], equal = r_.reference == c[0];
            bool pass = false;
            switch (s_.comparison) {
            case Comparison::Never:
                break;
            case Comparison::Less:
                pass = less;
                break;
            case Comparison::Equal:
                pass = equal;
                break;
            case Comparison::LessEqual:
                pass = less || equal;
                break;
            case Comparison::Greater:
                pass = !nan && !less && !equal;
                break;
            case Comparison::NotEqual:
                pass = !equal;
                break;
            case Comparison::GreaterEqual:
                pass = !nan && !less;
                break;
            default:
                pass = true;
            }
            c.fill(pass ? 1.0f : 0.0f);
        }
        return c;
    }

    // Point or bilinear in one level (R145).
    std::array<float, 4> level(int l, bool linear)
    {
        float const u = r_.u * float(t_.width(l)), v = r_.v * float(t_.height(l));
        if (!linear) return texel(l, fixed(u) >> 8, fixed(v) >> 8);
        std::int32_t const x = fixed(u - 0.5f), y = fixed(v - 0.5f);
        std::int32_t const i = x >> 8, j = y >> 8, fx = x & 255, fy = y & 255;
        std::array<float, 4> const top = mix(l, i, j, fx);
        return fy ? mix(top, mix(l, i, j + 1, fx), fy) : top;
    }

    static std::int32_t fixed(float texels) { return fixed_from_float(texels, 23, 8); }

    // a + (b - a) w/256: equal ends give the end, the result lies between them and grows with w.
    static std::array<float, 4> mix(std::array<float, 4> const& a, std::array<float, 4> const& b,
                                    std::int32_t w)
    {
        std::array<float, 4> r;
        for (std::size_t k = 0; k < 4; ++k) r[k] = a[k] + (b[k] - a[k]) * (float(w) * (1.0f / 256));
        return r;
    }

private:
    std::array<float, 4> mix(int l, std::int32_t i, std::int32_t j, std::int32_t fx)
    {
        std::array<float, 4> const a = texel(l, i, j);
        return fx ? mix(a, texel(l, i + 1, j), fx) : a;
    }

    Texture2D const& t_;
    Sampler const& s_;
    SampleRequest const& r_;
    int slice_;
    TexelReader read_;
    void* context_;
};

} // namespace

std::array<float, 4> sample_texture(Texture2D const& t, Sampler const& s, SampleRequest const& r,
                                    TexelReader read, void* context)
{
    if (!t.bound()) return {0, 0, 0, 0};
    Fetcher f(t, s, r, read, context);
    // R148: bias, then the clamp; NaN becomes the lower end.
    float lod = r.lod + s.lod_bias;
    lod = lod >= s.min_lod ? (lod <= s.max_lod ? lod : s.max_lod) : s.min_lod;
    bool const magnify = !(lod > 0);
    bool const linear = (magnify ? s.mag : s.min) == Filter::Linear;
    std::int32_t const last = t.levels() - 1;
    std::int32_t const fixed = std::clamp(fixed_from_float(lod, 15, 8), 0, last * 256); // R149
    if (s.mip == Filter::Point) return f.level(std::min((fixed + 128) >> 8, last), linear);
    std::int32_t const level = fixed >> 8, weight = fixed & 255;
    std::array<float, 4> const a = f.level(level, linear);
    return weight ? Fetcher::mix(a, f.level(level + 1, linear), weight) : a;
}

std::array<float, 4> gather_texture(Texture2D const& t, Sampler const& s, SampleRequest const& r,
                                    int component, TexelReader read, void* context)
{
    if (!t.bound()) return {0, 0, 0, 0};
    Fetcher f(t, s, r, read, context);
    std::int32_t const i = Fetcher::fixed(r.u * float(t.width()) - 0.5f) >> 8,
                       j = Fetcher::fixed(r.v * float(t.height()) - 0.5f) >> 8;
    auto const k = std::size_t(component);
    return {f.texel(0, i, j + 1)[k], f.texel(0, i + 1, j + 1)[k], f.texel(0, i + 1, j)[k],
            f.texel(0, i, j)[k]};
}

} // namespace detail

} // namespace tessemu
