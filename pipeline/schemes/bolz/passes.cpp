// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/bolz/passes.h"

#include "shaders_cpp/bolz/table_pixel_shaders.h"

#include <algorithm>

namespace tessemu {

Cells::Cells(std::vector<GridLevels> const& levels) : of_patch(levels.size())
{
    std::array<std::size_t, kTableSteps + 1> count{};
    std::size_t texels = 0;
    for (GridLevels const& l : levels) {
        ++count[l.inside];
        texels += std::size_t(side(l.inside)) * std::size_t(side(l.inside));
    }
    // About as wide as high.
    int wide = 1;
    while (std::size_t(wide) * std::size_t(wide) < texels) ++wide;
    for (int level = 0; level <= kTableSteps; ++level)
        if (count[std::size_t(level)]) wide = std::max(wide, side(level));
    wide = std::min(wide, ColorTarget::kMaxSize);
    std::array<int, kTableSteps + 1> first{};
    std::array<int, kTableSteps + 1> columns{};
    std::uint64_t high = 0;
    for (std::size_t level = 0; level <= kTableSteps; ++level) {
        int const s = side(int(level));
        columns[level] = wide / s;
        first[level] = int(std::min<std::uint64_t>(high, INT32_MAX / 2));
        if (count[level] == 0) continue;
        std::size_t const in_row = std::size_t(columns[level]);
        high += std::uint64_t((count[level] + in_row - 1) / in_row) * std::uint64_t(s);
        width = std::max(width, s * int(std::min(in_row, count[level])));
    }
    if (high > std::uint64_t(ColorTarget::kMaxSize))
        throw LimitError("texels down the target that patches are tessellated into (" +
                             std::to_string(levels.size()) +
                             " patches; fewer segments, or fewer steps of subdivision, would "
                             "do)",
                         high, ColorTarget::kMaxSize);
    height = int(high);
    std::array<std::size_t, kTableSteps + 1> next{};
    for (std::size_t p = 0; p < levels.size(); ++p) {
        std::size_t const level = levels[p].inside, k = next[level]++,
                          in_row = std::size_t(columns[level]);
        int const s = side(int(level));
        of_patch[p] = {int(k % in_row) * s, first[level] + int(k / in_row) * s};
    }
}

Passes::Passes(TablePatches const& t, Machine const& m, std::vector<GridLevels> l)
    : tables(t),
      machine(m),
      levels(std::move(l)),
      cells(levels),
      positions(cells.width, cells.height, Format::R32G32B32A32_FLOAT),
      normals(cells.width, cells.height, Format::R32G32B32A32_FLOAT)
{
    for (int n = 0; n <= kTableSteps; ++n)
        quads[std::size_t(n)] = bind_vertex_shader(PatchQuadVertexShader::of_level(n), machine);
}

namespace {

Draw draw_of(Passes const& f, std::size_t patch, PixelShader pixel_shader, ColorTarget& target,
             char const* name)
{
    GridLevels const& l = f.levels[patch];
    Draw out;
    out.name = name;
    out.pipeline.vertex_shader = f.quads[l.inside];
    out.pipeline.pixel_shader = std::move(pixel_shader);
    out.call.topology = PrimitiveTopology::TriangleStrip;
    out.call.vertex_count = 4;
    auto const& [x, y] = f.cells.of_patch[patch];
    float const side = float(Cells::side(l.inside));
    RasterTarget raster{{&target}, nullptr, {{float(x), float(y), side, side, 0, 1}}};
    raster.rasterizer.cull = CullMode::None;
    raster.depth_stencil.depth_enable = false;
    out.target = std::move(raster);
    return out;
}

Texture2D table_texture(std::vector<float> const& texels, TableLayout const& layout, Format format,
                        int slot, char const* name)
{
    return {std::as_bytes(std::span(texels)),
            format,
            layout.width(),
            layout.height(),
            std::size_t(layout.width()),
            slot,
            name};
}

ConstantBuffer<float> points_of(Passes const& f, TablePatches::Patch const& p)
{
    return ConstantBuffer<float>(
        f.constants.subspan(4 * std::size_t(p.first), 4 * std::size_t(p.count)));
}

/// The sums of a patch, in either order.
struct OrderedBinding {
    using Sums = OrderedSums;
    static constexpr Format kFormat = Format::R32_FLOAT;
    static Sums sums(Passes const& f, TablePatches::Patch const& p)
    {
        return {
            points_of(f, p),
            ConstantBuffer<float>(std::span(f.tables.offsets)
                                      .subspan(2 * std::size_t(p.first), 2 * std::size_t(p.count))),
            int(p.count)};
    }
};
struct PackedBinding {
    using Sums = PackedSums;
    static constexpr Format kFormat = Format::R32G32B32A32_FLOAT;
    static Sums sums(Passes const& f, TablePatches::Patch const& p)
    {
        return {points_of(f, p), f.tables.textures[p.type].layout, int(p.count)};
    }
};

template <class Binding> void add_passes(CommandList& list, std::shared_ptr<Passes> const& frame)
{
    using Sums = typename Binding::Sums;
    std::size_t const patches = frame->tables.patches.size();
    list.commands.emplace_back(DrawBatch{
        "positions", patches, [frame](std::size_t i) {
            TablePatches::Patch const& p = frame->tables.patches[i];
            TypeTextures const& t = frame->tables.textures[p.type];
            TablePositionPixelShader<Sums> shader{
                Binding::sums(*frame, p),
                table_texture(t.position, t.layout, Binding::kFormat, 0, "position_tables")};
            return draw_of(*frame, i, bind_pixel_shader(shader, frame->machine), frame->positions,
                           "positions");
        }});
    list.commands.emplace_back(
        DrawBatch{"normals", patches, [frame](std::size_t i) {
                      TablePatches::Patch const& p = frame->tables.patches[i];
                      TypeTextures const& t = frame->tables.textures[p.type];
                      TableNormalPixelShader<Sums> shader{
                          Binding::sums(*frame, p),
                          table_texture(t.du, t.layout, Binding::kFormat, 0, "tangent_tables_u"),
                          table_texture(t.dv, t.layout, Binding::kFormat, 1, "tangent_tables_v")};
                      return draw_of(*frame, i, bind_pixel_shader(shader, frame->machine),
                                     frame->normals, "normals");
                  }});
}

} // namespace

void add_passes(CommandList& list, std::shared_ptr<Passes> const& frame, TableOrder order)
{
    if (order == TableOrder::Global)
        add_passes<OrderedBinding>(list, frame);
    else
        add_passes<PackedBinding>(list, frame);
}

} // namespace tessemu
