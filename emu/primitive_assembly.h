// Primitive assembly: clip test, clipping, perspective divide, viewport, snapping to 16.8.
//
// Near and far planes are clipped exactly; x and y only against a guard band (choice I-12), pixels
// outside the viewport are the scissor's business. A triangle with NaN or infinity is dropped (R94,
// I-13).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"

#include <cstdint>
#include <vector>

namespace tessemu {

/// Post-viewport vertices of a run of primitives. Attributes stay as the shader wrote them.
struct AssembledVertices {
    std::vector<std::int32_t> x, y;  ///< 1/256 pixel, y down
    std::vector<float> z, inverse_w; ///< depth in the viewport's range; 1/w
    std::vector<std::uint8_t> outcode;

    float const* shaded = nullptr; ///< component k of vertex i at [k * stride + i]; 0..3: position
    std::size_t stride = 0, count = 0;
    int components = 0;
    std::vector<float> clipped; ///< vertices that clipping made, `components` floats each

    /// Component k of vertex i, made by a shader or by the clipper.
    float component(std::uint32_t i, int k) const
    {
        if (i < count) return shaded[std::size_t(k) * stride + i];
        return clipped[(i - count) * std::size_t(components) + std::size_t(k)];
    }
};

/// A triangle ready for the rasterizer: clockwise on the screen, area above 0.
struct AssembledTriangle {
    std::uint32_t v[3];
    std::int32_t primitive_id;
    bool front_face;
};

struct AssemblyCounters {
    std::uint64_t clip_invocations = 0, clip_primitives = 0;
};

/// Projects `count` shaded vertices. One division a vertex.
void project_vertices(Viewport const& viewport, float const* shaded, std::size_t stride,
                      std::size_t count, int components, AssembledVertices& out);

/// Assembles one triangle of vertices a, b, c: clips it, culls it, appends what is left (at most
/// 7).
void assemble_triangle(RasterizerState const& state, Viewport const& viewport,
                       AssembledVertices& vertices, std::uint32_t a, std::uint32_t b,
                       std::uint32_t c, std::int32_t primitive_id, AssemblyCounters& counters,
                       std::vector<AssembledTriangle>& out);

} // namespace tessemu
