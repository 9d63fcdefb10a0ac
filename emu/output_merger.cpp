// SPDX-License-Identifier: Apache-2.0
#include "emu/output_merger.h"

#include "emu/scalar.h"

namespace tessemu {

bool compare(Comparison func, std::uint32_t a, std::uint32_t b)
{
    switch (func) {
    case Comparison::Never:
        return false;
    case Comparison::Less:
        return a < b;
    case Comparison::Equal:
        return a == b;
    case Comparison::LessEqual:
        return a <= b;
    case Comparison::Greater:
        return a > b;
    case Comparison::NotEqual:
        return a != b;
    case Comparison::GreaterEqual:
        return a >= b;
    default:
        return true;
    }
}

std::uint8_t apply(StencilOp op, std::uint8_t value, std::uint8_t ref)
{
    switch (op) {
    case StencilOp::Keep:
        return value;
    case StencilOp::Zero:
        return 0;
    case StencilOp::Replace:
        return ref;
    case StencilOp::IncrSat:
        return value == 255 ? value : std::uint8_t(value + 1);
    case StencilOp::DecrSat:
        return value == 0 ? value : std::uint8_t(value - 1);
    case StencilOp::Invert:
        return std::uint8_t(~value);
    case StencilOp::Incr:
        return std::uint8_t(value + 1);
    default:
        return std::uint8_t(value - 1);
    }
}

namespace {

// The formats' clamp; NaN is 0 as in a conversion to a normalised format.
float clamp_to(FormatType type, float v)
{
    if (!is_clamped(type)) return v;
    float const low = type == FormatType::Snorm ? -1.0f : 0.0f;
    return v > low ? (v < 1 ? v : 1.0f) : (v == v ? low : 0.0f);
}

float factor(Blend b, std::size_t k, std::array<float, 4> const& blend_factor,
             std::array<float, 4> const& s, std::array<float, 4> const& s1,
             std::array<float, 4> const& d)
{
    switch (b) {
    case Blend::Zero:
        return 0;
    case Blend::One:
        return 1;
    case Blend::SrcColor:
        return s[k];
    case Blend::InvSrcColor:
        return 1 - s[k];
    case Blend::SrcAlpha:
        return s[3];
    case Blend::InvSrcAlpha:
        return 1 - s[3];
    case Blend::DestAlpha:
        return d[3];
    case Blend::InvDestAlpha:
        return 1 - d[3];
    case Blend::DestColor:
        return d[k];
    case Blend::InvDestColor:
        return 1 - d[k];
    case Blend::SrcAlphaSat: // R137
        return k == 3 ? 1 : min(1 - d[3], s[3]);
    case Blend::BlendFactor:
        return blend_factor[k];
    case Blend::InvBlendFactor:
        return 1 - blend_factor[k];
    case Blend::Src1Color:
        return s1[k];
    case Blend::InvSrc1Color:
        return 1 - s1[k];
    case Blend::Src1Alpha:
        return s1[3];
    default:
        return 1 - s1[3];
    }
}

float combine(BlendOp op, float s, float sf, float d, float df)
{
    switch (op) {
    case BlendOp::Add:
        return s * sf + d * df;
    case BlendOp::Subtract:
        return s * sf - d * df;
    case BlendOp::RevSubtract:
        return d * df - s * sf;
    case BlendOp::Min:
        return min(s, d);
    default:
        return max(s, d);
    }
}

} // namespace

std::array<float, 4> blend(RenderTargetBlend const& state, std::array<float, 4> const& blend_factor,
                           FormatType type, std::array<float, 4> source,
                           std::array<float, 4> const& source1, std::array<float, 4> const& dest)
{
    std::array<float, 4> bf = blend_factor, s1 = source1, r;
    for (std::size_t k = 0; k < 4; ++k) {
        source[k] = clamp_to(type, source[k]);
        s1[k] = clamp_to(type, s1[k]);
        bf[k] = clamp_to(type, bf[k]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
        bool const alpha = k == 3;
        float const sf = factor(alpha ? state.src_alpha : state.src, k, bf, source, s1, dest);
        float const df = factor(alpha ? state.dest_alpha : state.dest, k, bf, source, s1, dest);
        r[k] =
            clamp_to(type, combine(alpha ? state.op_alpha : state.op, source[k], sf, dest[k], df));
    }
    return r;
}

std::uint32_t alpha_to_coverage(float alpha, int samples)
{
    if (!(alpha > 0)) return 0;
    int const n = alpha >= 1 ? samples : int(alpha * float(samples) + 0.5f);
    return (1u << n) - 1;
}

OutputMerger::OutputMerger(RasterTarget const& target)
    : target_(target),
      depth_(target.depth),
      depth_test_(depth_ && target.depth_stencil.depth_enable),
      depth_write_(depth_test_ && target.depth_stencil.depth_write && !target.depth_read_only),
      stencil_test_(depth_ && depth_->has_stencil() && target.depth_stencil.stencil_enable),
      stencil_write_(stencil_test_ && !target.stencil_read_only)
{
}

bool OutputMerger::test(int x, int y, int s, float z, bool front_face, Viewport const& viewport)
{
    if (!depth_or_stencil()) return true;
    DepthStencilState const& state = target_.depth_stencil;
    std::size_t const at = depth_->index(x, y, s);
    std::uint32_t code = 0;
    bool depth_pass = true;
    if (depth_test_) {
        // R135: NaN becomes MinDepth.
        float const low = viewport.min_depth, high = viewport.max_depth;
        z = z >= low ? (z <= high ? z : high) : low;
        code = depth_->code(z);
        depth_pass = compare(state.depth_func, code, depth_->codes()[at]);
    }
    bool pass = depth_pass;
    if (stencil_test_) {
        StencilFace const& face = front_face ? state.front : state.back;
        std::uint8_t& stored = depth_->stencil()[at];
        bool const stencil_pass = compare(face.func, state.stencil_ref & state.stencil_read_mask,
                                          stored & state.stencil_read_mask);
        StencilOp const op = !stencil_pass ? face.fail : depth_pass ? face.pass : face.depth_fail;
        if (stencil_write_) {
            std::uint8_t const m = state.stencil_write_mask;
            stored = std::uint8_t((stored & ~m) | (apply(op, stored, state.stencil_ref) & m));
        }
        pass = pass && stencil_pass;
    }
    if (pass && depth_write_) depth_->codes()[at] = code;
    return pass;
}

void OutputMerger::write(int x, int y, int s, float const* color, int color_targets)
{
    for (std::size_t i = 0; i < target_.color.size() && int(i) < color_targets; ++i) {
        ColorTarget* const t = target_.color[i];
        if (!t) continue;
        RenderTargetBlend const& b = target_.blend.target[target_.blend.independent_blend ? i : 0];
        std::array<float, 4> value{color[4 * i], color[4 * i + 1], color[4 * i + 2],
                                   color[4 * i + 3]};
        std::byte* const at = t->texel(x, y, s);
        if (b.enable) {
            std::array<float, 4> source1{};
            if (i == 0 && color_targets > 1) std::copy_n(color + 4, 4, source1.begin());
            value = blend(b, target_.blend.blend_factor, info(t->format()).type, value, source1,
                          decode(t->format(), at));
        }
        encode(t->format(), value, at, b.write_mask); // R138
    }
}

} // namespace tessemu
