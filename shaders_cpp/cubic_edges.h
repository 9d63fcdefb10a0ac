// Edges of patches that are cubics of shared control points, for any scheme that has them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/watertight_patch.h"

namespace tessemu {

/// The edge of a patch whose control points begin with p, e+, e- (N each).
template <int N, class Patch> constexpr auto cubic_edge(Patch const& patch, int k)
{
    int const next = (k + 1) % N;
    auto const p0 = patch[k].position, p1 = patch[N + k].position;
    auto const p2 = patch[2 * N + next].position, p3 = patch[next].position;
    using T = std::remove_cvref_t<decltype(p0.x)>;
    return EdgeCurve<T>{p0, p1, p2, p3, float3<T>(p1 - p0), float3<T>(p3 - p2)};
}

/// Behind the registers of N edges, two for each corner: tangents whose cross product is the
/// normal.
template <int N> struct TangentPairCorners {
    template <class T>
    static constexpr float3<T> corner_normal(ControlPoints<EdgeRegister<T>> const& registers, int i)
    {
        float3<T> const a = registers[4 * N + 2 * i].vector;
        float3<T> const b = registers[4 * N + 2 * i + 1].vector;
        return cross(a, b);
    }
};

/// Patches whose control points begin with p, e+, e- and whose edge condition is about the edge
/// curve's own derivative: what WatertightPatch asks of a scheme about edges.
template <int N> struct CubicEdges : TangentPairCorners<N> {
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> static constexpr EdgeCurve<T> edge(auto const& patch, int k)
    {
        return cubic_edge<N>(patch, k);
    }
    template <class T> static constexpr float3<T> corner(auto const& patch, int i)
    {
        return patch[i].position;
    }
};

} // namespace tessemu
