// Points with their normals, both sums over a mesh's vertices: limit points, or those that a step of
// subdivision makes with normals by gradient masks in the same pass (HOLL10 2B).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// One thread a point: a mask of its position, and of two tangents.
struct GradientPointsShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    static constexpr int kFloats = 6; ///< position and unit normal

    Buffer<std::uint32_t> first;    ///< [point + 1]: where its terms begin
    Buffer<std::uint32_t> vertices; ///< of each term
    Buffer<float> weights;          ///< [term][3]: of the position and of both tangents
    Buffer<float> positions;        ///< [vertex][stride]
    RWBuffer<float> points;         ///< out: [point][kFloats]
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        return {first.info(), vertices.info(), weights.info(), positions.info(), points.info()};
    }

    /// \cost  9 mul, 9 add a term; 12 mul, 5 add, 1 div, 1 sqrt
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const point = linear_thread<GradientPointsShader>(in);
            Int const begin = Int(load<T>(first, point)),
                      count = Int(load<T>(first, point + Int(1))) - begin;
            V sums[3];
            for (V& s : sums) s = V(T(0), T(0), T(0));
            for (int k : loop<T>(longest<T>(count))) {
                mask_of<T> const here = Int(k) < count;
                Int const term = begin + Int(k);
                V const p = when(
                    here,
                    [&]() -> V {
                        Int const v = Int(load<T>(vertices, term)) * Int(stride);
                        return {load<T>(positions, v), load<T>(positions, v + Int(1)),
                                load<T>(positions, v + Int(2))};
                    },
                    sums[0]);
                for (int i = 0; i < 3; ++i)
                    sums[i] = when(
                        here,
                        [&]() -> V {
                            return sums[i] + load<T>(weights, term * Int(3) + Int(i)) * p;
                        },
                        sums[i]);
            }
            V const n = unit_or(V(cross(sums[1], sums[2])), [] { return V(T(0), T(0), T(1)); });
            Int at = point * Int(kFloats);
            for (V const& p : {sums[0], n})
                for (T const& c : {p.x, p.y, p.z}) {
                    store(points, at, c);
                    at = at + Int(1);
                }
        });
    }
};

} // namespace tessemu
