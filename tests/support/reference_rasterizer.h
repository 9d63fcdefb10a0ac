// The rasterizer of a reader: one triangle after another, pixel by pixel, in submission order.
//
// Written from Direct3D's rules (docs/conformance.md, R90 to R135) for solid triangles with one
// sample: clip, divide, viewport, snap, cull, exact edge functions, depth test, one run of the
// pixel shader per fragment that passes. Shares no code with the library's rasterizers but the
// pixel shader.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_pipeline.h"

namespace tessemu::test {

class ReferenceRasterizer {
public:
    /// Draws into targets of its own, cleared to `color` and depth 1.
    ReferenceRasterizer(RasterTarget const& state, PixelShader const& pixel_shader,
                        std::array<float, 4> const& color);

    /// Shades with another shader from now on.
    void use(PixelShader const& pixel_shader) { pixel_shader_ = pixel_shader; }
    /// A triangle of clip-space vertices: position, then attributes.
    void triangle(std::array<std::vector<float>, 3> const& vertices, std::int32_t primitive_id);

    /// Number of pixels whose colour or depth differs in a bit.
    std::size_t differing_pixels(ColorTarget const& color, DepthTarget const& depth) const;

    std::uint64_t clip_invocations = 0, clip_primitives = 0, fragments = 0, passed = 0;

private:
    using Vertex = std::vector<float>;
    struct Screen {
        std::int64_t x, y;
        float z, inverse_w;
    };
    Screen project(Vertex const& v) const;
    void draw(Vertex const* v[3], std::int32_t primitive_id, Vertex const& leading);
    void shade(int x, int y, float z, float w, std::vector<float> const& attributes,
               std::int32_t primitive_id, bool front);

    RasterTarget const& state_;
    PixelShader pixel_shader_;
    Viewport viewport_;
    Rect bounds_;
    ColorTarget color_;
    DepthTarget depth_;
    StageBuffers buffers_;
};

} // namespace tessemu::test
