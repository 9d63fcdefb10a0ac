// SPDX-License-Identifier: Apache-2.0
#include "emu/single_triangles.h"

#include <bit>

namespace tessemu {

void SingleTriangles::bind(RasterSetup const& setup, PrimitiveAssembler const& assembler)
{
    assembler_ = &assembler;
    bounds_ = setup.bounds[0];
}

void SingleTriangles::add(AssembledVertices& vertices, std::uint32_t const* v,
                          std::int32_t primitive_id, AssemblyCounters& counters)
{
    assembled_.clear();
    assembler_->assemble(vertices, v, 3, primitive_id, 0, counters, assembled_);
    for (AssembledPrimitive const& p : assembled_) draw(vertices, p);
}

// Cut to the bounds: eight pixels of a row at a time, in 64 bits.
void SingleTriangles::draw(AssembledVertices const& vs, AssembledPrimitive const& p)
{
    typedef std::int64_t I64 __attribute__((vector_size(64)));
    using F8 = Lanes<8>;
    auto const& [a, b, c] = p.v;
    std::int32_t const x[3] = {vs.x[a], vs.x[b], vs.x[c]}, y[3] = {vs.y[a], vs.y[b], vs.y[c]};
    Rect const pixels = pixel_bounds(x, y).intersect(bounds_);
    if (pixels.empty()) return;
    std::int64_t e0[3], dx[3], dy[3], strict[3];
    for (int i = 0; i < 3; ++i) {
        int const from = (i + 1) % 3, to = (i + 2) % 3;
        dx[i] = x[to] - x[from];
        dy[i] = y[to] - y[from];
        strict[i] = dy[i] < 0 || (dy[i] == 0 && dx[i] > 0) ? 0 : 1;
        e0[i] = dx[i] * (pixels.top * 256 + 128 - std::int64_t(y[from])) -
                dy[i] * (pixels.left * 256 + 128 - std::int64_t(x[from]));
    }
    std::int64_t const area =
        std::int64_t(x[1] - x[0]) * (y[2] - y[0]) - std::int64_t(x[2] - x[0]) * (y[1] - y[0]);
    F8 const inverse(1.0f / float(area));
    float const z0 = vs.z[a], dz1 = vs.z[b] - z0, dz2 = vs.z[c] - z0;
    float const w0 = vs.inverse_w[a], w1 = vs.inverse_w[b], w2 = vs.inverse_w[c];
    float const dw1 = w1 - w0, dw2 = w2 - w0;
    constexpr I64 kRamp{0, 256, 512, 768, 1024, 1280, 1536, 1792};
    for (int py = pixels.top; py < pixels.bottom; ++py)
        for (int px = pixels.left; px < pixels.right; px += 8) {
            I64 e[3], in = I64{} - 1;
            for (int i = 0; i < 3; ++i) {
                std::int64_t const here =
                    e0[i] + dx[i] * 256 * (py - pixels.top) - dy[i] * 256 * (px - pixels.left);
                e[i] = here - dy[i] * kRamp;
                in &= e[i] >= strict[i] + I64{};
            }
            std::uint32_t bits = 0;
            for (int l = 0; l < 8; ++l) bits |= std::uint32_t(in[l] & 1) << l;
            bits &= (1u << std::min(8, pixels.right - px)) - 1;
            if (bits == 0) continue;
            auto const n = std::size_t(std::popcount(bits));
            fragments_ += n;
            std::size_t const at = shading_.room(8);
            F8 const b1 = F8(__builtin_convertvector(e[1], F8::Raw)) * inverse,
                     b2 = F8(__builtin_convertvector(e[2], F8::Raw)) * inverse;
            F8 const z = F8(z0) + (b1 * F8(dz1) + b2 * F8(dz2));
            F8 const w = F8(1.0f) / (F8(w0) + (b1 * F8(dw1) + b2 * F8(dw2)));
            F8 const p1 = b1 * F8(w1) * w, p2 = b2 * F8(w2) * w;
            compress(z, bits).store(shading_.position[2] + at);
            compress(w, bits).store(shading_.position[3] + at);
            for (int k = 0; k < shading_.attributes(); ++k) {
                Interpolation const mode = shading_.modes()[std::size_t(k)];
                float const a0 = vs.component(a, k + 4), da1 = vs.component(b, k + 4) - a0,
                            da2 = vs.component(c, k + 4) - a0;
                bool const flat = mode == Interpolation::LinearNoperspective ||
                                  mode == Interpolation::LinearNoperspectiveCentroid;
                F8 const v = mode == Interpolation::Constant ? F8(vs.component(p.leading, k + 4))
                             : flat ? F8(a0) + (b1 * F8(da1) + b2 * F8(da2))
                                    : F8(a0) + (p1 * F8(da1) + p2 * F8(da2));
                compress(v, bits).store(shading_.attribute(std::size_t(k)) + at);
            }
            for (std::size_t q = at; bits; bits &= bits - 1, ++q) {
                int const l = std::countr_zero(bits);
                shading_.x[q] = px + l;
                shading_.y[q] = py;
                shading_.primitive_id[q] = p.primitive_id;
                shading_.front_face[q] = p.front_face ? -1 : 0;
                shading_.position[0][q] = float(px + l) + 0.5f;
                shading_.position[1][q] = float(py) + 0.5f;
            }
            shading_.add(n);
        }
}

} // namespace tessemu
