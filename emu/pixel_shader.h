// Pixel shader stage: one invocation per fragment, lanes across fragments in submission order.
//
// A pixel shader is
//
//     struct S {
//         template <class T> using Input = ...;  // record: the first attributes after SV_Position
//                                                // that the stage before wrote
//         template <class T> Output operator()(PixelInput<T> const&, Input<T> const&) const;
//     };
//
// Output is float4<T>, the colour o0, or a struct with any of
//
//     float4<T> color;  or  std::array<float4<T>, n> color;  // o0, or o0 to o(n-1)
//     T depth;                                               // SV_Depth (R124)
//     int_of<T> coverage;                                    // SV_Coverage, oMask (R118)
//     mask_of<T> discard;                                    // pixels that leave no trace (R125)
//
// The input record may declare how its members are interpolated (R120), `static constexpr
// std::array<Interpolation, members> kInterpolation`; linear otherwise. The shader may declare
// `static constexpr bool kForceEarlyDepthStencil` (R131) and `kSampleFrequency` (R114).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/bound_shader.h"
#include "emu/derivatives.h"
#include "emu/graphics_state.h"
#include "emu/statistics.h"

#include <algorithm>
#include <bit>

namespace tessemu {

template <class T> struct PixelInput {
    float4<T> position; ///< SV_Position: pixel centre or sample, unclamped depth, w (R121, R122)
    int_of<T> primitive_id;   ///< SV_PrimitiveID
    mask_of<T> front_face;    ///< SV_IsFrontFace
    int_of<T> sample_index;   ///< SV_SampleIndex at sample frequency, 0 otherwise
    int_of<T> coverage;       ///< SV_Coverage: covered samples after the mask (R119)
    int_of<T> viewport_index; ///< SV_ViewportArrayIndex (R99)
};

/// What a compiled pixel shader tells the pipeline.
struct PixelShaderInfo {
    std::vector<Interpolation> interpolation; ///< one per input scalar
    int color_targets = 0;
    bool writes_depth = false, writes_coverage = false, discards = false;
    bool force_early = false, sample_frequency = false;
};

/// What a run of one invocation shows: control flow cannot depend on lanes.
struct PixelShaderCost {
    std::uint32_t features = 0; ///< ShaderFeature bits
    FlopCount flops; ///< of every invocation, where features has neither branches nor fetches
};

/// Fragments, arrays per component; whole groups of 16 may be read and written.
struct FragmentBatch {
    std::size_t count;
    float const* position[4];
    float const* const* attributes; ///< component k at attributes[k]
    std::int32_t const* primitive_id;
    std::int32_t const* front_face; ///< 0 or -1
    std::int32_t const* sample_index;
    std::int32_t const* coverage;
    std::int32_t const* viewport_index; ///< null: all 0
    std::int32_t const* live; ///< 0: a helper, run for its quad and counted nowhere; null: all live
    float* const* color;      ///< out: component k of o(i) at color[4 * i + k]
    float* depth;             ///< out, where the shader writes it
    std::int32_t* out_coverage;
    std::int32_t* discard; ///< out: -1 where discarded
};

class PixelProgram : public ShaderProgram {
public:
    PixelShaderInfo const& info() const { return info_; }
    int input_floats() const { return int(info_.interpolation.size()); }
    virtual void run(ShaderBinding const& binding, FragmentBatch const& batch,
                     StageCounters& counters, StageBuffers const& buffers) const = 0;
    /// The same bits where counts are known (PixelShaderCost), of a shader that reads no memory.
    virtual void run_uncounted(ShaderBinding const& binding, FragmentBatch const& batch) const = 0;
    /// Runs one invocation on zeros.
    PixelShaderCost probe(ShaderBinding const& binding) const;

protected:
    PixelShaderInfo info_;
};

template <class Shader, class T>
class PixelProgramOn final : public CompiledProgram<PixelProgram, Shader> {
    using CompiledProgram<PixelProgram, Shader>::info_;
    static constexpr int N = lanes_of<T>;
    template <class U>
    using OutputOf = std::remove_cvref_t<decltype(std::declval<Shader const&>()(
        std::declval<PixelInput<U> const&>(),
        std::declval<typename Shader::template Input<U> const&>()))>;
    using Input = typename Shader::template Input<T>;
    using Output = OutputOf<T>;
    static constexpr int color_targets()
    {
        if constexpr (std::same_as<Output, float4<T>> || requires(Output o) { o.color.w; })
            return 1;
        else if constexpr (requires(Output o) { o.color; })
            return int(detail::array_size<decltype(Output::color)>);
        else
            return 0;
    }
    static constexpr int kColors = color_targets();
    static constexpr bool kDepth = requires(Output o) { o.depth; };
    static constexpr bool kCoverage = requires(Output o) { o.coverage; };
    static constexpr bool kDiscard = requires(Output o) { o.discard; };

    template <class U, class F> static void for_each_color(OutputOf<U> const& o, F&& f)
    {
        if constexpr (std::same_as<OutputOf<U>, float4<U>>)
            f(o);
        else if constexpr (requires { o.color.w; })
            f(o.color);
        else if constexpr (requires { o.color; })
            for (float4<U> const& c : o.color) f(c);
    }

public:
    PixelProgramOn()
    {
        describe_inputs();
        info_.color_targets = kColors;
        info_.writes_depth = kDepth;
        info_.writes_coverage = kCoverage;
        info_.discards = kDiscard;
        if constexpr (requires { Shader::kForceEarlyDepthStencil; })
            info_.force_early = Shader::kForceEarlyDepthStencil;
        if constexpr (requires { Shader::kSampleFrequency; })
            info_.sample_frequency = Shader::kSampleFrequency;
        for (Interpolation i : info_.interpolation)
            if (i == Interpolation::LinearSample || i == Interpolation::LinearNoperspectiveSample)
                info_.sample_frequency = true; // R114
    }

    void run(ShaderBinding const& binding, FragmentBatch const& b, StageCounters& counters,
             StageBuffers const& buffers) const override
    {
        StageScope const scope(counters, buffers, binding.sites());
        if constexpr (ScalarTraits<T>::kSites)
            counters.invocations += run_fragments<T>(binding, b);
        else
            counters.invocations += run_flattened<T>(binding, b);
    }
    void run_uncounted(ShaderBinding const& binding, FragmentBatch const& b) const override
    {
        if constexpr (std::same_as<T, Counted<Lanes<N>>>) {
            run_flattened<Lanes<N>>(binding, b);
        } else {
            StageCounters none;
            run(binding, b, none, StageBuffers({}));
        }
    }

private:
    // Flattened for the reason of DomainProgramOn's.
    template <class U>
#if !defined(__SANITIZE_ADDRESS__)
    [[gnu::flatten]]
#endif
    static std::uint64_t
    run_flattened(ShaderBinding const& binding, FragmentBatch const& b)
    {
        return run_fragments<U>(binding, b);
    }

    /// \returns  invocations
    template <class U>
    static std::uint64_t run_fragments(ShaderBinding const& binding, FragmentBatch const& b)
    {
        Shader const& shader = binding.as<Shader>();
        std::uint64_t invocations = 0;
        for (std::size_t first = 0; first < b.count; first += N) {
            std::uint32_t const active = active_lanes(b, first);
            if (active == 0) continue; // helpers only
            begin_group<U>(active);
            auto const lanes = [&](float const* p) { return U(Lanes<N>::load(p + first)); };
            PixelInput<U> pixel;
            pixel.position = {lanes(b.position[0]), lanes(b.position[1]), lanes(b.position[2]),
                              lanes(b.position[3])};
            __builtin_memcpy(&pixel.primitive_id.raw, b.primitive_id + first, 4 * N);
            __builtin_memcpy(&pixel.front_face.raw, b.front_face + first, 4 * N);
            __builtin_memcpy(&pixel.sample_index.raw, b.sample_index + first, 4 * N);
            __builtin_memcpy(&pixel.coverage.raw, b.coverage + first, 4 * N);
            pixel.viewport_index = int_of<U>(0);
            if (b.viewport_index)
                __builtin_memcpy(&pixel.viewport_index.raw, b.viewport_index + first, 4 * N);
            typename Shader::template Input<U> input{};
            int k = 0;
            for_each_scalar(input, [&](auto& s) { s = lanes(b.attributes[k++]); });
            OutputOf<U> const out = shader(pixel, input);
            k = 0;
            for_each_color<U>(out, [&](float4<U> const& color) {
                for_each_scalar(color,
                                [&](auto const& s) { lanes_value(s).store(b.color[k++] + first); });
            });
            if constexpr (kDepth) lanes_value(out.depth).store(b.depth + first);
            if constexpr (kCoverage)
                __builtin_memcpy(b.out_coverage + first, &out.coverage.raw, 4 * N);
            if constexpr (kDiscard) __builtin_memcpy(b.discard + first, &out.discard.raw, 4 * N);
            invocations += std::uint64_t(std::popcount(active));
        }
        return invocations;
    }

    static std::uint32_t active_lanes(FragmentBatch const& b, std::size_t first)
    {
        std::size_t const left = b.count - first;
        std::uint32_t const all = left >= std::size_t(N) ? (1u << N) - 1 : (1u << left) - 1;
        if (!b.live) return all;
        Mask<N> live;
        __builtin_memcpy(&live.raw, b.live + first, 4 * N);
        return live.bits() & all;
    }

    void describe_inputs()
    {
        if constexpr (requires { Input::kInterpolation; }) {
            std::size_t member = 0;
            std::apply(
                [&](auto... m) {
                    ((info_.interpolation.insert(
                         info_.interpolation.end(),
                         std::size_t(scalar_count<
                                     std::remove_cvref_t<decltype(std::declval<Input&>().*m)>>()),
                         Input::kInterpolation[member++])),
                     ...);
                },
                Input::signature());
        } else {
            info_.interpolation.assign(std::size_t(scalar_count<Input>()), Interpolation::Linear);
        }
    }
};

class PixelShader : public BoundShader<PixelProgram> {
public:
    using BoundShader::BoundShader;
    PixelShader(BoundShader<PixelProgram> shader) : BoundShader(std::move(shader)) {}
    PixelShaderCost probe() const { return (*this)->probe(binding()); }
    void run_uncounted(FragmentBatch const& batch) const
    {
        (*this)->run_uncounted(binding(), batch);
    }
};

template <class Shader> PixelShader bind_pixel_shader(Shader const& shader, Machine const& machine)
{
    return bind_shader<PixelProgramOn, PixelProgram>(shader, machine);
}

} // namespace tessemu
