// Domain shaders of the patches beside those at an isolated extraordinary vertex (LOOP10 section
// 4), where these differ from the stencil form's.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/bspline_quad.h"
#include "shaders_cpp/gregory/domain_shaders.h"

namespace tessemu {

/// Gregory quads behind whose control points come the patch's corners in the cage.
struct CagedGregoryInside : GregoryQuadInside {
    static constexpr int kControlPoints = 24;
};
using CagedGregoryDomainShader = WatertightPatch<CagedGregoryInside>;

/// A regular patch whose edges have equal bits from both sides and whose inside is a B-spline: p,
/// e+ and e-, then the net.
struct BsplineRowsInside : CubicEdges<4> {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 12 + RegularNet::kPoints;
    template <class T>
    static constexpr TangentFrame<T> evaluate(auto const& patch, DomainInput<T> const& in, bool)
    {
        return bspline_quad<T>(net_of(patch), in.u, in.v);
    }
    template <class T>
    static constexpr SecondOrderFrame<T> second_order(auto const& patch, DomainInput<T> const& in)
    {
        return BsplineQuadInside::second_order<T>(net_of(patch), in);
    }

private:
    template <class Patch> struct Net {
        Patch const& of;
        constexpr auto operator[](int i) const { return of[12 + i]; }
    };
    template <class Patch> static constexpr Net<Patch> net_of(Patch const& patch)
    {
        return {patch};
    }
};
using BsplineRowsDomainShader = WatertightPatch<BsplineRowsInside>;

} // namespace tessemu
