// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame.h"

#include "shaders_cpp/pixel/surface_views.h"

#include <glm/geometric.hpp>

namespace tessemu {

std::string_view name_of(View view)
{
    switch (view) {
    case View::Lit:
        return "lit";
    case View::Normals:
        return "normals";
    case View::Patches:
        return "patches";
    default:
        return "depth";
    }
}

std::optional<View> view_from_name(std::string_view name)
{
    for (View v : kViews)
        if (name_of(v) == name) return v;
    return {};
}

std::shared_ptr<PixelProgram const> make_view(View view, PatchKind const& kind,
                                              Camera const& camera, Machine const& machine)
{
    auto const array = [](glm::vec3 v) { return std::array<float, 3>{v.x, v.y, v.z}; };
    // A key light over the viewer's left shoulder.
    glm::vec3 const light = glm::normalize(-0.5f * camera.right() + 0.62f * camera.true_up() +
                                           0.6f * camera.backward());
    switch (view) {
    case View::Lit: {
        LitPixelShader s;
        s.light = array(light);
        s.half = array(glm::normalize(light + camera.backward()));
        s.up = array(camera.true_up());
        return make_pixel_program(s, machine);
    }
    case View::Normals:
        return make_pixel_program(NormalPixelShader{}, machine);
    case View::Patches: {
        constexpr std::array<float, 3> kColors[] = {{0.42f, 0.66f, 0.92f},
                                                    {1.0f, 0.66f, 0.28f},
                                                    {0.42f, 0.80f, 0.46f},
                                                    {0.88f, 0.45f, 0.62f}};
        PatchPixelShader s;
        s.color = kColors[std::size_t(kind.color_index) % std::size(kColors)];
        s.light = array(light);
        return make_pixel_program(s, machine);
    }
    default: {
        DepthPixelShader s;
        s.near_w = camera.near_plane;
        s.far_w = camera.far_plane;
        return make_pixel_program(s, machine);
    }
    }
}

namespace {
PassSettings pass_settings(FrameSettings const& s)
{
    PassSettings p;
    p.tess_factor = s.tess_factor;
    p.partitioning = s.partitioning;
    p.machine = s.machine;
    p.true_normals = s.true_normals;
    return p;
}
} // namespace

Frame draw_frame(PatchMesh const& mesh, FrameSettings const& s, ThreadPool const& threads,
                 DrawProgress const& progress)
{
    Frame frame{RenderTarget(s.width, s.height, s.background), {}};
    PassSettings settings = pass_settings(s);
    settings.view_projection = view_projection(s.camera, float(s.width) / float(s.height));
    settings.pixel_shader = [&](PatchKind const& kind) {
        return make_view(s.view, kind, s.camera, s.machine);
    };
    RasterTarget raster{&frame.target, {0, 0, float(s.width), float(s.height), 0, 1}, {}};
    raster.rasterizer.cull = s.cull;
    raster.rasterizer.front_counter_clockwise = true; // as the papers' meshes
    std::vector<DrawPass> const passes = mesh.passes(settings);
    std::size_t all = 0, done = 0;
    for (DrawPass const& pass : passes) all += pass.patches.size();
    for (DrawPass const& pass : passes) {
        DrawOptions options{s.vertex_cache, {}};
        if (progress)
            options.progress = [&](std::size_t n, std::size_t) { progress(done + n, all); };
        frame.statistics += draw(pass.pipeline, pass.call, &raster, {}, threads, options);
        done += pass.patches.size();
    }
    return frame;
}

DrawStatistics visit_surface(PatchMesh const& mesh, FrameSettings const& s,
                             ThreadPool const& threads, SurfaceVisitor const& visit)
{
    DrawStatistics statistics;
    for (DrawPass const& pass : mesh.passes(pass_settings(s))) {
        PatchVisitor visitor;
        if (visit) visitor = [&](ShadedPatch const& p) { visit(pass, p); };
        statistics +=
            draw(pass.pipeline, pass.call, nullptr, visitor, threads, {s.vertex_cache, {}});
    }
    return statistics;
}

} // namespace tessemu
