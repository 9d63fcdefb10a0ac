// Domain shaders of the Gregory scheme: regular quads, Gregory quads, Gregory triangles.
//
// Inside the patch the scheme's evaluation; on its edges and corners the watertight recipe. Quad
// domain: corners p0 (0,0), p1 (1,0), p2 (1,1), p3 (0,1). Tri domain: u = 1 at p0, v = 1 at p1, w =
// 1 at p2.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_shader.h"
#include "shaders_cpp/gregory/gregory_triangle.h"
#include "shaders_cpp/gregory/regular_quad.h"
#include "shaders_cpp/gregory/watertight_edge.h"

namespace tessemu {

/// v / |v|, and 0 where v is 0: a surface may have no normal at a degenerate point.
template <class T> constexpr float3<T> unit_or_zero(float3<T> const& v)
{
    Routine<T> const here("unit_or_zero");
    T const squared = dot(v, v);
    T const length = sqrt(squared);
    T const inverse = T(1) / select(squared > T(0), length, T(1));
    return {T(v.x * inverse), T(v.y * inverse), T(v.z * inverse)};
}

/// A patch of the scheme: `Inside` evaluates interior points.
template <class Inside> struct GregoryDomainShader {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kSides = kDomain == TessellatorDomain::Quad ? 4 : 3;
    static constexpr int kControlPoints = Inside::kControlPoints;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = EdgeRegister<T>;
    template <class T> using Output = SurfacePoint<T>;

    bool true_normals = false; ///< of interior points: the rational surface's instead of frozen F

    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in,
                                         ControlPoints<ControlVertex<T>> const& patch,
                                         ControlPoints<EdgeRegister<T>> const& registers) const
    {
        SurfacePoint<T> s;
        if constexpr (kSides == 4) {
            mask_of<T> const on[4] = {in.v == T(0), in.u == T(1), in.v == T(1), in.u == T(0)};
            T const t[4] = {in.u, in.v, T(1) - in.u, T(1) - in.v};
            s = inside_or_boundary<T>(in, patch, registers, on, t);
        } else {
            mask_of<T> const on[3] = {in.w == T(0), in.u == T(0), in.v == T(0)};
            T const t[3] = {in.v, in.w, in.u};
            s = inside_or_boundary<T>(in, patch, registers, on, t);
        }
        s.normal = unit_or_zero(s.normal);
        return s;
    }

private:
    template <class T>
    constexpr SurfacePoint<T>
    inside_or_boundary(DomainInput<T> const& in, ControlPoints<ControlVertex<T>> const& patch,
                       ControlPoints<EdgeRegister<T>> const& registers,
                       mask_of<T> const (&on)[kSides], T const (&t)[kSides]) const
    {
        auto boundary = on[0] | on[1] | on[2];
        if constexpr (kSides == 4) boundary = boundary | on[3];
        float3<T> const zero(T(0), T(0), T(0));
        SurfacePoint<T> const inside = when(
            !boundary,
            [&] {
                TangentFrame<T> const frame = Inside::template evaluate<T>(patch, in, true_normals);
                return SurfacePoint<T>{frame.position, cross(frame.du, frame.dv)};
            },
            SurfacePoint<T>{zero, zero});
        return when(
            boundary, [&] { return boundary_point<kSides, T>(patch, registers, on, t); }, inside);
    }
};

struct RegularQuadInside {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 16;
    template <class T>
    static constexpr TangentFrame<T> evaluate(ControlPoints<ControlVertex<T>> const& patch,
                                              DomainInput<T> const& in, bool)
    {
        return regular_quad<T>(patch, in.u, in.v);
    }
};

struct GregoryQuadInside {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 20;
    template <class T>
    static constexpr TangentFrame<T> evaluate(ControlPoints<ControlVertex<T>> const& patch,
                                              DomainInput<T> const& in, bool true_normals)
    {
        return gregory_quad<T>(patch, in.u, in.v, true_normals);
    }
};

struct GregoryTriangleInside {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Tri;
    static constexpr int kControlPoints = 15;
    template <class T>
    static constexpr TangentFrame<T> evaluate(ControlPoints<ControlVertex<T>> const& patch,
                                              DomainInput<T> const& in, bool true_normals)
    {
        return gregory_triangle<T>(patch, in.u, in.v, in.w, true_normals);
    }
};

using RegularQuadDomainShader = GregoryDomainShader<RegularQuadInside>;
using GregoryQuadDomainShader = GregoryDomainShader<GregoryQuadInside>;
using GregoryTriangleDomainShader = GregoryDomainShader<GregoryTriangleInside>;

} // namespace tessemu
