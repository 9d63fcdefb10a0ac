// Records that the patch schemes share: what travels between their stages.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/memory.h"

namespace tessemu {

/// A vertex of the control mesh, and a control point of any patch: object space.
template <class T> struct ControlVertex {
    float3<T> position;
    static constexpr auto signature() { return std::tuple{&ControlVertex::position}; }
};

/// Position (object space) and normal (unit length where it exists) of a surface.
template <class T> struct SurfacePoint {
    float3<T> position, normal;
    static constexpr auto signature()
    {
        return std::tuple{&SurfacePoint::position, &SurfacePoint::normal};
    }
};

/// What a domain shader hands to the rasterizer: clip-space position, object-space normal.
template <class T> struct ShadedVertex {
    float4<T> position; ///< SV_Position
    float3<T> normal;
    static constexpr auto signature()
    {
        return std::tuple{&ShadedVertex::position, &ShadedVertex::normal};
    }
};

/// v / |v|, and 0 where v is 0: a surface may have no normal at a degenerate point.
template <class T> constexpr float3<T> unit_or_zero(float3<T> const& v)
{
    Routine<T> const here("unit_or_zero");
    T const squared = dot(v, v);
    T const length = sqrt(squared);
    T const inverse = T(1) / select(squared > T(0), length, T(1));
    return {T(v.x * inverse), T(v.y * inverse), T(v.z * inverse)};
}

/// v / |v|; where v is 0 or not a number `otherwise()`, a unit vector.
///
/// \cost  that of unit_or_zero, and `otherwise` in the lanes that need it
template <class T, class Otherwise>
constexpr float3<T> unit_or(float3<T> const& v, Otherwise const& otherwise)
{
    Routine<T> const here("unit_or_zero"); // which it is, but for that
    T const squared = dot(v, v);
    T const length = sqrt(squared);
    mask_of<T> const exists = squared > T(0);
    T const inverse = T(1) / select(exists, length, T(1));
    float3<T> const unit(T(v.x * inverse), T(v.y * inverse), T(v.z * inverse));
    return when(
        !exists, [&]() -> float3<T> { return otherwise(); }, unit);
}

/// Position and two tangents whose cross product is the surface normal's direction. Their common
/// scale is the scheme's; see the function that returns them.
template <class T> struct TangentFrame {
    float3<T> position, du, dv;
};

/// Position, first and second derivatives, all by the patch's own u and v.
template <class T> struct SecondOrderFrame {
    float3<T> position, du, dv, duu, duv, dvv;
    static constexpr auto signature()
    {
        return std::tuple{&SecondOrderFrame::position, &SecondOrderFrame::du,
                          &SecondOrderFrame::dv,       &SecondOrderFrame::duu,
                          &SecondOrderFrame::duv,      &SecondOrderFrame::dvv};
    }
};

} // namespace tessemu
