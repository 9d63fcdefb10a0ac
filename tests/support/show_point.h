// The vertex shader of surfaces that no tessellator makes: points in a buffer, through the camera.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/vertex_shader.h"
#include "shaders_cpp/projection.h"
#include "shaders_cpp/records.h"

namespace tessemu::test {

struct ShowPoint {
    template <class T> using Input = SurfacePoint<T>;
    template <class T> using Output = ShadedVertex<T>;
    Matrix4 view_projection;
    template <class T>
    ShadedVertex<T> operator()(VertexInput<T> const&, SurfacePoint<T> const& p) const
    {
        return {transform(view_projection, p.position), p.normal};
    }
};

} // namespace tessemu::test
