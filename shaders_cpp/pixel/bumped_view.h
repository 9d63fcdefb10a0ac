// Any view of a surface, of a displaced one: the normal is turned by the height map's gradient.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/displacement.h"
#include "shaders_cpp/pixel/surface_views.h"

namespace tessemu {

/// N' = N - scale grad h, the gradient on the smooth surface from differences between neighbouring
/// pixels, which need no tangents of a parametrisation (Mikkelsen, Bump Mapping Unparametrized
/// Surfaces on the GPU, 2010, without the term of the surface's own curvature).
template <class View> struct BumpedView {
    template <class T> using Input = DisplacedAttributes<T>;

    View view;
    HeightMap height;
    float scale = 0;

    std::vector<ResourceInfo> resources() const
    {
        std::vector<ResourceInfo> out = resources_of(view);
        if (height.is_image()) out.push_back(height.info());
        return out;
    }

    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, DisplacedAttributes<T> const& in) const
    {
        float3<T> const n = unit_or_zero(in.normal);
        float3<T> const dx(ddx(in.base.x), ddx(in.base.y), ddx(in.base.z));
        float3<T> const dy(ddy(in.base.x), ddy(in.base.y), ddy(in.base.z));
        float2<T> const cx(ddx(in.coordinates.x), ddx(in.coordinates.y));
        float2<T> const cy(ddy(in.coordinates.x), ddy(in.coordinates.y));
        auto const at = [&](float3<T> const& base, float2<T> const& coordinates) -> T {
            return height.template operator()<T>(base, {{T(0), T(0)}, coordinates});
        };
        T const h = at(in.base, in.coordinates);
        T const hx = at(in.base + dx, in.coordinates + cx) - h;
        T const hy = at(in.base + dy, in.coordinates + cy) - h;
        float3<T> const r1 = cross(dy, n), r2 = cross(n, dx);
        T const det = dot(dx, r1);
        T const size = max(det, T(-det));
        T const towards = select(det < T(0), T(-scale), T(scale));
        float3<T> const gradient = hx * r1 + hy * r2;
        float3<T> const bumped = size * n - towards * gradient;
        return view(pixel, SurfaceAttributes<T>{bumped});
    }
};

} // namespace tessemu
