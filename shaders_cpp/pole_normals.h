// Normals where a surface has none of its own: at a pole, a vertex whose tangents are parallel or
// zero, as where many vertices of a sphere's mesh lie on one point, or a corner's two edges in a
// line.
//
// The normal there is the mean of the faces around the pole, each by its area: the same from all
// patches, in a pose too. A dispatch makes it before the draws; hull shaders hand it on instead of
// the vertex's own. An edge whose two ends are one pole is collapsed: its transversal field is zero,
// and so are the cross products along it, where domain shaders take the nearer corner's normal.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// One thread a pole. The direction of no area at all is z.
struct PoleNormalShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    /// Of a pole: the unit normal, and two unit vectors whose cross product it is.
    static constexpr int kNormal = 0, kTangents = 1, kVectors = 3;

    Buffer<std::uint32_t> first; ///< [pole + 1]: where its faces begin
    Buffer<std::uint32_t>
        faces;               ///< [face][4]: x_0 to x_3, (x_2 - x_0) x (x_3 - x_1) twice its area
    Buffer<float> positions; ///< [vertex][stride]
    RWBuffer<float> normals; ///< out: [pole][kVectors][3]
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        return {first.info(), faces.info(), positions.info(), normals.info()};
    }

    /// \cost  a pole: 6 mul, 9 add a face; 30 mul, 2 div, 2 sqrt
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const pole = linear_thread<PoleNormalShader>(in);
            Int const begin = Int(load<T>(first, pole)),
                      count = Int(load<T>(first, pole + Int(1))) - begin;
            V const zero(T(0), T(0), T(0)), x(T(1), T(0), T(0)), y(T(0), T(1), T(0)),
                z(T(0), T(0), T(1));
            V area = zero;
            for (int k : loop<T>(longest<T>(count)))
                area = when(
                    Int(k) < count,
                    [&]() -> V {
                        auto const corner = [&](int i) -> V {
                            Int const at = ((begin + Int(k)) << Int(2)) + Int(i);
                            Int const v = Int(load<T>(faces, at)) * Int(stride);
                            return {load<T>(positions, v), load<T>(positions, v + Int(1)),
                                    load<T>(positions, v + Int(2))};
                        };
                        V const x0 = corner(0), x1 = corner(1), x2 = corner(2), x3 = corner(3);
                        return area + cross(V(x2 - x0), V(x3 - x1));
                    },
                    area);
            V const n = unit_or(area, [&] { return z; });
            // Across the axis that n is least along.
            T const ax = abs(n.x), ay = abs(n.y), az = abs(n.z);
            V const axis = select_record((ax <= ay) & (ax <= az), x, select_record(ay <= az, y, z));
            V const a = unit_or(V(cross(axis, n)), [&] { return x; });
            V const b = cross(n, a);
            Int const out = pole * Int(3 * kVectors);
            int i = 0;
            for (V const& v : {n, a, b})
                for (T const& c : {v.x, v.y, v.z}) store(normals, out + Int(i++), c);
        });
    }
};

/// What a hull shader reads of poles.
struct PoleNormals {
    Buffer<float> normals; ///< of PoleNormalShader

    /// \param which  PoleNormalShader::kNormal, or one of the two tangents
    template <class T> [[gnu::noinline]] float3<T> vector(int_of<T> pole, int_of<T> which) const
    {
        using Int = int_of<T>;
        Int const at = (pole * Int(PoleNormalShader::kVectors) + which) * Int(3);
        return {load<T>(normals, at), load<T>(normals, at + Int(1)), load<T>(normals, at + Int(2))};
    }
    /// Among a shader's resources, where a mesh has poles.
    void add_to(std::vector<ResourceInfo>& resources) const
    {
        if (normals.info().elements) resources.push_back(normals.info());
    }
};

} // namespace tessemu
