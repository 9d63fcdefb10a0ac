// Hull shaders of patches at an isolated extraordinary vertex, LOOP10 section 4, and of the patches
// beside them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/cage_form/cage_factors.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"

namespace tessemu {

/// The product of a dense matrix with a net of 2n + 8 vertices, whose first four points are the
/// patch's corners: a row of the stencil form whose zero weights are multiplied too. Tess factors
/// follow the cage's edges, as those of LOOP10's regular patches do.
///
/// \cost  6n + 24 mul a control point
template <class Rows> struct DenseNetHullShader : StencilQuadHullShader<Rows> {
    template <class T> using PatchConstant = ControlVertex<T>; // none
    template <class T> using Inputs = ControlPoints<ControlVertex<T>>;

    int patch_constants() const { return 0; }
    std::vector<ResourceInfo> resources() const { return this->rows.resources(); }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, Inputs<T> const&, auto const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, Inputs<T> const& in, auto const&, auto const&) const
    {
        return cage_factors<TessellatorDomain::Quad, T>(this->factors,
                                                        [&](int k) { return in[k].position; });
    }
};

/// The stencil form's hull shader beside patches whose tess factors follow the cage's edges: its
/// last four control points are the patch's corners in the cage.
template <class Rows> struct CagedStencilHullShader : StencilQuadHullShader<Rows> {
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<ControlVertex<T>> const&,
                                  ControlPoints<ControlVertex<T>> const& out,
                                  ControlPoints<EdgeRegister<T>> const&) const
    {
        return cage_factors<TessellatorDomain::Quad, T>(
            this->factors, [&](int k) { return out[this->points - 4 + k].position; });
    }
};

/// Of a patch whose net comes from a buffer: the corners alone, for tess factors.
struct CornersAlone {
    static constexpr int kPoints = 4;
    static constexpr int kCorners[4] = {0, 1, 2, 3};
};

} // namespace tessemu
