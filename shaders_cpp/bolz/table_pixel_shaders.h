// The two passes that tessellate a patch, BOLZ03 section 3: a quad of (2^n + 1)^2 fragments into a
// float target, a fragment for each vertex; positions, and then normals.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/pixel_shader.h"
#include "emu/vertex_shader.h"
#include "shaders_cpp/bolz/table_sums.h"

namespace tessemu {

/// A fragment's texel in the first table.
template <class T> struct TableCoordinate {
    float2<T> at;
    static constexpr auto signature() { return std::tuple{&TableCoordinate::at}; }
};

/// The quad of a patch, a strip of four vertices over the viewport.
struct PatchQuadVertexShader {
    template <class T> struct Input { // SV_VertexID is all that there is
        static constexpr auto signature() { return std::tuple{}; }
    };
    template <class T> struct Output {
        float4<T> position;
        TableCoordinate<T> coordinate;
        static constexpr auto signature()
        {
            return std::tuple{&Output::position, &Output::coordinate};
        }
    };

    float low = 0, high = 0; ///< coordinates at the quad's corners, in texels

    /// Of the quad for 2^n segments, n = 0 to 5: so that fragments' centres are the centres of
    /// every 2^(5-n)th texel (section 3).
    static PatchQuadVertexShader of_level(int n)
    {
        float const step = float(1 << (5 - n)) / 2; // 2^(4-n)
        return {0.5f - step, 32.5f + step};
    }
    template <class T> Output<T> operator()(VertexInput<T> const& in, Input<T> const&) const
    {
        using Int = int_of<T>;
        auto const right = (in.vertex_id & Int(1)) != Int(0);
        auto const below = (in.vertex_id & Int(2)) != Int(0);
        auto const corner = [&](auto mask) -> T { return select(mask, T(high), T(low)); };
        return {{select(right, T(1), T(-1)), select(below, T(-1), T(1)), T(0), T(1)},
                {{corner(right), corner(below)}}};
    }
};

/// First pass: the limit position.
///
/// \tparam Sums  OrderedSums or PackedSums
template <class Sums> struct TablePositionPixelShader {
    template <class T> using Input = TableCoordinate<T>;

    Sums sums;
    Texture2D position;

    std::vector<ResourceInfo> resources() const { return {position.info()}; }
    template <class T>
    float4<T> operator()(PixelInput<T> const&, TableCoordinate<T> const& in) const
    {
        auto const [p] = sums.template operator()<T, 1>({position}, in.at);
        return {p, T(1)};
    }
};

/// a x b with every product rounded by itself, which the assembly of the day cannot say and HLSL
/// calls `precise`: two patches have the tangents of a shared point in two frames, as a x b and
/// (-b) x a, which differ where one of two products is fused into the difference.
///
/// \cost  6 mul, 3 add
template <class T> float3<T> rounded_cross(float3<T> const& a, float3<T> const& b)
{
    Routine<T> const here("rounded_cross");
    auto const difference = [](T const& p, T const& q) -> T { return p - q; };
    T const yz = a.y * b.z, zx = a.z * b.x, xy = a.x * b.y;
    T const zy = a.z * b.y, xz = a.x * b.z, yx = a.y * b.x;
    return {difference(yz, zy), difference(zx, xz), difference(xy, yx)};
}

/// Second pass: the direction of the normal, of any length.
template <class Sums> struct TableNormalPixelShader {
    template <class T> using Input = TableCoordinate<T>;

    Sums sums;
    Texture2D du, dv;

    std::vector<ResourceInfo> resources() const { return {du.info(), dv.info()}; }
    template <class T>
    float4<T> operator()(PixelInput<T> const&, TableCoordinate<T> const& in) const
    {
        auto const [a, b] = sums.template operator()<T, 2>({du, dv}, in.at);
        return {rounded_cross(a, b), T(0)};
    }
};

} // namespace tessemu
