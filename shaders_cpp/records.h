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

/// Position and two tangents whose cross product is the surface normal's direction. Their common
/// scale is the scheme's; see the function that returns them.
template <class T> struct TangentFrame {
    float3<T> position, du, dv;
};

} // namespace tessemu
