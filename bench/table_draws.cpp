// Thousands of small draws whose pixel shader sums tables: BOLZ03's tessellation, 4,096 patches of
// valence 4 and as many of valence 9, 33 x 33 fragments each.
//
// A quad is drawn into each patch's place of a float target; a fragment adds 16 or 26 control
// points, constants of the draw, with weights from a texture of one channel, which holds the tables
// of as many patch types as `types` says. With `empty` shaders do nothing: what a draw costs beside
// them. Counters: microseconds a draw.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/texture.h"
#include "pipeline/commands/command_list.h"

#include <benchmark/benchmark.h>

namespace tessemu {
namespace {

constexpr int kSide = 64, kDraws = kSide * kSide, kGrid = 33;

template <class T> struct QuadVertex {
    float4<T> position;
    float2<T> coordinates;
    static constexpr auto signature()
    {
        return std::tuple{&QuadVertex::position, &QuadVertex::coordinates};
    }
};
template <class T> struct Coordinates {
    float2<T> at;
    static constexpr std::array kInterpolation{Interpolation::LinearNoperspective};
    static constexpr auto signature() { return std::tuple{&Coordinates::at}; }
};
struct QuadVertexShader {
    template <class T> using Input = QuadVertex<T>;
    template <class T> using Output = QuadVertex<T>;
    template <class T> QuadVertex<T> operator()(VertexInput<T> const&, QuadVertex<T> const& v) const
    {
        return v;
    }
};

struct TableSum {
    template <class T> using Input = Coordinates<T>;
    Texture2D tables; ///< side by side
    int terms, first_row;
    ConstantBuffer<float> points;
    std::vector<ResourceInfo> resources() const { return {tables.info()}; }

    template <class T> float4<T> operator()(PixelInput<T> const&, Coordinates<T> const& in) const
    {
        float3<T> sum(T(0), T(0), T(0));
        for (int i : loop<T>(terms)) {
            float2<T> const at(T(float(kGrid * i)) + in.at.x, T(float(first_row)) + in.at.y);
            T const weight = fetch_texel<T>(tables, at).x;
            float3<T> const p(load<T>(points, 3 * i), load<T>(points, 3 * i + 1),
                              load<T>(points, 3 * i + 2));
            sum = sum + weight * p;
        }
        return {sum, T(1)};
    }
};
struct Empty {
    template <class T> using Input = Coordinates<T>;
    template <class T> float4<T> operator()(PixelInput<T> const&, Coordinates<T> const&) const
    {
        return {T(0), T(0), T(0), T(1)};
    }
};

class TableDraws {
public:
    TableDraws(int terms, int types, bool empty)
        : terms_(terms),
          types_(types),
          empty_(empty),
          tables_(std::size_t(kGrid * kGrid * terms * types), 1 / 64.0f),
          points_(std::size_t(3 * terms), 2.0f),
          color_(kSide * kGrid, kSide * kGrid, Format::R32G32B32A32_FLOAT)
    {
        for (auto [x, y] : {std::pair{0, 0}, {1, 0}, {0, 1}, {0, 1}, {1, 0}, {1, 1}})
            quad_.insert(quad_.end(), {float(2 * x - 1), float(1 - 2 * y), 0, 1, float(x * kGrid),
                                       float(y * kGrid)});
        list_.commands = {DrawBatch{"tables", kDraws, [this](std::size_t i) { return draw(i); }}};
    }
    DrawStatistics frame(ThreadPool const& threads) const
    {
        return run_commands(list_, threads).total;
    }
    float least() const
    {
        float least = 1e9f;
        for (int y = 0; y < color_.height(); ++y)
            for (int x = 0; x < color_.width(); ++x) least = std::min(least, color_.load(x, y)[0]);
        return least;
    }

private:
    Draw draw(std::size_t i) const
    {
        Draw d;
        d.pipeline.vertex_shader = bind_vertex_shader(QuadVertexShader{}, {});
        Texture2D const texture(std::as_bytes(std::span(tables_)), Format::R32_FLOAT,
                                kGrid * terms_, kGrid * types_, std::size_t(kGrid * terms_), 0,
                                "tables");
        d.pipeline.pixel_shader =
            empty_
                ? bind_pixel_shader(Empty{}, {})
                : bind_pixel_shader(TableSum{texture, terms_, kGrid * int(i % std::size_t(types_)),
                                             ConstantBuffer<float>(points_)},
                                    {});
        d.call.topology = PrimitiveTopology::TriangleList;
        d.call.set_vertices(quad_, 6);
        d.call.vertex_count = 6;
        RasterTarget t;
        t.color = {const_cast<ColorTarget*>(&color_)};
        t.viewports = {{float(i % kSide * kGrid), float(i / kSide * kGrid), kGrid, kGrid, 0, 1}};
        t.depth_stencil.depth_enable = false;
        d.target = t;
        return d;
    }

    int terms_, types_;
    bool empty_;
    std::vector<float> tables_, points_, quad_;
    ColorTarget color_;
    CommandList list_;
};

void table_draws(benchmark::State& state)
{
    TableDraws const scene(int(state.range(0)), int(state.range(1)), state.range(2) != 0);
    ThreadPool const threads(int(state.range(3)));
    DrawStatistics statistics;
    for (auto _ : state) statistics = scene.frame(threads);
    if (statistics.pipeline.PSInvocations != std::uint64_t(kDraws) * kGrid * kGrid)
        state.SkipWithError("fragments are missing");
    if (state.range(2) == 0 && scene.least() != float(state.range(0)) / 32)
        state.SkipWithError("sums are wrong");
    state.counters["time/draw"] =
        benchmark::Counter(double(kDraws), benchmark::Counter::kIsIterationInvariantRate |
                                               benchmark::Counter::kInvert);
}
BENCHMARK(table_draws)
    ->ArgsProduct({{16, 26}, {1, 16}, {0, 1}, {1, 2}})
    ->ArgNames({"terms", "types", "empty", "threads"})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

} // namespace
} // namespace tessemu
