// A frame: a patch mesh through all passes into a picture, or patch by patch to a visitor.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/camera.h"
#include "pipeline/displacement.h"
#include "pipeline/technique.h"

#include <optional>

namespace tessemu {

enum class View { Lit, Normals, Patches, Depth, Wire, Coverage };
std::string_view name_of(View view);
std::optional<View> view_from_name(std::string_view name);
inline constexpr View kViews[] = {View::Lit,   View::Normals, View::Patches,
                                  View::Depth, View::Wire,    View::Coverage};

/// The pixel shader of a view; on a displaced surface normals follow the height map.
std::shared_ptr<PixelProgram const> make_view(View view, PatchKind const& kind,
                                              Camera const& camera,
                                              Displacement const* displacement,
                                              Machine const& machine);

/// The colour of a patch kind in pictures, by its color_index.
std::array<float, 3> patch_kind_color(int color_index);

/// Tess factors from the camera, an edge at a time.
struct AdaptiveFactors {
    enum class Kind { None, Pixels, Distance };
    Kind kind = Kind::None;
    float value = 8; ///< Pixels: length of a segment in the picture. Distance: at which an edge
                     ///< gets the frame's tess factor; it falls with the distance
};
/// As the hull shaders have it.
TessFactorRule tess_factor_rule(AdaptiveFactors const& adaptive, Camera const& camera, int height,
                                float tess_factor);

struct FrameSettings {
    int width = 1024, height = 1024;
    Camera camera;
    View view = View::Lit;
    std::array<float, 4> background{0.93f, 0.94f, 0.96f, 1.0f};
    CullMode cull = CullMode::None; ///< open surfaces show their inside
    int samples = 1;                ///< 1, 2, 4 or 8
    Format color_format = Format::R8G8B8A8_UNORM;
    float tess_factor = 1;
    AdaptiveFactors adaptive; ///< instead of the uniform factor
    Partitioning partitioning = Partitioning::FractionalOdd;
    bool true_normals = false;
    std::shared_ptr<Displacement const> displacement; ///< none: the smooth surface
    std::shared_ptr<Pose const> pose;                 ///< none: the mesh at rest
    PlantedMistake mistake;
    float parity = 0;        ///< object space; see VertexFinish
    bool direct3d10 = false; ///< by geometry shader and instances, see instanced_tessellation.h
    Machine machine;
    VertexCacheModel vertex_cache;
};

/// What every pass of a frame is made for; without a camera's transform and without pixel shaders.
PassSettings pass_settings(FrameSettings const& settings);
/// The passes of a mesh for a frame, in order.
std::vector<DrawPass> frame_passes(PatchMesh const& mesh, FrameSettings const& settings,
                                   PassSettings const& pass);

/// A picture and what it took. Its memory serves frame after frame.
struct Frame {
    ColorTarget color; ///< resolved where there are several samples
    DepthTarget depth; ///< every sample
    DrawStatistics statistics;
    std::unique_ptr<ColorTarget> color_samples; ///< what is drawn to with several samples
    std::unique_ptr<CoverageCounts> coverage;   ///< of the coverage view
    DrawMemory memory;

    /// Throws LimitError for targets that are too large.
    explicit Frame(FrameSettings const& settings);
};

/// Clears the frame and draws all passes in order. The frame was made for the same size, format and
/// samples. The wire view draws the surface first and then its edges over it, and counts both; the
/// coverage view paints how often a pixel's first sample was covered: grey not at all, blue to
/// white an even number of times, orange an odd number.
void draw_frame(PatchMesh const& mesh, FrameSettings const& settings, ThreadPool const& threads,
                Frame& frame, DrawProgress const& progress = {});
/// The same in a frame of its own.
Frame draw_frame(PatchMesh const& mesh, FrameSettings const& settings, ThreadPool const& threads,
                 DrawProgress const& progress = {});

/// A patch of the surface in object space: the domain shader ran with the identity transform, so
/// the position's x, y, z are the surface's, bit for bit (w is 1).
using SurfaceVisitor = std::function<void(DrawPass const&, ShadedPatch const&)>;

/// Tessellates without raster; uses machine, factors and cache of `settings`. `visit` may be empty.
DrawStatistics visit_surface(PatchMesh const& mesh, FrameSettings const& settings,
                             ThreadPool const& threads, SurfaceVisitor const& visit);

} // namespace tessemu
