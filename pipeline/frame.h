// A frame: a patch mesh's commands into a picture, or patch by patch to a visitor.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/camera.h"
#include "pipeline/commands/displacement.h"
#include "pipeline/commands/patch_mesh.h"

#include <optional>

namespace tessemu {

enum class View { Lit, Normals, Patches, Valence, Zebra, Curvature, Depth, Wire, Coverage };
std::string_view name_of(View view);
std::optional<View> view_from_name(std::string_view name);
inline constexpr View kViews[] = {View::Lit,     View::Normals, View::Patches,
                                  View::Valence, View::Zebra,   View::Curvature,
                                  View::Depth,   View::Wire,    View::Coverage};

/// The colour of a class of patches in pictures.
std::array<float, 3> color_of(PatchClass patch_class);

/// Tess factors from the camera, an edge at a time.
struct AdaptiveFactors {
    enum class Kind { None, Pixels, Distance };
    Kind kind = Kind::None;
    double value = 8; ///< Pixels: length of a segment in the picture. Distance: at which an edge
                      ///< gets the frame's tess factor; it falls with the distance
};
/// As the hull shaders have it.
TessFactorRule tess_factor_rule(AdaptiveFactors const& adaptive, Camera const& camera, int height,
                                float tess_factor);

struct FrameSettings : SurfaceSettings {
    int width = 1024, height = 1024;
    Camera camera;
    View view = View::Lit;
    std::array<float, 4> background{0.93f, 0.94f, 0.96f, 1.0f};
    CullMode cull = CullMode::None; ///< open surfaces show their inside
    int samples = 1;                ///< 1, 2, 4 or 8
    Format color_format = Format::R8G8B8A8_UNORM;
    AdaptiveFactors adaptive; ///< instead of the uniform factor
    bool direct3d10 = false;  ///< by geometry shader and instances, see direct3d10.h
    VertexCacheModel vertex_cache;
    float curvature_max = 1; ///< of the curvature view: what is red, 1/length in object space
};

/// The pixel shader of the settings' view for a draw of the surface; on a displaced surface normals
/// follow the height map. That of the valence view depends on the patches: draw_frame makes it.
PixelShader make_view(Draw const& draw, FrameSettings const& settings);

/// The surface of a frame in object space: its adaptive rule from the camera, curvature if the view
/// shows it, the identity transform.
SurfaceSettings surface_settings(FrameSettings const& settings);
/// The same, through the camera.
SurfaceSettings seen_surface(FrameSettings const& settings);
/// The commands of a mesh for a frame, without pixel shaders; by the Direct3D 10 path where asked
/// for. Throws Error for the curvature of a displaced surface.
CommandList frame_commands(PatchMesh const& mesh, FrameSettings const& settings,
                           SurfaceSettings const& surface);

/// A picture and what it took. Its memory serves frame after frame.
struct Frame {
    ColorTarget color;                          ///< resolved where there are several samples
    DepthTarget depth;                          ///< every sample
    DrawStatistics statistics;                  ///< of all commands
    std::vector<CommandStatistics> commands;    ///< command by command
    std::unique_ptr<ColorTarget> color_samples; ///< what is drawn to with several samples
    std::unique_ptr<CoverageCounts> coverage;   ///< of the coverage view
    DrawMemory memory;

    /// Throws LimitError for targets that are too large.
    explicit Frame(FrameSettings const& settings);
};

/// Clears the frame and runs all commands in order. The frame was made for the same size, format
/// and samples. The wire view draws the surface first and then its edges over it, and counts both;
/// the valence view paints patches by PatchValence, and takes no Direct3D 10 path, whose pixels do
/// not know their patch: throws Error; the curvature view shows draws without a curvature in grey,
/// and throws Error for a displaced surface, and where no draw has one;
/// the coverage view paints how often a pixel's first sample was covered: grey not at all, blue to
/// white an even number of times, orange an odd number.
void draw_frame(PatchMesh const& mesh, FrameSettings const& settings, ThreadPool const& threads,
                Frame& frame, DrawProgress const& progress = {});
/// The same in a frame of its own.
Frame draw_frame(PatchMesh const& mesh, FrameSettings const& settings, ThreadPool const& threads,
                 DrawProgress const& progress = {});

/// Tessellates without raster, in object space: the transform is the identity, so positions are the
/// surface's bit for bit. Uses machine, factors and cache of `settings`. `visit` may be empty.
ListStatistics visit_surface(PatchMesh const& mesh, FrameSettings const& settings,
                             ThreadPool const& threads, SurfaceVisitor const& visit);

} // namespace tessemu
