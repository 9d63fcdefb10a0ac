// The cage form of a scheme: a patch for each face, its control points the face's vertices with
// their normals. A scheme says how its domain shader makes a surface of them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"
#include "shaders_cpp/cage_form/cage_shaders.h"

namespace tessemu {

/// Unit normals of the vertices: the mean of the faces around, each by its area; 0 where there is
/// none.
/// \cost linear in the faces
std::vector<glm::vec3> vertex_normals(ControlMesh const& mesh);

class CageForm final : public PatchMesh {
public:
    /// The domain shader of patches with so many sides; gives SurfacePoints of NormalVertex
    /// patches.
    using Surface = std::function<DomainShader(int sides, SurfaceSettings const&)>;

    /// \param mesh  of triangles and quads
    CageForm(std::shared_ptr<RefinedMesh const> mesh, Surface surface);

    CommandList commands(SurfaceSettings const& settings) const override;
    std::vector<PatchCount> patch_counts() const override;
    std::vector<std::string> warnings() const override { return warnings_; }

private:
    struct Group {
        PatchKind kind;
        int sides;
        std::vector<PatchPlace> patches;
        std::vector<std::uint32_t> indices;
    };
    Surface surface_;
    std::vector<float> vertices_; // position and normal, six floats each
    Group groups_[2];             // triangles, quads
    std::vector<std::string> warnings_;
};

} // namespace tessemu
