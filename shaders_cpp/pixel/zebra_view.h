// Reflection lines: parallel strips of light, mirrored in the surface, as a car body is inspected
// (docs/smoothness.md).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/pixel/surface_views.h"

namespace tessemu {

/// The direction v from the surface to the viewer is reflected in the normal, r = 2 (n.v) n - v;
/// the strips lie across an axis, so a stripe is where `stripes` r.axis is nearer to a whole number
/// than to the next half. Its edges are blended over a pixel, and where stripes are narrower than
/// two pixels they fade to grey. A stripe runs on where normals do and has a kink where curvature
/// jumps; it breaks where the normal does.
struct ZebraPixelShader {
    template <class T> using Input = SurfaceAttributes<T>;
    /// v at pixel (x, y): v0 + x vx + y vy, of any length.
    std::array<float, 3> v0{0, 0, 1}, vx{0, 0, 0}, vy{0, 0, 0};
    std::array<float, 3> axis{0, 1, 0}; ///< unit length
    float stripes = 7;                  ///< light ones for a unit of r.axis, which is -1 to 1

    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, SurfaceAttributes<T> const& in) const
    {
        auto const vec = [](std::array<float, 3> const& v) {
            return float3<T>(T(v[0]), T(v[1]), T(v[2]));
        };
        float3<T> const n = facing_normal(pixel, in);
        float3<T> const towards = vec(v0) + pixel.position.x * vec(vx) + pixel.position.y * vec(vy);
        float3<T> const v = unit_or_zero(towards);
        float3<T> const along = vec(axis);
        T const facing = dot(n, v);
        T const of_normal = dot(n, along), of_viewer = dot(v, along);
        T const reflected = T(2) * T(facing * of_normal) - of_viewer;
        T const place = T(stripes) * reflected;
        T const fraction = place - floor(place), rest = T(1) - fraction;
        // 1/4 at the edges of a stripe: how far off the nearest whole number, 0 to 1/2.
        T const wave = min(fraction, rest);
        T const dx = ddx(place), dy = ddy(place);
        T const width = max(T(max(dx, T(-dx)) + max(dy, T(-dy))), T(1.0f / 1024));
        T const light = saturate(T(T(0.5) + T(T(0.25) - wave) / width));
        T const shade = T(0.6) + T(0.4) * max(facing, T(0));
        T const grey = shade * T(T(0.06) + T(0.92) * light);
        return {grey, grey, grey, T(1)};
    }
};

} // namespace tessemu
