// SPDX-License-Identifier: Apache-2.0
#include "emu/primitive_assembly.h"

#include "emu/scalar.h"

#include <bit>
#include <limits>

namespace tessemu {

namespace {

// The guard band in pixels about the target's origin: 16 bits before the point, one bit kept back
// so that differences of coordinates fit a 32-bit integer with room.
constexpr float kGuardPixels = 16384.0f;

struct ViewportTransform {
    float scale_x, offset_x, scale_y, offset_y, scale_z, offset_z, min_z, max_z;

    explicit ViewportTransform(Viewport const& v)
        : scale_x(v.width * 0.5f),
          offset_x(v.x + v.width * 0.5f),
          scale_y(-v.height * 0.5f),
          offset_y(v.y + v.height * 0.5f),
          scale_z(v.max_depth - v.min_depth),
          offset_z(v.min_depth),
          min_z(v.min_depth),
          max_z(v.max_depth)
    {
    }
};

// Nearest 1/256, ties to even (R24, R101): adding 1.5 * 2^52 leaves the rounded integer in the low
// bits of the sum.
std::int32_t snap(float pixels)
{
    double const magic = 6755399441055744.0;
    return std::int32_t(std::bit_cast<std::int64_t>(double(pixels) * 256.0 + magic) -
                        std::bit_cast<std::int64_t>(magic));
}

void project(ViewportTransform const& t, float const position[4], std::size_t i,
             AssembledVertices& out)
{
    float const inverse_w = 1.0f / position[3];
    out.inverse_w[i] = inverse_w;
    out.x[i] = snap(position[0] * inverse_w * t.scale_x + t.offset_x);
    out.y[i] = snap(position[1] * inverse_w * t.scale_y + t.offset_y);
    float const z = position[2] * inverse_w * t.scale_z + t.offset_z;
    out.z[i] = z + 0.0f; // -0 becomes 0
}

struct ClipVertex {
    std::array<float, 32 * 4> c;
};

// Signed distance to a plane of the clip volume, >= 0 inside.
float distance(ClipVertex const& v, int plane, float guard_x, float guard_y)
{
    switch (plane) {
    case 0:
        return v.c[2];
    case 1:
        return v.c[3] - v.c[2];
    case 2:
        return guard_x * v.c[3] - v.c[0];
    case 3:
        return guard_x * v.c[3] + v.c[0];
    case 4:
        return guard_y * v.c[3] - v.c[1];
    default:
        return guard_y * v.c[3] + v.c[1];
    }
}

// From the inside vertex to the outside one, so that both triangles at a shared edge cut it alike.
ClipVertex cut(ClipVertex const& in, ClipVertex const& out, float d_in, float d_out, int components)
{
    float const t = d_in / (d_in - d_out);
    ClipVertex r;
    for (std::size_t k = 0; k < std::size_t(components); ++k)
        r.c[k] = in.c[k] + t * (out.c[k] - in.c[k]);
    return r;
}

} // namespace

void project_vertices(Viewport const& viewport, float const* shaded, std::size_t stride,
                      std::size_t count, int components, AssembledVertices& out)
{
    ViewportTransform const t(viewport);
    out.shaded = shaded;
    out.stride = stride;
    out.count = count;
    out.components = components;
    out.clipped.clear();
    out.x.resize(count), out.y.resize(count), out.z.resize(count), out.inverse_w.resize(count);
    out.outcode.resize(count);
    float const *X = shaded, *Y = shaded + stride, *Z = shaded + 2 * stride,
                *W = shaded + 3 * stride;
    for (std::size_t i = 0; i < count; ++i) {
        float const x = X[i], y = Y[i], z = Z[i], w = W[i];
        unsigned code = 0;
        code |= x < -w ? kLeft : 0;
        code |= x > w ? kRight : 0;
        code |= y < -w ? kBottom : 0;
        code |= y > w ? kTop : 0;
        code |= z < 0 ? kNear : 0;
        code |= z > w ? kFar : 0;
        code |= !(w > 0) ? kGuard : 0;
        float const sum = abs(x) + abs(y) + abs(z) + abs(w);
        code |= !(sum <= std::numeric_limits<float>::max()) ? kBroken : 0;
        float const inverse_w = 1.0f / w;
        float const px = x * inverse_w * t.scale_x + t.offset_x;
        float const py = y * inverse_w * t.scale_y + t.offset_y;
        bool const in_band = abs(px) <= kGuardPixels && abs(py) <= kGuardPixels;
        code |= !in_band ? kGuard : 0;
        out.outcode[i] = std::uint8_t(code);
        out.inverse_w[i] = inverse_w;
        out.x[i] = snap(in_band ? px : 0.0f);
        out.y[i] = snap(in_band ? py : 0.0f);
        out.z[i] = z * inverse_w * t.scale_z + t.offset_z + 0.0f;
    }
}

void clip_triangle(RasterizerState const& state, Viewport const& viewport,
                   AssembledVertices& vertices, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                   std::int32_t primitive_id, AssemblyCounters& counters,
                   std::vector<AssembledTriangle>& out)
{
    ViewportTransform const t(viewport);
    // |x/w * scale + offset| <= guard for every x/w within these bounds.
    float const guard_x = (kGuardPixels - abs(t.offset_x)) / abs(t.scale_x);
    float const guard_y = (kGuardPixels - abs(t.offset_y)) / abs(t.scale_y);
    std::vector<ClipVertex> polygon(3), next;
    std::uint32_t const ids[3] = {a, b, c};
    for (std::size_t i = 0; i < 3; ++i)
        for (int k = 0; k < vertices.components; ++k)
            polygon[i].c[std::size_t(k)] = vertices.component(ids[i], k);
    for (int plane = 0; plane < 6 && !polygon.empty(); ++plane) {
        next.clear();
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            ClipVertex const& p = polygon[i];
            ClipVertex const& q = polygon[(i + 1) % polygon.size()];
            float const dp = distance(p, plane, guard_x, guard_y);
            float const dq = distance(q, plane, guard_x, guard_y);
            if (dp >= 0) next.push_back(p);
            if ((dp >= 0) != (dq >= 0))
                next.push_back(dp >= 0 ? cut(p, q, dp, dq, vertices.components)
                                       : cut(q, p, dq, dp, vertices.components));
        }
        polygon.swap(next);
    }
    std::erase_if(polygon, [](ClipVertex const& v) { return !(v.c[3] > 0); });
    if (polygon.size() < 3) return;

    auto const first = std::uint32_t(vertices.x.size());
    for (ClipVertex const& v : polygon) {
        std::size_t const i = vertices.x.size();
        vertices.x.emplace_back(), vertices.y.emplace_back(), vertices.z.emplace_back();
        vertices.inverse_w.emplace_back();
        vertices.outcode.push_back(0);
        vertices.clipped.insert(vertices.clipped.end(), v.c.begin(),
                                v.c.begin() + vertices.components);
        project(t, v.c.data(), i, vertices);
    }
    for (std::uint32_t i = 1; i + 1 < polygon.size(); ++i) {
        ++counters.clip_primitives;
        emit_triangle(state, vertices, first, first + i, first + i + 1, primitive_id, out);
    }
}

} // namespace tessemu
