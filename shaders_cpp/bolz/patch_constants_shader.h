// What a patch's draws need of the mesh, made by dispatches before them: its control points as
// constants, and the normals at the corners, where derivatives say nothing.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/pole_normals.h"

namespace tessemu {

/// Control points as constants, one thread each: what the CPU sends in the paper.
struct PatchConstantsShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    static constexpr std::uint32_t kNone = 0xffffffffu;

    Buffer<std::uint32_t> vertices; ///< [control point]: of the mesh, or kNone: 0
    Buffer<float> positions;        ///< [vertex][stride]
    RWBuffer<float> constants;      ///< out: [control point][4]: x, y, z, 0
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        return {vertices.info(), positions.info(), constants.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const i = linear_thread<PatchConstantsShader>(in);
            Int const vertex = Int(load<T>(vertices, i));
            float3<T> const zero(T(0), T(0), T(0));
            float3<T> const p = when(
                vertex != Int(std::int32_t(kNone)),
                [&]() -> float3<T> {
                    Int const at = vertex * Int(stride);
                    return {load<T>(positions, at), load<T>(positions, at + Int(1)),
                            load<T>(positions, at + Int(2))};
                },
                zero);
            Int const out = i << Int(2);
            store(constants, out, p.x);
            store(constants, out + Int(1), p.y);
            store(constants, out + Int(2), p.z);
            store(constants, out + Int(3), T(0));
        });
    }
};

/// Normals of the surface at patches' own corners (the input vertices, where a mesh may be
/// extraordinary or tagged): derivatives are 0 or infinite there, and every patch has tangents of
/// its own frame, so one patch's stand for all that meet on one side of infinitely sharp edges. One
/// thread a corner.
struct CornerNormalShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};
    static constexpr std::uint32_t kNone = 0xffffffffu;
    /// What the mean of the faces around is for.
    enum class Faces : std::uint32_t {
        None,
        Fallback, ///< the normal where tangents are parallel
        Outside,  ///< that, and the side that the normal points to
        Normal,   ///< the normal: a pole
    };

    Buffer<std::uint32_t>
        corners; ///< [corner + 1][3]: where its terms begin; Faces; which of `faces`
    Buffer<std::uint32_t> vertices; ///< [term]
    Buffer<float> weights;          ///< [term][2]: of both tangents
    Buffer<float> positions;        ///< [vertex][stride]
    PoleNormals faces;              ///< means of faces, of PoleNormalShader
    RWBuffer<float> normals;        ///< out: [corner][3], unit length
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out{corners.info(), vertices.info(), weights.info(),
                                      positions.info(), normals.info()};
        faces.add_to(out);
        return out;
    }

    /// \cost  6 mul, 6 add a term; 9 mul, 5 add, 1 div, 1 sqrt
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const corner = linear_thread<CornerNormalShader>(in);
            Int const words = corner * Int(3);
            Int const begin = Int(load<T>(corners, words)),
                      count = Int(load<T>(corners, words + Int(3))) - begin;
            V const zero(T(0), T(0), T(0));
            V a = zero, b = zero;
            for (int k : loop<T>(longest<T>(count))) {
                mask_of<T> const here = Int(k) < count;
                V const p = when(
                    here,
                    [&]() -> V {
                        Int const v = Int(load<T>(vertices, begin + Int(k))) * Int(stride);
                        return {load<T>(positions, v), load<T>(positions, v + Int(1)),
                                load<T>(positions, v + Int(2))};
                    },
                    zero);
                Int const weight = (begin + Int(k)) << Int(1);
                a = when(
                    here, [&]() -> V { return a + load<T>(weights, weight) * p; }, a);
                b = when(
                    here, [&]() -> V { return b + load<T>(weights, weight + Int(1)) * p; }, b);
            }
            V const across = cross(a, b);
            Int const use = Int(load<T>(corners, words + Int(1))),
                      which = Int(load<T>(corners, words + Int(2)));
            auto const is = [&](Faces f) { return use == Int(std::int32_t(f)); };
            V const area = when(
                !is(Faces::None),
                [&]() -> V { return faces.vector<T>(which, Int(PoleNormalShader::kNormal)); },
                V(T(0), T(0), T(1)));
            // Of parallel tangents rounding decides: less than 2^-16 of their lengths' product.
            T const squared = dot(across, across), aa = dot(a, a), bb = dot(b, b);
            T const least = T(0x1p-32f) * T(aa * bb);
            mask_of<T> const is_pole = is(Faces::Normal), exists = squared > least;
            mask_of<T> const inwards = is(Faces::Outside) & (dot(across, area) < T(0));
            V const own = select(inwards, -across, across);
            V const n =
                unit_or(select(is_pole, zero, select(exists, own, zero)), [&] { return area; });
            Int const out = corner * Int(3);
            store(normals, out, n.x);
            store(normals, out + Int(1), n.y);
            store(normals, out + Int(2), n.z);
        });
    }
};

/// The one normal that displaces a vertex whose infinitely sharp edges part it into several sides:
/// the mean of theirs. One thread a vertex.
struct SharedNormalShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};

    Buffer<std::uint32_t> first;   ///< [vertex + 1]: where its corners begin
    Buffer<std::uint32_t> corners; ///< the corners of all, side after side
    Buffer<float> normals;         ///< [corner][3]
    RWBuffer<float> shared;        ///< out: [vertex][3], unit length

    std::vector<ResourceInfo> resources() const
    {
        return {first.info(), corners.info(), normals.info(), shared.info()};
    }
    /// \cost  3 add a side; 6 mul, 2 add, 1 div, 1 sqrt
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const vertex = linear_thread<SharedNormalShader>(in);
            Int const begin = Int(load<T>(first, vertex)),
                      count = Int(load<T>(first, vertex + Int(1))) - begin;
            auto const normal = [&](int side) -> V {
                Int const at = Int(load<T>(corners, begin + Int(side))) * Int(3);
                return {load<T>(normals, at), load<T>(normals, at + Int(1)),
                        load<T>(normals, at + Int(2))};
            };
            V sum(T(0), T(0), T(0));
            for (int side : loop<T>(longest<T>(count)))
                sum = when(
                    Int(side) < count, [&]() -> V { return sum + normal(side); }, sum);
            // Where they cancel the first one's.
            V const n = unit_or(sum, [&] { return normal(0); });
            Int const out = vertex * Int(3);
            store(shared, out, n.x);
            store(shared, out + Int(1), n.y);
            store(shared, out + Int(2), n.z);
        });
    }
};

} // namespace tessemu
