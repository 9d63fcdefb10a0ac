// A number at each point of a surface, below and above 0, as colour.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/pixel/surface_views.h"

namespace tessemu {

/// Attributes of a CurvedVertex.
template <class T> struct CurvedAttributes {
    float3<T> normal;
    T curvature;
    static constexpr auto signature()
    {
        return std::tuple{&CurvedAttributes::normal, &CurvedAttributes::curvature};
    }
};

/// White at 0, blue at -1 and below, red at 1 and above; linear between.
template <class T> float3<T> diverging_color(T t)
{
    T const below = saturate(T(-t)), above = saturate(t);
    auto const channel = [&](double white, double blue, double red) -> T {
        return T(white) - T(white - blue) * below - T(white - red) * above;
    };
    return {channel(0.97, 0.08, 0.78), channel(0.97, 0.28, 0.07), channel(0.96, 0.74, 0.12)};
}

/// The curvature's colour, softly lit.
struct CurvaturePixelShader {
    template <class T> using Input = CurvedAttributes<T>;
    float scale = 0; ///< 1 / the curvature that is red; 0: all is white
    std::array<float, 3> light{0.48f, 0.6f, 0.64f};

    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, CurvedAttributes<T> const& in) const
    {
        T const lit = patch_light(pixel, SurfaceAttributes<T>{in.normal}, light);
        T const shade = T(0.5) + T(0.5) * lit;
        float3<T> const color = diverging_color<T>(T(scale) * in.curvature);
        return {T(shade * color.x), T(shade * color.y), T(shade * color.z), T(1)};
    }
};

} // namespace tessemu
