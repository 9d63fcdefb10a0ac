// SPDX-License-Identifier: Apache-2.0
#include "emu/raster_stages.h"

#include <algorithm>
#include <cmath>

namespace tessemu {

RasterStages::RasterStages(RasterTarget const& target, GraphicsPipelineDesc const& desc,
                           OutputLayout layout, bool triangles, DrawMistakes const& mistakes)
    : target_(with_all_viewports(target, desc)),
      buffers_(desc.pixel_shader.resources()),
      setup_{target_,
             {},
             desc.pixel_shader,
             desc.pixel_shader ? desc.pixel_shader.probe() : PixelShaderCost{},
             layout,
             buffers_,
             mistakes.inclusive_edges},
      assembler_(target_,
                 desc.pixel_shader
                     ? std::span<Interpolation const>(desc.pixel_shader->info().interpolation)
                     : std::span<Interpolation const>(),
                 layout)
{
    Rect const all = extent();
    for (std::size_t i = 0; i < target_.viewports.size(); ++i) {
        Viewport const& v = target_.viewports[i];
        // Implicit scissor: sums first, then floor (R98).
        Rect r = all.intersect({int(std::floor(v.x)), int(std::floor(v.y)),
                                int(std::floor(v.x + v.width)), int(std::floor(v.y + v.height))});
        if (target_.rasterizer.scissor_enable)
            r = r.intersect(i < target_.scissors.size() ? target_.scissors[i] : Rect{});
        setup_.bounds.push_back(r);
    }
    Rect reached;
    for (Rect const& r : setup_.bounds) {
        if (r.empty()) continue;
        reached = reached.empty()
                      ? r
                      : Rect{std::min(reached.left, r.left), std::min(reached.top, r.top),
                             std::max(reached.right, r.right), std::max(reached.bottom, r.bottom)};
    }
    tiles_ = TileGrid::of(reached);
    streams_ = TriangleStream::supports(setup_, triangles);
}

void RasterStages::assemble(FrontEnd const& stages, Chunk& c) const
{
    assembler_.project(c.shaded.data(), c.stride, c.stride, c.gs_viewport, c.assembled);
    stages.for_each_primitive(
        c, [&](std::uint32_t const* v, int n, std::int32_t id, std::uint8_t viewport) {
            assembler_.assemble(c.assembled, v, n, id, viewport, c.counters.assembly, c.primitives);
        });
    bin(c);
}

void RasterStages::stream(FrontEnd const& stages, AssembledPrimitives const& primitives,
                          float const* shaded_vertices, std::size_t first, std::size_t count,
                          Chunk& slot, DrawMemory::Parts& memory)
{
    auto w = memory.take(stages.tessellator_state());
    if (w->draw != memory.draws) {
        w->stream.bind(setup_, assembler_, tiles_);
        w->draw = memory.draws;
    }
    FrontEndChunk& c = w->chunk;
    w->stream.begin(c.assembled, slot.fragments);
    if (stages.tessellates()) {
        stages.run_by_patch(
            c, *w->patterns, primitives, shaded_vertices, first, count, [&](std::size_t p) {
                std::size_t const points = (c.patterns[p]->patch.points() + 15) / 16 * 16;
                assembler_.project(c.shaded.data(), c.stride, points, {}, c.assembled);
                w->stream.add_patch(*c.patterns[p], std::int32_t(first + p), c.counters.assembly);
            });
    } else {
        stages.run(c, *w->patterns, primitives, shaded_vertices, first, count);
        assembler_.project(c.shaded.data(), c.stride, c.stride, {}, c.assembled);
        stages.for_each_primitive(c,
                                  [&](std::uint32_t const* v, int, std::int32_t id, std::uint8_t) {
                                      w->stream.add_triangle(v, id, c.counters.assembly);
                                  });
    }
    w->stream.end();
    slot.first = first;
    slot.count = count;
    slot.counters = c.counters;
    slot.fragment_count = w->stream.fragments();
    memory.give(std::move(w));
}

void RasterStages::rasterize(std::span<Chunk> wave, ThreadPool const& threads)
{
    std::vector<std::size_t> busy;
    for (std::size_t t = 0; t < tiles_.size(); ++t)
        for (Chunk const& c : wave)
            if (c.bin_start[t] != c.bin_start[t + 1]) {
                busy.push_back(t);
                break;
            }
    std::vector<RasterCounters> tile_counters(busy.size());
    threads.parallel_for(busy.size(), [&](std::size_t i) {
        std::size_t const t = busy[i];
        int const x = (tiles_.x + int(t) % tiles_.columns) << kTileShift,
                  y = (tiles_.y + int(t) / tiles_.columns) << kTileShift;
        DenormalMode const flush(DenormalMode::Flush);
        TileRasterizer raster(setup_, {x, y, x + kTileSize, y + kTileSize}, tile_counters[i]);
        for (Chunk const& c : wave)
            for (std::uint32_t k = c.bin_start[t]; k < c.bin_start[t + 1]; ++k)
                raster.draw(c.assembled, c.primitives[c.bin_primitives[k]]);
        raster.flush();
    });
    for (RasterCounters const& c : tile_counters) counters += c;
}

std::uint64_t RasterStages::merge(std::span<Chunk> wave, ThreadPool const& threads)
{
    std::vector<std::size_t> busy;
    for (std::size_t t = 0; t < tiles_.size(); ++t)
        if (std::any_of(wave.begin(), wave.end(),
                        [&](Chunk const& c) { return !c.fragments.empty(t); }))
            busy.push_back(t);
    std::vector<std::uint64_t> passed(busy.size());
    threads.parallel_for(busy.size(), [&](std::size_t b) {
        std::size_t const t = busy[b];
        for (std::size_t i = 0; i < wave.size(); ++i) {
            if (i + 1 < wave.size()) wave[i + 1].fragments.prefetch(t);
            if (!wave[i].fragments.empty(t))
                passed[b] += merge_fragments(target_, wave[i].fragments, t);
        }
    });
    std::uint64_t all = 0;
    for (std::uint64_t n : passed) all += n;
    counters.passed_samples += all;
    counters.pixel.invocations += all; // shading is pure: what fails might never have run
    counters.pixel.flops += setup_.pixel_cost.flops * all;
    std::uint64_t fragments = 0;
    for (Chunk const& c : wave) fragments += c.fragment_count;
    counters.covered_samples += fragments;
    return fragments;
}

RasterTarget RasterStages::with_all_viewports(RasterTarget t, GraphicsPipelineDesc const& desc)
{
    t.viewports.resize(desc.geometry_shader ? kMaxViewports
                                            : std::max<std::size_t>(1, t.viewports.size()));
    return t;
}

Rect RasterStages::extent() const
{
    for (ColorTarget const* c : target_.color)
        if (c) return {0, 0, c->width(), c->height()};
    if (target_.depth) return {0, 0, target_.depth->width(), target_.depth->height()};
    if (target_.coverage) return {0, 0, target_.coverage->width, target_.coverage->height};
    Viewport const& v = target_.viewports[0]; // nothing bound (R6)
    auto const size = [](float to) {
        return std::clamp(int(std::floor(to)), 0, ColorTarget::kMaxSize);
    };
    return {0, 0, size(v.x + v.width), size(v.y + v.height)};
}

void RasterStages::bin(Chunk& c) const
{
    std::size_t const tiles = tiles_.size();
    int const samples = target_.samples();
    bool const wide = target_.rasterizer.multisample_enable;
    c.bin_entries.clear();
    for (std::uint32_t i = 0; i < c.primitives.size(); ++i) {
        AssembledPrimitive const& p = c.primitives[i];
        Rect const r =
            primitive_bounds(c.assembled, p, samples, wide).intersect(setup_.bounds[p.viewport]);
        if (r.empty()) continue;
        for (int ty = r.top >> kTileShift; ty <= (r.bottom - 1) >> kTileShift; ++ty)
            for (int tx = r.left >> kTileShift; tx <= (r.right - 1) >> kTileShift; ++tx)
                c.bin_entries.emplace_back(std::uint32_t(tiles_.number(tx, ty)), i);
    }
    c.bin_start.assign(tiles + 1, 0);
    for (auto const& [tile, primitive] : c.bin_entries) ++c.bin_start[tile + 1];
    for (std::size_t t = 0; t < tiles; ++t) c.bin_start[t + 1] += c.bin_start[t];
    c.bin_primitives.resize(c.bin_entries.size());
    std::vector<std::uint32_t> at(c.bin_start.begin(), c.bin_start.end() - 1);
    for (auto const& [tile, primitive] : c.bin_entries) c.bin_primitives[at[tile]++] = primitive;
}

} // namespace tessemu
