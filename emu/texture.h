// Textures: Load, and sampling with 8-bit weights, mip levels and addressing modes (R142, R145 to
// R150). Open to every stage; what takes derivatives is for pixel shaders.
//
// A texel is an element of the texture's format: a read counts the format's bytes and gives four
// components, missing ones as the format has them (R36).
//
// The sampler is fixed function: its arithmetic is not counted, every texel it reads is. Choices
// (I-21): 8 bits of weight and of LOD fraction, LOD per pixel, a texel of weight 0 does not
// contribute even if it is NaN, no anisotropic filter.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/derivatives.h"
#include "emu/graphics_state.h"
#include "emu/memory.h"

namespace tessemu {

/// 2D texture array with mip levels, rows from the top: slice after slice, in each the levels from
/// the largest, each half the size of the one before, rounded down, at least 1.
class Texture2D {
public:
    Texture2D() = default; ///< nothing bound: reads give 0
    /// Four floats a texel (R32G32B32A32_FLOAT), row after row without a gap.
    ///
    /// Into a `recording` a shader that runs on Graph records its reads of texels, known by slot;
    /// where there is none it reads texel (0, 0).
    Texture2D(std::span<float const> texels, int width, int height, int slot, std::string name,
              int levels = 1, int slices = 1, ExpressionGraph* recording = nullptr)
        : texels_(std::as_bytes(texels)),
          width_(width),
          height_(height),
          levels_(levels),
          slices_(slices),
          slot_(slot),
          pitch_(std::size_t(width)),
          recording_(recording),
          name_(std::move(name))
    {
        assert(slot >= 0 && slot < kBufferSlots);
        assert(recording ||
               texels.size() == 4 * texels_of(width, height, levels) * std::size_t(slices));
    }
    /// One level of any format, from its own bytes.
    ///
    /// \param row_pitch  texels from one row to the next, at least `width`
    Texture2D(std::span<std::byte const> texels, Format format, int width, int height,
              std::size_t row_pitch, int slot, std::string name,
              ExpressionGraph* recording = nullptr)
        : texels_(texels),
          format_(format),
          width_(width),
          height_(height),
          slot_(slot),
          texel_bytes_(tessemu::info(format).bytes),
          pitch_(row_pitch),
          recording_(recording),
          name_(std::move(name))
    {
        assert(slot >= 0 && slot < kBufferSlots);
        assert(row_pitch >= std::size_t(width));
        assert(recording || height == 0 ||
               texels.size() >=
                   (row_pitch * std::size_t(height - 1) + std::size_t(width)) * texel_bytes_);
    }
    int width(int level = 0) const { return std::max(1, width_ >> level); }
    int height(int level = 0) const { return std::max(1, height_ >> level); }
    int levels() const { return levels_; }
    int slices() const { return slices_; }
    int slot() const { return slot_; }
    Format format() const { return format_; }
    bool bound() const { return !texels_.empty(); }
    ExpressionGraph* recording() const { return recording_; }
    /// Texels from one row of a level to the next.
    std::size_t row_pitch(int level = 0) const
    {
        return levels_ == 1 ? pitch_ : std::size_t(width(level));
    }
    /// Places of texels in memory, those between rows included.
    std::size_t texel_count() const { return texels_.size() / texel_bytes_; }
    /// Index of a texel that is in range.
    std::size_t index(int x, int y, int level, int slice) const
    {
        return texels_of(width_, height_, levels_) * std::size_t(slice) +
               texels_of(width_, height_, level) + std::size_t(y) * row_pitch(level) +
               std::size_t(x);
    }
    std::byte const* data() const { return texels_.data(); }
    /// Its four components.
    std::array<float, 4> texel(std::size_t i) const
    {
        return decode(format_, texels_.data() + texel_bytes_ * i);
    }
    ResourceInfo info() const
    {
        return {name_, ResourceKind::Texture, slot_, texel_count(), texel_bytes_};
    }
    /// Texels of the first `levels` levels of a slice.
    static std::size_t texels_of(int width, int height, int levels)
    {
        std::size_t n = 0;
        for (int l = 0; l < levels; ++l)
            n += std::size_t(std::max(1, width >> l)) * std::size_t(std::max(1, height >> l));
        return n;
    }

private:
    std::span<std::byte const> texels_;
    Format format_ = Format::R32G32B32A32_FLOAT;
    int width_ = 0, height_ = 0, levels_ = 1, slices_ = 1, slot_ = 0;
    std::size_t texel_bytes_ = 4 * sizeof(float), pitch_ = 0;
    ExpressionGraph* recording_ = nullptr;
    std::string name_;
};

/// What was drawn, as a texture of the target's format and size: a view of its memory. Throws Error
/// for more than one sample a pixel, which are resolved first.
Texture2D texture_of(ColorTarget const& target, int slot, std::string name);

/// Appends mip levels to a texture of one level by averaging 2x2 texels (2 or 1 at odd sizes: the
/// last row or column is left out where the size is rounded down). Returns texels and levels.
std::pair<std::vector<float>, int> make_mip_levels(std::span<float const> texels, int width,
                                                   int height);

enum class AddressMode : std::uint8_t { Wrap, Mirror, Clamp, Border, MirrorOnce };
enum class Filter : std::uint8_t { Point, Linear };

/// As made, Direct3D's default: what a shader samples with where no sampler is bound.
struct Sampler {
    Filter min = Filter::Linear, mag = Filter::Linear, mip = Filter::Linear;
    AddressMode address_u = AddressMode::Clamp, address_v = AddressMode::Clamp;
    std::array<float, 4> border{1, 1, 1, 1};
    float lod_bias = 0, min_lod = -3.402823466e38f, max_lod = 3.402823466e38f;
    Comparison comparison = Comparison::Never; ///< (reference FUNC texel), of sample_cmp
};

/// log2 of x in 8.8 fixed point, rounded down; without libm. 0 and denormals give -32768, infinity
/// and NaN 32767.
std::int32_t log2_fixed8(double x);

namespace detail {

/// One invocation's sample. `read` is told the index of each texel that is read.
struct SampleRequest {
    float u, v, lod; ///< lod before the sampler's bias and clamp
    std::int32_t slice;
    bool compare;
    float reference;
};
using TexelReader = void (*)(void*, std::size_t);
std::array<float, 4> sample_texture(Texture2D const& texture, Sampler const& sampler,
                                    SampleRequest const& request, TexelReader read, void* context);
std::array<float, 4> gather_texture(Texture2D const& texture, Sampler const& sampler,
                                    SampleRequest const& request, int component, TexelReader read,
                                    void* context);
/// R148: the LOD of derivatives in texels of level 0.
float lod_of(float dudx, float dvdx, float dudy, float dvdy);

template <class T> struct TexelCount {
    Texture2D const& texture;
    bool active = true;
    static void read(void* self, std::size_t index)
    {
        auto const& c = *static_cast<TexelCount*>(self);
        if constexpr (ScalarTraits<T>::kCounted) {
            FetchSlot* const s = detail::bound_slot(c.texture.slot());
            if (!s || !c.active) return;
            ++s->count;
            if (s->touched) s->touched->mark(index);
        }
    }
};

/// work(lane, count) gives a lane's four components.
template <class T, class Work> float4<T> sample_lanes(Texture2D const& texture, Work const& work)
{
    if constexpr (ScalarTraits<T>::kCounted) execution.features |= kFetches;
    TexelCount<T> count{texture};
    if constexpr (lanes_of<T> == 1) {
        std::array<float, 4> const r = work(0, count);
        return {T(r[0]), T(r[1]), T(r[2]), T(r[3])};
    } else {
        constexpr int N = lanes_of<T>;
        Lanes<N> c[4];
        for (int l = 0; l < N; ++l) {
            count.active = execution.active_bits >> l & 1;
            std::array<float, 4> const r = work(l, count);
            for (std::size_t k = 0; k < 4; ++k) c[k].raw[l] = r[k];
        }
        return {T(c[0]), T(c[1]), T(c[2]), T(c[3])};
    }
}
template <class T> float lane(T const& v, int l)
{
    if constexpr (lanes_of<T> == 1)
        return float(v);
    else
        return lanes_value(v).raw[l];
}
} // namespace detail

namespace detail {

// Four components of a texel that no index reaches: 0 where the format has the component, its
// default where it has not (R142).
std::array<float, 4> texel_out_of_range(Format format);

/// Texels by index, -1 out of range.
template <int N> void read_texels(Texture2D const& texture, IntLanes<N> index, Lanes<N> (&out)[4])
{
    if (texture.format() == Format::R32_FLOAT && texture.bound()) {
        IntLanes<N> const bits = gather_or_zero<N>(texture.data(), texture.texel_count(), index);
        out[0].raw = typename Lanes<N>::Raw(bits.raw);
        out[1] = out[2] = Lanes<N>(0.0f);
        out[3] = Lanes<N>(1.0f);
        return;
    }
    std::int32_t at[N];
    store_lanes<N>(index, at);
    if (texture.format() == Format::R32G32B32A32_FLOAT) {
        static constexpr float kZeros[4]{};
        Floats<4> column[4][N / 4];
        for (int g = 0; g < N / 4; ++g) {
            Floats<4> r[4];
            for (int l = 0; l < 4; ++l) {
                std::int32_t const i = at[4 * g + l];
                void const* const from = i < 0 ? static_cast<void const*>(kZeros)
                                               : texture.data() + sizeof(kZeros) * std::size_t(i);
                __builtin_memcpy(&r[l], from, sizeof r[l]);
            }
            transpose(r);
            for (int k = 0; k < 4; ++k) column[k][g] = r[k];
        }
        for (int k = 0; k < 4; ++k) out[k].raw = joined<N>(column[k]);
        return;
    }
    std::array<float, 4> const outside = texel_out_of_range(texture.format());
    for (int l = 0; l < N; ++l) {
        std::array<float, 4> const texel = at[l] < 0 ? outside : texture.texel(std::size_t(at[l]));
        for (std::size_t k = 0; k < 4; ++k) out[k].raw[l] = texel[k];
    }
}

/// The whole number below, as a shader's conversion gives it: clamped, 0 for NaN (R19).
inline std::int32_t floor_to_int(float x)
{
    return int_from_float(floor(x));
}
template <int N> IntLanes<N> floor_to_int(Lanes<N> x)
{
    // In the range of a texture's coordinates and a little more, where the conversion is exact.
    Lanes<N> const down = floor(x);
    Lanes<N> const low(-65536.0f), high(65536.0f);
    Lanes<N> const in =
        select(down == down, select(down < low, low, select(down > high, high, down)), 0.0f);
    return typename IntLanes<N>::Raw(__builtin_convertvector(in.raw, typename IntLanes<N>::Raw));
}
} // namespace detail

/// HLSL Load: texel (x, y) without filtering. Out of range components are 0, those that the format
/// lacks have their default, and with nothing bound all are 0 (R142).
template <class T>
float4<T> load(Texture2D const& texture, int_of<T> x, int_of<T> y, int level = 0, int slice = 0)
{
    if constexpr (RecordingScalar<T>) {
        if (texture.recording())
            return T::texel(*texture.recording(), {texture.slot(), level, slice}, T(float(x)),
                            T(float(y)));
    }
    bool const exists = texture.bound() && level >= 0 && level < texture.levels() && slice >= 0 &&
                        slice < texture.slices();
    int const width = exists ? texture.width(level) : 0,
              height = exists ? texture.height(level) : 0;
    auto const first = std::int32_t(exists ? texture.index(0, 0, level, slice) : 0),
               pitch = std::int32_t(exists ? texture.row_pitch(level) : 0);
    if constexpr (lanes_of<T> == 1) {
        bool const in = x >= 0 && y >= 0 && x < width && y < height;
        std::int32_t const i = in ? first + y * pitch + x : -1;
        detail::count_fetch<T>(texture.slot(), i, texture.texel_count());
        if (!texture.bound()) return {T(0), T(0), T(0), T(0)};
        std::array<float, 4> const texel =
            in ? texture.texel(std::size_t(i)) : detail::texel_out_of_range(texture.format());
        return load_record<float4<T>>(texel.data());
    } else {
        constexpr int N = lanes_of<T>;
        using I = IntLanes<N>;
        Mask<N> const in = (x >= I(0)) & (y >= I(0)) & (x < I(width)) & (y < I(height));
        I const index = select(in, I(first) + y * I(pitch) + x, I(-1));
        detail::count_fetch<T>(texture.slot(), index);
        Lanes<N> c[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        if (texture.bound()) detail::read_texels<N>(texture, index, c);
        return {T(c[0]), T(c[1]), T(c[2]), T(c[3])};
    }
}

/// The texel that holds the point `at`, in texels from the top left corner: a rectangle texture
/// with the filter NEAREST in OpenGL, Load of the whole numbers below in Direct3D 11. One counted
/// fetch; the conversion is part of it. Out of range as load().
template <class T> float4<T> fetch_texel(Texture2D const& texture, float2<T> const& at)
{
    if constexpr (RecordingScalar<T>) {
        if (texture.recording())
            return T::texel(*texture.recording(), {texture.slot()}, at.x, at.y);
        return load<T>(texture, 0, 0);
    } else if constexpr (requires { lanes_value(at.x); }) {
        return load<T>(texture, detail::floor_to_int(lanes_value(at.x)),
                       detail::floor_to_int(lanes_value(at.y)));
    } else if constexpr (std::floating_point<T>) {
        return load<T>(texture, detail::floor_to_int(float(at.x)),
                       detail::floor_to_int(float(at.y)));
    } else { // a tally has no point
        return load<T>(texture, 0, 0);
    }
}

/// SampleLevel: at a level of detail, with the sampler's filter. `slice` is rounded to nearest even
/// and clamped (R150).
template <class T>
float4<T> sample_level(Texture2D const& texture, Sampler const& sampler, float2<T> const& uv, T lod,
                       T slice = T(0))
{
    return detail::sample_lanes<T>(texture, [&](int l, detail::TexelCount<T>& count) {
        detail::SampleRequest const r{detail::lane(uv.x, l),
                                      detail::lane(uv.y, l),
                                      detail::lane(lod, l),
                                      fixed_from_float(detail::lane(slice, l), 24, 0),
                                      false,
                                      0};
        return detail::sample_texture(texture, sampler, r, count.read, &count);
    });
}

/// SampleGrad: derivatives of the coordinates along x and y (R148).
template <class T>
float4<T> sample_grad(Texture2D const& texture, Sampler const& sampler, float2<T> const& uv,
                      float2<T> const& dx, float2<T> const& dy, T bias = T(0), T slice = T(0))
{
    float const w = float(texture.width()), h = float(texture.height());
    return detail::sample_lanes<T>(texture, [&](int l, detail::TexelCount<T>& count) {
        float const lod = detail::lod_of(detail::lane(dx.x, l) * w, detail::lane(dx.y, l) * h,
                                         detail::lane(dy.x, l) * w, detail::lane(dy.y, l) * h);
        detail::SampleRequest const r{detail::lane(uv.x, l),
                                      detail::lane(uv.y, l),
                                      lod + detail::lane(bias, l),
                                      fixed_from_float(detail::lane(slice, l), 24, 0),
                                      false,
                                      0};
        return detail::sample_texture(texture, sampler, r, count.read, &count);
    });
}

/// Sample and SampleBias: derivatives inside the quad; pixel shaders only (R127).
template <class T>
float4<T> sample(Texture2D const& texture, Sampler const& sampler, float2<T> const& uv,
                 T bias = T(0), T slice = T(0))
{
    return sample_grad(texture, sampler, uv, float2<T>(ddx(uv.x), ddx(uv.y)),
                       float2<T>(ddy(uv.x), ddy(uv.y)), bias, slice);
}

/// SampleCmpLevelZero: the filtered result of (reference FUNC texel's first component).
template <class T>
T sample_cmp_level_zero(Texture2D const& texture, Sampler const& sampler, float2<T> const& uv,
                        T reference)
{
    return detail::sample_lanes<T>(
               texture,
               [&](int l, detail::TexelCount<T>& count) {
                   detail::SampleRequest const r{
                       detail::lane(uv.x, l),     detail::lane(uv.y, l), 0, 0, true,
                       detail::lane(reference, l)};
                   return detail::sample_texture(texture, sampler, r, count.read, &count);
               })
        .x;
}

/// Gather: one component of the four texels that bilinear filtering of level 0 would weigh, in the
/// order left bottom, right bottom, right top, left top.
template <class T>
float4<T> gather(Texture2D const& texture, Sampler const& sampler, float2<T> const& uv,
                 int component = 0)
{
    return detail::sample_lanes<T>(texture, [&](int l, detail::TexelCount<T>& count) {
        detail::SampleRequest const r{detail::lane(uv.x, l), detail::lane(uv.y, l), 0, 0, false, 0};
        return detail::gather_texture(texture, sampler, r, component, count.read, &count);
    });
}

} // namespace tessemu
