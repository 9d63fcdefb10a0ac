// The table form of a scheme: patches summed from tables of basis functions over the mesh that the
// scheme's initial step has made (HOLL10 2). A scheme says how tables are made of a local mesh.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/mesh_tables.h"
#include "pipeline/commands/patch_mesh.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

class TableForm : public PatchMesh {
public:
    /// Where a patch's points lie.
    enum class Mesher {
        Tessellator, ///< Direct3D 11's; between samples linear on the finest grid
        Pattern,     ///< a refinement pattern, an instance a patch: samples alone
    };

    /// \param make  tables of MeshTables::kSteps
    TableForm(std::shared_ptr<RefinedMesh const> mesh, MeshTables::Make const& make,
              Parameters const& parameters, BuildServices const& services);

    CommandList commands(SurfaceSettings const& settings) const override;
    std::vector<PatchCount> patch_counts() const override;
    std::vector<std::string> warnings() const override { return warnings_; }
    bool has_creases() const override
    {
        return normals_ == Normals::Tangents ? tables_.has_sharp_edges() : tables_.has_creases();
    }

    MeshTables const& tables() const { return tables_; }

    /// Of which normals are.
    enum class Normals {
        Shading,  ///< summed as positions are (subdivision shading)
        Tangents, ///< of the surface, from tables of tangents
    };
    /// "mesher", "normals", "tables".
    static std::vector<SchemeParameter> parameters();
    /// How tables are made by a scheme's masks: in double, or, where they are not enforced, as they
    /// come of each patch alone in single precision.
    template <class Masks> static MeshTables::Make maker(Parameters const& parameters)
    {
        if (parameters.word("tables") == "enforced")
            return [](LocalMesh const& type) {
                return make_local_tables<Masks>(type, MeshTables::kSteps);
            };
        return [](LocalMesh const& type) {
            return make_local_tables<Masks, SingleRow>(type, MeshTables::kSteps);
        };
    }

private:
    struct Kind {
        PatchKind kind;
        std::vector<std::uint32_t> sectors; ///< TangentTablePatch::corners
        std::vector<PatchPlace> places;
        std::vector<std::uint32_t> patches; ///< TableBuffers::patches
        std::vector<std::uint32_t> corners; ///< of each patch, vertices of the mesh
        std::vector<std::uint32_t> types;   ///< of each patch
    };
    void add_kinds();
    HalfEdge half_edge(MeshTables::Patch const& patch, int corner) const;
    void add_corner_terms();
    std::span<float const> add_corner_normals(CommandList& list, VertexSource const& positions,
                                              Machine const& machine) const;
    template <class Patch>
    void add_draw(CommandList& list, Kind const& kind, Patch const& patch,
                  VertexSource const& positions, std::shared_ptr<DomainPoints const> const& pattern,
                  std::span<float const> pattern_vertices, SurfaceSettings const& settings) const;
    /// TableVerticesShader's entries.
    static std::vector<std::uint32_t> entries(std::span<TableVertex const> vertices);

    Mesher mesher_;
    Normals normals_;
    std::vector<std::string> warnings_;
    MeshTables tables_;
    std::vector<float> entries_of_tables_;      ///< TableBuffers::tables
    std::vector<float> entries_of_tangents_[2]; ///< TangentTablePatch::tangents
    // CornerNormalShader's, by sector of a vertex.
    std::vector<std::uint32_t> corners_, corner_terms_;
    std::vector<float> corner_weights_;
    std::vector<std::uint32_t> points_;           ///< TableBuffers::points
    std::vector<std::uint32_t> sectors_, wholes_; ///< of the vertices; whatever is sharp
    std::vector<Kind> kinds_;
};

} // namespace tessemu
