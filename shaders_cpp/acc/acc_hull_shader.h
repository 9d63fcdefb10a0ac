// Hull shader of ACC in stencil form: 24 sums, and the corners' cosines as the 25th control point.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/acc/acc_quad.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"

namespace tessemu {

/// \tparam Rows  SummedRows or GatheredRows
template <class Rows = SummedRows<4>>
struct AccHullShader : StencilHullShader<TessellatorDomain::Quad, Rows> {
    using Stencils = StencilHullShader<TessellatorDomain::Quad, Rows>;
    using Stencils::rows;
    template <class T> using ControlPoint = AccControlPoint<T>;

    int control_points() const { return AccLayout::kPoints; }

    template <class T>
    AccControlPoint<T> control_point(PatchInput patch, ControlPoints<ControlVertex<T>> const& in,
                                     int_of<T> id) const
    {
        using Int = int_of<T>;
        T const zero(0);
        float3<T> const sum = when(
            id < Int(AccLayout::kCosines),
            [&]() -> float3<T> { return rows.template point<T>(patch, in, id); },
            float3<T>(zero, zero, zero));
        return when(
            id == Int(AccLayout::kCosines),
            [&] {
                std::int32_t const at = rows.template first_constant<T>(patch, in.size());
                auto const c = [&](int i) -> T { return load<T>(rows.constants(), at + i); };
                return AccControlPoint<T>{{c(0), c(1), c(2), c(3)}};
            },
            AccControlPoint<T>{{sum, zero}});
    }

    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<ControlVertex<T>> const&,
                                  ControlPoints<AccControlPoint<T>> const& out,
                                  ControlPoints<EdgeRegister<T>> const& registers) const
    {
        return Stencils::factors.template factors<TessellatorDomain::Quad, T>(
            [&](int k) { return AccQuadInside::edge<T>(out, k); },
            [&](int k) { return registers[4 * k].reversed > T(0); });
    }
};

} // namespace tessemu
