// Mean curvature of a surface whose inside has second derivatives, beside the point that is drawn.
//
//     E = Su.Su   F = Su.Sv   G = Sv.Sv        n = Su x Sv / |Su x Sv|
//     L = -n.Suu  M = -n.Suv  N = -n.Svv       H = (E N - 2 F M + G L) / (2 (E G - F^2))
//
// An inside, or a domain shader, has second derivatives if it has the member
//
//     template <class T> SecondOrderFrame<T> second_order(
//         ControlPoints<ControlPoint<T>> const& patch, DomainInput<T> const& in) const;
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/projection.h"

namespace tessemu {

/// The mean of the two principal curvatures, 1/length; positive where the surface bends away from
/// its normal: 1/r on a sphere of radius r whose normals point outwards, 0 on a minimal surface. 0
/// where the tangents are parallel or zero.
///
/// \cost  38 mul, 3 div, 1 sqrt
template <class T> constexpr T mean_curvature(SecondOrderFrame<T> const& s)
{
    Routine<T> const here("mean_curvature");
    float3<T> const across = cross(s.du, s.dv);
    T const squared = dot(across, across); // E G - F^2
    mask_of<T> const exists = squared > T(0);
    T const determinant = select(exists, squared, T(1));
    T const inverse = T(1) / sqrt(determinant);
    float3<T> const inwards(T(-across.x * inverse), T(-across.y * inverse), T(-across.z * inverse));
    T const E = dot(s.du, s.du), F = dot(s.du, s.dv), G = dot(s.dv, s.dv);
    T const L = dot(inwards, s.duu), M = dot(inwards, s.duv), N = dot(inwards, s.dvv);
    T const FM = F * M;
    T const twice = E * N - T(2) * FM + G * L;
    return select(exists, T(T(T(0.5) * twice) / determinant), T(0));
}

/// A point of a surface with its mean curvature.
template <class T> struct CurvedPoint {
    float3<T> position, normal;
    T curvature; ///< 1/length, object space
    static constexpr auto signature()
    {
        return std::tuple{&CurvedPoint::position, &CurvedPoint::normal, &CurvedPoint::curvature};
    }
};

/// What reaches the rasterizer of it: a ShadedVertex and the curvature.
template <class T> struct CurvedVertex {
    float4<T> position; ///< SV_Position
    float3<T> normal;
    T curvature;
    static constexpr auto signature()
    {
        return std::tuple{&CurvedVertex::position, &CurvedVertex::normal, &CurvedVertex::curvature};
    }
};

/// A domain shader with second derivatives.
template <class Surface>
concept HasSecondOrder =
    requires(Surface const& surface,
             ControlPoints<typename Surface::template ControlPoint<float>> const& patch,
             DomainInput<float> const& in)
{
    surface.template second_order<float>(patch, in);
};

/// Domain shader of a surface with its curvature: points and normals are the surface's own, bit for
/// bit, so what is closed stays closed.
template <HasSecondOrder Surface> struct CurvedSurface {
    static constexpr TessellatorDomain kDomain = Surface::kDomain;
    static constexpr int kControlPoints = Surface::kControlPoints;
    template <class T> using ControlPoint = typename Surface::template ControlPoint<T>;
    template <class T> using PatchConstant = typename Surface::template PatchConstant<T>;
    template <class T> using Output = CurvedPoint<T>;

    Surface surface = {};

    std::vector<ResourceInfo> resources() const { return resources_of(surface); }
    template <class T>
    constexpr CurvedPoint<T> operator()(DomainInput<T> const& in,
                                        ControlPoints<ControlPoint<T>> const& patch,
                                        ControlPoints<PatchConstant<T>> const& constants) const
    {
        SurfacePoint<T> const s = surface(in, patch, constants);
        return {s.position, s.normal,
                mean_curvature<T>(surface.template second_order<T>(patch, in))};
    }
};

/// Its epilog.
struct CurvedProjectionEpilog {
    template <class T> using Input = CurvedPoint<T>;
    template <class T> using Output = CurvedVertex<T>;

    Matrix4 view_projection = kIdentity;

    template <class T>
    constexpr CurvedVertex<T> operator()(DomainInput<T> const&, CurvedPoint<T> const& s) const
    {
        return {transform(view_projection, s.position), s.normal, s.curvature};
    }
};

} // namespace tessemu
