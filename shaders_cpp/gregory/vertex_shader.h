// Vertex shader of the stencil form: the control mesh as it is. Animation enters here.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/vertex_shader.h"
#include "shaders_cpp/records.h"

namespace tessemu {

struct StencilVertexShader {
    template <class T> using Input = ControlVertex<T>;
    template <class T> using Output = ControlVertex<T>;

    template <class T>
    ControlVertex<T> operator()(VertexInput<T> const&, ControlVertex<T> const& vertex) const
    {
        return vertex;
    }
};

} // namespace tessemu
