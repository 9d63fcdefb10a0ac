// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stencil_patch_mesh.h"

#include "shaders_cpp/pass_through.h"
#include "shaders_cpp/skinning.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace tessemu {

namespace {

// Patches of one kind and one number of inputs: an index buffer of their own, sorted by type.
struct Group {
    std::size_t kind;
    int inputs;
    std::vector<PatchOrigin> patches;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> words; // StencilPatchWords
    std::vector<std::uint8_t> order;
};

struct Type {
    std::size_t kind;
    int inputs, rows;
    int corner_row[4];
    std::size_t first_weight, first_mask;
};

class StencilPatchMesh final : public PatchMesh {
public:
    StencilPatchMesh(Topology const& topology, StencilScheme scheme)
        : mesh_(topology.mesh()),
          scheme_(std::move(scheme)),
          warnings_(scheme_.warnings)
    {
        collect(topology);
        warn_of_tags(mesh_, warnings_);
    }

    std::vector<DrawPass> passes(PassSettings const& settings) const override
    {
        std::shared_ptr<VertexProgram const> const vertex = vertex_program(settings);
        std::vector<std::shared_ptr<DomainProgram const>> domain(scheme_.kinds.size());
        std::vector<DrawPass> out;
        for (Group const& g : groups_) {
            StencilKind const& kind = scheme_.kinds[g.kind];
            if (!domain[g.kind]) domain[g.kind] = kind.domain_program(settings);
            out.push_back(
                make_patch_pass(kind.kind, mesh_, g.inputs, g.indices, g.patches, vertex,
                                kind.hull_program({weights_, masks_, g.words, g.order}, settings),
                                domain[g.kind], settings));
        }
        return out;
    }

    std::vector<PatchCount> patch_counts() const override
    {
        std::vector<PatchCount> out;
        for (std::size_t k = 0; k < scheme_.kinds.size(); ++k) {
            PatchCount c{scheme_.kinds[k].kind, 0, 0, 0, 0};
            for (Group const& g : groups_) {
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

    std::vector<std::string> const& warnings() const override { return warnings_; }

private:
    static std::unique_ptr<VertexProgram> vertex_program(PassSettings const& settings)
    {
        if (!settings.pose) return make_vertex_program(PassThroughVertexShader{}, settings.machine);
        return make_vertex_program(SkinningVertexShader{{{settings.pose->skin->vertices, 0, "skin"},
                                                         {settings.pose->bones, 1, "bones"}}},
                                   settings.machine);
    }

    struct Patch {
        std::uint32_t face, type;
        std::uint8_t rotation;
    };

    void collect(Topology const& topology)
    {
        std::vector<char> const hidden = hidden_faces(topology, warnings_);
        std::unordered_map<std::string, std::uint32_t> type_ids;
        std::vector<Patch> patches;
        Neighbourhood n;
        for (std::uint32_t f = 0; f < mesh_.faces(); ++f) {
            if (hidden[f]) continue;
            find_neighbourhood(topology, f, n);
            if (n.inputs.size() > kMaxControlPoints) refuse(f, n);
            auto const [it, fresh] = type_ids.try_emplace(n.key, std::uint32_t(types_.size()));
            if (fresh) add_type(f, n);
            patches.push_back({f, it->second, std::uint8_t(n.rotation)});
        }
        std::stable_sort(patches.begin(), patches.end(), [&](Patch const& a, Patch const& b) {
            Type const &s = types_[a.type], &t = types_[b.type];
            return std::tuple(s.kind, s.inputs, a.type) < std::tuple(t.kind, t.inputs, b.type);
        });
        for (Patch const& p : patches) {
            Type const& t = types_[p.type];
            if (groups_.empty() || groups_.back().kind != t.kind ||
                groups_.back().inputs != t.inputs)
                groups_.push_back({t.kind, t.inputs, {}, {}, {}, {}});
            find_neighbourhood(topology, p.face, n);
            add_patch(groups_.back(), t, n, p);
        }
    }

    [[noreturn]] void refuse(std::uint32_t face, Neighbourhood const& n) const
    {
        std::string valences;
        for (int i = 0; i < n.sides; ++i)
            valences += (i ? ", " : "") + std::to_string(n.corner[i].valence());
        throw LimitError("inputs of the patch of face " + std::to_string(face + 1) + " (valences " +
                             valences + ")",
                         n.inputs.size(), kMaxControlPoints);
    }

    void add_type(std::uint32_t face, Neighbourhood const& n)
    {
        std::size_t const kind = scheme_.kind_of(face);
        PatchStencils const s = scheme_.kinds[kind].stencils(n);
        Type t{kind,
               s.inputs,
               int(s.rows.size()),
               {s.corner_row[0], s.corner_row[1], s.corner_row[2], s.corner_row[3]},
               weights_.size(),
               masks_.size()};
        for (int i = 0; i < s.inputs; ++i)
            for (auto const& row : s.rows) weights_.push_back(float(row[std::size_t(i)]));
        for (auto const& row : s.rows) {
            std::uint32_t mask = 0;
            for (std::size_t i = 0; i < row.size(); ++i)
                if (float(row[i]) != 0) mask |= 1u << i;
            masks_.push_back(mask);
        }
        for (double c : s.constants) weights_.push_back(float(c));
        types_.push_back(t);
    }

    void add_patch(Group& g, Type const& t, Neighbourhood const& n, Patch const& p)
    {
        g.patches.push_back({p.face, p.rotation, std::uint8_t(n.sides)});
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

    ControlMesh const& mesh_;
    StencilScheme scheme_;
    std::vector<Type> types_;
    std::vector<float> weights_;       // [type][input][row], then the type's constants
    std::vector<std::uint32_t> masks_; // [type][row]
    std::vector<Group> groups_;
    std::vector<std::string> warnings_;
};

} // namespace

std::unique_ptr<PatchMesh> make_stencil_patch_mesh(Topology const& topology, StencilScheme scheme)
{
    return std::make_unique<StencilPatchMesh>(topology, std::move(scheme));
}

} // namespace tessemu
