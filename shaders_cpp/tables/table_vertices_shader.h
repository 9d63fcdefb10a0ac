// Vertices that table-driven patches sum over: positions with the normals of their faces (HOLL10
// 2B, the pass behind the initial step of subdivision).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// One thread a vertex: its position, and the mean normal of the faces around, each by the area of
/// the triangle at the vertex:
///
///     n = sum (e_j - v) x (e_j+1 - v), a closed fan from its last edge round to the first
struct TableVerticesShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    static constexpr int kFloats = 6; ///< position and unit normal

    /// [vertex][3]: of the mesh; where its ring begins; the ring's vertices, twice, and one more
    /// where the fan is open
    Buffer<std::uint32_t> entries;
    Buffer<std::uint32_t> rings; ///< vertices of the mesh, counter-clockwise
    Buffer<float> positions;     ///< [vertex of the mesh][stride]
    RWBuffer<float> vertices;    ///< out: [vertex][kFloats]
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        return {entries.info(), rings.info(), positions.info(), vertices.info()};
    }

    /// \cost  6 mul, 8 add for each of the ring's vertices; 6 mul, 2 add, 1 div, 1 sqrt
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const vertex = linear_thread<TableVerticesShader>(in);
            Int const entry = vertex * Int(3);
            auto const position = [&](Int of) -> V {
                Int const at = of * Int(stride);
                return {load<T>(positions, at), load<T>(positions, at + Int(1)),
                        load<T>(positions, at + Int(2))};
            };
            V const v = position(Int(load<T>(entries, entry)));
            Int const ring = Int(load<T>(entries, entry + Int(1))),
                      word = Int(load<T>(entries, entry + Int(2)));
            Int const count = word >> Int(1), open = word & Int(1);
            auto const spoke = [&](Int j) -> V {
                return position(Int(load<T>(rings, ring + j))) - v;
            };
            // The one before the first: of an open fan the first itself, which adds nothing.
            V last = spoke((count - Int(1)) * (Int(1) - open));
            V area(T(0), T(0), T(0));
            for (int j : loop<T>(longest<T>(count))) {
                mask_of<T> const here = Int(j) < count;
                V const next = when(
                    here, [&]() -> V { return spoke(Int(j)); }, last);
                area = when(
                    here, [&]() -> V { return area + cross(last, next); }, area);
                last = next;
            }
            V const n = unit_or(area, [] { return V(T(0), T(0), T(1)); });
            Int at = vertex * Int(kFloats);
            for (V const& p : {v, n})
                for (T const& c : {p.x, p.y, p.z}) {
                    store(vertices, at, c);
                    at = at + Int(1);
                }
        });
    }
};

} // namespace tessemu
