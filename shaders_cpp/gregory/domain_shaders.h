// Domain shaders of the Gregory scheme: regular quads, Gregory quads, Gregory triangles. Inside the
// patch the scheme's evaluation; on its edges and corners the watertight recipe.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/gregory_triangle.h"
#include "shaders_cpp/gregory/regular_quad.h"
#include "shaders_cpp/watertight_patch.h"

namespace tessemu {

/// Patches whose control points begin with p, e+, e- and whose edge condition is about the edge
/// curve's own derivative.
template <int N> struct GregoryEdges : TangentPairCorners<N> {
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

struct RegularQuadInside : GregoryEdges<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 16;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in, bool)
    {
        return regular_quad<T>(patch, in.u, in.v);
    }
};

struct GregoryQuadInside : GregoryEdges<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 20;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in,
                                              bool true_normals)
    {
        return gregory_quad<T>(patch, in.u, in.v, true_normals);
    }
};

struct GregoryTriangleInside : GregoryEdges<3> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kControlPoints = 15;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in,
                                              bool true_normals)
    {
        return gregory_triangle<T>(patch, in.u, in.v, in.w, true_normals);
    }
};

using RegularQuadDomainShader = WatertightPatch<RegularQuadInside>;
using GregoryQuadDomainShader = WatertightPatch<GregoryQuadInside>;
using GregoryTriangleDomainShader = WatertightPatch<GregoryTriangleInside>;

} // namespace tessemu
