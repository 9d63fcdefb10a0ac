// A frame as a list of commands, in order: dispatches, draws and batches of draws over buffers.
//
// A patch mesh makes the list, others change it: the Direct3D 10 path turns a draw into two, the
// wire view adds a second drawing of each, a checker's test replaces a shader. Whatever fills a
// buffer is a command of its own, so a filter that leaves draws of the surface out loses no
// dispatch.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/compute_shader.h"
#include "emu/graphics_pipeline.h"
#include "pipeline/mesh/patch_place.h"
#include "shaders_cpp/curvature.h"
#include "shaders_cpp/displacement.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <functional>
#include <map>
#include <optional>
#include <variant>

namespace tessemu {

/// What a patch is, as pictures and figures tell patches apart.
enum class PatchClass {
    RegularQuad,
    IrregularQuad,
    Triangle,
    Other,
    // At tags, of schemes that honour them.
    Crease, ///< or boundary
    Dart,
    ConvexCorner,
    ConcaveCorner,
    SemiSharp,
};

/// Patches of one shape: one domain shader, one number of control points.
struct PatchKind {
    std::string name; ///< "regular quad"
    PatchClass patch_class = PatchClass::Other;
    /// What the patch's edges are, from corner k to corner k+1, where the paper has words for them:
    /// "spoke".
    std::array<std::string, 4> edges = {};
};

struct Dispatch {
    std::string name; ///< what it does: "skinning"
    ComputeShader shader;
    std::array<std::uint32_t, 3> groups;
};

/// A draw that fills buffers, or shows patches of the surface.
struct Draw {
    std::string name; ///< what it draws or fills
    GraphicsPipelineDesc pipeline;
    DrawCall call;
    std::vector<StreamOutputBuffer> stream_output = {};
    /// Where it draws, whatever the run's target: it fills targets of the list's memory, so it runs
    /// also where there is no picture, and shows no patches.
    std::optional<RasterTarget> target = {};
    std::optional<RasterizerState> rasterizer = {}; ///< instead of the target's
    /// Of these, cache, memory, progress and streams are the run's and are overwritten.
    DrawOptions options = {};

    // Of a draw that shows patches.
    PatchKind kind = {};
    std::span<PatchPlace const> patches = {}; ///< by primitive id; empty: it shows none
    /// The vertices of each patch, where no tessellator makes them: of an instanced draw vertex i
    /// of instance p is point i of patch p, of any other vertex p * points + i. Its vertex shader
    /// gives such records as the other draws' domain shaders do.
    std::shared_ptr<DomainPoints const> grid = {};

    bool shows_surface() const { return !patches.empty(); }
    /// Of the last stage before the geometry shader and the rasterizer.
    OutputLayout output() const;
    /// Whether its vertices have a mean curvature.
    bool has_curvature() const { return output().holds<CurvedVertex<float>>(); }
};

/// Draws that fill buffers and touch nothing in common, made when they run: in any order, several
/// at once. Results and counts are as if one came after the other.
struct DrawBatch {
    std::string name; ///< what they draw or fill
    std::size_t count = 0;
    std::function<Draw(std::size_t)> draw; ///< of each number below `count`; called on any thread
};

using Command = std::variant<Dispatch, Draw, DrawBatch>;

struct CommandList {
    std::vector<Command> commands;
    std::vector<std::shared_ptr<void const>> memory; ///< what the commands view

    /// work(draw) for each draw of the surface, in order.
    template <class Work> void for_each_surface_draw(Work&& work)
    {
        for (Command& c : commands)
            if (Draw* const d = std::get_if<Draw>(&c); d && d->shows_surface()) work(*d);
    }
    template <class Work> void for_each_surface_draw(Work&& work) const
    {
        for (Command const& c : commands)
            if (Draw const* const d = std::get_if<Draw>(&c); d && d->shows_surface()) work(*d);
    }
    /// Leaves out the draws of the surface that `keep` does not want. What fills buffers stays.
    template <class Keep> void filter_surface_draws(Keep&& keep)
    {
        std::erase_if(commands, [&](Command const& c) {
            Draw const* const d = std::get_if<Draw>(&c);
            return d && d->shows_surface() && !keep(*d);
        });
    }
    /// Of all draws of the surface.
    std::size_t patches() const;
    /// Whether SV_PrimitiveID tells a patch in all draws of the surface: instances have it of their
    /// triangles.
    bool primitives_are_patches() const;
};

/// A point of the surface in object space.
struct SurfaceVertex {
    glm::vec3 position;       ///< displaced, where the surface is
    glm::vec3 normal;         ///< of the smooth surface
    glm::vec3 smooth;         ///< its point
    glm::vec2 coordinates{0}; ///< texture coordinates of the patch, where it is displaced
    float curvature = 0;      ///< mean curvature, where the draw has it
};

/// A patch as its draw left it: points with a place, and their connectivity.
class SurfacePatch {
public:
    SurfacePatch(Draw const& draw, ShadedPatch const& patch);

    PatchKind const& kind() const { return draw_->kind; }
    PatchPlace const& place() const { return draw_->patches[patch_.primitive_id]; }
    std::uint32_t number() const { return patch_.primitive_id; } ///< in its draw
    DomainPoints const& domain() const { return *patch_.points; }
    std::size_t points() const { return patch_.points->patch.points(); }
    std::vector<std::uint32_t> const& triangles() const { return patch_.points->patch.indices; }
    bool has_curvature() const { return draw_->has_curvature(); }
    /// Of a draw whose transform was the identity. Throws Error where the draw writes no
    /// ShadedVertex, DisplacedVertex or CurvedVertex records.
    SurfaceVertex vertex(std::size_t i) const;
    /// The whole record that the last stage before the rasterizer wrote.
    std::vector<float> scalars(std::size_t i) const;

private:
    Draw const* draw_;
    ShadedPatch patch_;
    OutputLayout layout_;
};

using SurfaceVisitor = std::function<void(SurfacePatch const&)>;

/// Like commands in a row, and what they counted.
struct CommandStatistics {
    std::string kind; ///< "dispatch", "draw" (a batch's too)
    std::string name;
    std::uint64_t number = 0; ///< how many
    DrawStatistics statistics;
    std::uint64_t own_targets = 0; ///< of draws into targets of their own (Draw::target)
    std::map<std::uint64_t, std::uint64_t> draws = {}; ///< by the fragments that each shaded

    CommandStatistics& operator+=(CommandStatistics const& o);
};

struct ListStatistics {
    DrawStatistics total;
    std::vector<CommandStatistics> commands;
};

struct CommandOptions {
    RasterTarget const* raster = nullptr; ///< none: rasterization is off
    SurfaceVisitor visit = {};            ///< sees the patches of the surface
    VertexCacheModel vertex_cache = {};
    DrawMemory* memory = nullptr;
    DrawProgress progress = {}; ///< patches done, of all
};

/// Runs the commands in order.
ListStatistics run_commands(CommandList const& list, ThreadPool const& threads,
                            CommandOptions const& options = {});

} // namespace tessemu
