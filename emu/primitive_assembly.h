// Primitive assembly: cull distances, clip test, clipping, perspective divide, viewport, snapping
// to 16.8, face culling, depth bias (rules R90 to R110).
//
// Near and far planes are clipped exactly; x and y only against a guard band (choice I-12), pixels
// outside the viewport are the scissor's business. A primitive with NaN or infinity is dropped
// (R94, I-13).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_state.h"
#include "emu/record.h"

#include <cstdint>
#include <span>
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

/// A point, line or triangle ready for the rasterizer; a triangle is clockwise on the screen and
/// its area is above 0.
struct AssembledPrimitive {
    std::uint32_t v[3];
    std::uint32_t leading; ///< vertex whose bits constant attributes take
    std::int32_t primitive_id;
    float depth_bias;      ///< added to the vertices' z
    std::uint8_t vertices; ///< 1, 2, 3
    bool front_face;
    std::uint8_t viewport; ///< index, in range
};

struct AssemblyCounters {
    std::uint64_t clip_invocations = 0, clip_primitives = 0;
};

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
    kBroken = 128 ///< NaN or infinity: the primitive is dropped
};
inline constexpr unsigned kViewPlanes = kLeft | kRight | kBottom | kTop | kNear | kFar;

/// Viewport scale and offset, and the guard band in pixels.
struct ViewportTransform {
    float scale_x, offset_x, scale_y, offset_y, scale_z, offset_z;
    float band_left, band_right, band_top, band_bottom;

    ViewportTransform(Viewport const& v, float guard_band_px);
};

/// Pixels whose centre lies in the bounding box of a snapped triangle. On the right and bottom side
/// the top-left rule excludes a centre that lies on the box, so those are left out.
inline Rect pixel_bounds(std::int32_t const (&x)[3], std::int32_t const (&y)[3])
{
    return {(std::min({x[0], x[1], x[2]}) + 127) >> 8, (std::min({y[0], y[1], y[2]}) + 127) >> 8,
            ((std::max({x[0], x[1], x[2]}) - 129) >> 8) + 1,
            ((std::max({y[0], y[1], y[2]}) - 129) >> 8) + 1};
}

class PrimitiveAssembler {
public:
    /// \param modes        of the attributes after SV_Position
    /// \param layout       of the vertices
    PrimitiveAssembler(RasterTarget const& target, std::span<Interpolation const> modes,
                       OutputLayout layout);

    /// Projects `count` shaded vertices, a multiple of 16. One division a vertex.
    /// \param viewports  index per vertex, or nothing: all take viewport 0
    void project(float const* shaded, std::size_t stride, std::size_t count,
                 std::span<std::uint8_t const> viewports, AssembledVertices& out) const;

    /// Appends what is left of a primitive of `n` vertices.
    void assemble(AssembledVertices& vertices, std::uint32_t const* v, int n,
                  std::int32_t primitive_id, std::uint8_t viewport, AssemblyCounters& counters,
                  std::vector<AssembledPrimitive>& out) const;

    bool front_is_clockwise() const { return !state_.front_counter_clockwise; }
    RasterizerState const& state() const { return state_; }

private:
    struct ClipVertex;
    bool culled_by_distance(AssembledVertices const& vertices, std::uint32_t const* v, int n) const;
    float plane_distance(ClipVertex const& v, int plane, ViewportTransform const& t) const;
    void cut(ClipVertex const& in, ClipVertex const& out, float t, std::uint32_t leading,
             AssembledVertices const& vertices, ClipVertex& result) const;
    std::uint32_t append(ClipVertex const& v, ViewportTransform const& t,
                         AssembledVertices& vertices) const;
    void clip(AssembledVertices& vertices, AssembledPrimitive const& primitive,
              AssemblyCounters& counters, std::vector<AssembledPrimitive>& out) const;
    void emit(AssembledVertices const& vertices, AssembledPrimitive primitive, unsigned edges,
              std::vector<AssembledPrimitive>& out) const;
    float depth_bias(AssembledVertices const& vertices, AssembledPrimitive const& p,
                     std::int64_t area) const;

    RasterizerState const& state_;
    std::vector<ViewportTransform> transforms_;
    std::vector<Interpolation> modes_;
    OutputLayout layout_;
    bool has_bias_;
    int unorm_depth_bits_; ///< 0: a float depth buffer
};

} // namespace tessemu
