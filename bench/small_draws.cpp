// Thousands of small draws a frame, each bringing its own constants: 4,096 bicubic patches of 9 x 9
// vertices by a vertex shader that has the control points as constants, 512x512.
//
// What a draw costs beside its vertices and pixels shows here: binding shaders, making the
// pipeline, starting threads. Counters: microseconds a draw, vertex shader runs a draw.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graphics_pipeline.h"
#include "shaders_cpp/bezier.h"
#include "shaders_cpp/pixel/surface_views.h"
#include "shaders_cpp/projection.h"

#include <benchmark/benchmark.h>

#include <cstring>

namespace tessemu {
namespace {

constexpr int kSide = 64, kDraws = kSide * kSide, kGrid = 9, kSize = 512;

template <class T> struct GridVertex {
    float2<T> at;
    static constexpr auto signature() { return std::tuple{&GridVertex::at}; }
};

/// \cost  162 mul of the patch, 12 of the projection
struct BicubicVertexShader {
    template <class T> using Input = GridVertex<T>;
    template <class T> using Output = ShadedVertex<T>;

    std::array<std::array<std::array<float, 3>, 4>, 4> control_points;
    Matrix4 view_projection;

    template <class T>
    ShadedVertex<T> operator()(VertexInput<T> const&, GridVertex<T> const& vertex) const
    {
        auto const point = [&](int i, int j) -> float3<T> {
            std::array<float, 3> const& p = control_points[std::size_t(i)][std::size_t(j)];
            return {T(p[0]), T(p[1]), T(p[2])};
        };
        TangentFrame<T> const s = tensor_product<T>(point, vertex.at.x, vertex.at.y);
        return {transform(view_projection, s.position), unit_or_zero(cross(s.du, s.dv))};
    }
};

class SmallDraws {
public:
    SmallDraws() : color_(kSize, kSize), depth_(kSize, kSize)
    {
        for (int i = 0; i < kGrid; ++i)
            for (int j = 0; j < kGrid; ++j) {
                grid_.push_back(float(i) / (kGrid - 1));
                grid_.push_back(float(j) / (kGrid - 1));
            }
        for (std::uint32_t i = 0; i + 1 < kGrid; ++i)
            for (std::uint32_t j = 0; j + 1 < kGrid; ++j) {
                std::uint32_t const a = i * kGrid + j, b = a + kGrid;
                indices_.insert(indices_.end(), {a, b, b + 1, a, b + 1, a + 1});
            }
        // A sheet of patches in waves, seen from above; it covers the picture.
        std::uint32_t state = 1;
        auto const random = [&] {
            return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f;
        };
        for (int p = 0; p < kDraws; ++p) {
            BicubicVertexShader s;
            s.view_projection = {{{2, 0, 0, -1}, {0, 2, 0, -1}, {0, 0, -0.5f, 0.5f}, {0, 0, 0, 1}}};
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j)
                    s.control_points[std::size_t(i)][std::size_t(j)] = {
                        (float(p % kSide) + float(i) / 3) / kSide,
                        (float(p / kSide) + float(j) / 3) / kSide, 0.01f * random()};
            shaders_.push_back(s);
        }
        call_.topology = PrimitiveTopology::TriangleList;
        call_.set_vertices(grid_, 2);
        call_.indices = std::span<std::uint32_t const>(indices_);
        raster_ = {{&color_}, &depth_, {{0, 0, kSize, kSize, 0, 1}}};
        raster_.rasterizer.cull = CullMode::None;
    }

    /// Draws a frame as an application does: every draw binds its shaders anew.
    DrawStatistics frame(bool raster, ThreadPool const& threads, Machine const& machine = {})
    {
        DrawStatistics sum;
        DrawOptions options;
        options.memory = &memory_;
        if (raster) {
            color_.clear({0, 0, 0, 1}, threads);
            depth_.clear(1, 0, threads);
        }
        for (BicubicVertexShader const& s : shaders_) {
            GraphicsPipelineDesc desc;
            desc.vertex_shader = bind_vertex_shader(s, machine);
            if (raster) desc.pixel_shader = bind_pixel_shader(NormalPixelShader{}, machine);
            sum += draw(GraphicsPipeline(std::move(desc)), call_, raster ? &raster_ : nullptr, {},
                        threads, options);
        }
        return sum;
    }
    std::vector<std::byte> picture() const
    {
        std::vector<std::byte> out;
        for (int y = 0; y < kSize; ++y)
            out.insert(out.end(), color_.texel(0, y), color_.texel(0, y) + color_.row_bytes());
        return out;
    }

private:
    std::vector<float> grid_;
    std::vector<std::uint32_t> indices_;
    std::vector<BicubicVertexShader> shaders_;
    DrawCall call_;
    ColorTarget color_;
    DepthTarget depth_;
    RasterTarget raster_;
    DrawMemory memory_;
};

void small_draws(benchmark::State& state)
{
    SmallDraws scene;
    bool const raster = state.range(0) != 0;
    ThreadPool const threads(int(state.range(1)));
    DrawStatistics statistics;
    for (auto _ : state) statistics = scene.frame(raster, threads);
    if (statistics.pipeline.IAPrimitives != std::uint64_t(kDraws) * 128)
        state.SkipWithError("triangles are missing");
    if (raster) {
        std::vector<std::byte> const picture = scene.picture();
        if (statistics.pipeline.PSInvocations < std::uint64_t(kSize) * kSize)
            state.SkipWithError("pixels are missing");
        DrawStatistics const check =
            scene.frame(raster, ThreadPool(1), {kNativeLanes, Contraction::None, 0, true});
        if (picture != scene.picture() || check != statistics)
            state.SkipWithError("the checking machine draws another picture");
    }
    state.counters["time/draw"] =
        benchmark::Counter(double(kDraws), benchmark::Counter::kIsIterationInvariantRate |
                                               benchmark::Counter::kInvert);
    state.counters["VS/draw"] = double(statistics.pipeline.VSInvocations) / kDraws;
}
BENCHMARK(small_draws)
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->ArgNames({"raster", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
} // namespace tessemu
