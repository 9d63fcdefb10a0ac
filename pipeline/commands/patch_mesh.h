// Patch mesh: a control mesh in the form that a scheme draws, and the draw of patches that most
// schemes need.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/command_list.h"
#include "pipeline/commands/surface_settings.h"
#include "pipeline/mesh/poles.h"
#include "pipeline/mesh/refinement.h"
#include "pipeline/mesh/valence_type.h"
#include "shaders_cpp/pole_normals.h"
#include "shaders_cpp/skinning.h"

namespace tessemu {

/// Patches of one kind, for `info`: how many, of how many connectivity types, with how many inputs.
struct PatchCount {
    PatchKind kind;
    std::size_t patches = 0, types = 0;
    int min_inputs = 0, max_inputs = 0;
    /// Of those that have one, ascending; a scheme whose tables are by type tells.
    std::vector<std::pair<ValenceType, std::size_t>> valence_types = {};
};

/// Patches that a scheme draws in another way than its paper's, for they are beyond a limit.
struct AnotherWay {
    std::uint32_t face; ///< the first, by its number in the file
    std::string what;   ///< how many, why and how, in the user's words
};
/// "3 patches have" and what.
AnotherWay another_way_of(std::size_t patches, std::uint32_t first_face, std::string const& what);

/// Holds its tables and index buffers; made once, it gives commands for any factor, machine or
/// view, so sweeps pay for tables once.
class PatchMesh {
public:
    explicit PatchMesh(std::shared_ptr<RefinedMesh const> mesh) : mesh_(std::move(mesh)) {}
    virtual ~PatchMesh() = default;

    RefinedMesh const& mesh() const { return *mesh_; }
    std::shared_ptr<RefinedMesh const> const& shared_mesh() const { return mesh_; }
    /// The surface, without pixel shaders. The list views the patch mesh, which must outlive it.
    virtual CommandList commands(SurfaceSettings const& settings) const = 0;
    virtual std::vector<PatchCount> patch_counts() const = 0;
    /// What the scheme could not honour, in the user's words.
    virtual std::vector<std::string> warnings() const { return {}; }
    virtual std::optional<AnotherWay> another_way() const { return {}; }
    /// Where patches have levels of their own, whatever the tess factor: how many have 2^i segments
    /// inside; else empty.
    virtual std::vector<std::uint64_t> level_counts() const { return {}; }
    /// Whether the surface has a normal on each side of an infinitely sharp edge.
    virtual bool has_creases() const { return false; }

private:
    std::shared_ptr<RefinedMesh const> mesh_;
};

/// Vertices of a draw: where they lie and how many floats the vertex shader reads of each.
struct VertexSource {
    std::span<float const> floats;
    int read = 3;   ///< floats of a vertex that are read, from its first
    int stride = 3; ///< floats from vertex to vertex
    /// Unit normals, read behind them; empty: none.
    std::span<float const> normals = {};

    void bind(DrawCall& call) const;
};
/// The control mesh's positions.
VertexSource positions_of(ControlMesh const& mesh);

/// A pose as shaders read it: slots 0 and 1.
SkinBuffers skin_of(Pose const& pose);

/// Where dispatches and draws find the file's vertices, in the settings' pose: the mesh's own memory,
/// or what a dispatch has moved.
VertexSource add_file_vertices(CommandList& list, ControlMesh const& base,
                               SurfaceSettings const& settings);

/// Where dispatches and draws find the drawn mesh's positions. Only the file's vertices are moved
/// into the settings' pose, by a dispatch; the steps of subdivision, dispatches too, make all
/// others of them.
///
/// \param texels  at least so many vertices' room
/// \param origin  taken off all positions before the first step
/// \returns  the control mesh's own memory, without a command, where there is neither;
///           else vertices of four floats each, texels
VertexSource add_vertices(CommandList& list, RefinedMesh const& mesh,
                          SurfaceSettings const& settings, std::size_t texels = 0,
                          std::array<float, 3> const& origin = {});

/// The drawn mesh as one of its own.
struct DrawnMesh {
    ControlMesh mesh;
    ListStatistics statistics; ///< of the dispatches that made its positions
};
/// With the positions that dispatches make, in the settings' pose. After steps, whose faces may no
/// longer reach the boundary, those that the file's boundary rule hides are holes.
DrawnMesh drawn_mesh(RefinedMesh const& mesh, SurfaceSettings const& settings,
                     ThreadPool const& threads);

/// The file's vertices, in the pose too, of a mesh that steps were taken of.
/// \param drawn  what add_vertices() gave, without texels and origin
VertexSource file_vertices(RefinedMesh const& mesh, VertexSource const& drawn);

/// Appends a dispatch of the poles' normals, where there are poles; PoleNormals reads them.
///
/// \param name       of the dispatch
/// \param positions  of the mesh's vertices in the pose that is drawn
std::span<float const> add_pole_normals(CommandList& list, Poles const& poles,
                                        VertexSource const& positions, Machine const& machine,
                                        char const* name = "pole normals");

/// What a draw of patches consists of.
struct PatchDraw {
    PatchKind kind;
    VertexSource vertices;
    int control_points = 0;                 ///< of a patch in the index buffer
    std::span<std::uint32_t const> indices; ///< `control_points` for each patch
    std::span<PatchPlace const> patches;    ///< by primitive id
    VertexShader vertex_shader;
    HullShader hull_shader;
    DomainShader domain_shader; ///< gives SurfacePoints or CurvedPoints
};

/// A surface's domain shader; with its curvature where the settings ask for it and the surface has
/// second derivatives.
template <class Surface>
DomainShader bind_surface(Surface const& surface, SurfaceSettings const& settings)
{
    if constexpr (HasSecondOrder<Surface>)
        if (settings.curvature)
            return bind_domain_shader(CurvedSurface<Surface>{surface}, settings.machine);
    return bind_domain_shader(surface, settings.machine);
}

/// The domain shader of a WatertightPatch.
template <class Surface> DomainShader surface_shader(SurfaceSettings const& settings)
{
    return bind_surface(Surface{settings.true_normals}, settings);
}

/// Appends the draw with the settings' epilog: projection, or displacement and projection. Throws
/// Error for settings that ask for the curvature of a displaced surface.
void add_patch_draw(CommandList& list, PatchDraw const& draw, SurfaceSettings const& settings);

/// Faces of the drawn mesh that are not drawn: the file's holes, and with BoundaryRule::None the
/// faces at the boundary, with a warning.
std::vector<char> hidden_faces(RefinedMesh const& mesh, std::vector<std::string>& warnings);

} // namespace tessemu
