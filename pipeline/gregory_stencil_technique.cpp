// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gregory_stencil_technique.h"

#include "pipeline/gregory_stencils.h"
#include "shaders_cpp/gregory/domain_shaders.h"
#include "shaders_cpp/gregory/stencil_hull_shader.h"
#include "shaders_cpp/pass_through.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kGregoryQuad, kGregoryTriangle, kKinds };
constexpr char const* kKindNames[kKinds] = {"regular quad", "Gregory quad", "Gregory triangle"};

PatchKind kind_info(Kind k)
{
    return {kKindNames[k], k};
}
int sides_of(Kind k)
{
    return k == kGregoryTriangle ? 3 : 4;
}
int points_of(Kind k)
{
    return k == kRegularQuad ? 16 : k == kGregoryQuad ? 20 : 15;
}

// Patches of one kind and one number of inputs: an index buffer of their own, sorted by type.
struct Group {
    Kind kind;
    int inputs;
    std::vector<PatchOrigin> patches;
    std::vector<std::uint32_t> indices;
    std::vector<std::uint32_t> words; // StencilPatchWords
    std::vector<std::uint8_t> order;
};

struct Type {
    Kind kind;
    int inputs, rows;
    int corner_row[4];
    std::size_t first_weight, first_mask;
};

class GregoryStencilMesh final : public PatchMesh {
public:
    GregoryStencilMesh(Topology const& topology, GregoryParameters parameters)
        : mesh_(topology.mesh()),
          parameters_(parameters)
    {
        parameters_.smooth_corners = mesh_.boundary == BoundaryRule::EdgeOnly;
        static_assert(sizeof(glm::vec3) == 3 * sizeof(float));
        collect(topology);
        if (!mesh_.creases.empty())
            warnings_.push_back(std::to_string(mesh_.creases.size()) +
                                " crease edges are drawn smooth: the scheme knows no creases");
        if (!mesh_.corners.empty())
            warnings_.push_back(std::to_string(mesh_.corners.size()) +
                                " sharp corners are drawn smooth: the scheme knows no corners");
    }

    std::vector<DrawPass> passes(PassSettings const& settings) const override
    {
        auto const vertex = std::shared_ptr<VertexProgram const>(
            make_vertex_program(PassThroughVertexShader{}, settings.machine));
        std::shared_ptr<DomainProgram const> domain[kKinds];
        domain[kRegularQuad] = domain_program<RegularQuadDomainShader>(settings);
        domain[kGregoryQuad] = domain_program<GregoryQuadDomainShader>(settings);
        domain[kGregoryTriangle] = domain_program<GregoryTriangleDomainShader>(settings);

        std::vector<DrawPass> out;
        for (Group const& g : groups_) {
            GraphicsPipelineDesc desc;
            desc.vertex_shader = vertex;
            desc.hull_shader = sides_of(g.kind) == 4
                                   ? hull_program<TessellatorDomain::Quad>(g, settings)
                                   : hull_program<TessellatorDomain::Tri>(g, settings);
            desc.domain_shader = domain[g.kind];
            if (settings.pixel_shader) desc.pixel_shader = settings.pixel_shader(kind_info(g.kind));
            desc.partitioning = settings.partitioning;
            desc.output_primitive = OutputPrimitive::TriangleCw;
            desc.input_control_points = g.inputs;

            DrawCall call;
            call.control_points = g.inputs;
            call.set_vertices({&mesh_.positions.data()->x, mesh_.positions.size() * 3}, 3);
            call.indices = std::span<std::uint32_t const>(g.indices);
            out.push_back({kind_info(g.kind), GraphicsPipeline(std::move(desc)), call, g.patches});
        }
        return out;
    }

    std::vector<PatchCount> patch_counts() const override
    {
        std::vector<PatchCount> out;
        for (int k = 0; k < kKinds; ++k) {
            PatchCount c{kind_info(Kind(k)), 0, 0, 0, 0};
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
    struct Patch {
        std::uint32_t face, type;
        std::uint8_t rotation;
    };

    void collect(Topology const& topology)
    {
        std::vector<char> hidden(mesh_.faces(), 0);
        for (std::uint32_t f : mesh_.holes) hidden[f] = 1;
        if (mesh_.boundary == BoundaryRule::None) {
            std::size_t dropped = 0;
            for (std::uint32_t f = 0; f < mesh_.faces(); ++f)
                for (std::uint32_t v : mesh_.face(f))
                    if (topology.is_boundary(v) && !hidden[f]) hidden[f] = 1, ++dropped;
            if (dropped)
                warnings_.push_back(
                    std::to_string(dropped) +
                    " faces at the boundary are not drawn: interpolateboundary is 0");
        }

        std::unordered_map<std::string, std::uint32_t> type_ids;
        std::vector<Patch> patches;
        Neighbourhood n;
        for (std::uint32_t f = 0; f < mesh_.faces(); ++f) {
            if (hidden[f]) continue;
            find_neighbourhood(topology, f, n);
            if (n.inputs.size() > kMaxControlPoints) refuse(f, n);
            auto const [it, fresh] = type_ids.try_emplace(n.key, std::uint32_t(types_.size()));
            if (fresh) add_type(topology, f, n);
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

    void add_type(Topology const& topology, std::uint32_t face, Neighbourhood const& n)
    {
        bool const regular = is_regular(topology, face);
        GregoryStencils const s = make_gregory_stencils(n, regular, parameters_);
        Type t{n.sides == 3 ? kGregoryTriangle
               : regular    ? kRegularQuad
                            : kGregoryQuad,
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

    template <TessellatorDomain kDomain>
    std::shared_ptr<HullProgram const> hull_program(Group const& g,
                                                    PassSettings const& settings) const
    {
        StencilHullShader<kDomain> hs;
        hs.points = points_of(g.kind);
        hs.weights = {weights_, 0, "stencil_weights"};
        hs.zero_masks = {masks_, 1, "zero_masks"};
        hs.patches = {g.words, 2, "patch_words"};
        hs.order = {g.order, 3, "order"};
        hs.factors.fill(settings.tess_factor);
        return make_hull_program(hs, settings.machine);
    }

    template <class Surface>
    static std::shared_ptr<DomainProgram const> domain_program(PassSettings const& settings)
    {
        return make_domain_program(
            ProjectedSurface<Surface>{{settings.true_normals}, settings.view_projection},
            settings.machine);
    }

    ControlMesh const& mesh_;
    GregoryParameters parameters_;
    std::vector<Type> types_;
    std::vector<float> weights_;       // [type][input][row]
    std::vector<std::uint32_t> masks_; // [type][row]
    std::vector<Group> groups_;
    std::vector<std::string> warnings_;
};

class GregoryStencilTechnique final : public Technique {
public:
    SchemeInfo info() const override
    {
        return {
            "gregory-stencil",
            "LOOP09",
            "3, 4.3, 4.5, 4.6",
            "Gregory quads and triangles, regular quads as bicubics, stencils by connectivity type",
            {{"lambda", "multiplies the tangent length lambda(n) of interior vertices", 1},
             {"r", "multiplies the transversal vectors r of the face points", 1}}};
    }

    std::unique_ptr<PatchMesh> build(Topology const& topology,
                                     std::map<std::string, double> const& parameters) const override
    {
        GregoryParameters p;
        for (auto const& [name, value] : parameters) {
            if (name == "lambda")
                p.lambda_scale = value;
            else if (name == "r")
                p.r_scale = value;
            else
                throw Error("gregory-stencil has no parameter '" + name +
                            "'; there are lambda and r");
        }
        return std::make_unique<GregoryStencilMesh>(topology, p);
    }
};

} // namespace

std::unique_ptr<Technique> make_gregory_stencil_technique()
{
    return std::make_unique<GregoryStencilTechnique>();
}

} // namespace tessemu
