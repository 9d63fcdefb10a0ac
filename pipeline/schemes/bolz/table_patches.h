// What the draws of a mesh's table-driven patches read, made once: tables as textures, control
// points in the order in which they are summed, the patches' corners and what lies beside them.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/mesh_basis.h"
#include "pipeline/commands/patch_mesh.h"
#include "shaders_cpp/bolz/patch_constants_shader.h"
#include "shaders_cpp/bolz/table_sums.h"

namespace tessemu {

/// In which order a patch's control points are summed.
enum class TableOrder { Global, Table };

/// Tables of a patch type as textures.
struct TypeTextures {
    TableLayout layout;
    std::vector<float> position, du, dv; ///< [row][column][channel]
};

struct TablePatches {
    /// \param hidden  by face of the drawn mesh: those are not drawn
    TablePatches(RefinedMesh const& mesh, MeshBasis const& basis, TableOrder order,
                 std::vector<char> const& hidden);

    std::vector<TypeTextures> textures; ///< by type
    /// A patch that is drawn.
    struct Patch {
        std::uint32_t face; ///< of the drawn mesh
        std::uint32_t rotation, type, corner;
        std::uint32_t first = 0, count = 0; ///< its control points among `vertices`
        std::array<std::uint32_t, 4>
            poles;            ///< at its corners 1 to 3; [0] where the corner's is one
        std::uint32_t shared; ///< its corner's shared normal
        std::array<std::uint32_t, 2> across;     ///< drawn patches beyond edges 0 and 3, where they
                                                 ///< are infinitely sharp
        std::array<std::uint32_t, 4> neighbours; ///< drawn patches beyond edges 0 to 3
    };
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<Patch> patches; ///< kinds one after the other
    struct Kind {
        PatchKind kind;
        std::uint32_t first, count; ///< of its patches
    };
    std::vector<Kind> kinds;

    std::vector<std::uint32_t> vertices; ///< [control point]: or PatchConstantsShader::kNone
    std::vector<float> offsets;          ///< [control point][2], in the global order

    // Of CornerNormalShader and SharedNormalShader.
    std::vector<std::uint32_t> corners, corner_vertices;
    std::vector<float> corner_weights;
    std::vector<std::uint32_t> shared_first{0}, shared_corners;
    Poles poles;              ///< of the mesh, and behind them each tagged corner's faces
    bool has_poles = false;   ///< the mesh has
    bool has_creases = false; ///< two patches that are drawn meet at an infinitely sharp edge

private:
    void add_textures(MeshBasis const& basis, TableOrder order);
    void add_patches(RefinedMesh const& mesh, MeshBasis const& basis, TableOrder order,
                     std::vector<char> const& hidden);
    void add_corners(RefinedMesh const& mesh, MeshBasis const& basis,
                     std::vector<char> const& hidden);
};

} // namespace tessemu
