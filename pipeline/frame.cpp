// SPDX-License-Identifier: Apache-2.0
#include "pipeline/frame.h"

#include "pipeline/commands/direct3d10.h"
#include "pipeline/patch_valences.h"
#include "shaders_cpp/pixel/bumped_view.h"
#include "shaders_cpp/pixel/curvature_view.h"
#include "shaders_cpp/pixel/zebra_view.h"

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
    case View::Valence:
        return "valence";
    case View::Zebra:
        return "zebra";
    case View::Curvature:
        return "curvature";
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
template <class Shader> PixelShader on_surface(Shader const& view, FrameSettings const& s)
{
    if (!s.displacement) return bind_pixel_shader(view, s.machine);
    return bind_pixel_shader(
        BumpedView<Shader>{view, s.displacement->height_map(), s.displacement->scale()}, s.machine);
}

std::array<float, 3> as_array(glm::vec3 v)
{
    return {v.x, v.y, v.z};
}

// A key light over the viewer's left shoulder.
glm::vec3 key_light(Camera const& camera)
{
    return glm::normalize(-0.5f * camera.right() + 0.62f * camera.true_up() +
                          0.6f * camera.backward());
}

// From the surface to the viewer: the picture's plane lies `focal` half heights before the eye.
ZebraPixelShader zebra(FrameSettings const& s)
{
    Camera const& c = s.camera;
    float const pixel = 2 / (c.focal * float(s.height)); // at a distance of 1
    glm::vec3 const right = c.right(), up = c.true_up();
    ZebraPixelShader out;
    out.v0 =
        as_array(c.backward() + 0.5f * pixel * (float(s.width) * right - float(s.height) * up));
    out.vx = as_array(-pixel * right);
    out.vy = as_array(pixel * up);
    out.axis = as_array(up);
    return out;
}
} // namespace

PixelShader make_view(Draw const& draw, FrameSettings const& settings)
{
    Camera const& camera = settings.camera;
    glm::vec3 const light = key_light(camera);
    switch (settings.view) {
    case View::Lit:
    case View::Wire:
    case View::Coverage: {
        LitPixelShader s;
        s.light = as_array(light);
        s.half = as_array(glm::normalize(light + camera.backward()));
        s.up = as_array(camera.true_up());
        return on_surface(s, settings);
    }
    case View::Normals:
        return on_surface(NormalPixelShader{}, settings);
    case View::Zebra:
        return on_surface(zebra(settings), settings);
    case View::Curvature: {
        if (draw.has_curvature()) {
            CurvaturePixelShader s;
            s.scale = settings.curvature_max > 0 ? 1 / settings.curvature_max : 0;
            s.light = as_array(light);
            return bind_pixel_shader(s, settings.machine);
        }
        PatchPixelShader s; // told apart, in grey
        s.color = {0.5f, 0.5f, 0.5f};
        s.light = as_array(light);
        return bind_pixel_shader(s, settings.machine);
    }
    case View::Patches: {
        PatchPixelShader s;
        s.color = color_of(draw.kind.patch_class);
        s.light = as_array(light);
        if (draw.grid) s.brightness = 0.94f, s.step = 0; // SV_PrimitiveID is a triangle's
        return on_surface(s, settings);
    }
    default: {
        DepthPixelShader s;
        s.near_w = camera.near_plane;
        s.far_w = camera.far_plane;
        return bind_pixel_shader(s, settings.machine);
    }
    }
}

std::array<float, 3> color_of(PatchClass patch_class)
{
    // As LOOP09's figure 1: gold for regular, purple for irregular quads, green for triangles.
    switch (patch_class) {
    case PatchClass::RegularQuad:
        return {0.96f, 0.78f, 0.36f};
    case PatchClass::IrregularQuad:
        return {0.66f, 0.54f, 0.86f};
    case PatchClass::Triangle:
        return {0.44f, 0.80f, 0.48f};
    case PatchClass::Crease:
        return {0.42f, 0.68f, 0.92f};
    case PatchClass::Dart:
        return {0.96f, 0.56f, 0.24f};
    case PatchClass::ConvexCorner:
        return {0.90f, 0.36f, 0.36f};
    case PatchClass::ConcaveCorner:
        return {0.72f, 0.30f, 0.62f};
    case PatchClass::SemiSharp:
        return {0.36f, 0.78f, 0.72f};
    default:
        return {0.88f, 0.45f, 0.50f};
    }
}

TessFactorRule tess_factor_rule(AdaptiveFactors const& adaptive, Camera const& camera, int height,
                                float tess_factor)
{
    TessFactorRule r;
    r.eye = {camera.eye.x, camera.eye.y, camera.eye.z};
    float const value = float(adaptive.value);
    if (adaptive.kind == AdaptiveFactors::Kind::Pixels) {
        r.kind = TessFactorRule::Kind::ProjectedLength;
        r.scale = camera.focal * float(height) / (2 * value);
    } else if (adaptive.kind == AdaptiveFactors::Kind::Distance) {
        r.kind = TessFactorRule::Kind::Distance;
        r.scale = tess_factor * value;
    }
    return r;
}

SurfaceSettings surface_settings(FrameSettings const& s)
{
    SurfaceSettings out = s;
    out.adaptive_rule = tess_factor_rule(s.adaptive, s.camera, s.height, s.tess_factor);
    out.curvature = s.curvature || s.view == View::Curvature;
    return out;
}

SurfaceSettings seen_surface(FrameSettings const& s)
{
    SurfaceSettings out = surface_settings(s);
    out.view_projection = view_projection(s.camera, float(s.width) / float(s.height));
    return out;
}

CommandList frame_commands(PatchMesh const& mesh, FrameSettings const& s,
                           SurfaceSettings const& surface)
{
    CommandList list = mesh.commands(surface);
    return s.direct3d10 ? instanced(std::move(list), surface) : list;
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

// The surface's draws once more, as lines over it.
void add_wires(CommandList& list, FrameSettings const& s, RasterizerState lines)
{
    lines.fill = FillMode::Wireframe;
    lines.multisample_enable = s.samples > 1;
    lines.slope_scaled_depth_bias = -1; // edges lie on the surface's own triangles
    lines.depth_bias = -64;
    PixelShader const ink = bind_pixel_shader(FlatPixelShader{{0.05f, 0.06f, 0.08f, 1}}, s.machine);
    std::vector<Draw> wires;
    list.for_each_surface_draw([&](Draw const& d) {
        wires.push_back(d);
        wires.back().name += ": edges";
        wires.back().pipeline.pixel_shader = ink;
        wires.back().rasterizer = lines;
    });
    for (Draw& d : wires) list.commands.emplace_back(std::move(d));
}

// A colour for each patch, by its valence.
void show_valences(CommandList& list, RefinedMesh const& mesh, FrameSettings const& s)
{
    if (!list.primitives_are_patches())
        throw Error("the valence view tells patches apart by SV_PrimitiveID, which the Direct3D 10 "
                    "path, and a scheme without a tessellator, has of triangles; 'patches' is a "
                    "view that they have");
    PatchValences const valences(mesh);
    PatchColorPixelShader view;
    view.light = as_array(key_light(s.camera));
    list.for_each_surface_draw([&](Draw& d) {
        auto const colors = std::make_shared<std::vector<float>>();
        for (PatchPlace const& p : d.patches) {
            std::array<float, 3> const color = valences(p).color();
            colors->insert(colors->end(), color.begin(), color.end());
        }
        view.colors = {*colors, PatchColorPixelShader::kSlot, "patch_colors"};
        d.pipeline.pixel_shader = on_surface(view, s);
        list.memory.push_back(colors);
    });
}

// Patches without are grey beside others, but a picture of them alone would say nothing.
void expect_curvature(CommandList const& list)
{
    bool patches = false, some = false;
    list.for_each_surface_draw([&](Draw const& d) {
        patches = true;
        some = some || d.has_curvature();
    });
    if (patches && !some)
        throw Error("the curvature view has nothing to show: no patch has second derivatives");
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
    RasterTarget raster{{&color}, &frame.depth, {{0, 0, float(s.width), float(s.height), 0, 1}}};
    raster.rasterizer.cull = s.cull;
    raster.rasterizer.front_counter_clockwise = true; // as the papers' meshes
    if (frame.coverage) {
        frame.coverage->clear();
        raster.coverage = frame.coverage.get();
    }
    CommandList list = frame_commands(mesh, s, seen_surface(s));
    if (s.view == View::Curvature) expect_curvature(list);
    if (s.view == View::Valence)
        show_valences(list, mesh.mesh(), s);
    else
        list.for_each_surface_draw([&](Draw& d) { d.pipeline.pixel_shader = make_view(d, s); });
    if (s.view == View::Wire) add_wires(list, s, raster.rasterizer);
    ListStatistics statistics =
        run_commands(list, threads, {&raster, {}, s.vertex_cache, &frame.memory, progress});
    frame.statistics = std::move(statistics.total);
    frame.commands = std::move(statistics.commands);
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

ListStatistics visit_surface(PatchMesh const& mesh, FrameSettings const& s,
                             ThreadPool const& threads, SurfaceVisitor const& visit)
{
    return run_commands(frame_commands(mesh, s, surface_settings(s)), threads,
                        {nullptr, visit, s.vertex_cache, nullptr, {}});
}

} // namespace tessemu
