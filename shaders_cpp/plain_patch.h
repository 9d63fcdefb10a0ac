// Patches that are evaluated alike everywhere, on their edges and at their corners too, as LOOP10
// draws them: no patch constants, and no promise that both patches at an edge give it equal bits.
// watertight_patch.h has the domain shader that promises it.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "shaders_cpp/cage_form/cage_factors.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// Domain shader of a patch.
///
///     struct Inside {                          // an inside of a WatertightPatch is one
///         static constexpr TessellatorDomain kDomain;
///         static constexpr int kControlPoints; // 0: as many as the hull shader puts out
///         template <class T> using ControlPoint = ...;
///         template <class T> TangentFrame<T> evaluate(
///             ControlPoints<ControlPoint<T>> const&, DomainInput<T> const&,
///             bool true_normals) const;
///         std::vector<ResourceInfo> resources() const; // optional
///         template <class T> SecondOrderFrame<T> second_order( // optional: see curvature.h
///             ControlPoints<ControlPoint<T>> const&, DomainInput<T> const&) const;
///     };
///
/// The normal has unit length; it is z where the tangents are parallel or zero.
template <class Inside> struct PlainPatch {
    static constexpr TessellatorDomain kDomain = Inside::kDomain;
    static constexpr int kControlPoints = Inside::kControlPoints;
    template <class T> using ControlPoint = typename Inside::template ControlPoint<T>;
    template <class T> using PatchConstant = ControlVertex<T>; // none
    template <class T> using Output = SurfacePoint<T>;

    Inside inside = {};
    bool true_normals = false; ///< where the scheme tells them from its own

    std::vector<ResourceInfo> resources() const requires(requires(Inside i) { i.resources(); })
    {
        return inside.resources();
    }
    template <class T>
    constexpr SurfacePoint<T> operator()(DomainInput<T> const& in,
                                         ControlPoints<ControlPoint<T>> const& patch,
                                         ControlPoints<ControlVertex<T>> const&) const
    {
        TangentFrame<T> const s = inside.template evaluate<T>(patch, in, true_normals);
        return {s.position, unit_or(cross(s.du, s.dv), [] { return float3<T>(T(0), T(0), T(1)); })};
    }
    template <class T>
    constexpr auto second_order(ControlPoints<ControlPoint<T>> const& patch,
                                DomainInput<T> const& in) const
        requires(requires { this->inside.template second_order<T>(patch, in); })
    {
        return inside.template second_order<T>(patch, in);
    }
};

/// Hull shader of a patch whose domain shader evaluates a net of the cage's vertices as they are:
/// no operation but those of adaptive tess factors, which follow the cage's edges.
///
///     struct Net {
///         static constexpr int kPoints;     // vertices of the cage
///         static constexpr int kCorners[4]; // which of them are the patch's, from (0,0) on
///     };
template <class Net> struct NetHullShader {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    template <class T> using Input = ControlVertex<T>;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>; // none
    template <class T> using Points = ControlPoints<ControlVertex<T>>;

    TessFactorRule factors;

    int control_points() const { return Net::kPoints; }
    int patch_constants() const { return 0; }
    template <class T>
    ControlVertex<T> control_point(PatchInput, Points<T> const& in, int_of<T> id) const
    {
        return in[id];
    }
    template <class T>
    ControlVertex<T> patch_constant(PatchInput, Points<T> const&, Points<T> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, Points<T> const& in, Points<T> const&,
                                  Points<T> const&) const
    {
        return cage_factors<kDomain, T>(factors,
                                        [&](int k) { return in[Net::kCorners[k]].position; });
    }
};

} // namespace tessemu
