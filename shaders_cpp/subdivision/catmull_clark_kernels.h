// Catmull-Clark subdivision by tables, one thread a new point: the kernels of LOOP10 section 3, run
// one after the other. What the tables hold: pipeline/mesh/subdivision_tables.h.
//
//     F  = mean of the face's old vertices
//     E  = (a + F + b + F') / 4
//     V' = (n-2)/n V + 1/n^2 (e_0 + F_0 + e_1 + F_1 + ...)      P and Q have the same weights
//     V' = (e + 6 V + e') / 8 where n = 1;  V' = V where n = 0
//
// Sums run in the tables' order, so a point's bits are its own thread's alone. From a mesh's second
// step on all faces are quads, and the edge kernel makes the face points too.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/stencil_form/stencil_row.h"

namespace tessemu {

/// The sum of point(0), ..., point(count - 1).
///
/// \cost  3 (count - 1) add
template <class T, class Point> float3<T> sum_of_points(int_of<T> count, Point const& point)
{
    float3<T> sum = point(0);
    for (int k : loop<T>(longest<T>(count) - 1))
        sum = when(
            int_of<T>(k + 1) < count, [&]() -> float3<T> { return sum + point(k + 1); }, sum);
    return sum;
}

/// F of a face of m sides. \cost 3 mul, 3 (m - 1) add, 1 div
template <class T, class Point> float3<T> face_point(int_of<T> m, Point const& point)
{
    T const weight = T(1) / T(m);
    float3<T> const sum = sum_of_points<T>(m, point);
    return weight * sum;
}

/// E, and F of a quad. \cost 3 mul, 9 add
template <class T, class Point> float3<T> mean_of_four(Point const& point)
{
    float3<T> const p0 = point(0), p1 = point(1), p2 = point(2), p3 = point(3);
    float3<T> const sum = p0 + p1 + p2 + p3;
    return T(0.25) * sum;
}

/// V' of a vertex.
///
/// \param n      faces around, at most 46,340: it is squared in 32 bits; 1: on a curve; 0: it stays
/// \param v      the vertex
/// \param point  (k): of the vertex's row of the table
/// \cost         6 mul, 6 n add, 2 div; n = 1: 6 mul, 6 add; n = 0: none
template <class T, class Point>
float3<T> vertex_point(int_of<T> n, float3<T> const& v, Point const& point)
{
    using Int = int_of<T>;
    float3<T> const stays_or_inner = when(
        Int(1) < n,
        [&]() -> float3<T> {
            T const own = T(n - Int(2)) / T(n), each = T(1) / T(n * n);
            float3<T> const sum = sum_of_points<T>(n + n, point);
            return own * v + each * sum;
        },
        v);
    return when(
        n == Int(1),
        [&]() -> float3<T> {
            float3<T> const e = point(0), f = point(1);
            float3<T> const ends = e + f;
            return T(0.75) * v + T(0.125) * ends;
        },
        stays_or_inner);
}

/// What the kernels share: `count` threads, of which thread i makes point `first_new` + i.
struct NewPoints {
    RWVectorBuffer points; ///< old and new
    std::int32_t first_new = 0, count = 0;

    /// work(i) -> the point of thread i.
    template <class Shader, class T, class Work>
    void for_each(ComputeGroup<T>& group, Work const& work) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const i = linear_thread<Shader>(in);
            when<T>(i < Int(count), [&] {
                float3<T> const p = work(i);
                store3(points, Int(first_new) + i, p);
            });
        });
    }
};

/// Faces of any size. \cost 2 + m index fetches, m vertex fetches
struct FacePointShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    Buffer<std::uint32_t> offset_valence; ///< [face][2]
    Buffer<std::uint32_t> index;
    NewPoints out;

    std::vector<ResourceInfo> resources() const
    {
        return {offset_valence.info(), index.info(), out.points.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        out.for_each<FacePointShader>(group, [&](Int face) {
            Int const first = Int(load<T>(offset_valence, face + face)),
                      sides = Int(load<T>(offset_valence, face + face + Int(1)));
            return face_point<T>(sides, [&](int k) -> float3<T> {
                return load3<T>(out.points, Int(load<T>(index, first + Int(k))));
            });
        });
    }
};

/// Edges; faces of a mesh of quads. \cost 4 index fetches, 4 vertex fetches
struct EdgePointShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    Buffer<std::uint32_t> index; ///< [edge][4]
    NewPoints out;

    std::vector<ResourceInfo> resources() const { return {index.info(), out.points.info()}; }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        out.for_each<EdgePointShader>(group, [&](Int edge) {
            Int const first = edge << Int(2);
            return mean_of_four<T>([&](int k) -> float3<T> {
                return load3<T>(out.points, Int(load<T>(index, first + Int(k))));
            });
        });
    }
};

/// Vertices. \cost 2 + 2n index fetches, 1 + 2n vertex fetches; n = 1: 4 and 3
struct VertexPointShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    Buffer<std::uint32_t> offset_valence; ///< [vertex][2]
    Buffer<std::uint32_t> index;
    std::int32_t from_new_to_old = 0; ///< F + E + V: how far before a new point its old vertex is
    NewPoints out;

    std::vector<ResourceInfo> resources() const
    {
        return {offset_valence.info(), index.info(), out.points.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        out.for_each<VertexPointShader>(group, [&](Int vertex) {
            Int const first = Int(load<T>(offset_valence, vertex + vertex)),
                      n = Int(load<T>(offset_valence, vertex + vertex + Int(1)));
            float3<T> const v = load3<T>(out.points, Int(out.first_new - from_new_to_old) + vertex);
            return vertex_point<T>(n, v, [&](int k) -> float3<T> {
                return load3<T>(out.points, Int(load<T>(index, first + Int(k))));
            });
        });
    }
};

/// Points that blend two rules: sums of weighted points. The same point's plain kernel has run
/// before.
///
/// \cost  3 + 2 k index and weight fetches and k vertex fetches for k terms; 3 k mul, 3 k add
struct BlendedPointShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    Buffer<std::uint32_t> target, first, index;
    Buffer<float> weights;
    RWVectorBuffer points;
    std::int32_t count = 0;

    std::vector<ResourceInfo> resources() const
    {
        return {target.info(), first.info(), index.info(), weights.info(), points.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const row = linear_thread<BlendedPointShader>(in);
            when<T>(row < Int(count), [&] {
                Int const begin = Int(load<T>(first, row)),
                          terms = Int(load<T>(first, row + Int(1))) - begin;
                float3<T> const p = stencil_row<T>(longest<T>(terms), [&](int k) {
                    Int const at = begin + Int(k);
                    return StencilTerm{mask_of<T>(Int(k) < terms),
                                       [=, this]() -> T { return load<T>(weights, at); },
                                       [=, this]() -> float3<T> {
                                           return load3<T>(points, Int(load<T>(index, at)));
                                       }};
                });
                store3(points, Int(load<T>(target, row)), p);
            });
        });
    }
};

} // namespace tessemu
