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

/// Clip planes that a vertex lies outside of. The guard bit is set where a vertex leaves the band
/// in which 16.8 coordinates are exact.
enum Outcode : std::uint8_t {
    kLeft = 1,
    kRight = 2,
    kBottom = 4,
    kTop = 8,
    kNear = 16,
    kFar = 32,
    kGuard = 64,  ///< beyond the guard band, or w <= 0: needs clipping
    kBroken = 128 ///< NaN or infinity: the triangle is dropped
};

/// Pixels whose centre lies in the bounding box of a snapped triangle. On the right and bottom side
/// the top-left rule excludes a centre that lies on the box, so those are left out.
inline Rect pixel_bounds(std::int32_t const (&x)[3], std::int32_t const (&y)[3])
{
    return {(std::min({x[0], x[1], x[2]}) + 127) >> 8, (std::min({y[0], y[1], y[2]}) + 127) >> 8,
            ((std::max({x[0], x[1], x[2]}) - 129) >> 8) + 1,
            ((std::max({y[0], y[1], y[2]}) - 129) >> 8) + 1};
}

/// Culls a projected triangle and appends it unless it can cover no pixel.
inline void emit_triangle(RasterizerState const& state, AssembledVertices const& vertices,
                          std::uint32_t a, std::uint32_t b, std::uint32_t c,
                          std::int32_t primitive_id, std::vector<AssembledTriangle>& out)
{
    std::int32_t const x[3] = {vertices.x[a], vertices.x[b], vertices.x[c]};
    std::int32_t const y[3] = {vertices.y[a], vertices.y[b], vertices.y[c]};
    if (pixel_bounds(x, y).empty()) return;
    std::int64_t const area =
        std::int64_t(x[1] - x[0]) * (y[2] - y[0]) - std::int64_t(x[2] - x[0]) * (y[1] - y[0]);
    if (area == 0) return; // covers nothing (R104)
    bool const clockwise = area > 0;
    bool const front = clockwise != state.front_counter_clockwise;
    if (state.cull == (front ? CullMode::Front : CullMode::Back)) return;
    out.push_back({{a, clockwise ? b : c, clockwise ? c : b}, primitive_id, front});
}

/// Clips a triangle that leaves the clip volume or the guard band, appends what is left (at most
/// 7).
void clip_triangle(RasterizerState const& state, Viewport const& viewport,
                   AssembledVertices& vertices, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                   std::int32_t primitive_id, AssemblyCounters& counters,
                   std::vector<AssembledTriangle>& out);

/// Assembles one triangle of vertices a, b, c.
inline void assemble_triangle(RasterizerState const& state, Viewport const& viewport,
                              AssembledVertices& vertices, std::uint32_t a, std::uint32_t b,
                              std::uint32_t c, std::int32_t primitive_id,
                              AssemblyCounters& counters, std::vector<AssembledTriangle>& out)
{
    constexpr unsigned kView = kLeft | kRight | kBottom | kTop | kNear | kFar;
    unsigned const ca = vertices.outcode[a], cb = vertices.outcode[b], cc = vertices.outcode[c];
    unsigned const some = ca | cb | cc;
    ++counters.clip_invocations;
    if ((some & kBroken) || (ca & cb & cc & kView)) return; // or wholly outside one plane
    if (some & (kNear | kFar | kGuard))
        return clip_triangle(state, viewport, vertices, a, b, c, primitive_id, counters, out);
    ++counters.clip_primitives;
    emit_triangle(state, vertices, a, b, c, primitive_id, out);
}

} // namespace tessemu
