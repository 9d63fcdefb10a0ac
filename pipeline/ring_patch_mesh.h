// A patch mesh in two-stage form (LOOP09 4.1, 4.2): a vertex shader over one-ring textures, a hull
// shader over sectors with the offsets texture. A scheme says which shaders.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/technique.h"
#include "pipeline/vertex_rings.h"
#include "shaders_cpp/sector_tables.h"

namespace tessemu {

/// What a draw's hull shader reads besides the vertices; see SectorTables.
struct SectorBuffers {
    std::span<std::uint32_t const> offsets, edges;
    std::span<float const> angles;
};

/// Patches of one hull and one domain shader.
struct RingKind {
    PatchKind kind;
    int sides;
    std::function<std::shared_ptr<HullProgram const>(SectorBuffers const&, PassSettings const&)>
        hull_program;
    std::function<std::shared_ptr<DomainProgram const>(PassSettings const&)> domain_program;
};

struct RingScheme {
    std::vector<RingKind> kinds;
    std::function<std::size_t(std::uint32_t face)> kind_of;
    std::function<std::shared_ptr<VertexProgram const>(RingTextures const&, PassSettings const&)>
        vertex_program;
};

/// Throws LimitError for a vertex with more edges than the vertex shader's registers hold. \cost
/// linear in the faces
std::unique_ptr<PatchMesh> make_ring_patch_mesh(Topology const& topology, RingScheme scheme);

/// A hull shader with SectorTables' members on the buffers of a kind.
template <class Shader>
std::shared_ptr<HullProgram const> sector_hull_program(SectorBuffers const& buffers,
                                                       PassSettings const& settings)
{
    Shader hs;
    hs.offsets = {buffers.offsets, 0, "corner_offsets"};
    hs.edges = {buffers.edges, 1, "edge_bits"};
    hs.angles = {buffers.angles, 2, "angles"};
    hs.factors = settings.factor_rule();
    return make_hull_program(hs, settings.machine);
}

} // namespace tessemu
