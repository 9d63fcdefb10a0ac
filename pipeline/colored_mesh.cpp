// SPDX-License-Identifier: Apache-2.0
#include "pipeline/colored_mesh.h"

#include "shaders_cpp/pixel/colored_view.h"

#include <glm/geometric.hpp>

namespace tessemu {

std::uint32_t ColoredMesh::add(glm::vec3 p, glm::vec3 n, std::array<float, 3> c)
{
    auto const id = std::uint32_t(vertices.size() / 9);
    vertices.insert(vertices.end(), {p.x, p.y, p.z, n.x, n.y, n.z, c[0], c[1], c[2]});
    return id;
}

ColoredMesh control_mesh_picture(Topology const& topology)
{
    ControlMesh const& mesh = topology.mesh();
    ColoredMesh out;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const face = mesh.face(f);
        std::size_t const n = face.size();
        glm::vec3 normal(0); // of the face's mean plane
        for (std::size_t i = 0; i < n; ++i)
            normal += cross(mesh.positions[face[i]], mesh.positions[face[(i + 1) % n]]);
        PatchClass const kind = n == 3                    ? PatchClass::Triangle
                                : n > 4                   ? PatchClass::Other
                                : is_regular(topology, f) ? PatchClass::RegularQuad
                                                          : PatchClass::IrregularQuad;
        std::uint32_t first = 0;
        for (std::size_t i = 0; i < n; ++i) {
            std::uint32_t const id = out.add(mesh.positions[face[i]], normal, color_of(kind));
            if (i == 0) first = id;
            if (i >= 2) out.triangles.insert(out.triangles.end(), {first, id - 1, id});
        }
    }
    for (HalfEdge h = 0; h < mesh.face_vertices.size(); ++h) {
        HalfEdge const twin = topology.twin(h);
        if (twin != Topology::kNone && twin < h) continue;
        for (HalfEdge end : {h, topology.next(h)})
            out.lines.push_back(out.add(mesh.positions[topology.vertex_of(end)], glm::vec3(0),
                                        {0.05f, 0.06f, 0.08f}));
    }
    return out;
}

void draw_colored_mesh(ColoredMesh const& mesh, FrameSettings const& s, float ambient,
                       ThreadPool const& threads, Frame& frame)
{
    ColorTarget& color = frame.color_samples ? *frame.color_samples : frame.color;
    color.clear(s.background, threads);
    frame.depth.clear(1, 0, threads);
    frame.statistics = {};
    frame.commands.clear();
    glm::vec3 const viewer = s.camera.backward();
    GraphicsPipelineDesc desc;
    desc.vertex_shader = bind_vertex_shader(
        ColoredVertexShader{view_projection(s.camera, float(s.width) / float(s.height))},
        s.machine);
    desc.pixel_shader =
        bind_pixel_shader(ColoredPixelShader{{viewer.x, viewer.y, viewer.z}, ambient}, s.machine);
    GraphicsPipeline const pipeline(std::move(desc));
    RasterTarget raster{{&color}, &frame.depth, {{0, 0, float(s.width), float(s.height), 0, 1}}};
    raster.rasterizer.cull = s.cull;
    raster.rasterizer.front_counter_clockwise = true;
    DrawCall call;
    call.set_vertices(mesh.vertices, 9);
    DrawOptions options;
    options.vertex_cache = s.vertex_cache;
    options.memory = &frame.memory;
    call.topology = PrimitiveTopology::TriangleList;
    call.indices = std::span<std::uint32_t const>(mesh.triangles);
    auto const run = [&](char const* name) {
        DrawStatistics const s2 = draw(pipeline, call, &raster, {}, threads, options);
        frame.statistics += s2;
        frame.commands.push_back({"draw", name, 1, s2});
    };
    run("triangles");
    if (!mesh.lines.empty()) {
        raster.rasterizer.multisample_enable = s.samples > 1;
        raster.rasterizer.slope_scaled_depth_bias = -1;
        raster.rasterizer.depth_bias = -64;
        call.topology = PrimitiveTopology::LineList;
        call.indices = std::span<std::uint32_t const>(mesh.lines);
        run("lines");
    }
    if (frame.color_samples) resolve(*frame.color_samples, frame.color);
}

} // namespace tessemu
