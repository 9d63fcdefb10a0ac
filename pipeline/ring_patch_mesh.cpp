// SPDX-License-Identifier: Apache-2.0
#include "pipeline/ring_patch_mesh.h"

#include "shaders_cpp/skinning.h"

namespace tessemu {

namespace {

// Patches of one kind: an index buffer of their corners, and the offsets texture (figure 8).
struct Group {
    std::vector<PatchOrigin> patches;
    std::vector<std::uint32_t> indices, offsets, edges;
};

class RingPatchMesh final : public PatchMesh {
public:
    RingPatchMesh(Topology const& topology, RingScheme scheme)
        : mesh_(topology.mesh()),
          scheme_(std::move(scheme)),
          rings_(topology),
          groups_(scheme_.kinds.size())
    {
        for (double c : make_ring_angles()) angles_.push_back(float(c));
        std::vector<char> const hidden = hidden_faces(topology, warnings_);
        for (std::uint32_t f = 0; f < mesh_.faces(); ++f)
            if (!hidden[f]) add_patch(topology, f);
        warn_of_tags(mesh_, warnings_);
    }

    std::vector<DrawPass> passes(PassSettings const& settings) const override
    {
        if (settings.mistake.kind == Mistake::Weights)
            throw Error(
                "the mistake 'weights' needs weights of one patch, which the stencil form has: "
                "in the two-stage form a vertex is the same for all its patches");
        // At rest the texture is the mesh's; in a pose a pass before the draws fills another.
        std::shared_ptr<std::vector<float>> moved;
        if (settings.pose) moved = std::make_shared<std::vector<float>>(rings_.positions.size());
        std::vector<float> const& positions = moved ? *moved : rings_.positions;
        RingTextures textures;
        textures.rings = {rings_.rings, 0, "ring_heads"};
        textures.entries = {rings_.entries, 1, "ring_entries"};
        textures.positions =
            Texture2D(positions, RingTextures::kTextureWidth, rings_.height, 2, "ring_positions");
        auto const vertex = scheme_.vertex_program(textures, settings);
        std::vector<DrawPass> out;
        for (std::size_t k = 0; k < groups_.size(); ++k) {
            Group const& g = groups_[k];
            if (g.patches.empty()) continue;
            RingKind const& kind = scheme_.kinds[k];
            out.push_back(
                make_patch_pass(kind.kind, mesh_, kind.sides, g.indices, g.patches, vertex,
                                kind.hull_program({g.offsets, g.edges, angles_}, settings),
                                kind.domain_program(settings), settings));
            if (!moved) continue;
            DrawPass& pass = out.back();
            pass.call.vertex_buffers = {{std::as_bytes(std::span(*moved)), 16, 0}};
            pass.memory.push_back(moved);
            if (out.size() == 1) pass.prepare = skinning_pass(*settings.pose, *moved, settings);
        }
        return out;
    }

    std::vector<PatchCount> patch_counts() const override
    {
        std::vector<PatchCount> out;
        for (std::size_t k = 0; k < groups_.size(); ++k)
            if (std::size_t const n = groups_[k].patches.size())
                out.push_back(
                    {scheme_.kinds[k].kind, n, 1, scheme_.kinds[k].sides, scheme_.kinds[k].sides});
        return out;
    }

    std::vector<std::string> const& warnings() const override { return warnings_; }

private:
    /// Fills the texture of moved positions.
    std::function<DrawStatistics(ThreadPool const&, VertexCacheModel const&)>
    skinning_pass(Pose const& pose, std::vector<float>& moved, PassSettings const& settings) const
    {
        SkinningComputeShader cs;
        cs.skin = {{pose.skin->vertices, 0, "skin"}, {pose.bones, 1, "bones"}};
        cs.rest = {{&mesh_.positions.data()->x, mesh_.positions.size() * 3}, 2, "rest_positions"};
        cs.moved = {std::span(moved).first(mesh_.positions.size() * 4), 3, "moved_positions"};
        std::shared_ptr<ComputeProgram const> program = make_compute_program(cs, settings.machine);
        std::size_t const groups = (mesh_.positions.size() + 63) / 64;
        return [program, groups](ThreadPool const& threads, VertexCacheModel const&) {
            return dispatch(*program, {std::uint32_t(groups), 1, 1}, threads);
        };
    }

    void add_patch(Topology const& topology, std::uint32_t f)
    {
        auto const face = mesh_.face(f);
        auto const n = std::uint32_t(face.size());
        Group& g = groups_[scheme_.kind_of(f)];
        g.patches.push_back({f, 0, std::uint8_t(n)});
        g.indices.insert(g.indices.end(), face.begin(), face.end());
        std::uint32_t bits = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            HalfEdge const h = mesh_.face_start[f] + i;
            g.offsets.push_back(corner_offsets(topology, h));
            if (face[i] > face[(i + 1) % n]) bits |= 1u << i;
            if (topology.twin(h) == Topology::kNone) bits |= 256u << i;
        }
        g.edges.push_back(bits);
    }

    ControlMesh const& mesh_;
    RingScheme scheme_;
    VertexRings rings_;
    std::vector<float> angles_;
    std::vector<Group> groups_;
    std::vector<std::string> warnings_;
};

} // namespace

std::unique_ptr<PatchMesh> make_ring_patch_mesh(Topology const& topology, RingScheme scheme)
{
    return std::make_unique<RingPatchMesh>(topology, std::move(scheme));
}

} // namespace tessemu
