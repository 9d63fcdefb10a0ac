// Linear blend skinning of the control mesh, the only thing that moves in an animation (LOOP09 4,
// 4.3): in the vertex shader where that is free, in a compute shader where it is not.
//
//     v' = sum over i of w_i M_(b_i) v,   up to four bones a vertex
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "emu/vertex_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// Bones and weights of the vertices, and the pose.
struct SkinBuffers {
    static constexpr int kBoneFloats = 12;
    Buffer<std::uint32_t> vertices; ///< [vertex][2]: four bone numbers; four weights in 1/255
    Buffer<float> bones;            ///< [bone][3][4]: rows of the matrices

    /// \cost  13 mul and 12 fetches of bones for each weight that is not 0
    template <class T> float3<T> posed(int_of<T> vertex, float3<T> const& rest) const
    {
        return blended<T>(vertex, rest, true);
    }
    /// A direction: turned, not moved. \cost 13 mul and 9 fetches of bones for each weight
    template <class T> float3<T> turned(int_of<T> vertex, float3<T> const& rest) const
    {
        return blended<T>(vertex, rest, false);
    }

private:
    template <class T>
    float3<T> blended(int_of<T> vertex, float3<T> const& rest, bool is_point) const
    {
        using Int = int_of<T>;
        Routine<T> const here("posed");
        Int const numbers = Int(load<T>(vertices, Int(vertex << Int(1))));
        Int const weights = Int(load<T>(vertices, Int((vertex << Int(1)) + Int(1))));
        float3<T> sum(T(0), T(0), T(0));
        for (int i : loop<T>(4)) {
            Int const weight = (weights >> Int(8 * i)) & Int(255);
            Int const row = ((numbers >> Int(8 * i)) & Int(255)) * Int(kBoneFloats);
            sum = when(
                weight != Int(0),
                [&] {
                    auto const m = [&](int k) -> T { return load<T>(bones, row + Int(k)); };
                    auto const along = [&](int r) -> T {
                        T const x = m(4 * r), y = m(4 * r + 1), z = m(4 * r + 2);
                        if (!is_point) return x * rest.x + y * rest.y + z * rest.z;
                        return x * rest.x + y * rest.y + z * rest.z + m(4 * r + 3);
                    };
                    T const w = T(1.0 / 255) * T(weight);
                    float3<T> const moved{along(0), along(1), along(2)}; // in this order
                    return float3<T>(sum + w * moved);
                },
                sum);
        }
        return sum;
    }
};

struct SkinningVertexShader {
    template <class T> using Input = ControlVertex<T>;
    template <class T> using Output = ControlVertex<T>;
    SkinBuffers skin;

    std::vector<ResourceInfo> resources() const
    {
        return {skin.vertices.info(), skin.bones.info()};
    }
    template <class T>
    ControlVertex<T> operator()(VertexInput<T> const& in, ControlVertex<T> const& vertex) const
    {
        return {skin.posed<T>(in.vertex_id, vertex.position)};
    }
};

/// One thread a vertex, for shaders that read their neighbours from memory.
struct SkinningComputeShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    SkinBuffers skin;
    Buffer<float> rest;    ///< [vertex][3]
    RWBuffer<float> moved; ///< [vertex][stride]
    int stride = 4;
    std::array<float, 3> origin{}; ///< of what is written

    std::vector<ResourceInfo> resources() const
    {
        return {skin.vertices.info(), skin.bones.info(), rest.info(), moved.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const vertex = linear_thread<SkinningComputeShader>(in);
            Int const three = vertex * Int(3);
            float3<T> const p(load<T>(rest, three), load<T>(rest, three + Int(1)),
                              load<T>(rest, three + Int(2)));
            float3<T> posed = skin.posed<T>(vertex, p);
            if (origin != std::array<float, 3>{})
                posed = posed - float3<T>(T(origin[0]), T(origin[1]), T(origin[2]));
            Int const out = vertex * Int(stride);
            store(moved, out, posed.x);
            store(moved, out + Int(1), posed.y);
            store(moved, out + Int(2), posed.z);
        });
    }
};

} // namespace tessemu
