// Flat triangle, the substitute without a curve: what HOLL10 calls no refinement.
//
//     p = u P0 + v P1 + w P2,   n = u N0 + v N1 + w N2, of length 1
//
// Control points: corners 0, 1, 2 with their normals. Edges have equal bits from both sides, for on
// an edge both are sums of two rounded terms, as in phong_triangle.h.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/cage_form/cage_shaders.h"

namespace tessemu {

struct FlatTriangle {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kControlPoints = 3;
    template <class T> using ControlPoint = NormalVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Output = SurfacePoint<T>;

    /// \cost  24 mul, 14 add, 1 div, 1 sqrt, 1 comparison; 3 fetches
    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in,
                                         ControlPoints<NormalVertex<T>> const& patch,
                                         ControlPoints<ControlVertex<T>> const&) const
    {
        NormalVertex<T> const a = patch[0], b = patch[1], c = patch[2];
        float3<T> const pa = in.u * a.position, pb = in.v * b.position, pc = in.w * c.position;
        float3<T> const na = in.u * a.normal, nb = in.v * b.normal, nc = in.w * c.normal;
        // Opposite normals cancel in between: there is z, the same from both sides of an edge.
        float3<T> const normal =
            unit_or(float3<T>(na + nb + nc), [] { return float3<T>(T(0), T(0), T(1)); });
        return {float3<T>(pa + pb + pc), normal};
    }
};

} // namespace tessemu
