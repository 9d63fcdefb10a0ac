// Pixel shaders that show a surface: lit, normals, patches, depth.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/pixel_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// The attribute that the views read.
template <class T> struct SurfaceAttributes {
    float3<T> normal;
    static constexpr auto signature() { return std::tuple{&SurfaceAttributes::normal}; }
};

/// The interpolated normal, unit length, turned towards the viewer on back faces; 0 where there is
/// none.
template <class T>
float3<T> facing_normal(PixelInput<T> const& pixel, SurfaceAttributes<T> const& in)
{
    T const squared = dot(in.normal, in.normal);
    T const inverse = T(1) / select(squared > T(0), T(sqrt(squared)), T(1));
    float3<T> const n(T(in.normal.x * inverse), T(in.normal.y * inverse), T(in.normal.z * inverse));
    return select(pixel.front_face, n, -n);
}

/// Key light, sky and ground, a soft highlight: display-referred colour, no textures.
struct LitPixelShader {
    template <class T> using Input = SurfaceAttributes<T>;
    std::array<float, 3> light{0.48f, 0.6f, 0.64f}; ///< towards the light, unit length
    std::array<float, 3> half{0.24f, 0.3f, 0.923f}; ///< between light and viewer, unit length
    std::array<float, 3> up{0, 1, 0};
    std::array<float, 3> base{0.86f, 0.72f, 0.55f};

    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, SurfaceAttributes<T> const& in) const
    {
        auto const vec = [](std::array<float, 3> const& v) {
            return float3<T>(T(v[0]), T(v[1]), T(v[2]));
        };
        float3<T> const n = facing_normal(pixel, in);
        float3<T> const light_v = vec(light), half_v = vec(half), up_v = vec(up);
        T const diffuse = max(T(dot(n, light_v)), T(0));
        T const sky = T(0.5) + T(0.5) * T(dot(n, up_v));
        T const h = max(T(dot(n, half_v)), T(0));
        T const h2 = h * h;
        T const h4 = h2 * h2;
        T const h8 = h4 * h4;
        T const h16 = h8 * h8;
        T const highlight = T(0.22) * T(h16 * h16);
        auto const channel = [&](float albedo, float ground, float skylight) -> T {
            T const ambient = T(ground) + T(skylight - ground) * sky;
            T const shade = ambient + T(0.62) * diffuse;
            return saturate(T(T(albedo) * shade + highlight));
        };
        return {channel(base[0], 0.34f, 0.42f), channel(base[1], 0.30f, 0.46f),
                channel(base[2], 0.30f, 0.56f), T(1)};
    }
};

/// One colour everywhere.
struct FlatPixelShader {
    template <class T> using Input = SurfaceAttributes<T>;
    std::array<float, 4> color{1, 1, 1, 1};
    template <class T> float4<T> operator()(PixelInput<T> const&, SurfaceAttributes<T> const&) const
    {
        return {T(color[0]), T(color[1]), T(color[2]), T(color[3])};
    }
};

/// The unit normal as a colour: 0.5 + 0.5 n.
struct NormalPixelShader {
    template <class T> using Input = SurfaceAttributes<T>;
    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, SurfaceAttributes<T> const& in) const
    {
        float3<T> const n = facing_normal(pixel, in);
        T const half(0.5);
        return {T(half + half * n.x), T(half + half * n.y), T(half + half * n.z), T(1)};
    }
};

/// How bright a patch's colour is, 0.45 in the dark to 1.
template <class T>
T patch_light(PixelInput<T> const& pixel, SurfaceAttributes<T> const& in,
              std::array<float, 3> const& light)
{
    float3<T> const n = facing_normal(pixel, in);
    float3<T> const light_v{T(light[0]), T(light[1]), T(light[2])};
    T const diffuse = max(T(dot(n, light_v)), T(0));
    return T(0.45) + T(0.55) * diffuse;
}

/// Patches told apart: a colour per patch kind, varied a little from patch to patch, lit.
struct PatchPixelShader {
    template <class T> using Input = SurfaceAttributes<T>;
    std::array<float, 3> color{0.7f, 0.7f, 0.7f};
    std::array<float, 3> light{0.48f, 0.6f, 0.64f};
    /// Of a patch: the least, and what each of 255 steps adds.
    float brightness = 0.78f, step = float(0.32 / 255);

    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, SurfaceAttributes<T> const& in) const
    {
        using Int = int_of<T>;
        T const bright = patch_light(pixel, in, light);
        Int const hash = (pixel.primitive_id * Int(0x9e3779b)) >> Int(20);
        T const variation = T(brightness) + T(step) * T(hash & Int(255));
        T const shade = variation * bright;
        return {saturate(T(T(color[0]) * shade)), saturate(T(T(color[1]) * shade)),
                saturate(T(T(color[2]) * shade)), T(1)};
    }
};

/// A colour for each patch, lit.
struct PatchColorPixelShader {
    static constexpr int kSlot = 0;
    template <class T> using Input = SurfaceAttributes<T>;
    Buffer<float> colors; ///< [patch][3]
    std::array<float, 3> light{0.48f, 0.6f, 0.64f};

    std::vector<ResourceInfo> resources() const { return {colors.info()}; }
    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, SurfaceAttributes<T> const& in) const
    {
        using Int = int_of<T>;
        T const bright = patch_light(pixel, in, light);
        Int const first = pixel.primitive_id * Int(3);
        T const r = load<T>(colors, first), g = load<T>(colors, first + Int(1)),
                b = load<T>(colors, first + Int(2));
        return {T(r * bright), T(g * bright), T(b * bright), T(1)};
    }
};

/// Distance along the view as grey: `near_w` is white, `far_w` black.
struct DepthPixelShader {
    template <class T> using Input = SurfaceAttributes<T>;
    float near_w = 0, far_w = 1;
    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, SurfaceAttributes<T> const&) const
    {
        T const scale(1.0f / (far_w - near_w));
        T const d = saturate(T((T(far_w) - pixel.position.w) * scale));
        return {d, d, d, T(1)};
    }
};

} // namespace tessemu
