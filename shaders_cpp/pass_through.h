// Shaders that hand on what they get: a vertex shader, and a hull shader with uniform tess factors.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/hull_shader.h"
#include "emu/vertex_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

/// The control mesh as it is, at rest.
struct PassThroughVertexShader {
    template <class T> using Input = ControlVertex<T>;
    template <class T> using Output = ControlVertex<T>;

    template <class T>
    ControlVertex<T> operator()(VertexInput<T> const&, ControlVertex<T> const& vertex) const
    {
        return vertex;
    }
};

/// Input control points as output control points (rule R46), no patch constants, one factor for
/// all.
template <TessellatorDomain kDomain_, int kControlPoints> struct PassThroughHullShader {
    static constexpr TessellatorDomain kDomain = kDomain_;
    template <class T> using Input = ControlVertex<T>;
    template <class T> using ControlPoint = ControlVertex<T>;
    template <class T> using PatchConstant = ControlVertex<T>;
    template <class T> using Points = ControlPoints<ControlVertex<T>>;

    float tess_factor = 1;

    int control_points() const { return kControlPoints; }
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
    std::array<T, 6> tess_factors(PatchInput, Points<T> const&, Points<T> const&,
                                  Points<T> const&) const
    {
        T const f(tess_factor);
        return {f, f, f, f, f, f};
    }
};

} // namespace tessemu
