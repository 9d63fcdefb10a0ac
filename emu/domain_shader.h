// Domain shader stage: one invocation per domain point, lanes across the points of one patch.
//
// A domain shader is
//
//     struct S {
//         static constexpr TessellatorDomain kDomain;
//         static constexpr int kControlPoints;           // optional: how many the hull shader puts
//                                                        // out; otherwise any number
//         template <class T> using ControlPoint = ...;   // the hull shader's records
//         template <class T> using PatchConstant = ...;
//         template <class T> using Output = ...;         // record; first member float4<T> position
//         template <class T> Output<T> operator()(
//             DomainInput<T> const&, ControlPoints<ControlPoint<T>> const&,
//             ControlPoints<PatchConstant<T>> const&) const;
//     };
//
// One that reads the tess factors takes them as a fourth argument, TessFactorInput<T> const&.
// One whose Output has no position yet is finished by an epilog: the end of the shader, compiled
// apart from it (as drivers do), so that a surface compiled once serves every kind of vertex:
//
//     struct E {
//         template <class T> using Input = ...;          // record; the domain shader's Output
//         template <class T> using Output = ...;         // record; first member float4<T> position
//         template <class T> Output<T> operator()(DomainInput<T> const&, Input<T> const&) const;
//     };
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/bound_shader.h"
#include "emu/statistics.h"
#include "emu/tessellator.h"

#include <algorithm>
#include <type_traits>

namespace tessemu {

/// SV_DomainLocation and SV_PrimitiveID. Each of u, v is a multiple of 2^-16 in [0,1]; w = 1-u-v is
/// given on a tri (exact), 0 elsewhere.
template <class T> struct DomainInput {
    T u, v, w;
    std::int32_t primitive_id = 0;
};

/// A tess factor as an input of the domain shader.
template <class T> struct TessFactor {
    T value;
    static constexpr auto signature() { return std::tuple{&TessFactor::value}; }
};
/// SV_TessFactor, then SV_InsideTessFactor, as many as the domain has, in the order of TessFactors:
/// what the hull shader wrote, neither clamped nor rounded, but for a maximum that it declares
/// (I-28). Each [] is a counted fetch.
template <class T> using TessFactorInput = ControlPoints<TessFactor<T>>;

class DomainEpilogProgram;
using DomainEpilog = BoundShader<DomainEpilogProgram>;

struct DomainBatch {
    float const* control_points;
    int control_point_count; ///< that the hull shader wrote
    float const* patch_constants;
    int patch_constant_count;
    std::int32_t primitive_id;
    float const* u; ///< padded to a whole group of lanes
    float const* v;
    std::size_t points;
    float* outputs; ///< out: component k of point i at [k * stride + i], whole groups are written
    std::size_t stride;
    DomainEpilog const* epilog = nullptr;      ///< turns the outputs into others in place
    TessFactors const* tess_factors = nullptr; ///< null where the shader reads none
};

/// The end of a domain shader.
class DomainEpilogProgram : public ShaderProgram {
public:
    virtual int input_floats() const = 0;
    virtual OutputLayout output() const = 0;
    /// Points `first` to `first + count - 1` of a batch; `first` is a multiple of the lanes.
    virtual void run(ShaderBinding const& binding, DomainBatch const& batch, std::size_t first,
                     std::size_t count) const = 0;
};

class DomainProgram : public ShaderProgram {
public:
    virtual TessellatorDomain domain() const = 0;
    /// That the shader type declares; 0: as many as the draw's hull shader puts out.
    virtual int control_points() const = 0;
    virtual int control_point_floats() const = 0;
    virtual int patch_constant_floats() const = 0;
    virtual bool reads_tess_factors() const { return false; }
    virtual OutputLayout output() const = 0;
    int output_floats() const { return output().floats; }
    /// Runs a patch, inside a StageScope that the caller holds open over many patches.
    virtual void run(ShaderBinding const& binding, DomainBatch const& batch,
                     StageCounters& counters) const = 0;
};

namespace detail {
/// `left` points are yet to run.
template <class T> void begin_domain_group(std::size_t left)
{
    constexpr std::size_t N = lanes_of<T>;
    begin_group<T>(left >= N ? (1u << N) - 1 : (1u << left) - 1);
}
template <class T, TessellatorDomain kDomain>
DomainInput<T> domain_input(DomainBatch const& b, std::size_t first)
{
    constexpr int N = lanes_of<T>;
    Lanes<N> const u = Lanes<N>::load(b.u + first), v = Lanes<N>::load(b.v + first);
    Lanes<N> w(0.0f);
    if constexpr (kDomain == TessellatorDomain::Tri) w = Lanes<N>(1.0f) - u - v;
    return {T(u), T(v), T(w), b.primitive_id};
}
} // namespace detail

template <class Shader, class T>
class DomainProgramOn final : public CompiledProgram<DomainProgram, Shader> {
    static constexpr int N = lanes_of<T>;
    using Point = typename Shader::template ControlPoint<T>;
    using Constant = typename Shader::template PatchConstant<T>;
    using Output = typename Shader::template Output<T>;
    using Factors = TessFactorInput<T>;
    static constexpr bool kReadsFactors =
        std::is_invocable_v<Shader const&, DomainInput<T> const&, ControlPoints<Point> const&,
                            ControlPoints<Constant> const&, Factors const&>;
    static constexpr std::size_t kBlock = 256; // points that an epilog finds in the nearest cache

public:
    TessellatorDomain domain() const override { return Shader::kDomain; }
    int control_points() const override
    {
        if constexpr (requires { Shader::kControlPoints; }) return Shader::kControlPoints;
        return 0;
    }
    int control_point_floats() const override { return scalar_count<Point>(); }
    int patch_constant_floats() const override { return scalar_count<Constant>(); }
    bool reads_tess_factors() const override { return kReadsFactors; }
    OutputLayout output() const override
    {
        return output_layout<typename Shader::template Output<float>>();
    }

    void run(ShaderBinding const& binding, DomainBatch const& b,
             StageCounters& counters) const override
    {
        if constexpr (ScalarTraits<T>::kSites)
            run_points(binding.as<Shader>(), b, counters);
        else
            run_flattened(binding.as<Shader>(), b, counters);
    }

private:
    // Only where shader and views are one function do the counts fold to a few additions. With a
    // sanitizer's checks in it that function would take minutes to compile.
#if !defined(__SANITIZE_ADDRESS__)
    [[gnu::flatten]]
#endif
    void
    run_flattened(Shader const& shader, DomainBatch const& b, StageCounters& counters) const
    {
        run_points(shader, b, counters);
    }

    void run_points(Shader const& shader, DomainBatch const& b, StageCounters& counters) const
    {
        ControlPoints<Point> const points(b.control_points, b.control_point_count);
        ControlPoints<Constant> const constants(b.patch_constants, b.patch_constant_count);
        Factors const factors(kReadsFactors ? b.tess_factors->data() : nullptr,
                              tess_factor_count(Shader::kDomain));
        auto const shade = [&](DomainInput<T> const& in) -> Output {
            if constexpr (kReadsFactors)
                return shader(in, points, constants, factors);
            else
                return shader(in, points, constants);
        };
        for (std::size_t block = 0; block < b.points; block += kBlock) {
            std::size_t const end = std::min(block + kBlock, b.points);
            for (std::size_t first = block; first < end; first += N) {
                detail::begin_domain_group<T>(end - first);
                Output const out = shade(detail::domain_input<T, Shader::kDomain>(b, first));
                float* at = b.outputs + first;
                for_each_scalar(out, [&](auto const& s) {
                    lanes_value(s).store(at);
                    at += b.stride;
                });
            }
            if (b.epilog) b.epilog->run(b, block, end - block);
        }
        counters.invocations += b.points;
        counters.input_fetches += points.fetches();
        counters.input_touched += points.touched();
        counters.constant_fetches += constants.fetches();
        counters.constant_touched += constants.touched();
        if constexpr (kReadsFactors) {
            counters.factor_fetches += factors.fetches();
            counters.factor_touched += factors.touched();
        }
    }
};

using DomainShader = BoundShader<DomainProgram>;

template <class Shader>
DomainShader bind_domain_shader(Shader const& shader, Machine const& machine)
{
    return bind_shader<DomainProgramOn, DomainProgram>(shader, machine);
}

template <class Shader, class T>
class DomainEpilogProgramOn final : public CompiledProgram<DomainEpilogProgram, Shader> {
    static constexpr std::size_t N = lanes_of<T>;
    using Input = typename Shader::template Input<T>;
    using Output = typename Shader::template Output<T>;

public:
    int input_floats() const override { return scalar_count<Input>(); }
    OutputLayout output() const override
    {
        return output_layout<typename Shader::template Output<float>>();
    }

    void run(ShaderBinding const& binding, DomainBatch const& b, std::size_t begin,
             std::size_t count) const override
    {
        Shader const& shader = binding.as<Shader>();
        for (std::size_t first = begin; first < begin + count; first += N) {
            detail::begin_domain_group<T>(begin + count - first);
            float* at = b.outputs + first;
            Input input{};
            for_each_scalar(input, [&](auto& s) {
                s = T(Lanes<int(N)>::load(at));
                at += b.stride;
            });
            at = b.outputs + first;
            // An epilog knows of u and v; w is the domain's own affair.
            Output const out =
                shader(detail::domain_input<T, TessellatorDomain::Quad>(b, first), input);
            for_each_scalar(out, [&](auto const& s) {
                lanes_value(s).store(at);
                at += b.stride;
            });
        }
    }
};

template <class Shader>
DomainEpilog bind_domain_epilog(Shader const& shader, Machine const& machine)
{
    return bind_shader<DomainEpilogProgramOn, DomainEpilogProgram>(shader, machine);
}

} // namespace tessemu
