// The view-projection transform, and the epilog that applies it to a surface.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/records.h"

#include <array>

namespace tessemu {

/// Rows of a 4x4 matrix; clip = matrix * (x, y, z, 1).
using Matrix4 = std::array<std::array<float, 4>, 4>;

inline constexpr Matrix4 kIdentity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

/// matrix * (p, 1). \cost 12 mul, 12 add
template <class T> constexpr float4<T> transform(Matrix4 const& m, float3<T> const& p)
{
    Routine<T> const here("transform");
    auto const row = [&](int i) -> T {
        auto const& r = m[std::size_t(i)];
        return T(r[0]) * p.x + T(r[1]) * p.y + T(r[2]) * p.z + T(r[3]);
    };
    return {row(0), row(1), row(2), row(3)};
}

/// From a surface point to clip space, and two ways to make what is too small to be seen visible.
struct VertexFinish {
    Matrix4 view_projection = kIdentity;
    /// Moves a point by so much along its normal, out or in by the parity of its bits: points that
    /// differ in a last bit come apart.
    float parity = 0;
    /// Rounds x/w and y/w to multiples of 1/lattice, 0 for none: edges run through many samples.
    std::array<float, 2> lattice{0, 0};

    template <class T>
    constexpr float4<T> operator()(float3<T> const& position, float3<T> const& normal) const
    {
        float3<T> p = position;
        if (parity != 0) {
            auto const bits = asuint(p.x) + asuint(p.y) + asuint(p.z);
            using Int = int_of<T>;
            T const by = select((bits & Int(1)) != Int(0), T(parity), T(-parity));
            p = p + by * normal;
        }
        float4<T> const clip = transform(view_projection, p);
        if (lattice[0] == 0) return clip;
        T const inverse = T(1) / clip.w;
        auto const snapped = [&](T const& x, float n) -> T {
            T const scaled = T(n) * T(x * inverse);
            return T(1 / n) * floor(T(scaled + T(0.5)));
        };
        return {snapped(clip.x, lattice[0]), snapped(clip.y, lattice[1]), T(clip.z * inverse),
                T(1)};
    }
};

/// The epilog of a surface's domain shader.
struct ProjectionEpilog {
    template <class T> using Input = SurfacePoint<T>;
    template <class T> using Output = ShadedVertex<T>;

    VertexFinish finish;

    template <class T>
    constexpr ShadedVertex<T> operator()(DomainInput<T> const&, SurfacePoint<T> const& s) const
    {
        return {finish(s.position, s.normal), s.normal};
    }
};

} // namespace tessemu
