// The cage form of a scheme: a patch for each face, its control points the face's vertices with
// their normals. A scheme derives from it and says how its domain shader makes a surface of them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"
#include "shaders_cpp/cage_form/cage_shaders.h"

namespace tessemu {

/// Unit normals of the vertices: the mean of the faces around, each by its area; z where there is
/// none. Vertices that edges of no length join have one.
/// \cost linear in the faces
std::vector<glm::vec3> vertex_normals(ControlMesh const& mesh);

/// Whose normals a face's corners have: their vertices', or the face's own in the pose that is
/// drawn, as in a mesh whose normals are split along all edges.
enum class CageNormals { Vertices, Faces };

class CageForm : public PatchMesh {
public:
    CommandList commands(SurfaceSettings const& settings) const final;
    std::vector<PatchCount> patch_counts() const final;
    std::vector<std::string> warnings() const final { return warnings_; }

protected:
    /// \param mesh  of triangles and quads
    explicit CageForm(std::shared_ptr<RefinedMesh const> mesh,
                      CageNormals normals = CageNormals::Vertices);

    /// What a scheme says: of patches with so many sides, from NormalVertex patches to
    /// SurfacePoints.
    virtual DomainShader domain_shader(int sides, SurfaceSettings const& settings) const = 0;
    /// From NormalVertex patches to them, by default without patch constants.
    virtual HullShader hull_shader(int sides, SurfaceSettings const& settings) const;
    /// What hull shaders begin with.
    template <TessellatorDomain kDomain>
    CageHullShader<kDomain> cage_hull_shader(SurfaceSettings const& settings) const
    {
        return {settings.factor_rule(), face_normals_};
    }

private:
    struct Group {
        PatchKind kind;
        int sides;
        std::vector<PatchPlace> patches;
        std::vector<std::uint32_t> indices;
    };
    VertexSource vertices(CommandList& list, SurfaceSettings const& settings) const;

    bool face_normals_;
    std::vector<float> vertices_; // of the file's mesh: position and normal, six floats each
    Poles normals_;               // of a mesh that steps make: a dispatch makes its normals
    Group groups_[2];             // triangles, quads
    std::vector<std::string> warnings_;
};

} // namespace tessemu
