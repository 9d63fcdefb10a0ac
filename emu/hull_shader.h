// Hull shader stage: control-point phase, fork phase, tess factors.
//
// A hull shader is
//
//     struct S {
//         static constexpr TessellatorDomain kDomain;
//         static constexpr float kMaxTessFactor = ...;   // optional, at most 64
//         template <class T> using Input = ...;          // record: an input control point
//         template <class T> using ControlPoint = ...;   // record: an output control point
//         template <class T> using PatchConstant = ...;  // record: at most 4 scalars, one register
//         int control_points() const;                    // output control points, 0 to 32
//         int patch_constants() const;                   // fork instances, one register each
//         template <class T> ControlPoint<T> control_point(
//             PatchInput, ControlPoints<Input<T>> const&, int_of<T> id) const;
//         template <class T> PatchConstant<T> patch_constant(
//             PatchInput, ControlPoints<Input<T>> const&, ControlPoints<ControlPoint<T>> const&,
//             int_of<T> instance) const;
//         template <class T> std::array<T, 6> tess_factors(
//             PatchInput, ControlPoints<Input<T>> const&, ControlPoints<ControlPoint<T>> const&,
//             ControlPoints<PatchConstant<T>> const&) const;
//     };
//
// The control-point phase runs once per output control point, the fork phase once per instance,
// both with lanes across the ids of one patch; tess_factors is the join phase (rules R45 to R52).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/bound_shader.h"
#include "emu/statistics.h"
#include "emu/tessellator.h"

#include <algorithm>

namespace tessemu {

inline constexpr int kMaxControlPoints = 32;
inline constexpr int kMaxHullOutputScalars = 3968; // R49
inline constexpr int kMaxPatchConstantScalars = 128;

struct PatchInput {
    std::int32_t primitive_id; ///< SV_PrimitiveID: the patch's number in the draw
};

/// A run of patches: where the stage reads and writes.
struct HullBatch {
    std::span<std::uint32_t const> vertices; ///< vertex ids, patch after patch
    float const* shaded_vertices;            ///< the vertex shader's outputs, by id
    int input_control_points;
    std::uint32_t first_primitive;
    std::size_t patches;
    float* control_points;  ///< out: patch after patch
    float* patch_constants; ///< out
    TessFactors* factors;   ///< out
};

class HullProgram : public ShaderProgram {
public:
    virtual TessellatorDomain domain() const = 0;
    virtual int input_floats() const = 0;       ///< of one control point
    virtual int input_fetch_floats() const = 0; ///< of one fetch, see ControlPoints
    /// Output control points, and fork instances with a register each.
    virtual int control_points(ShaderBinding const& binding) const = 0;
    virtual int patch_constants(ShaderBinding const& binding) const = 0;
    virtual int control_point_floats() const = 0; ///< of one output control point
    virtual int control_point_fetch_floats() const = 0;
    virtual int patch_constant_floats() const = 0;
    virtual float max_tess_factor() const = 0; ///< [maxtessfactor], 64 where not declared (R53)
    virtual void run(ShaderBinding const& binding, HullBatch const& batch, StageCounters& counters,
                     StageBuffers const& buffers) const = 0;
};

template <class Shader, class T>
class HullProgramOn final : public CompiledProgram<HullProgram, Shader> {
    static constexpr int N = lanes_of<T>;
    using Input = typename Shader::template Input<T>;
    using Point = typename Shader::template ControlPoint<T>;
    using Constant = typename Shader::template PatchConstant<T>;
    static constexpr std::size_t kIn = scalar_count<Input>(), kOut = scalar_count<Point>(),
                                 kConst = scalar_count<Constant>();
    static_assert(kConst <= 4, "a patch constant is one register of four scalars");

public:
    TessellatorDomain domain() const override { return Shader::kDomain; }
    int input_floats() const override { return int(kIn); }
    int input_fetch_floats() const override { return ControlPoints<Input>::kFetchScalars; }
    int control_point_fetch_floats() const override { return ControlPoints<Point>::kFetchScalars; }
    int control_points(ShaderBinding const& binding) const override
    {
        return binding.as<Shader>().control_points();
    }
    int control_point_floats() const override { return int(kOut); }
    int patch_constants(ShaderBinding const& binding) const override
    {
        return binding.as<Shader>().patch_constants();
    }
    int patch_constant_floats() const override { return int(kConst); }
    float max_tess_factor() const override
    {
        if constexpr (requires { Shader::kMaxTessFactor; }) return Shader::kMaxTessFactor;
        return tessemu::kMaxTessFactor;
    }

    void run(ShaderBinding const& binding, HullBatch const& b, StageCounters& counters,
             StageBuffers const& buffers) const override
    {
        Shader const& shader = binding.as<Shader>();
        StageScope const scope(counters, buffers, binding.sites());
        int const n = b.input_control_points;
        int const points = shader.control_points(), constants = shader.patch_constants();
        std::vector<float> inputs(std::size_t(n) * kIn);
        for (std::size_t p = 0; p < b.patches; ++p) {
            for (std::size_t i = 0; i < std::size_t(n); ++i) {
                std::uint32_t const id = b.vertices[p * std::size_t(n) + i];
                __builtin_memcpy(inputs.data() + i * kIn, b.shaded_vertices + id * kIn,
                                 kIn * sizeof(float));
            }
            float* const out = b.control_points + p * std::size_t(points) * kOut;
            float* const registers = b.patch_constants + p * std::size_t(constants) * kConst;
            PatchInput const patch{std::int32_t(b.first_primitive + p)};
            ControlPoints<Input> const input(inputs.data(), n);
            ControlPoints<Point> const output(out, points);
            ControlPoints<Constant> const forked(registers, constants);

            for_each_id(points, [&](IntLanes<N> id, int first, int active) {
                Point const point = shader.template control_point<T>(patch, input, id);
                scatter(point, out, first, active);
            });
            for_each_id(constants, [&](IntLanes<N> id, int first, int active) {
                Constant const c = shader.template patch_constant<T>(patch, input, output, id);
                scatter(c, registers, first, active);
            });
            begin_group<T>(1);
            std::array<T, 6> const f =
                shader.template tess_factors<T>(patch, input, output, forked);
            for (std::size_t i = 0; i < 6; ++i) b.factors[p][i] = lanes_value(f[i]).raw[0];

            counters.input_fetches += input.fetches();
            counters.input_touched += input.touched();
            counters.output_fetches += output.fetches();
            counters.output_touched += output.touched();
            counters.constant_fetches += forked.fetches();
            counters.constant_touched += forked.touched();
        }
        counters.invocations += b.patches;
    }

private:
    template <class Work> static void for_each_id(int count, Work const& work)
    {
        for (int first = 0; first < count; first += N) {
            int const active = std::min(N, count - first);
            begin_group<T>((1u << active) - 1);
            work(IntLanes<N>::iota() + IntLanes<N>(first), first, active);
        }
    }
    template <class P> static void scatter(P const& record, float* out, int first, int active)
    {
        constexpr std::size_t stride = scalar_count<P>();
        std::size_t k = 0;
        for_each_scalar(record, [&](auto const& s) {
            Lanes<N> const v = lanes_value(s);
            for (int l = 0; l < active; ++l) out[std::size_t(first + l) * stride + k] = v.raw[l];
            ++k;
        });
    }
};

class HullShader : public BoundShader<HullProgram> {
public:
    using BoundShader::BoundShader;
    HullShader(BoundShader<HullProgram> shader) : BoundShader(std::move(shader)) {}
    int control_points() const { return (*this)->control_points(binding()); }
    int patch_constants() const { return (*this)->patch_constants(binding()); }
    /// Of all output control points of a patch, and of all its patch constants.
    int patch_floats() const { return control_points() * (*this)->control_point_floats(); }
    int constant_floats() const { return patch_constants() * (*this)->patch_constant_floats(); }
};

template <class Shader> HullShader bind_hull_shader(Shader const& shader, Machine const& machine)
{
    return bind_shader<HullProgramOn, HullProgram>(shader, machine);
}

} // namespace tessemu
