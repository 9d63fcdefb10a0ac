// Textures: Load, and sampling with 8-bit weights, mip levels and addressing modes (R142, R145 to
// R150). Open to every stage; what takes derivatives is for pixel shaders.
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

/// 2D texture array of float4 texels with mip levels, rows from the top: slice after slice, in each
/// the levels from the largest, each half the size of the one before, rounded down, at least 1.
class Texture2D {
public:
    Texture2D() = default; ///< nothing bound: reads give 0
    Texture2D(std::span<float const> texels, int width, int height, int slot, std::string name,
              int levels = 1, int slices = 1)
        : texels_(texels),
          width_(width),
          height_(height),
          levels_(levels),
          slices_(slices),
          slot_(slot),
          name_(std::move(name))
    {
        assert(slot >= 0 && slot < kBufferSlots);
        assert(texels.size() == 4 * texels_of(width, height, levels) * std::size_t(slices));
    }
    int width(int level = 0) const { return std::max(1, width_ >> level); }
    int height(int level = 0) const { return std::max(1, height_ >> level); }
    int levels() const { return levels_; }
    int slices() const { return slices_; }
    int slot() const { return slot_; }
    bool bound() const { return !texels_.empty(); }
    std::span<float const> texels() const { return texels_; }
    /// Index of a texel that is in range.
    std::size_t index(int x, int y, int level, int slice) const
    {
        return texels_of(width_, height_, levels_) * std::size_t(slice) +
               texels_of(width_, height_, level) + std::size_t(y) * std::size_t(width(level)) +
               std::size_t(x);
    }
    float const* texel(std::size_t i) const { return texels_.data() + 4 * i; }
    ResourceInfo info() const
    {
        return {name_, ResourceKind::Texture, slot_, texels_.size() / 4, 4 * sizeof(float)};
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
    std::span<float const> texels_;
    int width_ = 0, height_ = 0, levels_ = 1, slices_ = 1, slot_ = 0;
    std::string name_;
};

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

/// HLSL Load: texel (x, y) without filtering; zeros out of range (R142).
template <class T>
float4<T> load(Texture2D const& texture, int_of<T> x, int_of<T> y, int level = 0, int slice = 0)
{
    bool const exists = texture.bound() && level >= 0 && level < texture.levels() && slice >= 0 &&
                        slice < texture.slices();
    int const width = exists ? texture.width(level) : 0,
              height = exists ? texture.height(level) : 0;
    std::size_t const first = exists ? texture.index(0, 0, level, slice) : 0;
    auto const texel = [&](std::int32_t i, std::int32_t j) {
        bool const in = i >= 0 && j >= 0 && i < width && j < height;
        return in ? std::int32_t(first) + j * width + i : std::int32_t(-1);
    };
    float const* const data = texture.texels().data();
    if constexpr (lanes_of<T> == 1) {
        std::int32_t const i = texel(x, y);
        detail::count_fetch<T>(texture.slot(), i, texture.texels().size() / 4);
        if (i < 0) return {T(0), T(0), T(0), T(0)};
        return load_record<float4<T>>(data + 4 * std::size_t(i));
    } else {
        constexpr int N = lanes_of<T>;
        IntLanes<N> index(0);
        for (int k = 0; k < N; ++k) index.raw[k] = texel(x.raw[k], y.raw[k]);
        detail::count_fetch<T>(texture.slot(), index);
        Lanes<N> c[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        for (int k = 0; k < N; ++k)
            for (int m = 0; m < 4; ++m)
                if (index.raw[k] >= 0)
                    c[m].raw[k] = data[4 * std::size_t(index.raw[k]) + std::size_t(m)];
        return {T(c[0]), T(c[1]), T(c[2]), T(c[3])};
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
