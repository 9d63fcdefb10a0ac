// Domain shaders of the two-stage form: a scheme's evaluation on control points that arrive corner
// by corner.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/regular_quad.h"
#include "shaders_cpp/two_stage_form/corner_tables.h"

namespace tessemu {

/// Corners as a patch of control points p, e+, e-, f+, f-, each corner by corner.
template <int N, int kVectors, class T> class CornersAsPatch {
public:
    constexpr explicit CornersAsPatch(ControlPoints<CornerVectors<kVectors, T>> const& corners)
        : corners_(corners)
    {
    }
    constexpr ControlVertex<T> operator[](int i) const { return {corners_.vector(i % N, i / N)}; }

private:
    ControlPoints<CornerVectors<kVectors, T>> const& corners_;
};

/// \tparam Inside  of the stencil form, as WatertightPatch asks for it
/// \tparam kCount  vectors of a corner
template <class Inside, int kCount> struct ByCorners {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kControlPoints = kDomain == TessellatorDomain::Quad ? 4 : 3;
    template <class T> using ControlPoint = CornerVectors<kCount, T>;
    template <class T> using Corners = ControlPoints<CornerVectors<kCount, T>>;
    template <class T> using View = CornersAsPatch<kControlPoints, kCount, T>;

    template <class T>
    static constexpr TangentFrame<T> evaluate(Corners<T> const& corners, DomainInput<T> const& in,
                                              bool true_normals)
    {
        return Inside::template evaluate<T>(View<T>(corners), in, true_normals);
    }
    template <class T> static constexpr EdgeCurve<T> edge(Corners<T> const& corners, int k)
    {
        return Inside::template edge<T>(View<T>(corners), k);
    }
    template <class T> static constexpr float3<T> corner(Corners<T> const& corners, int i)
    {
        return Inside::template corner<T>(View<T>(corners), i);
    }
    template <class T>
    static constexpr float3<T> corner_normal(ControlPoints<EdgeRegister<T>> const& registers, int i)
    {
        return registers[4 * kControlPoints + i].vector;
    }
};

using RegularCornersDomainShader = WatertightPatch<ByCorners<RegularQuadInside, 4>>;

} // namespace tessemu
