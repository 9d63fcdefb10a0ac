// Pixel shader stage: one invocation per fragment that passes the early depth test, lanes across
// fragments in submission order.
//
// A pixel shader is
//
//     struct S {
//         template <class T> using Input = ...;  // record: the first attributes after SV_Position
//         that
//                                                // the stage before wrote
//         template <class T> float4<T> operator()(PixelInput<T> const&, Input<T> const&) const;
//     };
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/machine.h"
#include "emu/statistics.h"

namespace tessemu {

template <class T> struct PixelInput {
    float4<T> position;     ///< SV_Position: pixel centre, depth, w (R121)
    int_of<T> primitive_id; ///< SV_PrimitiveID
    mask_of<T> front_face;  ///< SV_IsFrontFace
};

/// Fragments of one tile, arrays per component.
struct FragmentBatch {
    std::size_t count;
    float const* position[4];
    float const* const* attributes; ///< component k at attributes[k]
    std::int32_t const* primitive_id;
    std::int32_t const* front_face; ///< 0 or -1
    float* color[4];                ///< out; whole groups are written
};

class PixelProgram {
public:
    virtual ~PixelProgram() = default;
    virtual int input_floats() const = 0;
    virtual std::vector<ResourceInfo> resources() const = 0;
    virtual void run(FragmentBatch const& batch, StageCounters& counters,
                     StageBuffers const& buffers) const = 0;
};

template <class Shader, class T> class PixelProgramOn final : public PixelProgram {
    static constexpr int N = lanes_of<T>;
    using Input = typename Shader::template Input<T>;

public:
    PixelProgramOn(Shader const& shader, std::uint64_t seed) : shader_(shader), seed_(seed) {}
    int input_floats() const override { return scalar_count<Input>(); }
    std::vector<ResourceInfo> resources() const override { return resources_of(shader_); }

    void run(FragmentBatch const& b, StageCounters& counters,
             StageBuffers const& buffers) const override
    {
        StageScope const scope(counters, buffers, seed_);
        for (std::size_t first = 0; first < b.count; first += N) {
            std::size_t const left = b.count - first;
            execution.activate(left >= std::size_t(N) ? (1u << N) - 1 : (1u << left) - 1);
            site_state.scope = site_state.next = 0;
            auto const lanes = [&](float const* p) { return T(Lanes<N>::load(p + first)); };
            PixelInput<T> pixel;
            pixel.position = {lanes(b.position[0]), lanes(b.position[1]), lanes(b.position[2]),
                              lanes(b.position[3])};
            __builtin_memcpy(&pixel.primitive_id.raw, b.primitive_id + first, 4 * N);
            __builtin_memcpy(&pixel.front_face.raw, b.front_face + first, 4 * N);
            Input input{};
            int k = 0;
            for_each_scalar(input, [&](auto& s) { s = lanes(b.attributes[k++]); });
            float4<T> const color = shader_(pixel, input);
            k = 0;
            for_each_scalar(color,
                            [&](auto const& s) { lanes_value(s).store(b.color[k++] + first); });
        }
        counters.invocations += b.count;
    }

private:
    Shader shader_;
    std::uint64_t seed_;
};

template <class Shader>
std::unique_ptr<PixelProgram> make_pixel_program(Shader const& shader, Machine const& machine)
{
    return make_program<PixelProgramOn, PixelProgram>(shader, machine);
}

} // namespace tessemu
