// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gregory_two_stage_technique.h"

#include "pipeline/ring_patch_mesh.h"
#include "shaders_cpp/gregory/sector_domain_shaders.h"

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kGregoryQuad, kGregoryTriangle };

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
        constexpr auto kQuad = TessellatorDomain::Quad, kTri = TessellatorDomain::Tri;
        RingScheme s;
        s.kinds = {{{"regular quad", kRegularQuad},
                    4,
                    sector_hull_program<SectorHullShader<kQuad, 4>>,
                    surface_program<RegularSectorsDomainShader>},
                   {{"Gregory quad", kGregoryQuad},
                    4,
                    sector_hull_program<SectorHullShader<kQuad, 5>>,
                    surface_program<GregoryQuadSectorsDomainShader>},
                   {{"Gregory triangle", kGregoryTriangle},
                    3,
                    sector_hull_program<SectorHullShader<kTri, 5>>,
                    surface_program<GregoryTriangleSectorsDomainShader>}};
        s.kind_of = [&topology](std::uint32_t face) -> std::size_t {
            if (topology.mesh().face(face).size() == 3) return kGregoryTriangle;
            return is_regular(topology, face) ? kRegularQuad : kGregoryQuad;
        };
        std::vector<float> constants;
        for (double c : make_ring_constants(lambda)) constants.push_back(float(c));
        bool const smooth_corners = topology.mesh().boundary == BoundaryRule::EdgeOnly;
        s.vertex_program = [constants = std::make_shared<std::vector<float>>(std::move(constants)),
                            r, smooth_corners](RingTextures const& textures,
                                               PassSettings const& settings) {
            RingVertexShader<> vs{
                textures, {*constants, 3, "ring_constants"}, float(r), smooth_corners};
            return std::shared_ptr<VertexProgram const>(make_vertex_program(vs, settings.machine));
        };
        return make_ring_patch_mesh(topology, std::move(s));
    }
};

} // namespace

std::unique_ptr<Technique> make_gregory_two_stage_technique()
{
    return std::make_unique<GregoryTwoStageTechnique>();
}

} // namespace tessemu
