// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/stencil_form.h"

#include "shaders_cpp/pass_through.h"
#include "shaders_cpp/skinning.h"
#include "shaders_cpp/stencil_form/stencil_compute_shader.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>

namespace tessemu {

namespace {

VertexShader vertex_shader(SurfaceSettings const& settings, bool at_rest)
{
    if (!settings.pose || !at_rest)
        return bind_vertex_shader(PassThroughVertexShader{}, settings.machine);
    return bind_vertex_shader(SkinningVertexShader{skin_of(*settings.pose)}, settings.machine);
}

} // namespace

CommandList StencilForm::commands(SurfaceSettings const& settings, Tables const& tables) const
{
    CommandList list;
    // The vertex shader poses a mesh that is drawn as it is; what reads it from memory needs it
    // posed before.
    bool const as_it_is = mesh().steps() == 0,
               reads_memory = !poles_.empty() || !tables.wide.empty() || reads_positions();
    VertexSource const vertices =
        as_it_is ? positions_of(mesh().base()) : add_vertices(list, mesh(), settings);
    VertexSource const positions =
        as_it_is && reads_memory ? add_vertices(list, mesh(), settings) : vertices;
    std::span<float const> const poles =
        add_pole_normals(list, poles_, positions, settings.machine);
    VertexShader const vertex = vertex_shader(settings, as_it_is);
    for (Group const& g : tables.groups) {
        StencilBuffers const buffers{tables.weights, tables.zero_masks, g.words, g.order, poles};
        DomainShader const domain = prepared_domain_shader(list, positions, g.kind, settings);
        add_patch_draw(list,
                       {kinds_[g.kind], vertices, g.inputs, g.indices, g.patches, vertex,
                        hull_shader(g.kind, buffers, settings), domain},
                       settings);
    }
    add_wide_draws(list, settings, tables, positions, poles);
    return list;
}

void StencilForm::add_wide_draws(CommandList& list, SurfaceSettings const& settings,
                                 Tables const& tables, VertexSource const& positions,
                                 std::span<float const> poles) const
{
    VertexShader const vertex = bind_vertex_shader(PassThroughVertexShader{}, settings.machine);
    for (WideGroup const& g : tables.wide) {
        std::size_t const rows = g.first.size() - 1;
        auto const sums = std::make_shared<std::vector<float>>(3 * rows);
        list.memory.push_back(sums);
        StencilComputeShader cs;
        cs.first = {g.first, 0, "stencil_starts"};
        cs.vertices = {g.vertices, 1, "stencil_vertices"};
        cs.weights = {g.weights, 2, "stencil_weights"};
        cs.positions = {positions.floats, 3, "positions"};
        cs.sums = {*sums, 4, "stencil_sums"};
        cs.stride = positions.stride;
        cs.rows = int(rows);
        list.commands.emplace_back(
            Dispatch{"stencils", bind_compute_shader(cs, settings.machine), groups_for(rows, 64)});
        GatheredBuffers const buffers{g.rows, *sums, g.words, g.constants, poles};
        DomainShader const domain = prepared_domain_shader(list, positions, g.kind, settings);
        add_patch_draw(list,
                       {kinds_[g.kind],
                        {*sums, 3, 3},
                        g.points,
                        g.indices,
                        g.patches,
                        vertex,
                        hull_shader(g.kind, buffers, settings),
                        domain},
                       settings);
    }
}

std::vector<PatchCount> StencilForm::patch_counts() const
{
    std::vector<PatchCount> out;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
        PatchCount c{kinds_[k], 0, 0, 0, 0};
        auto const add = [&](std::size_t patches, int min_inputs, int max_inputs) {
            c.min_inputs = c.patches ? std::min(c.min_inputs, min_inputs) : min_inputs;
            c.max_inputs = std::max(c.max_inputs, max_inputs);
            c.patches += patches;
        };
        for (Group const& g : tables_.groups)
            if (g.kind == k) add(g.patches.size(), g.inputs, g.inputs);
        for (WideGroup const& g : tables_.wide)
            if (g.kind == k) add(g.patches.size(), g.min_inputs, g.max_inputs);
        std::map<ValenceType, std::size_t> valences;
        for (Type const& t : types_) {
            if (t.kind != k) continue;
            ++c.types;
            if (t.valences) valences[*t.valences] += t.patches;
        }
        c.valence_types.assign(valences.begin(), valences.end());
        if (c.patches) out.push_back(std::move(c));
    }
    return out;
}

void StencilForm::make_tables(std::vector<TypeAhead> const& ahead)
{
    struct Patch {
        std::uint32_t face, type;
    };
    Topology const& topology = mesh().topology();
    std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
    poles_ = find_poles(topology);
    std::unordered_map<std::string, std::uint32_t> type_ids;
    std::unordered_map<std::string, Table> ready;
    std::vector<Patch> patches;
    Neighbourhood n;
    for (TypeAhead const& a : ahead) {
        ControlMesh const cage = one_ring_cage(a.type);
        find_neighbourhood(Topology(cage), 0, n);
        ready.emplace(n.key, add_table(a.kind, n));
    }
    for (std::uint32_t f = 0; f < mesh().mesh().faces(); ++f) {
        if (hidden[f]) continue;
        find_neighbourhood(topology, f, n);
        arrange(f, n);
        auto const [it, fresh] = type_ids.try_emplace(n.key, std::uint32_t(types_.size()));
        if (fresh) {
            std::size_t const kind = kind_of(f);
            auto const made = ready.find(n.key);
            types_.push_back(
                {made != ready.end() ? made->second : add_table(kind, n), kind, valence_type(n)});
        }
        ++types_[it->second].patches;
        patches.push_back({f, it->second});
    }
    std::stable_sort(patches.begin(), patches.end(), [&](Patch const& a, Patch const& b) {
        Type const &s = types_[a.type], &t = types_[b.type];
        return std::tuple(s.kind, s.inputs(), a.type) < std::tuple(t.kind, t.inputs(), b.type);
    });
    std::size_t wide = 0;
    int most = 0;
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
    Type* last = nullptr; // of wide patches: rows are large, and live as long as their type's turn
    for (Patch const& p : patches) {
        Type& t = types_[p.type];
        find_neighbourhood(topology, p.face, n);
        arrange(p.face, n);
        added(t.kind, p.face, n);
        if (!t.wide()) {
            add_patch(t, n, p.face);
            continue;
        }
        if (last != &t) {
            if (last) last->stencils.rows = {};
            last = &t;
            t.stencils = stencils(t.kind, n);
        }
        add_wide_patch(t, n, p.face);
        ++wide, most = std::max(most, t.inputs());
        first = std::min(first, mesh().base().file_face(mesh().place(p.face).face));
    }
    if (last) last->stencils.rows = {};
    if (wide)
        draws_another_way(another_way_of(
            wide, first,
            "more than " + std::to_string(kMaxControlPoints) + " inputs (up to " +
                std::to_string(most) + "): a dispatch sums their control points before the draw"));
}

StencilForm::Table StencilForm::add_table(std::size_t kind, Neighbourhood const& n)
{
    Table t{{}, 0, tables_.weights.size(), tables_.zero_masks.size()};
    PatchStencils& s = t.stencils;
    s.inputs = int(n.inputs.size());
    if (s.inputs > kMaxControlPoints) return t; // wide: its rows are made patch by patch
    s = stencils(kind, n);
    t.rows = s.rows.size();
    for (int i = 0; i < s.inputs; ++i)
        for (auto const& row : s.rows) tables_.weights.push_back(float(row[std::size_t(i)]));
    for (auto const& row : s.rows) {
        std::uint32_t mask = 0;
        for (std::size_t i = 0; i < row.size(); ++i)
            if (float(row[i]) != 0 || s.dense) mask |= 1u << i;
        tables_.zero_masks.push_back(mask);
    }
    for (double c : s.constants) tables_.weights.push_back(float(c));
    s.rows.clear();
    return t;
}

namespace {

constexpr std::size_t kMostTerms = std::size_t(1) << 28; // 2 GiB of tables

// Inputs in ascending global vertex id, in which sums run.
template <class Index> std::vector<Index> ascending(Neighbourhood const& n)
{
    std::vector<Index> order(n.inputs.size());
    std::iota(order.begin(), order.end(), Index(0));
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
        return std::pair(n.inputs[a], a) < std::pair(n.inputs[b], b);
    });
    return order;
}

} // namespace

std::uint32_t StencilForm::edge_bits(Neighbourhood const& n) const
{
    std::uint32_t bits = 0;
    for (int k = 0; k < n.sides; ++k) {
        std::uint32_t const a = n.inputs[std::size_t(n.corner[k].vertex())];
        std::uint32_t const b = n.inputs[std::size_t(n.corner[(k + 1) % n.sides].vertex())];
        if (a > b) bits |= 1u << (EdgeBits::kReversed + k);
        if (poles_.collapsed(a, b)) bits |= 1u << (EdgeBits::kCollapsed + k);
    }
    return bits;
}

std::uint32_t StencilForm::corner_row(Neighbourhood const& n, int corner, int row) const
{
    std::uint32_t const pole = poles_.at(n.inputs[std::size_t(n.corner[corner].vertex())]);
    return pole == Poles::kNone ? std::uint32_t(row) : std::uint32_t(kPole) + pole;
}

void StencilForm::add_patch(Type const& t, Neighbourhood const& n, std::uint32_t face)
{
    std::vector<Group>& groups = tables_.groups;
    if (groups.empty() || groups.back().kind != t.kind || groups.back().inputs != t.inputs())
        groups.push_back({t.kind, t.inputs(), {}, {}, {}, {}});
    Group& g = groups.back();
    g.patches.push_back(mesh().place(face, n.rotation));
    g.indices.insert(g.indices.end(), n.inputs.begin(), n.inputs.end());
    std::vector<std::uint8_t> const order = ascending<std::uint8_t>(n);
    g.order.insert(g.order.end(), order.begin(), order.end());
    g.words.insert(g.words.end(), {std::uint32_t(t.first_weight), std::uint32_t(t.first_mask),
                                   std::uint32_t(t.rows), edge_bits(n)});
    for (int i = 0; i < n.sides; ++i)
        g.words.push_back(corner_row(n, i, t.stencils.corner_row[i] + 2 * n.ring_shift[i]));
}

void StencilForm::add_wide_patch(Type const& t, Neighbourhood const& n, std::uint32_t face)
{
    PatchStencils const& s = t.stencils;
    std::vector<WideGroup>& groups = tables_.wide;
    if (groups.empty() || groups.back().kind != t.kind) {
        WideGroup fresh{};
        fresh.kind = t.kind;
        fresh.points = s.control_points;
        fresh.rows = s.control_points + 6 * n.sides;
        fresh.min_inputs = t.inputs(); // of the first: they ascend
        fresh.first = {0};
        groups.push_back(std::move(fresh));
    }
    WideGroup& g = groups.back();
    g.max_inputs = t.inputs();
    auto const first_row = std::uint32_t(g.first.size() - 1);
    for (int i = 0; i < g.points; ++i) g.indices.push_back(first_row + std::uint32_t(i));
    g.patches.push_back(mesh().place(face, n.rotation));
    g.words.insert(g.words.end(), {edge_bits(n), std::uint32_t(g.constants.size())});
    for (int i = 0; i < n.sides; ++i)
        g.words.push_back(corner_row(n, i, s.control_points + 4 * n.sides + 2 * i));
    for (double c : s.constants) g.constants.push_back(float(c));
    std::vector<std::uint32_t> const order = ascending<std::uint32_t>(n);
    auto const add_row = [&](StencilRow const& row) {
        for (std::uint32_t i : order)
            if (float const w = float(row[i]); w != 0) {
                g.vertices.push_back(n.inputs[i]);
                g.weights.push_back(w);
            }
        g.first.push_back(std::uint32_t(g.weights.size()));
    };
    for (int r = 0; r < s.control_points + 4 * n.sides; ++r) add_row(s.rows[std::size_t(r)]);
    for (int i = 0; i < n.sides; ++i) {
        VertexStencils const corner(n.corner[i], s.inputs,
                                    mesh().base().rules.boundary == BoundaryRule::EdgeOnly);
        auto const [a, b] = corner.tangents(n.ring_shift[i]);
        add_row(a);
        add_row(b);
    }
    if (g.weights.size() > kMostTerms)
        throw LimitError("terms of the stencils of patches with more than 32 inputs, up to that of "
                         "face " +
                             std::to_string(mesh().base().file_face(mesh().place(face).face) + 1) +
                             ",",
                         g.weights.size(), kMostTerms);
}

} // namespace tessemu
