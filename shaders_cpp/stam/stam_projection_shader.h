// Nets projected to eigen space by a dispatch: where a patch has more points than a hull shader
// takes, and where two patches need each other's (docs/stam.md).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/stencil_form/stencil_row.h"

namespace tessemu {

/// Patches of one valence, one thread a row of V^-1; a patch begins a group.
struct StamProjectionShader {
    static constexpr std::array<int, 3> kThreads{32, 1, 1};

    Buffer<float> inverse;      ///< V^-1, [point][function]
    Buffer<std::uint32_t> nets; ///< [patch][point]: vertices
    Buffer<float> positions;    ///< [vertex][stride]
    RWBuffer<float> projected;  ///< out: [patch][function][3]
    int functions = 0;          ///< 2n + 8
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        return {inverse.info(), nets.info(), positions.info(), projected.info()};
    }
    static std::uint64_t threads(std::uint64_t patches, int functions)
    {
        return patches * std::uint64_t(groups_a_patch(functions)) * std::uint64_t(kThreads[0]);
    }

    /// \cost  6n + 24 mul a thread
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            std::int32_t const number = in.group_id.x + in.group_id.y * std::int32_t(kMaxDispatch);
            std::int32_t const patch = number / groups_a_patch(functions),
                               part = number % groups_a_patch(functions);
            Int const function = in.group_thread_id.x + Int(part * kThreads[0]);
            mask_of<T> const here = function < Int(functions);
            when<T>(here, [&] {
                float3<T> const sum = stencil_row<T>(functions, [&](int k) {
                    return StencilTerm{here,
                                       [=, this]() -> T {
                                           return load<T>(inverse, Int(k * functions) + function);
                                       },
                                       [=, this]() -> float3<T> {
                                           std::int32_t const v =
                                               load<T>(nets, patch * functions + k) *
                                               std::int32_t(stride);
                                           return {load<T>(positions, v), load<T>(positions, v + 1),
                                                   load<T>(positions, v + 2)};
                                       }};
                });
                Int const out = (Int(patch * functions) + function) * Int(3);
                store(projected, out, sum.x);
                store(projected, out + Int(1), sum.y);
                store(projected, out + Int(2), sum.z);
            });
        });
    }

private:
    static constexpr int groups_a_patch(int functions)
    {
        return (functions + kThreads[0] - 1) / kThreads[0];
    }
};

} // namespace tessemu
