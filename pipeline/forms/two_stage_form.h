// The two-stage form of a scheme (LOOP09 4.1, 4.2): a vertex shader over one-ring textures, a hull
// shader over corners with the offsets texture. A scheme derives from it and says which shaders.
//
// The vertex shader hands a vertex with up to 15 edges on. A patch with a vertex of more is wide: a
// dispatch makes, of each of its corners, the window of the ring that the patch needs.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/commands/patch_mesh.h"
#include "pipeline/forms/vertex_rings.h"
#include "shaders_cpp/two_stage_form/corner_tables.h"

#include <map>

namespace tessemu {

/// What a draw's hull shader reads besides the vertices; see CornerTables.
struct CornerBuffers {
    std::span<std::uint32_t const> offsets, edges;
    std::span<float const> angles;
    std::span<std::uint32_t const> corner_poles;
    std::span<float const> poles; ///< see PoleNormals
};

/// What the dispatch of wide patches reads and writes; see CornerWindow.
struct WindowBuffers {
    std::span<std::uint32_t const> corners;
    std::span<float const> constants;
    std::span<float> windows;
};

class TwoStageForm : public PatchMesh {
public:
    CommandList commands(SurfaceSettings const& settings) const final;
    std::vector<PatchCount> patch_counts() const final;
    std::vector<std::string> warnings() const final { return warnings_; }
    std::optional<AnotherWay> another_way() const final { return another_way_; }

protected:
    struct Kind {
        PatchKind kind;
        int sides;
    };
    TwoStageForm(std::shared_ptr<RefinedMesh const> mesh, std::vector<Kind> kinds);
    /// Sorts the faces by kind: the last line of the scheme's constructor.
    /// \cost  linear in the faces
    void make_tables();

    // What a scheme says. Kinds are numbers in the constructor's list.
    virtual std::size_t kind_of(std::uint32_t face) const = 0;
    virtual VertexShader vertex_shader(RingTextures const& textures,
                                       SurfaceSettings const& settings) const = 0;
    virtual HullShader hull_shader(std::size_t kind, CornerBuffers const& buffers,
                                   SurfaceSettings const& settings) const = 0;
    virtual DomainShader domain_shader(std::size_t kind, SurfaceSettings const& settings) const = 0;

    // What a scheme says that takes vertices of more than RingLayout::kEdges edges.
    virtual std::vector<double> wide_constants(int /*faces*/, bool /*boundary*/) const
    {
        return {};
    }
    virtual ComputeShader window_shader(RingTextures const&, WindowBuffers const&,
                                        SurfaceSettings const&) const
    {
        return {};
    }

private:
    // Patches of one kind: an index buffer of their corners, and the offsets texture (figure 8).
    struct Group {
        std::vector<PatchPlace> patches;
        std::vector<std::uint32_t> indices, offsets, edges;
        std::vector<std::uint32_t> poles;   // by corner; empty: the mesh has none
        std::vector<std::uint32_t> windows; // of wide patches: CornerWindow by corner
    };
    // Where the constants of a ring and its row of the angles are.
    struct WideRing {
        std::uint32_t first_constant, row;
    };
    WideRing wide_ring(int faces, bool boundary);
    std::uint32_t most_edges(std::uint32_t face) const;
    void add_patch(std::uint32_t face, bool wide);
    void add_wide_draws(CommandList& list, RingTextures const& textures,
                        std::span<float const> poles, SurfaceSettings const& settings) const;

    std::vector<Kind> kinds_;
    Poles poles_;
    VertexRings rings_;
    std::vector<float> angles_;
    std::vector<Group> groups_, wide_; // by kind
    std::map<std::pair<int, bool>, WideRing> wide_rings_;
    std::vector<float> wide_constants_;
    std::vector<std::string> warnings_;
    std::optional<AnotherWay> another_way_;
};

/// A hull shader with CornerTables' members on the buffers of a kind.
template <class Shader>
HullShader corner_hull_shader(CornerBuffers const& buffers, SurfaceSettings const& settings)
{
    Shader hs;
    hs.offsets = {buffers.offsets, 0, "corner_offsets"};
    hs.edges = {buffers.edges, 1, "edge_bits"};
    hs.angles = {buffers.angles, 2, "angles"};
    hs.corner_poles = {buffers.corner_poles, 3, "corner_poles"};
    hs.poles.normals = {buffers.poles, 4, "pole_normals"};
    hs.factors = settings.factor_rule();
    return bind_hull_shader(hs, settings.machine);
}

} // namespace tessemu
