// Which patch a pixel shows, as numbers: for a float target.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/pixel_shader.h"
#include "shaders_cpp/pixel/surface_views.h"

namespace tessemu {

/// SV_PrimitiveID, and the draw's number in the frame. Exact below 2^24.
struct IdPixelShader {
    template <class T> using Input = SurfaceAttributes<T>;
    float draw = 0;
    template <class T>
    float4<T> operator()(PixelInput<T> const& pixel, SurfaceAttributes<T> const&) const
    {
        return {T(pixel.primitive_id), T(draw), T(0), T(1)};
    }
};

} // namespace tessemu
