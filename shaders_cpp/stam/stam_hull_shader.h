// Hull shader of Stam's evaluation as in the paper, LOOP10 4.2: thread i is the product of row i of
// V^-1 with the net, a row of the stencil form whose zero weights are multiplied too.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/cage_form/cage_factors.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"

namespace tessemu {

/// In: the net, whose first four points are the patch's corners. Out: the net in eigen space. Tess
/// factors follow the cage's edges, as those of LOOP10's regular patches do.
///
/// \cost  6n + 24 mul a control point
template <class Rows> struct StamHullShader : StencilQuadHullShader<Rows> {
    template <class T> using PatchConstant = ControlVertex<T>; // none
    template <class T> using Points = ControlPoints<ControlVertex<T>>;

    int patch_constants() const { return 0; }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, Points<T> const&, Points<T> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, Points<T> const& in, Points<T> const&,
                                  Points<T> const&) const
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

} // namespace tessemu
