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

/// The epilog of a surface's domain shader.
struct ProjectionEpilog {
    template <class T> using Input = SurfacePoint<T>;
    template <class T> using Output = ShadedVertex<T>;

    Matrix4 view_projection = kIdentity;

    template <class T>
    constexpr ShadedVertex<T> operator()(DomainInput<T> const&, SurfacePoint<T> const& s) const
    {
        return {transform(view_projection, s.position), s.normal};
    }
};

} // namespace tessemu
