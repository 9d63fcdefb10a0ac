// SPDX-License-Identifier: Apache-2.0
#include "emu/primitive_assembly.h"

#include "emu/lane_memory.h"

#include <bit>
#include <cassert>
#include <limits>

namespace tessemu {

namespace {

// Half the width of the widest band: 16 bits before the point, one kept back so that differences of
// coordinates fit a 32-bit integer with room.
constexpr float kBandPixels = 16384.0f;

constexpr int N = kRasterLanes;
using F = Lanes<N>;
using I = IntLanes<N>;

// Nearest 1/256, ties to even (R24, R101), of pixels in the band: adding 1.5 * 2^23 leaves the
// rounded integer in the low bits of the sum.
constexpr float kSnapMagic = 12582912.0f;

I snap(F pixels)
{
    F const sum = pixels * F(256.0f) + F(kSnapMagic);
    return I(I::Raw(sum.raw)) - I(std::bit_cast<std::int32_t>(kSnapMagic));
}
std::int32_t snap(float pixels)
{
    return std::bit_cast<std::int32_t>(pixels * 256.0f + kSnapMagic) -
           std::bit_cast<std::int32_t>(kSnapMagic);
}

// A vertex by the viewport; the same text on lanes and on a single float.
template <class T> struct Projected {
    T px, py, z, inverse_w;
};
template <class T> Projected<T> through_viewport(ViewportTransform const& t, T x, T y, T z, T w)
{
    T const inverse_w = T(1.0f) / w;
    return {x * inverse_w * T(t.scale_x) + T(t.offset_x),
            y * inverse_w * T(t.scale_y) + T(t.offset_y),
            z * inverse_w * T(t.scale_z) + T(t.offset_z) + T(0.0f), // -0 becomes 0
            inverse_w};
}

void project_group(ViewportTransform const& t, float const* shaded, std::size_t stride,
                   std::size_t i, AssembledVertices& out)
{
    F const x = F::load(shaded + i), y = F::load(shaded + stride + i),
            z = F::load(shaded + 2 * stride + i), w = F::load(shaded + 3 * stride + i);
    auto const bit = [](Mask<N> m, int code) { return I(I::Raw(m.raw & code)); };
    I code = bit(x < -w, kLeft) | bit(x > w, kRight) | bit(y < -w, kBottom) | bit(y > w, kTop) |
             bit(z < F(0.0f), kNear) | bit(z > w, kFar) | bit(!(w > F(0.0f)), kGuard);
    F const sum = abs(x) + abs(y) + abs(z) + abs(w);
    code = code | bit(!(sum <= F(std::numeric_limits<float>::max())), kBroken);
    Projected<F> const p = through_viewport(t, x, y, z, w);
    Mask<N> const in_band = (p.px >= F(t.band_left)) & (p.px <= F(t.band_right)) &
                            (p.py >= F(t.band_top)) & (p.py <= F(t.band_bottom));
    code = code | bit(!in_band, kGuard);
    store_bytes(code, out.outcode.data() + i);
    I const X = snap(select(in_band, p.px, F(0.0f))), Y = snap(select(in_band, p.py, F(0.0f)));
    __builtin_memcpy(out.x.data() + i, &X.raw, sizeof X.raw);
    __builtin_memcpy(out.y.data() + i, &Y.raw, sizeof Y.raw);
    p.z.store(out.z.data() + i);
    p.inverse_w.store(out.inverse_w.data() + i);
}

// R110. 0: a float depth buffer.
int unorm_depth_bits(RasterTarget const& target)
{
    if (!target.depth)
        return target.rasterizer.unbound_depth_bias == UnboundDepthBias::Unorm24 ? 24 : 0;
    switch (target.depth->format()) {
    case Format::D16_UNORM:
        return 16;
    case Format::D24_UNORM_S8_UINT:
        return 24;
    default:
        return 0;
    }
}

} // namespace

struct PrimitiveAssembler::ClipVertex {
    std::array<float, 32 * 4> c;
};

ViewportTransform::ViewportTransform(Viewport const& v, float guard)
    : scale_x(v.width * 0.5f),
      offset_x(v.x + v.width * 0.5f),
      scale_y(-v.height * 0.5f),
      offset_y(v.y + v.height * 0.5f),
      scale_z(v.max_depth - v.min_depth),
      offset_z(v.min_depth),
      band_left(std::max(-kBandPixels, v.x - guard)),
      band_right(std::min(kBandPixels, v.x + v.width + guard)),
      band_top(std::max(-kBandPixels, v.y - guard)),
      band_bottom(std::min(kBandPixels, v.y + v.height + guard))
{
}

PrimitiveAssembler::PrimitiveAssembler(RasterTarget const& target,
                                       std::span<Interpolation const> modes, OutputLayout layout)
    : state_(target.rasterizer),
      modes_(modes.begin(), modes.end()),
      layout_(layout),
      has_bias_(target.rasterizer.depth_bias != 0 ||
                target.rasterizer.slope_scaled_depth_bias != 0),
      unorm_depth_bits_(unorm_depth_bits(target))
{
    for (Viewport const& v : target.viewports)
        transforms_.emplace_back(v, target.rasterizer.guard_band_px);
    if (transforms_.empty()) transforms_.emplace_back(Viewport{}, 0.0f);
    modes_.resize(std::size_t(std::max(0, layout.floats - 4)), Interpolation::Linear);
}

void PrimitiveAssembler::project(float const* shaded, std::size_t stride, std::size_t count,
                                 std::span<std::uint8_t const> viewports,
                                 AssembledVertices& out) const
{
    assert(count % 16 == 0);
    out.shaded = shaded;
    out.stride = stride;
    out.count = count;
    out.components = layout_.floats;
    out.clipped.clear();
    out.x.resize(count), out.y.resize(count), out.z.resize(count), out.inverse_w.resize(count);
    out.outcode.resize(count);
    for (std::size_t i = 0; i < count; i += std::size_t(N))
        project_group(transforms_[0], shaded, stride, i, out);
    if (transforms_.size() == 1 || viewports.empty()) return;
    // Vertices of another viewport: a group each, of which one lane counts.
    AssembledVertices one;
    for (auto* v : {&one.x, &one.y}) v->resize(std::size_t(N));
    one.z.resize(std::size_t(N)), one.inverse_w.resize(std::size_t(N)),
        one.outcode.resize(std::size_t(N));
    for (std::size_t i = 0; i < count; ++i) {
        if (viewports[i] == 0) continue;
        float position[4 * N];
        for (std::size_t k = 0; k < 4; ++k)
            std::fill_n(position + k * std::size_t(N), N, shaded[k * stride + i]);
        project_group(transforms_[viewports[i]], position, std::size_t(N), 0, one);
        out.x[i] = one.x[0], out.y[i] = one.y[0], out.z[i] = one.z[0];
        out.inverse_w[i] = one.inverse_w[0], out.outcode[i] = one.outcode[0];
    }
}

// R92, R93: NaN counts as below 0 for culling and drops the primitive for clipping.
bool PrimitiveAssembler::culled_by_distance(AssembledVertices const& vertices,
                                            std::uint32_t const* v, int n) const
{
    int const clip = layout_.floats - layout_.cull_distances - layout_.clip_distances;
    for (int k = clip; k < clip + layout_.clip_distances; ++k)
        for (int i = 0; i < n; ++i) {
            float const d = vertices.component(v[i], k);
            if (!(d == d)) return true;
        }
    for (int k = clip + layout_.clip_distances; k < layout_.floats; ++k) {
        bool all = true;
        for (int i = 0; i < n; ++i) all = all && !(vertices.component(v[i], k) >= 0);
        if (all) return true;
    }
    return false;
}

void PrimitiveAssembler::assemble(AssembledVertices& vertices, std::uint32_t const* v, int n,
                                  std::int32_t primitive_id, std::uint8_t viewport,
                                  AssemblyCounters& counters,
                                  std::vector<AssembledPrimitive>& out) const
{
    unsigned some = 0, every = 0xff;
    for (int i = 0; i < n; ++i) {
        some |= vertices.outcode[v[i]];
        every &= vertices.outcode[v[i]];
    }
    ++counters.clip_invocations;
    if (some & kBroken) return;
    if ((layout_.clip_distances || layout_.cull_distances) && culled_by_distance(vertices, v, n))
        return;
    unsigned const depth_planes = state_.depth_clip_enable ? kNear | kFar : 0u;
    if (every & kViewPlanes & ~((kNear | kFar) & ~depth_planes)) return; // outside of one plane
    AssembledPrimitive p{{v[0], v[n > 1 ? 1 : 0], v[n > 2 ? 2 : 0]},
                         v[0],
                         primitive_id,
                         0,
                         std::uint8_t(n),
                         true,
                         viewport};
    if (some & (depth_planes | kGuard)) {
        if (n == 1) return;
        return clip(vertices, p, counters, out);
    }
    ++counters.clip_primitives;
    emit(vertices, p, 7, out);
}

float PrimitiveAssembler::plane_distance(ClipVertex const& v, int plane,
                                         ViewportTransform const& t) const
{
    float const w = v.c[3];
    switch (
        plane) { // left and right, top and bottom of the band, where the viewport has any extent
    case 0:
        return v.c[2];
    case 1:
        return w - v.c[2];
    case 2:
        return v.c[0] - (t.band_left - t.offset_x) / t.scale_x * w;
    case 3:
        return (t.band_right - t.offset_x) / t.scale_x * w - v.c[0];
    case 4:
        return v.c[1] - (t.band_bottom - t.offset_y) / t.scale_y * w;
    default:
        return (t.band_top - t.offset_y) / t.scale_y * w - v.c[1];
    }
}

// in + t (out - in), from the inside vertex to the outside one, so that both triangles at a shared
// edge cut it alike. Attributes follow their interpolation (R95).
void PrimitiveAssembler::cut(ClipVertex const& in, ClipVertex const& out, float t,
                             std::uint32_t leading, AssembledVertices const& vertices,
                             ClipVertex& r) const
{
    for (std::size_t k = 0; k < 4; ++k) r.c[k] = in.c[k] + t * (out.c[k] - in.c[k]);
    // The same place on the screen, between the projected ends.
    float const on_screen = t * out.c[3] / r.c[3];
    for (std::size_t k = 4; k < std::size_t(layout_.floats); ++k) {
        switch (modes_[k - 4]) {
        case Interpolation::Constant:
            r.c[k] = vertices.component(leading, int(k));
            break;
        case Interpolation::LinearNoperspective:
        case Interpolation::LinearNoperspectiveCentroid:
        case Interpolation::LinearNoperspectiveSample:
            r.c[k] = in.c[k] + on_screen * (out.c[k] - in.c[k]);
            break;
        default:
            r.c[k] = in.c[k] + t * (out.c[k] - in.c[k]);
        }
    }
}

std::uint32_t PrimitiveAssembler::append(ClipVertex const& v, ViewportTransform const& t,
                                         AssembledVertices& vertices) const
{
    auto const i = std::uint32_t(vertices.x.size());
    Projected<float> const p = through_viewport(t, v.c[0], v.c[1], v.c[2], v.c[3]);
    vertices.x.push_back(snap(std::clamp(p.px, t.band_left, t.band_right)));
    vertices.y.push_back(snap(std::clamp(p.py, t.band_top, t.band_bottom)));
    vertices.z.push_back(p.z);
    vertices.inverse_w.push_back(p.inverse_w);
    vertices.outcode.push_back(0);
    vertices.clipped.insert(vertices.clipped.end(), v.c.begin(), v.c.begin() + layout_.floats);
    return i;
}

void PrimitiveAssembler::clip(AssembledVertices& vertices, AssembledPrimitive const& primitive,
                              AssemblyCounters& counters,
                              std::vector<AssembledPrimitive>& out) const
{
    ViewportTransform const& t = transforms_[primitive.viewport];
    if (t.scale_x == 0 || t.scale_y == 0) return; // an empty viewport shows nothing
    struct Corner {
        ClipVertex v;
        bool original_edge; // to the next corner
    };
    bool const line = primitive.vertices == 2;
    std::vector<Corner> polygon(primitive.vertices), next;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        polygon[i].original_edge = true;
        for (int k = 0; k < layout_.floats; ++k)
            polygon[i].v.c[std::size_t(k)] = vertices.component(primitive.v[i], k);
    }
    for (int plane = state_.depth_clip_enable ? 0 : 2; plane < 6 && !polygon.empty(); ++plane) {
        next.clear();
        std::size_t const sides = line ? polygon.size() - 1 : polygon.size();
        for (std::size_t i = 0; i < sides; ++i) {
            Corner const& p = polygon[i];
            Corner const& q = polygon[(i + 1) % polygon.size()];
            float const dp = plane_distance(p.v, plane, t), dq = plane_distance(q.v, plane, t);
            if (dp >= 0) next.push_back(p);
            if ((dp >= 0) != (dq >= 0)) {
                // Leaving, the new edge runs along the plane; entering, along the old edge.
                next.push_back({{}, dp < 0 && p.original_edge});
                bool const leaving = dp >= 0;
                cut(leaving ? p.v : q.v, leaving ? q.v : p.v,
                    leaving ? dp / (dp - dq) : dq / (dq - dp), primitive.leading, vertices,
                    next.back().v);
            }
            if (line && dq >= 0) next.push_back(q);
        }
        polygon.swap(next);
        if (line && polygon.size() < 2) return;
    }
    std::erase_if(polygon, [](Corner const& c) { return !(c.v.c[3] > 0); });
    if (polygon.size() < primitive.vertices) return;

    std::vector<std::uint32_t> ids;
    for (Corner const& c : polygon) ids.push_back(append(c.v, t, vertices));
    AssembledPrimitive p = primitive;
    if (line) {
        p.v[0] = ids[0], p.v[1] = ids[1];
        ++counters.clip_primitives;
        return emit(vertices, p, 7, out);
    }
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        ++counters.clip_primitives;
        p.v[0] = ids[0], p.v[1] = ids[i], p.v[2] = ids[i + 1];
        unsigned const edges =
            unsigned(i == 1 && polygon[0].original_edge) | unsigned(polygon[i].original_edge) << 1 |
            unsigned(i + 2 == polygon.size() && polygon[i + 1].original_edge) << 2;
        emit(vertices, p, edges, out);
    }
}

// R110. The slope is that of the plane through the snapped vertices, in depth per pixel.
float PrimitiveAssembler::depth_bias(AssembledVertices const& vertices, AssembledPrimitive const& p,
                                     std::int64_t area) const
{
    auto const& [a, b, c] = p.v;
    float const dz1 = vertices.z[b] - vertices.z[a], dz2 = vertices.z[c] - vertices.z[a];
    float const scale = 256.0f / float(area);
    float const dzdx =
        (dz1 * float(vertices.y[c] - vertices.y[a]) - dz2 * float(vertices.y[b] - vertices.y[a])) *
        scale;
    float const dzdy =
        (dz2 * float(vertices.x[b] - vertices.x[a]) - dz1 * float(vertices.x[c] - vertices.x[a])) *
        scale;
    float const slope = std::max(abs(dzdx), abs(dzdy));
    float unit;
    if (unorm_depth_bits_) {
        unit = float_from_unorm(1, unorm_depth_bits_);
    } else {
        float const most = std::max({abs(vertices.z[a]), abs(vertices.z[b]), abs(vertices.z[c])});
        std::uint32_t const exponent = std::bit_cast<std::uint32_t>(most) >> 23;
        unit = exponent > 23 ? std::bit_cast<float>((exponent - 23) << 23) : 0.0f;
    }
    float bias = float(state_.depth_bias) * unit;
    if (state_.slope_scaled_depth_bias != 0) bias += state_.slope_scaled_depth_bias * slope;
    if (state_.depth_bias_clamp > 0) bias = std::min(state_.depth_bias_clamp, bias);
    if (state_.depth_bias_clamp < 0) bias = std::max(state_.depth_bias_clamp, bias);
    return bias;
}

void PrimitiveAssembler::emit(AssembledVertices const& vertices, AssembledPrimitive p,
                              unsigned edges, std::vector<AssembledPrimitive>& out) const
{
    if (p.vertices != 3) {
        out.push_back(p);
        return;
    }
    auto const& [a, b, c] = p.v;
    std::int32_t const x[3] = {vertices.x[a], vertices.x[b], vertices.x[c]};
    std::int32_t const y[3] = {vertices.y[a], vertices.y[b], vertices.y[c]};
    std::int64_t const area =
        std::int64_t(x[1] - x[0]) * (y[2] - y[0]) - std::int64_t(x[2] - x[0]) * (y[1] - y[0]);
    bool const clockwise = area > 0; // zero area is back-facing (R104)
    p.front_face = area != 0 && clockwise == front_is_clockwise();
    if (state_.cull == (p.front_face ? CullMode::Front : CullMode::Back)) return;
    if (has_bias_ && area != 0) p.depth_bias = depth_bias(vertices, p, area);
    if (state_.fill == FillMode::Wireframe) {
        AssembledPrimitive line = p;
        line.vertices = 2;
        for (int i = 0; i < 3; ++i) {
            if (!(edges >> i & 1)) continue;
            line.v[0] = p.v[i];
            line.v[1] = p.v[(i + 1) % 3];
            out.push_back(line);
        }
        return;
    }
    if (area == 0) return; // covers nothing (R104)
    if (!clockwise) std::swap(p.v[1], p.v[2]);
    out.push_back(p);
}

} // namespace tessemu
