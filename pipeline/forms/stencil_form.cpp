// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/stencil_form.h"

#include "shaders_cpp/pass_through.h"
#include "shaders_cpp/skinning.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace tessemu {

namespace {

VertexShader vertex_shader(SurfaceSettings const& settings)
{
    if (!settings.pose) return bind_vertex_shader(PassThroughVertexShader{}, settings.machine);
    return bind_vertex_shader(SkinningVertexShader{skin_of(*settings.pose)}, settings.machine);
}

} // namespace

CommandList StencilForm::commands(SurfaceSettings const& settings, Tables const& tables) const
{
    CommandList list;
    VertexShader const vertex = vertex_shader(settings);
    for (Group const& g : tables.groups)
        add_patch_draw(
            list, mesh(),
            {kinds_[g.kind], positions_of(mesh().mesh()), g.inputs, g.indices, g.patches, vertex,
             hull_shader(g.kind, {tables.weights, tables.zero_masks, g.words, g.order}, settings),
             domain_shader(g.kind, settings)},
            settings);
    return list;
}

std::vector<PatchCount> StencilForm::patch_counts() const
{
    std::vector<PatchCount> out;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        PatchCount c{kinds_[k], 0, 0, 0, 0};
        for (Group const& g : tables_.groups) {
            if (g.kind != k) continue;
            if (c.patches == 0) c.min_inputs = g.inputs;
            c.max_inputs = g.inputs;
            c.patches += g.patches.size();
        }
        c.types = std::size_t(std::count_if(types_.begin(), types_.end(),
                                            [&](Type const& t) { return t.kind == k; }));
        if (c.patches) out.push_back(c);
    }
    return out;
}

void StencilForm::make_tables()
{
    struct Patch {
        std::uint32_t face, type;
    };
    Topology const& topology = mesh().topology();
    std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
    std::unordered_map<std::string, std::uint32_t> type_ids;
    std::vector<Patch> patches;
    Neighbourhood n;
    for (std::uint32_t f = 0; f < mesh().mesh().faces(); ++f) {
        if (hidden[f]) continue;
        find_neighbourhood(topology, f, n);
        auto const [it, fresh] = type_ids.try_emplace(n.key, std::uint32_t(types_.size()));
        if (fresh) types_.push_back(add_type(f, n));
        patches.push_back({f, it->second});
    }
    std::stable_sort(patches.begin(), patches.end(), [&](Patch const& a, Patch const& b) {
        Type const &s = types_[a.type], &t = types_[b.type];
        return std::tuple(s.kind, s.inputs, a.type) < std::tuple(t.kind, t.inputs, b.type);
    });
    std::vector<Group>& groups = tables_.groups;
    for (Patch const& p : patches) {
        Type const& t = types_[p.type];
        if (groups.empty() || groups.back().kind != t.kind || groups.back().inputs != t.inputs)
            groups.push_back({t.kind, t.inputs, {}, {}, {}, {}});
        find_neighbourhood(topology, p.face, n);
        add_patch(groups.back(), t, n, p.face);
    }
}

StencilForm::Type StencilForm::add_type(std::uint32_t face, Neighbourhood const& n)
{
    if (n.inputs.size() > kMaxControlPoints) {
        std::string valences;
        for (int i = 0; i < n.sides; ++i)
            valences += (i ? ", " : "") + std::to_string(n.corner[i].valence());
        throw LimitError("inputs of the patch of face " +
                             std::to_string(mesh().base().file_face(mesh().place(face).face) + 1) +
                             " (valences " + valences + ")",
                         n.inputs.size(), kMaxControlPoints);
    }
    std::size_t const kind = kind_of(face);
    PatchStencils const s = stencils(kind, n);
    Type const t{kind,
                 s.inputs,
                 int(s.rows.size()),
                 {s.corner_row[0], s.corner_row[1], s.corner_row[2], s.corner_row[3]},
                 tables_.weights.size(),
                 tables_.zero_masks.size()};
    for (int i = 0; i < s.inputs; ++i)
        for (auto const& row : s.rows) tables_.weights.push_back(float(row[std::size_t(i)]));
    for (auto const& row : s.rows) {
        std::uint32_t mask = 0;
        for (std::size_t i = 0; i < row.size(); ++i)
            if (float(row[i]) != 0) mask |= 1u << i;
        tables_.zero_masks.push_back(mask);
    }
    for (double c : s.constants) tables_.weights.push_back(float(c));
    return t;
}

void StencilForm::add_patch(Group& g, Type const& t, Neighbourhood const& n, std::uint32_t face)
{
    g.patches.push_back(mesh().place(face, n.rotation));
    g.indices.insert(g.indices.end(), n.inputs.begin(), n.inputs.end());
    std::uint8_t order[kMaxControlPoints];
    std::iota(order, order + n.inputs.size(), std::uint8_t(0));
    std::sort(order, order + n.inputs.size(),
              [&](std::uint8_t a, std::uint8_t b) { return n.inputs[a] < n.inputs[b]; });
    g.order.insert(g.order.end(), order, order + n.inputs.size());

    std::uint32_t reversed = 0;
    for (int k = 0; k < n.sides; ++k) {
        std::uint32_t const a = n.inputs[std::size_t(n.corner[k].vertex())];
        std::uint32_t const b = n.inputs[std::size_t(n.corner[(k + 1) % n.sides].vertex())];
        if (a > b) reversed |= 1u << k;
    }
    g.words.insert(g.words.end(), {std::uint32_t(t.first_weight), std::uint32_t(t.first_mask),
                                   std::uint32_t(t.rows), reversed});
    for (int i = 0; i < n.sides; ++i)
        g.words.push_back(std::uint32_t(t.corner_row[i] + 2 * n.ring_shift[i]));
}

} // namespace tessemu
