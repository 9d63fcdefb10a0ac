// Vertices that table-driven patches sum over: positions with the normals of their faces (HOLL10
// 2B, the pass behind the initial step of subdivision), or with normals that steps have carried
// along.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// Vertices of a mesh with the faces around them.
struct VertexFans {
    /// [vertex][3]: of the mesh; where its ring begins; the ring's vertices, twice, and one more
    /// where the fan is open
    Buffer<std::uint32_t> entries;
    Buffer<std::uint32_t> rings; ///< vertices of the mesh, counter-clockwise
    Buffer<float> positions;     ///< [vertex of the mesh][stride]
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        return {entries.info(), rings.info(), positions.info()};
    }
    template <class T> struct Around {
        float3<T> position, normal;
    };
    /// Its position, and the mean normal of the faces around, each by the area of the triangle at
    /// the vertex, scaled to length 1:
    ///
    ///     n = sum (e_j - v) x (e_j+1 - v), a closed fan from its last edge round to the first
    ///
    /// \cost  6 mul, 8 add for each of the ring's vertices; 6 mul, 2 add, 1 div, 1 sqrt
    template <class T> Around<T> around(int_of<T> const& vertex) const
    {
        using Int = int_of<T>;
        using V = float3<T>;
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
        auto const spoke = [&](Int j) -> V { return position(Int(load<T>(rings, ring + j))) - v; };
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
        return {v, unit_or(area, [] { return V(T(0), T(0), T(1)); })};
    }
};

/// Position and normal, [vertex][kFloats].
struct TableVertices {
    static constexpr int kFloats = 6;

    RWBuffer<float> floats;

    template <class T>
    void put(int_of<T> const& vertex, float3<T> const& position, float3<T> const& normal) const
    {
        using Int = int_of<T>;
        Int at = vertex * Int(kFloats);
        for (float3<T> const& p : {position, normal})
            for (T const& c : {p.x, p.y, p.z}) {
                store(floats, at, c);
                at = at + Int(1);
            }
    }
};

/// One thread a vertex: with the normal of its faces.
struct TableVerticesShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};

    VertexFans mesh;
    TableVertices vertices; ///< out

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = mesh.resources();
        out.push_back(vertices.floats.info());
        return out;
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        group.for_each_thread([&](ComputeInput<T> const& in) {
            int_of<T> const vertex = linear_thread<TableVerticesShader>(in);
            auto const [position, normal] = mesh.around<T>(vertex);
            vertices.put<T>(vertex, position, normal);
        });
    }
};

/// One thread a vertex: its normal alone, for steps of subdivision to carry along (subdivision
/// shading: Alexa and Boubekeur 2008).
struct MeshNormalsShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};

    VertexFans mesh;
    RWVectorBuffer normals; ///< out, by vertex of the mesh

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = mesh.resources();
        out.push_back(normals.info());
        return out;
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        group.for_each_thread([&](ComputeInput<T> const& in) {
            int_of<T> const vertex = linear_thread<MeshNormalsShader>(in);
            store3(normals, vertex, mesh.around<T>(vertex).normal);
        });
    }
};

/// One thread a vertex: with a normal as steps have carried it along, of any length.
struct CarriedVerticesShader {
    static constexpr std::array<int, 3> kThreads{64, 1, 1};

    Buffer<std::uint32_t> entries; ///< VertexFans::entries
    Buffer<float> positions;       ///< [vertex of the mesh][stride]
    Buffer<float> normals;         ///< the same
    TableVertices vertices;        ///< out
    int stride = 3;

    std::vector<ResourceInfo> resources() const
    {
        return {entries.info(), positions.info(), normals.info(), vertices.floats.info()};
    }
    template <class T> void operator()(ComputeGroup<T>& group) const
    {
        using Int = int_of<T>;
        group.for_each_thread([&](ComputeInput<T> const& in) {
            Int const vertex = linear_thread<CarriedVerticesShader>(in);
            Int const at = Int(load<T>(entries, vertex * Int(3))) * Int(stride);
            auto const vector = [&](Buffer<float> const& of) -> float3<T> {
                return {load<T>(of, at), load<T>(of, at + Int(1)), load<T>(of, at + Int(2))};
            };
            vertices.put<T>(vertex, vector(positions), vector(normals));
        });
    }
};

} // namespace tessemu
