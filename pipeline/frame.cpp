// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame.h"

#include "pipeline/instanced_tessellation.h"
#include "shaders_cpp/pixel/bumped_view.h"

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
    case View::Depth:
        return "depth";
    case View::Wire:
        return "wire";
    default:
        return "coverage";
    }
}

std::optional<View> view_from_name(std::string_view name)
{
    for (View v : kViews)
        if (name_of(v) == name) return v;
    return {};
}

namespace {
template <class Shader>
std::shared_ptr<PixelProgram const> on_surface(Shader const& view, Displacement const* displacement,
                                               Machine const& machine)
{
    if (!displacement) return make_pixel_program(view, machine);
    return make_pixel_program(
        BumpedView<Shader>{view, displacement->height_map(), displacement->scale()}, machine);
}
} // namespace

std::shared_ptr<PixelProgram const> make_view(View view, PatchKind const& kind,
                                              Camera const& camera,
                                              Displacement const* displacement,
                                              Machine const& machine)
{
    auto const array = [](glm::vec3 v) { return std::array<float, 3>{v.x, v.y, v.z}; };
    // A key light over the viewer's left shoulder.
    glm::vec3 const light = glm::normalize(-0.5f * camera.right() + 0.62f * camera.true_up() +
                                           0.6f * camera.backward());
    switch (view) {
    case View::Lit:
    case View::Wire:
    case View::Coverage: {
        LitPixelShader s;
        s.light = array(light);
        s.half = array(glm::normalize(light + camera.backward()));
        s.up = array(camera.true_up());
        return on_surface(s, displacement, machine);
    }
    case View::Normals:
        return on_surface(NormalPixelShader{}, displacement, machine);
    case View::Patches: {
        PatchPixelShader s;
        s.color = patch_kind_color(kind.color_index);
        s.light = array(light);
        return on_surface(s, displacement, machine);
    }
    default: {
        DepthPixelShader s;
        s.near_w = camera.near_plane;
        s.far_w = camera.far_plane;
        return make_pixel_program(s, machine);
    }
    }
}

std::array<float, 3> patch_kind_color(int color_index)
{
    // As LOOP09's figure 1: gold for regular, purple for irregular quads, green for triangles.
    constexpr std::array<float, 3> kColors[] = {
        {0.96f, 0.78f, 0.36f}, {0.66f, 0.54f, 0.86f}, {0.44f, 0.80f, 0.48f}, {0.88f, 0.45f, 0.50f}};
    return kColors[std::size_t(color_index) % std::size(kColors)];
}

TessFactorRule tess_factor_rule(AdaptiveFactors const& adaptive, Camera const& camera, int height,
                                float tess_factor)
{
    TessFactorRule r;
    r.eye = {camera.eye.x, camera.eye.y, camera.eye.z};
    if (adaptive.kind == AdaptiveFactors::Kind::Pixels) {
        r.kind = TessFactorRule::Kind::ProjectedLength;
        r.scale = camera.focal * float(height) / (2 * adaptive.value);
    } else if (adaptive.kind == AdaptiveFactors::Kind::Distance) {
        r.kind = TessFactorRule::Kind::Distance;
        r.scale = tess_factor * adaptive.value;
    }
    return r;
}

PassSettings pass_settings(FrameSettings const& s)
{
    PassSettings p;
    p.tess_factor = s.tess_factor;
    p.adaptive = tess_factor_rule(s.adaptive, s.camera, s.height, s.tess_factor);
    p.partitioning = s.partitioning;
    p.machine = s.machine;
    p.true_normals = s.true_normals;
    p.displacement = s.displacement;
    p.pose = s.pose;
    p.mistake = s.mistake;
    p.parity = s.parity;
    return p;
}

std::vector<DrawPass> frame_passes(PatchMesh const& mesh, FrameSettings const& s,
                                   PassSettings const& settings)
{
    std::vector<DrawPass> passes = mesh.passes(settings);
    Mistake const m = s.mistake.kind;
    if (m == Mistake::Factors || m == Mistake::Fold) {
        if (s.direct3d10)
            throw Error("the mistake '" + std::string(name_of(m)) +
                        "' is the tessellator's, which the Direct3D 10 path does not have");
        for (DrawPass& pass : passes)
            for (std::size_t i = 0; i < pass.patches.size(); ++i) {
                if (pass.patches[i].face != s.mistake.face) continue;
                (m == Mistake::Fold ? pass.mistakes.reversed_winding : pass.mistakes.other_factor) =
                    std::int64_t(i);
            }
    }
    if (s.direct3d10)
        for (DrawPass& pass : passes) pass = instanced(std::move(pass), settings);
    return passes;
}

Frame::Frame(FrameSettings const& s)
    : color(s.width, s.height, s.color_format),
      depth(s.width, s.height, Format::D32_FLOAT, s.samples)
{
    if (s.samples > 1)
        color_samples = std::make_unique<ColorTarget>(s.width, s.height, s.color_format, s.samples);
    if (s.view == View::Coverage)
        coverage = std::make_unique<CoverageCounts>(s.width, s.height, s.samples);
}

namespace {

// Draws all passes with one rasterizer state.
void draw_passes(PatchMesh const& mesh, FrameSettings const& s, RasterTarget const& raster,
                 PassSettings const& settings, ThreadPool const& threads, Frame& frame,
                 DrawProgress const& progress)
{
    std::vector<DrawPass> const passes = frame_passes(mesh, s, settings);
    std::size_t all = 0, done = 0;
    for (DrawPass const& pass : passes) all += pass.patches.size();
    for (DrawPass const& pass : passes) {
        DrawOptions options;
        options.vertex_cache = s.vertex_cache;
        options.memory = &frame.memory;
        if (progress)
            options.progress = [&](std::size_t n, std::size_t) { progress(done + n, all); };
        frame.statistics += draw_pass(pass, &raster, {}, threads, options);
        done += pass.patches.size();
    }
}

void paint_coverage(FrameSettings const& s, Frame& frame)
{
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x) {
            std::uint32_t const n = frame.coverage->at(x, y, 0);
            float const t = float(std::min(n, 8u)) / 8;
            std::array<float, 4> const color =
                n == 0       ? s.background
                : n % 2 == 1 ? std::array<float, 4>{0.95f, 0.45f - 0.25f * t, 0.1f, 1}
                             : std::array<float, 4>{0.15f + 0.8f * t, 0.35f + 0.6f * t, 0.8f, 1};
            encode(frame.color.format(), color, frame.color.texel(x, y));
        }
}

} // namespace

void draw_frame(PatchMesh const& mesh, FrameSettings const& s, ThreadPool const& threads,
                Frame& frame, DrawProgress const& progress)
{
    ColorTarget& color = frame.color_samples ? *frame.color_samples : frame.color;
    color.clear(s.background, threads);
    frame.depth.clear(1, 0, threads);
    frame.statistics = {};
    PassSettings settings = pass_settings(s);
    settings.view_projection = view_projection(s.camera, float(s.width) / float(s.height));
    settings.pixel_shader = [&](PatchKind const& kind) {
        return make_view(s.view, kind, s.camera, s.displacement.get(), s.machine);
    };
    RasterTarget raster{{&color}, &frame.depth, {{0, 0, float(s.width), float(s.height), 0, 1}}};
    raster.rasterizer.cull = s.cull;
    raster.rasterizer.front_counter_clockwise = true; // as the papers' meshes
    raster.inclusive_edges = s.mistake.kind == Mistake::TopLeft;
    if (frame.coverage) {
        frame.coverage->clear();
        raster.coverage = frame.coverage.get();
    }
    draw_passes(mesh, s, raster, settings, threads, frame, progress);
    if (s.view == View::Wire) {
        settings.pixel_shader = [&](PatchKind const&) {
            return make_pixel_program(FlatPixelShader{{0.05f, 0.06f, 0.08f, 1}}, s.machine);
        };
        raster.rasterizer.fill = FillMode::Wireframe;
        raster.rasterizer.multisample_enable = s.samples > 1;
        raster.rasterizer.slope_scaled_depth_bias = -1; // edges lie on the surface's own triangles
        raster.rasterizer.depth_bias = -64;
        draw_passes(mesh, s, raster, settings, threads, frame, progress);
    }
    if (frame.color_samples) resolve(*frame.color_samples, frame.color);
    if (frame.coverage) paint_coverage(s, frame);
}

Frame draw_frame(PatchMesh const& mesh, FrameSettings const& s, ThreadPool const& threads,
                 DrawProgress const& progress)
{
    Frame frame(s);
    draw_frame(mesh, s, threads, frame, progress);
    return frame;
}

DrawStatistics visit_surface(PatchMesh const& mesh, FrameSettings const& s,
                             ThreadPool const& threads, SurfaceVisitor const& visit)
{
    DrawStatistics statistics;
    for (DrawPass const& pass : frame_passes(mesh, s, pass_settings(s))) {
        PatchVisitor visitor;
        if (visit) visitor = [&](ShadedPatch const& p) { visit(pass, p); };
        DrawOptions options;
        options.vertex_cache = s.vertex_cache;
        statistics += draw_pass(pass, nullptr, visitor, threads, options);
    }
    return statistics;
}

} // namespace tessemu
