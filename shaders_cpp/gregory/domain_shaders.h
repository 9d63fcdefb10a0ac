// Domain shaders of the Gregory scheme: Gregory quads, Gregory triangles. Inside the patch the
// scheme's evaluation; on its edges and corners the watertight recipe.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/gregory/gregory_triangle.h"
#include "shaders_cpp/regular_quad.h"

namespace tessemu {

struct GregoryQuadInside : CubicEdges<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 20;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in,
                                              bool true_normals)
    {
        return gregory_quad<T>(patch, in.u, in.v, true_normals);
    }
};

struct GregoryTriangleInside : CubicEdges<3> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kControlPoints = 15;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in,
                                              bool true_normals)
    {
        return gregory_triangle<T>(patch, in.u, in.v, in.w, true_normals);
    }
};

using GregoryQuadDomainShader = WatertightPatch<GregoryQuadInside>;
using GregoryTriangleDomainShader = WatertightPatch<GregoryTriangleInside>;

} // namespace tessemu
