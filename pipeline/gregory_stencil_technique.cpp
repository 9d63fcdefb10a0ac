// SPDX-License-Identifier: Apache-2.0
#include "pipeline/gregory_stencil_technique.h"

#include "pipeline/stencil_patch_mesh.h"
#include "shaders_cpp/gregory/domain_shaders.h"

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kGregoryQuad, kGregoryTriangle };

template <class Surface>
StencilKind make_kind(char const* name, Kind k, GregoryParameters const& parameters)
{
    constexpr TessellatorDomain kDomain = Surface::kDomain;
    return {{name, k},
            kDomain == TessellatorDomain::Quad ? 4 : 3,
            [](StencilBuffers const& buffers, PassSettings const& settings) {
                return stencil_hull_program<StencilHullShader<kDomain>>(
                    buffers, Surface::kControlPoints, settings);
            },
            surface_program<Surface>,
            [parameters](Neighbourhood const& n) {
                return make_gregory_stencils(n, Surface::kControlPoints == 16, parameters);
            }};
}

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
        p.smooth_corners = topology.mesh().boundary == BoundaryRule::EdgeOnly;
        for (auto const& [name, value] : parameters) {
            if (name == "lambda")
                p.lambda_scale = value;
            else if (name == "r")
                p.r_scale = value;
            else
                throw Error("gregory-stencil has no parameter '" + name +
                            "'; there are lambda and r");
        }
        StencilScheme s;
        s.kinds = {make_kind<RegularQuadDomainShader>("regular quad", kRegularQuad, p),
                   make_kind<GregoryQuadDomainShader>("Gregory quad", kGregoryQuad, p),
                   make_kind<GregoryTriangleDomainShader>("Gregory triangle", kGregoryTriangle, p)};
        s.kind_of = [&topology](std::uint32_t face) -> std::size_t {
            if (topology.mesh().face(face).size() == 3) return kGregoryTriangle;
            return is_regular(topology, face) ? kRegularQuad : kGregoryQuad;
        };
        return make_stencil_patch_mesh(topology, std::move(s));
    }
};

} // namespace

std::unique_ptr<Technique> make_gregory_stencil_technique()
{
    return std::make_unique<GregoryStencilTechnique>();
}

} // namespace tessemu
