// One-rings as a two-stage vertex shader reads and hands them on (LOOP09 4.1, figure 7).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/texture.h"
#include "emu/vertex_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// Vectors of a vertex: limit position, normal direction, from kE on an edge point for each edge,
/// and from kSecond on a second vector for each edge or face, which means what the scheme wants. 32
/// output registers hold 15 edges: valence 15, or 14 faces on the boundary.
struct RingLayout {
    static constexpr int kEdges = 15;
    static constexpr int kVectors = 2 + 2 * kEdges;
    static constexpr int kP = 0, kNormal = 1, kE = 2, kSecond = 2 + kEdges;
};

template <class T> struct RingVertex {
    static constexpr int kVectors = RingLayout::kVectors, kP = RingLayout::kP,
                         kNormal = RingLayout::kNormal;
    std::array<float3<T>, kVectors> vectors;
    static constexpr auto signature() { return std::tuple{&RingVertex::vectors}; }
};

/// Tables by valence have a row for each interior n, then one for each number k of boundary faces.
struct RingRows {
    static constexpr int kBoundary = 16; ///< first row of the boundary
    static constexpr int kCount = 32;
};

/// A vertex's ring of edges: far ends d_j and, where asked for, the diagonal vertices of the faces.
struct RingTextures {
    static constexpr int kTextureWidth = 1024;
    static constexpr std::uint32_t kNone = 0xffffffffu;

    Buffer<std::uint32_t> rings;   ///< [vertex][2]: first entry; faces, plus 2^16 on the boundary
    Buffer<std::uint32_t> entries; ///< [edge][2]: its far end; the diagonal vertex of the face
                                   ///< after it, kNone in a triangle
    Texture2D positions;           ///< vertex i at (i % kTextureWidth, i / kTextureWidth)

    template <class T> struct Ring {
        int_of<T> first, n, edges; ///< first word of the entries; faces; edges
        mask_of<T> boundary;
    };
    template <class T> Ring<T> ring(int_of<T> vertex) const
    {
        using Int = int_of<T>;
        Int const head = vertex << Int(1);
        Int const first = Int(load<T>(rings, head)) << Int(1);
        Int const word = Int(load<T>(rings, head + Int(1)));
        Int const n = word & Int(0xffff);
        return {first, n, n + (word >> Int(16)), (word & Int(0x10000)) != Int(0)};
    }
    template <class T> float3<T> position(int_of<T> id) const
    {
        using Int = int_of<T>;
        float4<T> const p =
            load<T>(positions, Int(id & Int(kTextureWidth - 1)), Int(id >> Int(10)));
        return {p.x, p.y, p.z};
    }
    template <class T> float3<T> far_end(Ring<T> const& r, int j) const
    {
        return position<T>(int_of<T>(load<T>(entries, r.first + int_of<T>(2 * j))));
    }
    template <class T> int_of<T> diagonal(Ring<T> const& r, int j) const
    {
        return int_of<T>(load<T>(entries, r.first + int_of<T>(2 * j + 1)));
    }
};

} // namespace tessemu
