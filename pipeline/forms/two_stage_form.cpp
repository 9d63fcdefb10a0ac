// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/two_stage_form.h"

#include <algorithm>
#include <limits>

namespace tessemu {

TwoStageForm::TwoStageForm(std::shared_ptr<RefinedMesh const> mesh, std::vector<Kind> kinds)
    : PatchMesh(std::move(mesh)),
      kinds_(std::move(kinds)),
      rings_(this->mesh().topology()),
      groups_(kinds_.size()),
      wide_(kinds_.size())
{
    for (double c : make_ring_angles()) angles_.push_back(float(c));
}

std::uint32_t TwoStageForm::most_edges(std::uint32_t face) const
{
    std::uint32_t most = 0;
    for (std::uint32_t v : mesh().mesh().face(face))
        most = std::max(most, mesh().topology().valence(v));
    return most;
}

void TwoStageForm::make_tables()
{
    std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
    poles_ = find_poles(mesh().topology());
    std::size_t wide = 0;
    std::uint32_t most = 0, first = std::numeric_limits<std::uint32_t>::max();
    for (std::uint32_t f = 0; f < mesh().mesh().faces(); ++f) {
        if (hidden[f]) continue;
        std::uint32_t const edges = most_edges(f);
        bool const is_wide = edges > std::uint32_t(RingLayout::kEdges);
        add_patch(f, is_wide);
        if (!is_wide) continue;
        ++wide, most = std::max(most, edges);
        first = std::min(first, mesh().base().file_face(mesh().place(f).face));
    }
    if (wide)
        another_way_ = another_way_of(
            wide, first,
            "a vertex of more than " + std::to_string(RingLayout::kEdges) + " edges (up to " +
                std::to_string(most) + "): a dispatch makes their corners before the draw");
}

void TwoStageForm::add_patch(std::uint32_t f, bool wide)
{
    Topology const& topology = mesh().topology();
    ControlMesh const& control = mesh().mesh();
    auto const face = control.face(f);
    auto const n = std::uint32_t(face.size());
    Group& g = wide ? wide_[kind_of(f)] : groups_[kind_of(f)];
    g.patches.push_back(mesh().place(f));
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
        HalfEdge const h = control.face_start[f] + i;
        if (wide) {
            WideRing const ring =
                wide_ring(int(topology.ring(face[i]).size()), topology.is_boundary(face[i]));
            auto const edges = window_edges(topology, h);
            g.indices.push_back(std::uint32_t(g.indices.size()));
            g.windows.insert(g.windows.end(), {face[i], ring.first_constant, edges[0], edges[1],
                                               edges[2], edges[3]});
            g.offsets.push_back(1u | 2u << 8 | ring.row << 16); // e+ and e- in the window
        } else {
            g.indices.push_back(face[i]);
            g.offsets.push_back(corner_offsets(topology, h));
        }
        if (face[i] > face[(i + 1) % n]) bits |= 1u << i;
        if (topology.twin(h) == Topology::kNone) bits |= 1u << (8 + i);
        if (poles_.collapsed(face[i], face[(i + 1) % n])) bits |= 1u << (16 + i);
        if (poles_.at(face[i]) != Poles::kNone) bits |= 1u << (24 + i);
        if (!poles_.empty()) g.poles.push_back(poles_.at(face[i]));
    }
    g.edges.push_back(bits);
}

// Rows of the angles behind those of all meshes: so a row is no number of an edge in a window, and
// the hull shader finds a window's ring nowhere closed.
TwoStageForm::WideRing TwoStageForm::wide_ring(int faces, bool boundary)
{
    auto const [it, fresh] = wide_rings_.try_emplace({faces, boundary});
    if (fresh) {
        it->second = {std::uint32_t(wide_constants_.size()), std::uint32_t(angles_.size() / 2)};
        for (double c : wide_constants(faces, boundary)) wide_constants_.push_back(float(c));
        for (double c : ring_angles(faces, boundary)) angles_.push_back(float(c));
    }
    return it->second;
}

CommandList TwoStageForm::commands(SurfaceSettings const& settings) const
{
    CommandList list;
    // The texture of a mesh at rest is made once; else dispatches before the draws fill another.
    bool const as_it_is = mesh().steps() == 0 && !settings.pose;
    VertexSource const vertices = add_vertices(list, mesh(), settings, rings_.positions.size() / 4);
    std::span<float const> const positions =
        as_it_is ? std::span<float const>(rings_.positions) : vertices.floats;
    std::span<float const> const poles = add_pole_normals(list, poles_, vertices, settings.machine);
    RingTextures textures;
    textures.rings = {rings_.rings, 0, "ring_heads"};
    textures.entries = {rings_.entries, 1, "ring_entries"};
    textures.positions =
        Texture2D(positions, RingTextures::kTextureWidth, rings_.height, 2, "ring_positions");
    VertexShader const vertex = vertex_shader(textures, settings);
    for (std::size_t k = 0; k < groups_.size(); ++k) {
        Group const& g = groups_[k];
        if (g.patches.empty()) continue;
        add_patch_draw(list,
                       {kinds_[k].kind, vertices, kinds_[k].sides, g.indices, g.patches, vertex,
                        hull_shader(k, {g.offsets, g.edges, angles_, g.poles, poles}, settings),
                        domain_shader(k, settings)},
                       settings);
    }
    add_wide_draws(list, textures, poles, settings);
    return list;
}

void TwoStageForm::add_wide_draws(CommandList& list, RingTextures const& textures,
                                  std::span<float const> poles,
                                  SurfaceSettings const& settings) const
{
    constexpr std::size_t kFloats = scalar_count<RingWindow<float>>();
    for (std::size_t k = 0; k < wide_.size(); ++k) {
        Group const& g = wide_[k];
        if (g.patches.empty()) continue;
        auto const windows = std::make_shared<std::vector<float>>(g.indices.size() * kFloats);
        list.memory.push_back(windows);
        list.commands.emplace_back(
            Dispatch{"ring windows",
                     window_shader(textures, {g.windows, wide_constants_, *windows}, settings),
                     groups_for(g.indices.size(), 64)});
        add_patch_draw(list,
                       {kinds_[k].kind,
                        {*windows, int(kFloats), int(kFloats)},
                        kinds_[k].sides,
                        g.indices,
                        g.patches,
                        bind_vertex_shader(RingWindowVertexShader{}, settings.machine),
                        hull_shader(k, {g.offsets, g.edges, angles_, g.poles, poles}, settings),
                        domain_shader(k, settings)},
                       settings);
    }
}

std::vector<PatchCount> TwoStageForm::patch_counts() const
{
    std::vector<PatchCount> out;
    for (std::size_t k = 0; k < groups_.size(); ++k)
        if (std::size_t const n = groups_[k].patches.size() + wide_[k].patches.size())
            out.push_back({kinds_[k].kind, n, 1, kinds_[k].sides, kinds_[k].sides});
    return out;
}

} // namespace tessemu
