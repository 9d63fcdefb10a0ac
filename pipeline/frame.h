// A frame: a patch mesh through all passes into a picture, or patch by patch to a visitor.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/camera.h"
#include "pipeline/technique.h"

#include <optional>

namespace tessemu {

enum class View { Lit, Normals, Patches, Depth };
std::string_view name_of(View view);
std::optional<View> view_from_name(std::string_view name);
inline constexpr View kViews[] = {View::Lit, View::Normals, View::Patches, View::Depth};

/// The pixel shader of a view.
std::shared_ptr<PixelProgram const> make_view(View view, PatchKind const& kind,
                                              Camera const& camera, Machine const& machine);

struct FrameSettings {
    int width = 1024, height = 1024;
    Camera camera;
    View view = View::Lit;
    std::array<float, 4> background{0.93f, 0.94f, 0.96f, 1.0f};
    CullMode cull = CullMode::None; ///< open surfaces show their inside
    float tess_factor = 1;
    Partitioning partitioning = Partitioning::FractionalOdd;
    bool true_normals = false;
    Machine machine;
    VertexCacheModel vertex_cache;
};

struct Frame {
    RenderTarget target;
    DrawStatistics statistics;
};

/// Draws all passes in order. Throws LimitError for a target that is too large.
Frame draw_frame(PatchMesh const& mesh, FrameSettings const& settings, ThreadPool const& threads,
                 DrawProgress const& progress = {});

/// A patch of the surface in object space: the domain shader ran with the identity transform, so
/// the position's x, y, z are the surface's, bit for bit (w is 1).
using SurfaceVisitor = std::function<void(DrawPass const&, ShadedPatch const&)>;

/// Tessellates without raster; uses machine, factors and cache of `settings`. `visit` may be empty.
DrawStatistics visit_surface(PatchMesh const& mesh, FrameSettings const& settings,
                             ThreadPool const& threads, SurfaceVisitor const& visit);

} // namespace tessemu
