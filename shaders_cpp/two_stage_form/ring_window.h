// A vertex as one patch needs it: of its ring the edges of the patch and those beside them. For
// vertices with more edges than output registers hold: a dispatch makes the window of each corner
// of such patches, and the hull shader finds in it the edges that it asks a whole ring for.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "shaders_cpp/two_stage_form/ring_vertex.h"

namespace tessemu {

/// Limit position, normal direction, then edge points and second vectors of four edges: the one
/// before e+, e+, e-, the one after e-. At the boundary an edge that is not there is zero.
template <class T> struct RingWindow {
    static constexpr int kEdges = 4, kP = 0, kNormal = 1, kE = 2, kSecond = kE + kEdges;
    static constexpr int kVectors = kSecond + kEdges;
    std::array<float3<T>, kVectors> vectors;
    static constexpr auto signature() { return std::tuple{&RingWindow::vectors}; }
};

/// What the dispatch knows of a corner; words.
struct CornerWindow {
    static constexpr int kVertex = 0;   ///< of the mesh
    static constexpr int kConstant = 1; ///< where the constants of its valence begin
    static constexpr int kEdges = 2;    ///< numbers in its ring of the window's four edges
    static constexpr int kWords = kEdges + 4;
    /// What stands for an edge that is not there.
    static constexpr std::uint32_t kNone = 0xffffffffu;
    /// Edges of a vertex: of each, d_j, c_j and m_j take one of 4096 temporary registers.
    static constexpr int kMost = 1024;
};

/// The vertex shader of such patches: a window as the hull shader's vertex, with ring edges 0 to 3.
struct RingWindowVertexShader {
    template <class T> using Input = RingWindow<T>;
    template <class T> using Output = RingVertex<T>;

    template <class T>
    RingVertex<T> operator()(VertexInput<T> const&, RingWindow<T> const& window) const
    {
        RingVertex<T> out;
        out.vectors.fill(float3<T>(T(0), T(0), T(0)));
        out.vectors[RingLayout::kP] = window.vectors[RingWindow<T>::kP];
        out.vectors[RingLayout::kNormal] = window.vectors[RingWindow<T>::kNormal];
        for (int k : loop<T>(RingWindow<T>::kEdges)) {
            out.vectors[std::size_t(RingLayout::kE + k)] =
                window.vectors[std::size_t(RingWindow<T>::kE + k)];
            out.vectors[std::size_t(RingLayout::kSecond + k)] =
                window.vectors[std::size_t(RingWindow<T>::kSecond + k)];
        }
        return out;
    }
};

} // namespace tessemu
