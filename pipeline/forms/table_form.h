// The table form of a scheme: patches summed from tables of basis functions over the mesh that the
// scheme's initial step has made (HOLL10 2). A scheme says how tables are made of a local mesh.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/mesh_tables.h"
#include "pipeline/commands/patch_mesh.h"
#include "pipeline/mesh/gradient_rows.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

class TableForm : public PatchMesh {
public:
    /// Where a patch's points lie.
    enum class Mesher {
        Tessellator, ///< Direct3D 11's; between samples linear on the finest grid
        Pattern,     ///< a refinement pattern, an instance a patch: samples alone
    };

    /// What a scheme's masks are to it.
    struct Rules {
        MeshTables::Make make; ///< tables of MeshTables::kSteps steps
        int rings;             ///< of faces around a patch that weigh in it
        /// Of the vertices that patches sum over, after the mesh's steps; none: no tangents.
        GradientRows (*gradients)(RefinedMesh const&, std::span<TableVertex const>,
                                  std::span<std::uint32_t const> rings);
    };
    TableForm(std::shared_ptr<RefinedMesh const> mesh, Rules const& rules,
              Parameters const& parameters, BuildServices const& services);

    CommandList commands(SurfaceSettings const& settings) const override;
    std::vector<PatchCount> patch_counts() const override;
    std::vector<std::string> warnings() const override { return warnings_; }
    bool has_creases() const override
    {
        return normals_ == Normals::Tangents
                   ? tables_.has_sharp_edges()
                   : normals_ == Normals::Shading && tables_.has_creases();
    }

    MeshTables const& tables() const { return tables_; }

    /// Of which normals are.
    enum class Normals {
        Shading,  ///< summed as positions are (subdivision shading)
        Carried,  ///< the same from the file's mesh on: its steps carry the normals along
        Tangents, ///< of the surface, from tables of tangents
    };
    /// "mesher", "shading", "tables", of masks that have tangents "normals" and "initial".
    static std::vector<SchemeParameter> parameters(bool has_tangents, int steps);
    /// Of subdivision, that "shading" asks for.
    static int more_steps(Parameters const& parameters, int steps);
    /// How tables are made by a scheme's masks: in double, or, where they are not enforced, as they
    /// come of each patch alone in single precision.
    template <class Masks> static Rules rules(Parameters const& parameters)
    {
        Rules out{{}, rings_of<Masks>(), nullptr};
        if constexpr (!WideMasks<Masks>) out.gradients = gradient_rows<Masks>;
        if (parameters.word("tables") == "enforced")
            out.make = [](LocalMesh const& type) {
                return make_local_tables<Masks>(type, MeshTables::kSteps);
            };
        else
            out.make = [](LocalMesh const& type) {
                return make_local_tables<Masks, SingleRow>(type, MeshTables::kSteps);
            };
        return out;
    }

private:
    template <class Masks>
    static GradientRows gradient_rows(RefinedMesh const& mesh,
                                      std::span<TableVertex const> vertices,
                                      std::span<std::uint32_t const> rings)
    {
        Topology const& t = mesh.topology();
        std::vector<WeightedSum> const x = sums_over_base<Masks>(mesh);
        GradientMasks<Masks> masks(t);
        GradientRows out;
        for (TableVertex const& v : vertices) {
            auto const faces = t.ring(v.vertex);
            std::optional<std::size_t> first; // of a side's edges, in the whole ring
            if (v.ring - (v.is_open ? 1 : 0) < faces.size()) {
                first = 0;
                while (t.vertex_of(t.next(faces[*first])) != rings[v.first_ring]) ++*first;
            }
            auto const [a, b] = masks.at(v.vertex, first, x);
            out.add(x[v.vertex], a, b);
        }
        return out;
    }
    /// GradientPointsShader's, of the vertices that patches sum over.
    struct Gradients {
        explicit Gradients(GradientRows const& rows)
            : first(rows.first),
              vertices(rows.vertices),
              weights(rows.weights.begin(), rows.weights.end())
        {
        }
        std::vector<std::uint32_t> first, vertices;
        std::vector<float> weights;
    };
    struct Kind {
        PatchKind kind;
        int sides;
        std::vector<std::uint32_t> sectors; ///< TangentTablePatch::corners
        std::vector<PatchPlace> places;
        std::vector<std::uint32_t> patches; ///< TableBuffers::patches
        std::vector<std::uint32_t> corners; ///< of each patch, vertices of the mesh
        std::vector<std::uint32_t> types;   ///< of each patch
    };
    void add_kinds();
    void add_gradients(Rules const& rules);
    HalfEdge half_edge(MeshTables::Patch const& patch, int corner) const;
    void add_corner_terms();
    std::span<float const> add_corner_normals(CommandList& list, VertexSource const& positions,
                                              Machine const& machine) const;
    /// What draws read that dispatches before them have made.
    struct Sources {
        VertexSource positions;
        std::span<float const> vertices;       ///< TableBuffers::vertices
        std::span<float const> corner_normals; ///< by TangentTablePatch; none: by TablePatch
        int pattern = 0;                       ///< segments; 0: the tessellator's points
    };
    template <class Samples>
    void add_draw(CommandList& list, Kind const& kind, Sources const& from,
                  SurfaceSettings const& settings) const;
    /// The file's positions to the vertices that patches sum over, in one pass.
    Sources add_initial_pass(CommandList& list, SurfaceSettings const& settings) const;
    /// \returns  TableBuffers::vertices
    std::span<float const> add_table_vertices(CommandList& list, VertexSource const& positions,
                                              SurfaceSettings const& settings) const;
    /// VertexFans::entries.
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
    std::vector<std::uint32_t> points_;                    ///< TableBuffers::points
    std::vector<std::uint32_t> sectors_, wholes_;          ///< of the vertices; whatever is sharp
    std::vector<std::uint32_t> file_entries_, file_rings_; ///< of the file's, where Carried
    /// One pass makes positions and normals: of each sector, and of whatever is sharp, if they are
    /// two.
    std::optional<Gradients> gradients_, whole_gradients_;
    std::vector<Kind> kinds_;
};

} // namespace tessemu
