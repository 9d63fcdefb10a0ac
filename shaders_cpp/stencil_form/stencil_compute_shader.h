// Stencils of any length summed by a dispatch, one thread a row: for patches with more inputs than
// a patch of Direct3D 11 may have.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/stencil_form/stencil_row.h"

namespace tessemu {

/// The weights are those of the hull shader's tables without the zeros, the vertices of a row
/// ascend: the same sum as SummedRows makes of the same row, to the bit.
struct StencilComputeShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};

    Buffer<std::uint32_t> first;    ///< [row + 1]: where its terms begin
    Buffer<std::uint32_t> vertices; ///< of each term
    Buffer<float> weights;          ///< of each term
    Buffer<float> positions;        ///< [vertex][stride]
    RWBuffer<float> sums;           ///< out: [row][3]
    int stride = 3;
    int rows = 0;

    std::vector<ResourceInfo> resources() const
    {
        return {first.info(), vertices.info(), weights.info(), positions.info(), sums.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const row = linear_thread<StencilComputeShader>(in);
            mask_of<T> const here = row < Int(rows);
            when<T>(here, [&] {
                Int const begin = Int(load<T>(first, row)),
                          terms = Int(load<T>(first, row + Int(1))) - begin;
                float3<T> const sum = stencil_row<T>(longest<T>(terms), [&](int k) {
                    Int const at = begin + Int(k);
                    return StencilTerm{mask_of<T>(Int(k) < terms),
                                       [=, this]() -> T { return load<T>(weights, at); },
                                       [=, this]() -> float3<T> {
                                           Int const v = Int(load<T>(vertices, at)) * Int(stride);
                                           return {load<T>(positions, v),
                                                   load<T>(positions, v + Int(1)),
                                                   load<T>(positions, v + Int(2))};
                                       }};
                });
                Int const out = row * Int(3);
                store(sums, out, sum.x);
                store(sums, out + Int(1), sum.y);
                store(sums, out + Int(2), sum.z);
            });
        });
    }
};

} // namespace tessemu
