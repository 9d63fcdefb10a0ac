// Phong tessellation of a triangle (Boubekeur and Alexa 2008; docs/math/subdivision.md, 6.5).
//
//     p   = u P0 + v P1 + w P2
//     p*  = (1 - alpha) p + alpha (u pi0(p) + v pi1(p) + w pi2(p))
//     pi  = q - ((q - P) . N) N, the projection on a vertex's tangent plane
//
// Control points: corners 0, 1, 2 with their normals. The normal is the interpolated one.
//
// Edges have equal bits from both sides without a word about edges: on an edge the third weight is
// 0, and sums of two rounded terms do not depend on their order. So every product has a name, which
// keeps a contraction from fusing one of them, and what belongs to a corner is a routine, which
// decides alike whichever corner calls it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/cage_form/cage_shaders.h"

namespace tessemu {

/// weight * pi(q). \cost 9 mul, 8 add
template <class T>
constexpr float3<T> phong_projected(float3<T> const& q, NormalVertex<T> const& corner, T weight)
{
    Routine<T> const here("phong_projected");
    T const height = dot(float3<T>(q - corner.position), corner.normal);
    float3<T> const projected = q - height * corner.normal;
    return weight * projected;
}

struct PhongTriangle {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kControlPoints = 3;
    template <class T> using ControlPoint = NormalVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Output = SurfacePoint<T>;

    float alpha = 0.75f;

    /// \cost  57 mul, 47 add, 1 div, 1 sqrt, 1 comparison; 3 fetches
    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in,
                                         ControlPoints<NormalVertex<T>> const& patch,
                                         ControlPoints<ControlVertex<T>> const&) const
    {
        NormalVertex<T> const a = patch[0], b = patch[1], c = patch[2];
        float3<T> const pa = in.u * a.position, pb = in.v * b.position, pc = in.w * c.position;
        float3<T> const na = in.u * a.normal, nb = in.v * b.normal, nc = in.w * c.normal;
        float3<T> const p = pa + pb + pc;
        float3<T> const qa = phong_projected<T>(p, a, in.u), qb = phong_projected<T>(p, b, in.v),
                        qc = phong_projected<T>(p, c, in.w);
        float3<T> const q = qa + qb + qc;
        // Opposite normals cancel in between: there is z, the same from both sides of an edge.
        float3<T> const normal =
            unit_or(float3<T>(na + nb + nc), [] { return float3<T>(T(0), T(0), T(1)); });
        return {float3<T>(T(1 - alpha) * p + T(alpha) * q), normal};
    }
};

} // namespace tessemu
