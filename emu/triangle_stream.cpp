// SPDX-License-Identifier: Apache-2.0
#include "emu/triangle_stream.h"

namespace tessemu {

bool TriangleStream::supports(RasterSetup const& setup, bool triangles)
{
    RasterTarget const& t = setup.target;
    if (!triangles || !setup.pixel_shader || t.samples() != 1 || t.coverage ||
        setup.inclusive_edges || t.color.size() != 1 || !t.color[0] || !t.depth ||
        t.viewports.size() != 1)
        return false;
    PixelShaderInfo const& ps = setup.pixel_shader->info();
    bool const pure = setup.pixel_cost.features == 0 && !ps.writes_depth && !ps.writes_coverage &&
                      !ps.discards && !ps.sample_frequency && ps.color_targets == 1;
    RasterizerState const& r = t.rasterizer;
    bool const plain = r.fill == FillMode::Solid && r.depth_bias == 0 &&
                       r.slope_scaled_depth_bias == 0 && setup.layout.clip_distances == 0 &&
                       setup.layout.cull_distances == 0;
    DepthStencilState const& d = t.depth_stencil;
    bool const depth = d.depth_enable && d.depth_write && !t.depth_read_only && !d.stencil_enable &&
                       t.depth->format() == Format::D32_FLOAT &&
                       (d.depth_func == Comparison::Less || d.depth_func == Comparison::LessEqual);
    BlendState const& b = t.blend;
    Format const f = t.color[0]->format();
    bool const overwritten = !b.alpha_to_coverage && !b.target[0].enable &&
                             b.target[0].write_mask == 0xf && (b.sample_mask & 1);
    return pure && plain && depth && overwritten &&
           (f == Format::R8G8B8A8_UNORM || f == Format::R32G32B32A32_FLOAT);
}

void TriangleStream::bind(RasterSetup const& setup, PrimitiveAssembler const& assembler,
                          TileGrid const& tiles)
{
    setup_ = &setup;
    shading_.bind(setup, tiles);
    single_.bind(setup, assembler);
    covered_.bind(setup, assembler.front_is_clockwise());
    coverage_.bind(setup, assembler);
}

void TriangleStream::begin(AssembledVertices& vertices, FragmentBins& bins)
{
    vertices_ = &vertices;
    shading_.begin(bins);
    single_.begin();
    covered_.begin();
}

namespace {

// Where the first n vertices lie.
struct Extent {
    std::int32_t low_x, high_x, low_y, high_y; // 24.8
    unsigned outcodes = 0;                     // of all

    Extent(AssembledVertices const& vertices, std::size_t n)
    {
        constexpr int N = kRasterLanes;
        using I = IntLanes<N>;
        I min_x(0x7fffffff), min_y(0x7fffffff), max_x(-0x7fffffff), max_y(-0x7fffffff);
        I const lane = I::iota(), last(std::int32_t(n - 1));
        for (std::size_t i = 0; i < n; i += std::size_t(N)) {
            // Past the last point lies padding: those lanes repeat it.
            auto const load = [&](std::vector<std::int32_t> const& column) {
                return i + std::size_t(N) <= n
                           ? load_lanes<N>(column.data() + i)
                           : gather(column.data(), min(lane + I(std::int32_t(i)), last));
            };
            I const x = load(vertices.x), y = load(vertices.y);
            min_x = min(min_x, x), max_x = max(max_x, x);
            min_y = min(min_y, y), max_y = max(max_y, y);
        }
        LaneRange<N> const x(min_x, max_x), y(min_y, max_y);
        low_x = x.low, high_x = x.high, low_y = y.low, high_y = y.high;
        for (std::size_t i = 0; i < n; ++i) outcodes |= vertices.outcode[i];
    }
};

} // namespace

void TriangleStream::add_patch(DomainPoints const& pattern, std::int32_t primitive_id,
                               AssemblyCounters& counters)
{
    std::size_t const triangles = pattern.patch.indices.size() / 3;
    if (triangles == 0) return;
    Extent const extent(*vertices_, pattern.patch.points());
    std::int32_t const left = extent.low_x >> 8, top = extent.low_y >> 8;
    bool const fits = (extent.high_x >> 8) - left < TriangleCoverage::kMaxPatchPixels &&
                      (extent.high_y >> 8) - top < TriangleCoverage::kMaxPatchPixels;
    // A pixel whose centre lies on the right or bottom bound is never covered.
    Rect const& bounds = setup_->bounds[0];
    bool const inside = left >= bounds.left && top >= bounds.top &&
                        (extent.high_x + 127) >> 8 <= bounds.right &&
                        (extent.high_y + 127) >> 8 <= bounds.bottom;
    if (extent.outcodes || !fits || !inside) {
        for (std::size_t t = 0; t < triangles; ++t) {
            std::uint32_t const v[3] = {pattern.corner[0][t], pattern.corner[1][t],
                                        pattern.corner[2][t]};
            add_triangle(v, primitive_id, counters);
        }
        return;
    }
    counters.clip_invocations += triangles;
    counters.clip_primitives += triangles;
    DepthTarget const& depth = *setup_->target.depth;
    auto const* const codes = reinterpret_cast<std::int32_t const*>(depth.codes());
    coverage_.add_patch(
        {&pattern, vertices_, primitive_id, left, top, codes + depth.index(left, top)});
}

} // namespace tessemu
