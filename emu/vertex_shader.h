// Vertex shader stage: one invocation per vertex that the post-transform cache does not hold.
//
// A vertex shader is
//
//     struct S {
//         template <class T> using Input = ...;   // record, as the vertex buffer holds it
//         template <class T> using Output = ...;  // record; without a hull or geometry shader its
//                                                 // first member is float4<T> position
//         template <class T> Output<T> operator()(VertexInput<T>, Input<T> const&) const;
//     };
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/bound_shader.h"
#include "emu/input_assembler.h"
#include "emu/statistics.h"

#include <algorithm>

namespace tessemu {

template <class T> struct VertexInput {
    int_of<T> vertex_id; ///< SV_VertexID: the index, or the number in a draw without indices (R34)
    std::int32_t instance_id = 0; ///< SV_InstanceID, from 0 in every draw
};

/// Vertices of one instance to run.
struct VertexBatch {
    std::span<std::uint32_t const> ids; ///< where outputs go
    DrawCall const& call;
    AssembledPrimitives const& primitives; ///< tells the index of an id
    std::uint32_t instance;
};

class VertexProgram : public ShaderProgram {
public:
    virtual int input_floats() const = 0;
    int output_floats() const { return output().floats; }
    virtual OutputLayout output() const = 0;
    /// Runs a batch, writing `outputs[id * output_floats]`. Without `outputs` the runs are counted
    /// and their results dropped.
    virtual void run(ShaderBinding const& binding, VertexBatch const& batch, float* outputs,
                     StageCounters& counters, StageBuffers const& buffers) const = 0;
};

template <class Shader, class T>
class VertexProgramOn final : public CompiledProgram<VertexProgram, Shader> {
    static constexpr int N = lanes_of<T>;
    using Input = typename Shader::template Input<T>;
    using Output = typename Shader::template Output<T>;

public:
    int input_floats() const override { return scalar_count<Input>(); }
    OutputLayout output() const override
    {
        return output_layout<typename Shader::template Output<float>>();
    }

    void run(ShaderBinding const& binding, VertexBatch const& batch, float* outputs,
             StageCounters& counters, StageBuffers const& buffers) const override
    {
        Shader const& shader = binding.as<Shader>();
        std::span<std::uint32_t const> const ids = batch.ids;
        StageScope const scope(counters, buffers, binding.sites());
        constexpr std::size_t in = scalar_count<Input>(), out = scalar_count<Output>();
        for (std::size_t first = 0; first < ids.size(); first += N) {
            int const active = int(std::min<std::size_t>(N, ids.size() - first));
            begin_group<T>((1u << active) - 1);
            IntLanes<N> id(0), index(0);
            float fetched[N][in + 1] = {};
            for (int l = 0; l < active; ++l) {
                std::uint32_t const v = ids[first + std::size_t(l)];
                id.raw[l] = std::int32_t(v);
                index.raw[l] = std::int32_t(batch.primitives.index(v));
                fetch_vertex(batch.call, batch.primitives.index(v), batch.instance, fetched[l]);
            }
            Input input{};
            std::size_t k = 0;
            for_each_scalar(input, [&](auto& s) {
                Lanes<N> v(0.0f);
                for (int l = 0; l < active; ++l) v.raw[l] = fetched[l][k];
                s = T(v);
                ++k;
            });
            Output const output =
                shader(VertexInput<T>{index, std::int32_t(batch.instance)}, input);
            if (!outputs) continue;
            k = 0;
            for_each_scalar(output, [&](auto const& s) {
                Lanes<N> const v = lanes_value(s);
                for (int l = 0; l < active; ++l)
                    outputs[std::uint32_t(id.raw[l]) * out + k] = v.raw[l];
                ++k;
            });
        }
        counters.invocations += ids.size();
        counters.input_fetches += ids.size();
    }
};

using VertexShader = BoundShader<VertexProgram>;

template <class Shader>
VertexShader bind_vertex_shader(Shader const& shader, Machine const& machine)
{
    return bind_shader<VertexProgramOn, VertexProgram>(shader, machine);
}

} // namespace tessemu
