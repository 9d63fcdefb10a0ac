// Fixed-function state of a draw under Direct3D 11's names, and the targets it draws into.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/formats.h"
#include "emu/large_array.h"
#include "emu/parallel.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tessemu {

struct Viewport {
    float x = 0, y = 0, width = 0, height = 0, min_depth = 0, max_depth = 1;
};

/// Pixels left <= x < right, top <= y < bottom.
struct Rect {
    int left = 0, top = 0, right = 0, bottom = 0;

    Rect intersect(Rect const& o) const
    {
        return {std::max(left, o.left), std::max(top, o.top), std::min(right, o.right),
                std::min(bottom, o.bottom)};
    }
    bool empty() const { return left >= right || top >= bottom; }
};

enum class CullMode : std::uint8_t { None, Front, Back };
enum class FillMode : std::uint8_t { Solid, Wireframe };

/// What a depth bias counts in where no depth buffer is bound: steps of 24 bits, as the
/// specification has it (R110), or of a float depth buffer, as drivers do.
enum class UnboundDepthBias : std::uint8_t { Unorm24, Float };

struct RasterizerState {
    FillMode fill = FillMode::Solid;
    CullMode cull = CullMode::Back;
    bool front_counter_clockwise = false; ///< R104: otherwise clockwise on the target is front
    std::int32_t depth_bias = 0;
    float depth_bias_clamp = 0, slope_scaled_depth_bias = 0;
    UnboundDepthBias unbound_depth_bias = UnboundDepthBias::Unorm24;
    bool depth_clip_enable = true;
    bool scissor_enable = false;
    bool multisample_enable = false; ///< lines become 1.4 pixels wide (R107); nothing else
    float guard_band_px = 16384;     ///< half width of the band in x and y, at most this (I-12)
};

enum class Comparison : std::uint8_t {
    Never,
    Less,
    Equal,
    LessEqual,
    Greater,
    NotEqual,
    GreaterEqual,
    Always
};
enum class StencilOp : std::uint8_t { Keep, Zero, Replace, IncrSat, DecrSat, Invert, Incr, Decr };

struct StencilFace {
    StencilOp fail = StencilOp::Keep, depth_fail = StencilOp::Keep, pass = StencilOp::Keep;
    Comparison func = Comparison::Always;
};

struct DepthStencilState {
    bool depth_enable = true;
    bool depth_write = true;
    Comparison depth_func = Comparison::Less;
    bool stencil_enable = false;
    std::uint8_t stencil_read_mask = 0xff, stencil_write_mask = 0xff;
    StencilFace front, back;
    std::uint8_t stencil_ref = 0;
};

enum class Blend : std::uint8_t {
    Zero,
    One,
    SrcColor,
    InvSrcColor,
    SrcAlpha,
    InvSrcAlpha,
    DestAlpha,
    InvDestAlpha,
    DestColor,
    InvDestColor,
    SrcAlphaSat,
    BlendFactor,
    InvBlendFactor,
    Src1Color,
    InvSrc1Color,
    Src1Alpha,
    InvSrc1Alpha
};
enum class BlendOp : std::uint8_t { Add, Subtract, RevSubtract, Min, Max };

struct RenderTargetBlend {
    bool enable = false;
    Blend src = Blend::One, dest = Blend::Zero;
    BlendOp op = BlendOp::Add;
    Blend src_alpha = Blend::One, dest_alpha = Blend::Zero;
    BlendOp op_alpha = BlendOp::Add;
    std::uint8_t write_mask = 0xf; ///< bit i: component i is written
};

/// How an attribute crosses a primitive (R120). Centroid and sample modes differ from the others
/// with more than one sample only.
enum class Interpolation : std::uint8_t {
    Constant, ///< the leading vertex's bits
    Linear,   ///< perspective correct
    LinearNoperspective,
    LinearCentroid,
    LinearNoperspectiveCentroid,
    LinearSample,
    LinearNoperspectiveSample
};

inline constexpr std::size_t kMaxRenderTargets = 8; // R137
inline constexpr std::size_t kMaxViewports = 16;    // R99
inline constexpr int kMaxSamples = 8;

struct BlendState {
    bool alpha_to_coverage = false;
    bool independent_blend = false; ///< otherwise entry 0 holds for all targets
    std::array<RenderTargetBlend, kMaxRenderTargets> target{};
    std::array<float, 4> blend_factor{1, 1, 1, 1};
    std::uint32_t sample_mask = 0xffffffffu; ///< bit i is sample i (I-22)
};

/// Offset of a sample from the pixel's centre in 1/16 pixel, x right and y down (R115).
struct SampleOffset {
    int x, y;
};
/// The standard pattern of 1, 2, 4 or 8 samples.
std::span<SampleOffset const> sample_pattern(int samples);

/// A colour target of 1, 2, 4 or 8 samples a pixel, rows from the top, in its format's own bytes.
class ColorTarget {
public:
    /// Throws LimitError outside 1 to 16384 pixels an axis (R112 asks for 2^15 addressable;
    /// D3D11's textures end at 2^14) and Error for a format that cannot be drawn to. Contents are
    /// undefined until cleared.
    ColorTarget(int width, int height, Format format = Format::R8G8B8A8_UNORM, int samples = 1);

    static constexpr int kMaxSize = 16384;

    int width() const { return width_; }
    int height() const { return height_; }
    int samples() const { return samples_; }
    Format format() const { return format_; }
    std::size_t texel_bytes() const { return bytes_; }
    /// Bytes of a row's texels.
    std::size_t row_bytes() const { return std::size_t(width_) * std::size_t(samples_) * bytes_; }
    /// Texels from one row to the next: the same for all targets of a size.
    std::size_t pitch() const { return pitch_; }
    /// Sample s of pixel (x, y); a row's texels follow each other, samples of a pixel too.
    std::byte* texel(int x, int y, int s = 0)
    {
        return storage_.get() +
               (std::size_t(y) * pitch_ + std::size_t(x) * std::size_t(samples_) + std::size_t(s)) *
                   bytes_;
    }
    std::byte const* texel(int x, int y, int s = 0) const
    {
        return const_cast<ColorTarget*>(this)->texel(x, y, s);
    }
    std::array<float, 4> load(int x, int y, int s = 0) const
    {
        return decode(format_, texel(x, y, s));
    }
    /// Clears the whole view; viewport and scissor do not apply (R140).
    void clear(std::array<float, 4> const& color, ThreadPool const& threads);

private:
    int width_, height_, samples_;
    Format format_;
    std::size_t bytes_, pitch_;
    LargeArray<std::byte> storage_;
};

/// Averages the samples of every pixel, in linear space for sRGB (R116).
void resolve(ColorTarget const& source, ColorTarget& target);

/// A depth-stencil target. Depth is held as the format's code, a float's bits or an integer, so
/// that codes compare like depths.
class DepthTarget {
public:
    DepthTarget(int width, int height, Format format = Format::D32_FLOAT, int samples = 1);

    int width() const { return width_; }
    int height() const { return height_; }
    int samples() const { return samples_; }
    Format format() const { return format_; }
    bool has_stencil() const { return !stencil_.empty(); }
    std::size_t index(int x, int y, int s = 0) const
    {
        return std::size_t(y) * pitch_ + std::size_t(x) * std::size_t(samples_) + std::size_t(s);
    }
    std::size_t pitch() const { return pitch_; } ///< codes from one row to the next
    std::uint32_t* codes() { return depth_.get(); }
    std::uint32_t const* codes() const { return depth_.get(); }
    std::uint8_t* stencil() { return stencil_.data(); }
    std::uint8_t const* stencil() const { return stencil_.data(); }
    float depth(int x, int y, int s = 0) const;
    /// z in [0,1] as the format holds it: rounded to nearest, a float unchanged (R134).
    std::uint32_t code(float z) const;
    void clear(float depth, std::uint8_t stencil, ThreadPool const& threads);

private:
    int width_, height_, samples_;
    Format format_;
    std::size_t pitch_;
    LargeArray<std::uint32_t> depth_;
    std::vector<std::uint8_t> stencil_;
};

/// How often each sample was covered, before any depth test: what a crack or an overlap shows in.
struct CoverageCounts {
    CoverageCounts(int w, int h, int s = 1)
        : width(w),
          height(h),
          samples(s),
          count(std::size_t(w) * std::size_t(h) * std::size_t(s)),
          winding(count.size())
    {
    }
    int width, height, samples;
    std::vector<std::uint32_t> count;  ///< sample after sample, row after row
    std::vector<std::int32_t> winding; ///< front hits less back hits
    std::size_t index(int x, int y, int s) const
    {
        return (std::size_t(y) * std::size_t(width) + std::size_t(x)) * std::size_t(samples) +
               std::size_t(s);
    }
    std::uint32_t& at(int x, int y, int s) { return count[index(x, y, s)]; }
    void add(int x, int y, int s, bool front)
    {
        std::size_t const i = index(x, y, s);
        ++count[i];
        winding[i] += front ? 1 : -1;
    }
    void clear()
    {
        std::fill(count.begin(), count.end(), 0u);
        std::fill(winding.begin(), winding.end(), 0);
    }
};

/// Where and how primitives are drawn. All targets have the same size and number of samples; with
/// none at all the first viewport's extent is rasterized (R6).
struct RasterTarget {
    std::vector<ColorTarget*> color; ///< at most 8; a null entry is unbound
    DepthTarget* depth = nullptr;
    std::vector<Viewport> viewports = {}; ///< at most 16; the rest are all zeros (R97)
    std::vector<Rect> scissors = {};      ///< the rest are empty
    RasterizerState rasterizer = {};
    DepthStencilState depth_stencil = {};
    BlendState blend = {};
    bool depth_read_only = false, stencil_read_only = false; ///< of the view (R139)
    CoverageCounts* coverage = nullptr;                      ///< counted where given

    int samples() const;
};

} // namespace tessemu
