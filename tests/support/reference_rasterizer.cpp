// SPDX-License-Identifier: Apache-2.0
#include "tests/support/reference_rasterizer.h"

#include <bit>
#include <cmath>
#include <cstring>

namespace tessemu::test {

namespace {
// The guard band: so many pixels around the viewport, and no more than 16 bits hold (I-12).
struct Band {
    float left, right, top, bottom;
    Band(Viewport const& v, float guard)
        : left(std::max(-16384.0f, v.x - guard)),
          right(std::min(16384.0f, v.x + v.width + guard)),
          top(std::max(-16384.0f, v.y - guard)),
          bottom(std::min(16384.0f, v.y + v.height + guard))
    {
    }
};
} // namespace

ReferenceRasterizer::ReferenceRasterizer(RasterTarget const& state, PixelShader const& pixel_shader,
                                         std::array<float, 4> const& color)
    : state_(state),
      pixel_shader_(pixel_shader),
      viewport_(state.viewports.at(0)),
      color_(state.color[0]->width(), state.color[0]->height(), state.color[0]->format()),
      depth_(color_.width(), color_.height()),
      buffers_({})
{
    color_.clear(color, ThreadPool(1));
    depth_.clear(1, 0, ThreadPool(1));
    Viewport const& v = viewport_;
    bounds_ = Rect{0, 0, color_.width(), color_.height()}.intersect(
        {int(std::floor(v.x)), int(std::floor(v.y)), int(std::floor(v.x + v.width)),
         int(std::floor(v.y + v.height))});
    if (state.rasterizer.scissor_enable) bounds_ = bounds_.intersect(state.scissors.at(0));
}

ReferenceRasterizer::Screen ReferenceRasterizer::project(Vertex const& v) const
{
    float const inverse_w = 1.0f / v[3];
    float const x =
        v[0] * inverse_w * (viewport_.width * 0.5f) + (viewport_.x + viewport_.width * 0.5f);
    float const y =
        v[1] * inverse_w * (-viewport_.height * 0.5f) + (viewport_.y + viewport_.height * 0.5f);
    float const z =
        v[2] * inverse_w * (viewport_.max_depth - viewport_.min_depth) + viewport_.min_depth + 0.0f;
    // nearbyint rounds ties to even; the band holds clip vertices that rounding pushed past it.
    Band const band(viewport_, state_.rasterizer.guard_band_px);
    auto const snap = [](float p) { return std::int64_t(std::nearbyint(double(p) * 256)); };
    return {snap(std::min(std::max(x, band.left), band.right)),
            snap(std::min(std::max(y, band.top), band.bottom)), z, inverse_w};
}

void ReferenceRasterizer::triangle(std::array<std::vector<float>, 3> const& in,
                                   std::int32_t primitive_id)
{
    DenormalMode const flush(DenormalMode::Flush);
    ++clip_invocations;
    bool const depth_clip = state_.rasterizer.depth_clip_enable;
    // Outside of one plane of the view volume altogether, or broken.
    Band const band(viewport_, state_.rasterizer.guard_band_px);
    bool outside[6] = {true, true, true, true, depth_clip, depth_clip}, cut = false;
    for (Vertex const& v : in) {
        float const x = v[0], y = v[1], z = v[2], w = v[3];
        if (!(std::fabs(x) + std::fabs(y) + std::fabs(z) + std::fabs(w) <= 3.402823466e38f)) return;
        bool const out[6] = {x<-w, x> w, y<-w, y> w, z<0, z> w};
        for (int i = 0; i < 6; ++i) outside[i] = outside[i] && out[i];
        float const inverse_w = 1.0f / w;
        float const px =
            x * inverse_w * (viewport_.width * 0.5f) + (viewport_.x + viewport_.width * 0.5f);
        float const py =
            y * inverse_w * (-viewport_.height * 0.5f) + (viewport_.y + viewport_.height * 0.5f);
        bool const in_band =
            px >= band.left && px <= band.right && py >= band.top && py <= band.bottom;
        cut = cut || !(w > 0) || !in_band || (depth_clip && (out[4] || out[5]));
    }
    for (bool o : outside)
        if (o) return;

    std::vector<Vertex> polygon(in.begin(), in.end());
    if (cut) {
        float const sx = viewport_.width * 0.5f, ox = viewport_.x + sx;
        float const sy = -viewport_.height * 0.5f, oy = viewport_.y + viewport_.height * 0.5f;
        auto const distance = [&](Vertex const& v, int plane) {
            switch (plane) {
            case 0:
                return v[2];
            case 1:
                return v[3] - v[2];
            case 2:
                return v[0] - (band.left - ox) / sx * v[3];
            case 3:
                return (band.right - ox) / sx * v[3] - v[0];
            case 4:
                return v[1] - (band.bottom - oy) / sy * v[3];
            default:
                return (band.top - oy) / sy * v[3] - v[1];
            }
        };
        for (int plane = depth_clip ? 0 : 2; plane < 6; ++plane) {
            std::vector<Vertex> next;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                Vertex const &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
                float const dp = distance(p, plane), dq = distance(q, plane);
                if (dp >= 0) next.push_back(p);
                if ((dp >= 0) == (dq >= 0)) continue;
                Vertex const &a = dp >= 0 ? p : q, &b = dp >= 0 ? q : p;
                float const t = dp >= 0 ? dp / (dp - dq) : dq / (dq - dp);
                Vertex r(a.size());
                for (std::size_t k = 0; k < 4; ++k) r[k] = a[k] + t * (b[k] - a[k]);
                float const s = t * b[3] / r[3];
                for (std::size_t k = 4; k < a.size(); ++k) {
                    auto const& modes = pixel_shader_->info().interpolation;
                    auto const mode = k - 4 < modes.size() ? modes[k - 4] : Interpolation::Linear;
                    r[k] = mode == Interpolation::Constant              ? in[0][k]
                           : mode == Interpolation::LinearNoperspective ? a[k] + s * (b[k] - a[k])
                                                                        : a[k] + t * (b[k] - a[k]);
                }
                next.push_back(r);
            }
            polygon = next;
        }
        std::erase_if(polygon, [](Vertex const& v) { return !(v[3] > 0); });
    }
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        ++clip_primitives;
        Vertex const* v[3] = {&polygon[0], &polygon[i], &polygon[i + 1]};
        draw(v, primitive_id, in[0]);
    }
}

void ReferenceRasterizer::draw(Vertex const* v[3], std::int32_t primitive_id, Vertex const& leading)
{
    Screen p[3] = {project(*v[0]), project(*v[1]), project(*v[2])};
    std::int64_t area =
        (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    bool const front = area != 0 && (area > 0) != state_.rasterizer.front_counter_clockwise;
    if (state_.rasterizer.cull == (front ? CullMode::Front : CullMode::Back) || area == 0) return;
    if (area < 0) {
        std::swap(v[1], v[2]);
        std::swap(p[1], p[2]);
        area = -area;
    }
    auto const edge = [&](int from, int to, std::int64_t x, std::int64_t y) {
        return (p[to].x - p[from].x) * (y - p[from].y) - (p[to].y - p[from].y) * (x - p[from].x);
    };
    auto const owns = [&](int from, int to) { // top or left
        std::int64_t const dx = p[to].x - p[from].x, dy = p[to].y - p[from].y;
        return dy < 0 || (dy == 0 && dx > 0);
    };
    float const inverse = 1.0f / float(area);
    auto const low = [](std::int64_t a, std::int64_t b, std::int64_t c) {
        return int(std::floor(double(std::min({a, b, c})) / 256));
    };
    auto const high = [](std::int64_t a, std::int64_t b, std::int64_t c) {
        return int(std::ceil(double(std::max({a, b, c})) / 256)) + 1;
    };
    Rect const box = Rect{low(p[0].x, p[1].x, p[2].x), low(p[0].y, p[1].y, p[2].y),
                          high(p[0].x, p[1].x, p[2].x), high(p[0].y, p[1].y, p[2].y)}
                         .intersect(bounds_);
    for (int y = box.top; y < box.bottom; ++y)
        for (int x = box.left; x < box.right; ++x) {
            std::int64_t const cx = x * 256 + 128, cy = y * 256 + 128;
            std::int64_t const e[3] = {edge(1, 2, cx, cy), edge(2, 0, cx, cy), edge(0, 1, cx, cy)};
            bool const own[3] = {owns(1, 2), owns(2, 0), owns(0, 1)};
            bool inside = true;
            for (int i = 0; i < 3; ++i) inside = inside && (e[i] > 0 || (e[i] == 0 && own[i]));
            if (!inside) continue;
            ++fragments;
            float const b1 = float(e[1]) * inverse, b2 = float(e[2]) * inverse;
            float const z = p[0].z + (b1 * (p[1].z - p[0].z) + b2 * (p[2].z - p[0].z));
            float const clamped = z >= viewport_.min_depth
                                      ? (z <= viewport_.max_depth ? z : viewport_.max_depth)
                                      : viewport_.min_depth;
            std::uint32_t& stored = depth_.codes()[depth_.index(x, y)];
            std::uint32_t const code = std::bit_cast<std::uint32_t>(clamped) & 0x7fffffffu;
            bool const or_equal = state_.depth_stencil.depth_func == Comparison::LessEqual;
            if (!(code < stored || (or_equal && code == stored))) continue;
            ++passed;
            stored = code;
            float const w = 1.0f / (p[0].inverse_w + (b1 * (p[1].inverse_w - p[0].inverse_w) +
                                                      b2 * (p[2].inverse_w - p[0].inverse_w)));
            float const p1 = b1 * p[1].inverse_w * w, p2 = b2 * p[2].inverse_w * w;
            std::vector<float> attributes;
            for (std::size_t k = 0; k < pixel_shader_->info().interpolation.size(); ++k) {
                float const a0 = (*v[0])[k + 4], d1 = (*v[1])[k + 4] - a0, d2 = (*v[2])[k + 4] - a0;
                switch (pixel_shader_->info().interpolation[k]) {
                case Interpolation::Constant:
                    attributes.push_back(leading[k + 4]);
                    break;
                case Interpolation::LinearNoperspective:
                    attributes.push_back(a0 + (b1 * d1 + b2 * d2));
                    break;
                default:
                    attributes.push_back(a0 + (p1 * d1 + p2 * d2));
                }
            }
            shade(x, y, z, w, attributes, primitive_id, front);
        }
}

void ReferenceRasterizer::shade(int x, int y, float z, float w,
                                std::vector<float> const& attributes, std::int32_t primitive_id,
                                bool front)
{
    constexpr std::size_t kGroup = 16;
    std::vector<float> rows((attributes.size() + 8) * kGroup);
    std::vector<float const*> attribute;
    for (std::size_t k = 0; k < attributes.size(); ++k) {
        rows[k * kGroup] = attributes[k];
        attribute.push_back(&rows[k * kGroup]);
    }
    float* const rest = rows.data() + attributes.size() * kGroup;
    float* color[4];
    FragmentBatch b{};
    b.count = 1;
    float const position[4] = {float(x) + 0.5f, float(y) + 0.5f, z, w};
    for (std::size_t k = 0; k < 4; ++k) {
        rest[k * kGroup] = position[k];
        b.position[k] = rest + k * kGroup;
        color[k] = rest + (4 + k) * kGroup;
    }
    std::int32_t const id[kGroup] = {primitive_id}, face[kGroup] = {front ? -1 : 0},
                       zero[kGroup] = {}, one[kGroup] = {1};
    b.attributes = attribute.data();
    b.primitive_id = id;
    b.front_face = face;
    b.sample_index = zero;
    b.coverage = one;
    b.color = color;
    StageCounters counters;
    pixel_shader_.run(b, counters, buffers_);
    encode(color_.format(), {color[0][0], color[1][0], color[2][0], color[3][0]},
           color_.texel(x, y));
}

std::size_t ReferenceRasterizer::differing_pixels(ColorTarget const& color,
                                                  DepthTarget const& depth) const
{
    std::size_t n = 0;
    for (int y = 0; y < color.height(); ++y)
        for (int x = 0; x < color.width(); ++x)
            n += std::memcmp(color.texel(x, y), color_.texel(x, y), color.texel_bytes()) != 0 ||
                 depth.codes()[depth.index(x, y)] != depth_.codes()[depth_.index(x, y)];
    return n;
}

} // namespace tessemu::test
