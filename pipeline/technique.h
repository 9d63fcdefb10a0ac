// Techniques: how a control mesh becomes draws.
//
// A technique builds a patch mesh once: patch kinds, connectivity types, tables, index buffers. The
// patch mesh then gives passes for any tess factor, machine or view, so sweeps pay for tables once.
// A scheme is one folder of shaders and one technique file, registered in one line of
// technique.cpp.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/graphics_pipeline.h"
#include "pipeline/animation.h"
#include "pipeline/mistake.h"
#include "pipeline/patch_origin.h"
#include "pipeline/topology.h"
#include "shaders_cpp/projection.h"
#include "shaders_cpp/tess_factor_rule.h"
#include "shaders_cpp/watertight_patch.h"

#include <map>

namespace tessemu {

class Displacement;

/// A free choice of a scheme that a user may set.
struct SchemeParameter {
    std::string name, meaning;
    double default_value;
};

struct SchemeInfo {
    std::string name;    ///< as on the command line
    std::string paper;   ///< "LOOP09"
    std::string section; ///< "3, 4.3, 4.6"
    std::string summary;
    std::vector<SchemeParameter> parameters;
};

/// Patches of one shape: one domain shader, one number of control points.
struct PatchKind {
    std::string name; ///< "regular quad"
    int color_index;  ///< tells kinds apart in pictures
};

/// What a pass is made for.
struct PassSettings {
    float tess_factor = 1;   ///< uniform; every edge and the inside
    TessFactorRule adaptive; ///< instead of it, unless its kind is Uniform
    Partitioning partitioning = Partitioning::FractionalOdd;
    Machine machine;
    bool true_normals = false; ///< interior normals of the rational surface, not of frozen F
    Matrix4 view_projection = kIdentity;
    std::shared_ptr<Displacement const> displacement; ///< none: the smooth surface
    std::shared_ptr<Pose const> pose;                 ///< none: the mesh at rest
    PlantedMistake mistake;
    float parity = 0;                   ///< see VertexFinish
    std::array<float, 2> lattice{0, 0}; ///< see VertexFinish
    /// Called once per pass; absent: rasterization is off.
    std::function<std::shared_ptr<PixelProgram const>(PatchKind const&)> pixel_shader;

    TessFactorRule factor_rule() const
    {
        TessFactorRule rule = adaptive;
        rule.uniform = tess_factor;
        return rule;
    }
};

/// One draw of a technique.
struct DrawPass {
    PatchKind kind;
    GraphicsPipeline pipeline;
    DrawCall call; ///< views into the patch mesh, which must outlive the pass
    std::span<PatchOrigin const> patches; ///< by primitive id
    /// Work that must come first, where there is any: a dispatch or a draw that fills buffers.
    /// Gives what it counted.
    std::function<DrawStatistics(ThreadPool const&, VertexCacheModel const&)> prepare;
    std::vector<std::shared_ptr<void const>> memory; ///< what else the pass's buffers view
    /// Of a pass that draws an instance of this pattern for each patch, without a tessellator.
    std::shared_ptr<DomainPoints const> pattern;
    DrawMistakes mistakes;
};

/// Prepares and draws a pass; see draw().
DrawStatistics draw_pass(DrawPass const& pass, RasterTarget const* raster,
                         PatchVisitor const& visit, ThreadPool const& threads,
                         DrawOptions const& options = {});

/// Patches of one kind and type count, for `info`.
struct PatchCount {
    PatchKind kind;
    std::size_t patches = 0, types = 0;
    int min_inputs = 0, max_inputs = 0;
};

/// A control mesh in the form that a technique draws. Holds its tables and index buffers.
class PatchMesh {
public:
    virtual ~PatchMesh() = default;
    virtual std::vector<DrawPass> passes(PassSettings const& settings) const = 0;
    virtual std::vector<PatchCount> patch_counts() const = 0;
    /// What the scheme could not honour, in the user's words.
    virtual std::vector<std::string> const& warnings() const = 0;
};

class Technique {
public:
    virtual ~Technique() = default;
    virtual SchemeInfo info() const = 0;
    /// True if the scheme takes faces with more than 4 sides.
    virtual bool takes_polygons() const { return false; }
    /// \param topology    of a mesh that the scheme takes; both are read only here
    /// \param parameters  those that differ from their defaults; a wrong name throws Error
    /// Throws LimitError for a patch that no draw can hold.
    virtual std::unique_ptr<PatchMesh>
    build(Topology const& topology, std::map<std::string, double> const& parameters) const = 0;
};

/// The scheme's surface on the settings' machine; make_patch_pass gives it its epilog.
template <class Surface>
std::shared_ptr<DomainProgram const> surface_program(PassSettings const& settings)
{
    Mistake const m = settings.mistake.kind;
    return make_domain_program(
        Surface{settings.true_normals,
                {m == Mistake::Order, m == Mistake::Contraction, m == Mistake::Normals}},
        settings.machine);
}

/// The pass of a patch mesh whose vertex buffer is the control mesh's positions.
///
/// \param indices  `control_points` for each patch; must outlive the pass
/// \param domain   gives SurfacePoints
DrawPass make_patch_pass(PatchKind const& kind, ControlMesh const& mesh, int control_points,
                         std::span<std::uint32_t const> indices,
                         std::span<PatchOrigin const> patches,
                         std::shared_ptr<VertexProgram const> vertex,
                         std::shared_ptr<HullProgram const> hull,
                         std::shared_ptr<DomainProgram const> domain, PassSettings const& settings);

/// Faces that are not drawn: the mesh's holes, and with BoundaryRule::None those at the boundary,
/// with a warning.
std::vector<char> hidden_faces(Topology const& topology, std::vector<std::string>& warnings);
/// Warns of creases and sharp corners, which no scheme of LOOP09 knows.
void warn_of_tags(ControlMesh const& mesh, std::vector<std::string>& warnings);

/// All techniques in the order of the papers.
std::vector<std::unique_ptr<Technique>> const& techniques();
/// Throws Error that lists the known names.
Technique const& find_technique(std::string_view name);

/// A control mesh as a technique takes it: faces with more than 4 sides are split by one
/// Catmull-Clark step on the whole mesh, with a warning.
struct PreparedMesh {
    std::unique_ptr<ControlMesh> mesh;
    std::unique_ptr<Topology> topology; ///< of *mesh
    std::vector<std::string> warnings;
};
/// Throws MeshError.
PreparedMesh prepare_mesh(ControlMesh mesh, Technique const& technique);

} // namespace tessemu
