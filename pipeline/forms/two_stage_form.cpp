// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/two_stage_form.h"

#include "shaders_cpp/skinning.h"

namespace tessemu {

namespace {

// Fills the texture of moved positions.
Dispatch skinning(ControlMesh const& mesh, std::vector<float>& moved,
                  SurfaceSettings const& settings)
{
    SkinningComputeShader cs;
    cs.skin = skin_of(*settings.pose);
    cs.rest = {positions_of(mesh).floats, 2, "rest_positions"};
    cs.moved = {std::span(moved).first(mesh.positions.size() * 4), 3, "moved_positions"};
    auto const groups = std::uint32_t((mesh.positions.size() + 63) / 64);
    return {"skinning", bind_compute_shader(cs, settings.machine), {groups, 1, 1}};
}

} // namespace

TwoStageForm::TwoStageForm(std::shared_ptr<RefinedMesh const> mesh, std::vector<Kind> kinds)
    : PatchMesh(std::move(mesh)),
      kinds_(std::move(kinds)),
      rings_(this->mesh().topology()),
      groups_(kinds_.size())
{
    Topology const& topology = this->mesh().topology();
    for (std::uint32_t v = 0; v < this->mesh().mesh().positions.size(); ++v)
        if (!topology.ring(v).empty() && topology.valence(v) > std::uint32_t(RingLayout::kEdges))
            throw LimitError("edges at " + this->mesh().vertex_in_words(v) +
                                 ", by the vertex shader's output registers,",
                             topology.valence(v), std::uint64_t(RingLayout::kEdges));
    for (double c : make_ring_angles()) angles_.push_back(float(c));
}

void TwoStageForm::make_tables()
{
    Topology const& topology = mesh().topology();
    ControlMesh const& control = mesh().mesh();
    std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
    for (std::uint32_t f = 0; f < control.faces(); ++f) {
        if (hidden[f]) continue;
        auto const face = control.face(f);
        auto const n = std::uint32_t(face.size());
        Group& g = groups_[kind_of(f)];
        g.patches.push_back(mesh().place(f));
        g.indices.insert(g.indices.end(), face.begin(), face.end());
        std::uint32_t bits = 0;
        for (std::uint32_t i = 0; i < n; ++i) {
            HalfEdge const h = control.face_start[f] + i;
            g.offsets.push_back(corner_offsets(topology, h));
            if (face[i] > face[(i + 1) % n]) bits |= 1u << i;
            if (topology.twin(h) == Topology::kNone) bits |= 256u << i;
        }
        g.edges.push_back(bits);
    }
}

CommandList TwoStageForm::commands(SurfaceSettings const& settings) const
{
    CommandList list;
    // At rest the texture is the mesh's; in a pose a dispatch before the draws fills another.
    VertexSource vertices = positions_of(mesh().mesh());
    std::span<float const> positions = rings_.positions;
    if (settings.pose) {
        auto const moved = std::make_shared<std::vector<float>>(rings_.positions.size());
        list.memory.push_back(moved);
        list.commands.emplace_back(skinning(mesh().mesh(), *moved, settings));
        positions = *moved;
        vertices = {positions, 3, 4};
    }
    RingTextures textures;
    textures.rings = {rings_.rings, 0, "ring_heads"};
    textures.entries = {rings_.entries, 1, "ring_entries"};
    textures.positions =
        Texture2D(positions, RingTextures::kTextureWidth, rings_.height, 2, "ring_positions");
    VertexShader const vertex = vertex_shader(textures, settings);
    for (std::size_t k = 0; k < groups_.size(); ++k) {
        Group const& g = groups_[k];
        if (g.patches.empty()) continue;
        add_patch_draw(list, mesh(),
                       {kinds_[k].kind, vertices, kinds_[k].sides, g.indices, g.patches, vertex,
                        hull_shader(k, {g.offsets, g.edges, angles_}, settings),
                        domain_shader(k, settings)},
                       settings);
    }
    return list;
}

std::vector<PatchCount> TwoStageForm::patch_counts() const
{
    std::vector<PatchCount> out;
    for (std::size_t k = 0; k < groups_.size(); ++k)
        if (std::size_t const n = groups_[k].patches.size())
            out.push_back({kinds_[k].kind, n, 1, kinds_[k].sides, kinds_[k].sides});
    return out;
}

} // namespace tessemu
