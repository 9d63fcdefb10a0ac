// SPDX-License-Identifier: Apache-2.0
#include "emu/rasterizer.h"

#include "emu/error.h"

namespace tessemu {

RenderTarget::RenderTarget(int width, int height, std::array<float, 4> clear_color)
    : width_(width),
      height_(height)
{
    for (int size : {width, height}) {
        if (size < 1)
            throw Error("render target size is " + std::to_string(size) +
                        ", at least 1 pixel is needed");
        if (size > kMaxSize)
            throw LimitError("render target size in pixels", std::uint64_t(size), kMaxSize);
    }
    pitch_ = std::size_t((width + kPadding - 1) / kPadding * kPadding);
    depth_.assign(pitch_ * std::size_t(height), 1.0f);
    color_.assign(depth_.size(), clear_color);
}

namespace {

// One edge: e(x, y) at pixel centres of a row, eight at a time.
constexpr int kWidth = 8;
typedef std::int64_t I64 __attribute__((vector_size(8 * kWidth)));
using F32 = Lanes<kWidth>;

struct Edge {
    std::int64_t dx, dy, at_origin;
    bool top_left;

    // From a to b, clockwise on the screen; the value is positive inside.
    Edge(std::int64_t ax, std::int64_t ay, std::int64_t bx, std::int64_t by)
        : dx(bx - ax),
          dy(by - ay),
          at_origin(dy * ax - dx * ay),
          top_left(dy < 0 || (dy == 0 && dx > 0))
    {
    }
    std::int64_t operator()(std::int64_t x, std::int64_t y) const
    {
        return dx * y - dy * x + at_origin;
    }
};

F32 to_float(I64 v)
{
    F32 r;
    r.raw = __builtin_convertvector(v, F32::Raw);
    return r;
}

I64 ramp(std::int64_t step)
{
    I64 r;
    for (int i = 0; i < kWidth; ++i) r[i] = step * i;
    return r;
}

} // namespace

TileRasterizer::TileRasterizer(RenderTarget& target, Rect bounds, Viewport const& viewport,
                               PixelProgram const* pixel_shader, StageBuffers const& buffers,
                               StageCounters& counters)
    : target_(target),
      bounds_(bounds),
      min_depth_(viewport.min_depth),
      max_depth_(viewport.max_depth),
      pixel_shader_(pixel_shader),
      buffers_(buffers),
      counters_(counters),
      attributes_(pixel_shader ? pixel_shader->input_floats() : 0)
{
    attribute_storage_.resize(std::size_t(attributes_) * (kQueue + kGroup));
    for (int k = 0; k < attributes_; ++k)
        attribute_rows_.push_back(attribute_storage_.data() + std::size_t(k) * (kQueue + kGroup));
}

void TileRasterizer::draw(AssembledVertices const& vertices, AssembledTriangle const& t)
{
    std::uint32_t const* v = t.v;
    std::int32_t const x[3] = {vertices.x[v[0]], vertices.x[v[1]], vertices.x[v[2]]};
    std::int32_t const y[3] = {vertices.y[v[0]], vertices.y[v[1]], vertices.y[v[2]]};
    Rect const pixels = pixel_bounds(x, y).intersect(bounds_);
    if (pixels.empty()) return;
    int const left = pixels.left, right = pixels.right - 1, top = pixels.top,
              bottom = pixels.bottom - 1;

    // Edge i lies opposite vertex i.
    Edge const edge[3] = {
        {x[1], y[1], x[2], y[2]}, {x[2], y[2], x[0], y[0]}, {x[0], y[0], x[1], y[1]}};
    std::int64_t const area = edge[0](x[0], y[0]);
    F32 const inverse_area = 1.0f / float(area);
    I64 const step[3] = {ramp(-edge[0].dy * 256), ramp(-edge[1].dy * 256), ramp(-edge[2].dy * 256)};

    float const z0 = vertices.z[v[0]], dz1 = vertices.z[v[1]] - z0, dz2 = vertices.z[v[2]] - z0;
    float const w0 = vertices.inverse_w[v[0]], dw1 = vertices.inverse_w[v[1]] - w0,
                dw2 = vertices.inverse_w[v[2]] - w0;
    float const w1 = vertices.inverse_w[v[1]], w2 = vertices.inverse_w[v[2]];
    float a0[kMaxAttributes], da1[kMaxAttributes], da2[kMaxAttributes];
    for (int k = 0; k < attributes_; ++k) {
        a0[k] = vertices.component(v[0], 4 + k);
        da1[k] = vertices.component(v[1], 4 + k) - a0[k];
        da2[k] = vertices.component(v[2], 4 + k) - a0[k];
    }

    int const aligned_left = left & ~(kWidth - 1);
    for (int py = top; py <= bottom; ++py) {
        float* const depth_row = target_.depth_row(py);
        for (int px = aligned_left; px <= right; px += kWidth) {
            std::int64_t const cx = std::int64_t(px) * 256 + 128, cy = std::int64_t(py) * 256 + 128;
            I64 e[3];
            I64 covered = I64{} == I64{};
            for (int i = 0; i < 3; ++i) {
                e[i] = edge[i](cx, cy) + step[i];
                covered &= e[i] >= I64{} + (edge[i].top_left ? 0 : 1);
            }
            typedef std::int32_t M32 __attribute__((vector_size(4 * kWidth)));
            Mask<kWidth> mask = __builtin_convertvector(covered, M32);
            IntLanes<kWidth> const column = IntLanes<kWidth>::iota() + IntLanes<kWidth>(px);
            mask = mask & (column >= IntLanes<kWidth>(left)) & (column <= IntLanes<kWidth>(right));
            std::uint32_t const bits = mask.bits();
            if (!bits) continue;
            covered_ += std::uint64_t(std::popcount(bits));

            F32 const b1 = to_float(e[1]) * inverse_area, b2 = to_float(e[2]) * inverse_area;
            F32 z = F32(z0) + (b1 * F32(dz1) + b2 * F32(dz2));
            z = select(z < F32(min_depth_), F32(min_depth_), z);
            z = select(z > F32(max_depth_), F32(max_depth_), z);
            F32 const stored = F32::load(depth_row + px);
            Mask<kWidth> const pass = mask & (z < stored);
            std::uint32_t const pass_bits = pass.bits();
            if (!pass_bits) continue;
            passes_ += std::uint64_t(std::popcount(pass_bits));
            select(pass, z, stored).store(depth_row + px);
            if (!pixel_shader_) continue;

            // Perspective: weights of a/w, divided by the interpolated 1/w (R120).
            F32 const w = F32(1.0f) / (F32(w0) + (b1 * F32(dw1) + b2 * F32(dw2)));
            F32 const p1 = b1 * F32(w1) * w, p2 = b2 * F32(w2) * w;
            F32 attribute[kMaxAttributes];
            for (int k = 0; k < attributes_; ++k)
                attribute[k] = F32(a0[k]) + (p1 * F32(da1[k]) + p2 * F32(da2[k]));
            for (std::uint32_t rest = pass_bits; rest; rest &= rest - 1) {
                int const l = std::countr_zero(rest);
                std::size_t const q = queued_++;
                pixel_x_[q] = px + l;
                pixel_y_[q] = py;
                position_[0][q] = float(px + l) + 0.5f;
                position_[1][q] = float(py) + 0.5f;
                position_[2][q] = z.raw[l];
                position_[3][q] = w.raw[l];
                primitive_id_[q] = t.primitive_id;
                front_face_[q] = t.front_face ? -1 : 0;
                for (int k = 0; k < attributes_; ++k)
                    attribute_storage_[std::size_t(k) * (kQueue + kGroup) + q] =
                        attribute[k].raw[l];
            }
            if (queued_ + kWidth > kQueue) flush();
        }
    }
}

void TileRasterizer::flush()
{
    if (queued_ == 0) return;
    FragmentBatch batch{};
    batch.count = queued_;
    for (int k = 0; k < 4; ++k) {
        batch.position[k] = position_[k];
        batch.color[k] = color_[k];
    }
    batch.attributes = attribute_rows_.data();
    batch.primitive_id = primitive_id_;
    batch.front_face = front_face_;
    pixel_shader_->run(batch, counters_, buffers_);
    for (std::size_t i = 0; i < queued_; ++i)
        target_.color_row(pixel_y_[i])[pixel_x_[i]] = {color_[0][i], color_[1][i], color_[2][i],
                                                       color_[3][i]};
    queued_ = 0;
}

} // namespace tessemu
