// Triangles with a colour at each vertex; a colour for a number.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/pixel_shader.h"
#include "emu/vertex_shader.h"
#include "shaders_cpp/projection.h"

namespace tessemu {

/// Blue, cyan, green, yellow, red at 0, 1/4, 1/2, 3/4, 1.
template <class T> float3<T> heat_color(T t)
{
    T const x = T(4) * saturate(t);
    auto const ramp = [&](double from, double to) -> T { // 0 before, 1 after
        return saturate(T((x - T(from)) * T(1 / (to - from))));
    };
    T const one(1);
    return {ramp(2, 3), T(ramp(0, 1) - ramp(3, 4)), T(one - ramp(1, 2))};
}

template <class T> struct ColoredVertex {
    float3<T> position, normal, color;
    static constexpr auto signature()
    {
        return std::tuple{&ColoredVertex::position, &ColoredVertex::normal, &ColoredVertex::color};
    }
};
template <class T> struct ProjectedColoredVertex {
    float4<T> position; ///< SV_Position
    float3<T> normal, color;
    static constexpr auto signature()
    {
        return std::tuple{&ProjectedColoredVertex::position, &ProjectedColoredVertex::normal,
                          &ProjectedColoredVertex::color};
    }
};
template <class T> struct ColoredAttributes {
    float3<T> normal, color;
    static constexpr auto signature()
    {
        return std::tuple{&ColoredAttributes::normal, &ColoredAttributes::color};
    }
};

struct ColoredVertexShader {
    template <class T> using Input = ColoredVertex<T>;
    template <class T> using Output = ProjectedColoredVertex<T>;
    Matrix4 view_projection = kIdentity;

    template <class T>
    ProjectedColoredVertex<T> operator()(VertexInput<T> const&, ColoredVertex<T> const& v) const
    {
        return {transform(view_projection, v.position), v.normal, v.color};
    }
};

/// The colour, darkened away from the viewer so that the shape can be read; as it is where there is
/// no normal.
struct ColoredPixelShader {
    template <class T> using Input = ColoredAttributes<T>;
    std::array<float, 3> viewer{0, 0, 1}; ///< towards the viewer, unit length
    float ambient = 0.7f;

    template <class T>
    float4<T> operator()(PixelInput<T> const&, ColoredAttributes<T> const& in) const
    {
        float3<T> const towards{T(viewer[0]), T(viewer[1]), T(viewer[2])};
        T const squared = dot(in.normal, in.normal);
        T const facing = dot(unit_or_zero(in.normal), towards);
        T const lit = T(ambient) + T(1 - ambient) * max(facing, T(-facing));
        T const shade = select(squared > T(0), lit, T(1));
        return {T(shade * in.color.x), T(shade * in.color.y), T(shade * in.color.z), T(1)};
    }
};

} // namespace tessemu
