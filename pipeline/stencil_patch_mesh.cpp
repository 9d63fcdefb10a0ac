// SPDX-License-Identifier: Apache-2.0
#include "pipeline/stencil_patch_mesh.h"

#include "shaders_cpp/pass_through.h"
#include "shaders_cpp/skinning.h"

#include <algorithm>
#include <bit>
#include <cmath>
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
            std::shared_ptr<FlippedWeight const> const mistake = flipped_weight(g, settings);
            StencilBuffers buffers{weights_, masks_, g.words, g.order};
            if (mistake) buffers.weights = mistake->weights, buffers.patches = mistake->words;
            out.push_back(make_patch_pass(kind.kind, mesh_, g.inputs, g.indices, g.patches, vertex,
                                          kind.hull_program(buffers, settings), domain[g.kind],
                                          settings));
            out.back().memory.push_back(mistake);
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
    /// The mistake of one patch: weights of its own, of which one differs in the last bit.
    struct FlippedWeight {
        std::vector<float> weights;
        std::vector<std::uint32_t> words;
    };
    std::shared_ptr<FlippedWeight const> flipped_weight(Group const& g,
                                                        PassSettings const& settings) const
    {
        if (settings.mistake.kind != Mistake::Weights) return {};
        for (std::size_t i = 0; i < g.patches.size(); ++i) {
            if (g.patches[i].face != settings.mistake.face) continue;
            auto out = std::make_shared<FlippedWeight>(FlippedWeight{weights_, g.words});
            std::size_t const words = g.words.size() / g.patches.size();
            std::uint32_t& first = out->words[i * words];
            auto const rows = std::size_t(g.words[i * words + 2]), inputs = std::size_t(g.inputs);
            // The type's weights and, behind them, its constants.
            auto const next = std::upper_bound(
                types_.begin(), types_.end(), first,
                [](std::uint32_t at, Type const& t) { return at < t.first_weight; });
            std::size_t const end = next == types_.end() ? weights_.size() : next->first_weight;
            auto const begin = std::size_t(first);
            first = std::uint32_t(weights_.size());
            out->weights.insert(out->weights.end(), weights_.begin() + std::ptrdiff_t(begin),
                                weights_.begin() + std::ptrdiff_t(end));
            // A last bit may drown in the sum's rounding: of the weights of the corners' limit
            // points, the first that changes its point.
            float* const own = out->weights.data() + first;
            auto const* const ids = g.indices.data() + i * inputs;
            auto const* const order = g.order.data() + i * inputs;
            auto const sum = [&](std::size_t row) {
                glm::vec3 s(0);
                for (std::size_t k = 0; k < inputs; ++k)
                    s += own[order[k] * rows + row] * mesh_.positions[ids[order[k]]];
                return s;
            };
            auto const sides = std::size_t(scheme_.kinds[g.kind].sides);
            for (std::size_t at = 0; at < inputs * sides; ++at) {
                float& weight = own[at / sides * rows + at % sides];
                float const right = weight;
                glm::vec3 const before = sum(at % sides);
                weight = std::bit_cast<float>(std::bit_cast<std::uint32_t>(right) ^ 1u);
                if (right != 0 && sum(at % sides) != before) break;
                weight = right;
            }
            return out;
        }
        return {};
    }

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
