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

/// Neighbourhoods of faces, a block of them at a time on all threads.
class Neighbourhoods {
public:
    /// \param find  (face, out): thread by thread
    Neighbourhoods(ThreadPool const* threads,
                   std::function<void(std::uint32_t, Neighbourhood&)> find)
        : threads_(threads && threads->threads() > 1 ? threads : nullptr),
          find_(std::move(find)),
          block_(threads_ ? kBlock : 1)
    {
    }

    /// take(i, neighbourhood of face(i)) for i from 0 to n - 1 in this order.
    template <class Face, class Take>
    void for_each(std::size_t n, Face const& face, Take const& take)
    {
        for (std::size_t first = 0; first < n; first += block_.size()) {
            std::size_t const count = std::min(block_.size(), n - first);
            auto const find_item = [&](std::size_t item) {
                for (std::size_t i = item * kItem; i < std::min(count, (item + 1) * kItem); ++i)
                    find_(face(first + i), block_[i]);
            };
            if (threads_)
                threads_->parallel_for((count + kItem - 1) / kItem, find_item);
            else
                find_item(0);
            for (std::size_t i = 0; i < count; ++i) take(first + i, block_[i]);
        }
    }

private:
    static constexpr std::size_t kItem = 64, kBlock = 16 * kItem; // of a megabyte or so
    ThreadPool const* threads_;
    std::function<void(std::uint32_t, Neighbourhood&)> find_;
    std::vector<Neighbourhood> block_;
};

void StencilForm::make_tables(ThreadPool const* threads, std::vector<TypeAhead> const& ahead)
{
    poles_ = find_poles(mesh().topology());
    Neighbourhoods neighbourhoods(threads, [this](std::uint32_t f, Neighbourhood& n) {
        find_neighbourhood(mesh().topology(), f, n);
        arrange(f, n);
    });
    std::vector<Patch> patches = find_types(neighbourhoods, ahead);
    std::stable_sort(patches.begin(), patches.end(), [&](Patch const& a, Patch const& b) {
        Type const &s = types_[a.type], &t = types_[b.type];
        return std::tuple(s.kind, s.inputs(), a.type) < std::tuple(t.kind, t.inputs(), b.type);
    });
    reserve_groups();
    std::size_t wide = 0;
    int most = 0;
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
    Type* last = nullptr; // of wide patches: rows are large, and live as long as their type's turn
    auto const face = [&](std::size_t i) { return patches[i].face; };
    neighbourhoods.for_each(patches.size(), face, [&](std::size_t i, Neighbourhood const& n) {
        Patch const& p = patches[i];
        Type& t = types_[p.type];
        added(t.kind, p.face, n);
        if (!t.wide()) {
            add_patch(t, n, p.face);
            return;
        }
        if (last != &t) {
            if (last) last->stencils.rows = {};
            last = &t;
            t.stencils = stencils(t.kind, n);
        }
        add_wide_patch(t, n, p.face);
        ++wide, most = std::max(most, t.inputs());
        first = std::min(first, mesh().base().file_face(mesh().place(p.face).face));
    });
    if (last) last->stencils.rows = {};
    if (wide)
        draws_another_way(another_way_of(
            wide, first,
            "more than " + std::to_string(kMaxControlPoints) + " inputs (up to " +
                std::to_string(most) + "): a dispatch sums their control points before the draw"));
}

// Numbers the types in the order of their first faces.
std::vector<StencilForm::Patch> StencilForm::find_types(Neighbourhoods& neighbourhoods,
                                                        std::vector<TypeAhead> const& ahead)
{
    std::vector<std::uint32_t> faces;
    faces.reserve(mesh().mesh().faces());
    std::vector<char> const hidden = hidden_faces(mesh(), warnings_);
    for (std::uint32_t f = 0; f < mesh().mesh().faces(); ++f)
        if (!hidden[f]) faces.push_back(f);
    std::unordered_map<std::string, Table> ready;
    for (TypeAhead const& a : ahead) {
        ControlMesh const cage = one_ring_cage(a.type);
        Neighbourhood n;
        find_neighbourhood(Topology(cage), 0, n);
        ready.emplace(n.key, add_table(a.kind, n));
    }
    std::unordered_map<std::string, std::uint32_t> ids;
    std::vector<Patch> patches;
    patches.reserve(faces.size());
    auto const face = [&](std::size_t i) { return faces[i]; };
    neighbourhoods.for_each(faces.size(), face, [&](std::size_t i, Neighbourhood const& n) {
        auto const [it, fresh] = ids.try_emplace(n.key, std::uint32_t(types_.size()));
        if (fresh) {
            std::size_t const kind = kind_of(faces[i]);
            auto const made = ready.find(n.key);
            types_.push_back({made != ready.end() ? made->second : add_table(kind, n), kind,
                              n.sides, valence_type(n)});
        }
        ++types_[it->second].patches;
        patches.push_back({faces[i], it->second});
    });
    return patches;
}

// Groups of all patches that are not wide, in order, with room for them.
void StencilForm::reserve_groups()
{
    std::map<std::pair<std::size_t, int>, std::vector<Type const*>> groups;
    for (Type const& t : types_)
        if (!t.wide()) groups[{t.kind, t.inputs()}].push_back(&t);
    for (auto const& [of, types] : groups) {
        Group g{of.first, of.second, {}, {}, {}, {}};
        std::size_t patches = 0, words = 0;
        for (Type const* t : types) {
            patches += t->patches;
            words += t->patches * std::size_t(StencilPatchWords::count(t->sides));
        }
        g.patches.reserve(patches);
        g.indices.reserve(patches * std::size_t(g.inputs));
        g.order.reserve(patches * std::size_t(g.inputs));
        g.words.reserve(words);
        tables_.groups.push_back(std::move(g));
    }
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
template <class Index> void append_ascending(Neighbourhood const& n, std::vector<Index>& out)
{
    std::array<std::uint64_t, kMaxControlPoints> few;
    std::vector<std::uint64_t> many;
    std::size_t const count = n.inputs.size();
    if (count > few.size()) many.resize(count);
    std::uint64_t* const keys = count > few.size() ? many.data() : few.data();
    for (std::size_t i = 0; i < count; ++i) keys[i] = std::uint64_t(n.inputs[i]) << 32 | i;
    std::sort(keys, keys + count);
    for (std::size_t i = 0; i < count; ++i) out.push_back(Index(keys[i]));
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
    Group& g = *std::find_if(tables_.groups.begin(), tables_.groups.end(), [&](Group const& of) {
        return of.kind == t.kind && of.inputs == t.inputs();
    });
    g.patches.push_back(mesh().place(face, n.rotation));
    g.indices.insert(g.indices.end(), n.inputs.begin(), n.inputs.end());
    append_ascending(n, g.order);
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
    std::vector<std::uint32_t> order;
    append_ascending(n, order);
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
