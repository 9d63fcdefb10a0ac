// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gregory_two_stage_technique.h"

#include "pipeline/vertex_rings.h"
#include "shaders_cpp/gregory/sector_domain_shaders.h"

#include <algorithm>

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kGregoryQuad, kGregoryTriangle, kKinds };

// Patches of one kind: an index buffer of their corners, and the offsets texture (figure 8).
struct Group {
    std::vector<PatchOrigin> patches;
    std::vector<std::uint32_t> indices, offsets, edges;
};

class GregoryTwoStageMesh final : public PatchMesh {
public:
    GregoryTwoStageMesh(Topology const& topology, double lambda_scale, double r_scale)
        : mesh_(topology.mesh()),
          rings_(topology),
          r_scale_(r_scale)
    {
        for (double c : make_ring_constants(lambda_scale)) constants_.push_back(float(c));
        for (double c : make_ring_cosines()) cosines_.push_back(float(c));
        std::vector<char> const hidden = hidden_faces(topology, warnings_);
        for (std::uint32_t f = 0; f < mesh_.faces(); ++f)
            if (!hidden[f]) add_patch(topology, f);
        warn_of_tags(mesh_, warnings_);
    }

    std::vector<DrawPass> passes(PassSettings const& settings) const override
    {
        RingVertexShader<> vs;
        vs.rings = {rings_.rings, 0, "ring_heads"};
        vs.entries = {rings_.entries, 1, "ring_entries"};
        vs.positions = Texture2D(rings_.positions, RingVertexShader<>::kTextureWidth, rings_.height,
                                 2, "ring_positions");
        vs.constants = {constants_, 3, "ring_constants"};
        vs.r_scale = float(r_scale_);
        vs.smooth_corners = mesh_.boundary == BoundaryRule::EdgeOnly;
        auto const vertex =
            std::shared_ptr<VertexProgram const>(make_vertex_program(vs, settings.machine));
        std::vector<DrawPass> out;
        for (int k = 0; k < kKinds; ++k) {
            Group const& g = groups_[k];
            if (g.patches.empty()) continue;
            GraphicsPipelineDesc desc;
            desc.vertex_shader = vertex;
            desc.hull_shader = hull_program(k, settings);
            desc.domain_shader =
                k == kRegularQuad ? projected_domain_program<RegularSectorsDomainShader>(settings)
                : k == kGregoryQuad
                    ? projected_domain_program<GregoryQuadSectorsDomainShader>(settings)
                    : projected_domain_program<GregoryTriangleSectorsDomainShader>(settings);
            if (settings.pixel_shader) desc.pixel_shader = settings.pixel_shader(kind(k));
            desc.partitioning = settings.partitioning;
            desc.output_primitive = OutputPrimitive::TriangleCw;
            desc.input_control_points = sides(k);
            DrawCall call;
            call.control_points = sides(k);
            call.set_vertices({&mesh_.positions.data()->x, mesh_.positions.size() * 3}, 3);
            call.indices = std::span<std::uint32_t const>(g.indices);
            out.push_back({kind(k), GraphicsPipeline(std::move(desc)), call, g.patches});
        }
        return out;
    }

    std::vector<PatchCount> patch_counts() const override
    {
        std::vector<PatchCount> out;
        for (int k = 0; k < kKinds; ++k)
            if (std::size_t const n = groups_[k].patches.size())
                out.push_back({kind(k), n, 1, sides(k), sides(k)});
        return out;
    }

    std::vector<std::string> const& warnings() const override { return warnings_; }

private:
    static PatchKind kind(int k)
    {
        constexpr char const* kNames[] = {"regular quad", "Gregory quad", "Gregory triangle"};
        return {kNames[k], k};
    }
    static int sides(int k) { return k == kGregoryTriangle ? 3 : 4; }

    void add_patch(Topology const& topology, std::uint32_t f)
    {
        auto const face = mesh_.face(f);
        auto const n = std::uint32_t(face.size());
        Group& g = groups_[n == 3                    ? kGregoryTriangle
                           : is_regular(topology, f) ? kRegularQuad
                                                     : kGregoryQuad];
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

    template <class Shader>
    std::shared_ptr<HullProgram const> hull_program(Group const& g,
                                                    PassSettings const& settings) const
    {
        Shader hs;
        hs.offsets = {g.offsets, 0, "corner_offsets"};
        hs.edges = {g.edges, 1, "edge_bits"};
        hs.cosines = {cosines_, 2, "cosines"};
        hs.factors.fill(settings.tess_factor);
        return make_hull_program(hs, settings.machine);
    }
    std::shared_ptr<HullProgram const> hull_program(int k, PassSettings const& settings) const
    {
        constexpr auto kQuad = TessellatorDomain::Quad, kTri = TessellatorDomain::Tri;
        Group const& g = groups_[k];
        return k == kRegularQuad   ? hull_program<SectorHullShader<kQuad, 4>>(g, settings)
               : k == kGregoryQuad ? hull_program<SectorHullShader<kQuad, 5>>(g, settings)
                                   : hull_program<SectorHullShader<kTri, 5>>(g, settings);
    }

    ControlMesh const& mesh_;
    VertexRings rings_;
    double r_scale_;
    std::vector<float> constants_, cosines_;
    Group groups_[kKinds];
    std::vector<std::string> warnings_;
};

class GregoryTwoStageTechnique final : public Technique {
public:
    SchemeInfo info() const override
    {
        return {
            "gregory-two-stage",
            "LOOP09",
            "3, 4.1, 4.2, 4.5, 4.6",
            "the same patches by a vertex shader over one-rings and a hull shader over sectors; "
            "valences up to 15",
            {{"lambda", "multiplies the tangent length lambda(n) of interior vertices", 1},
             {"r", "multiplies the transversal vectors r of the face points", 1}}};
    }

    std::unique_ptr<PatchMesh> build(Topology const& topology,
                                     std::map<std::string, double> const& parameters) const override
    {
        double lambda = 1, r = 1;
        for (auto const& [name, value] : parameters) {
            if (name == "lambda")
                lambda = value;
            else if (name == "r")
                r = value;
            else
                throw Error("gregory-two-stage has no parameter '" + name +
                            "'; there are lambda and r");
        }
        return std::make_unique<GregoryTwoStageMesh>(topology, lambda, r);
    }
};

} // namespace

std::unique_ptr<Technique> make_gregory_two_stage_technique()
{
    return std::make_unique<GregoryTwoStageTechnique>();
}

} // namespace tessemu
