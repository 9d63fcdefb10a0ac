// Vertex shader stage: one invocation per vertex that the post-transform cache does not hold.
//
// A vertex shader is
//
//     struct S {
//         template <class T> using Input = ...;   // record, as the vertex buffer holds it
//         template <class T> using Output = ...;  // record; without a hull shader its first member
//         is
//                                                 // float4<T> position (SV_Position)
//         template <class T> Output<T> operator()(VertexInput<T>, Input<T> const&) const;
//     };
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/machine.h"
#include "emu/statistics.h"

#include <algorithm>

namespace tessemu {

template <class T> struct VertexInput {
    int_of<T> vertex_id; ///< SV_VertexID (R34)
};

class VertexProgram {
public:
    virtual ~VertexProgram() = default;
    virtual int input_floats() const = 0;
    virtual int output_floats() const = 0;
    virtual std::vector<ResourceInfo> resources() const = 0;
    /// Runs `ids`, reading `vertices[id * input_floats]` (zeros past the end, R35), writing
    /// `outputs[id * output_floats]`. Without `outputs` the runs are counted and their results
    /// dropped.
    virtual void run(std::span<std::uint32_t const> ids, std::span<float const> vertices,
                     float* outputs, StageCounters& counters,
                     StageBuffers const& buffers) const = 0;
};

template <class Shader, class T> class VertexProgramOn final : public VertexProgram {
    static constexpr int N = lanes_of<T>;
    using Input = typename Shader::template Input<T>;
    using Output = typename Shader::template Output<T>;

public:
    VertexProgramOn(Shader const& shader, std::uint64_t seed) : shader_(shader), seed_(seed) {}
    int input_floats() const override { return scalar_count<Input>(); }
    int output_floats() const override { return scalar_count<Output>(); }
    std::vector<ResourceInfo> resources() const override { return resources_of(shader_); }

    void run(std::span<std::uint32_t const> ids, std::span<float const> vertices, float* outputs,
             StageCounters& counters, StageBuffers const& buffers) const override
    {
        StageScope const scope(counters, buffers, seed_);
        constexpr std::size_t in = scalar_count<Input>(), out = scalar_count<Output>();
        for (std::size_t first = 0; first < ids.size(); first += N) {
            int const active = int(std::min<std::size_t>(N, ids.size() - first));
            execution.activate((1u << active) - 1);
            IntLanes<N> id(0);
            for (int l = 0; l < active; ++l) id.raw[l] = std::int32_t(ids[first + std::size_t(l)]);
            Input input{};
            std::size_t k = 0;
            for_each_scalar(input, [&](auto& s) {
                Lanes<N> v(0.0f);
                for (int l = 0; l < active; ++l) {
                    std::size_t const at = std::uint32_t(id.raw[l]) * in + k;
                    if (at < vertices.size()) v.raw[l] = vertices[at];
                }
                s = T(v);
                ++k;
            });
            site_state.scope = site_state.next = 0;
            Output const output = shader_(VertexInput<T>{id}, input);
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

private:
    Shader shader_;
    std::uint64_t seed_;
};

template <class Shader>
std::unique_ptr<VertexProgram> make_vertex_program(Shader const& shader, Machine const& machine)
{
    return make_program<VertexProgramOn, VertexProgram>(shader, machine);
}

} // namespace tessemu
