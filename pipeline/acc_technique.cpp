// SPDX-License-Identifier: Apache-2.0
#include "pipeline/acc_technique.h"

#include "pipeline/stencil_patch_mesh.h"
#include "shaders_cpp/acc/acc_hull_shader.h"
#include "shaders_cpp/gregory/domain_shaders.h"

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kAccQuad };

class AccTechnique final : public Technique {
public:
    SchemeInfo info() const override
    {
        return {"acc",
                "LOOP09",
                "5, 6 (Loop and Schaefer 2008)",
                "ACC: bicubics with separate tangent patches, 25 control points; quads only",
                {}};
    }

    std::unique_ptr<PatchMesh> build(Topology const& topology,
                                     std::map<std::string, double> const& parameters) const override
    {
        if (!parameters.empty())
            throw Error("acc has no parameter '" + parameters.begin()->first + "'");
        ControlMesh const& mesh = topology.mesh();
        std::size_t triangles = 0, first = 0;
        for (std::size_t f = mesh.faces(); f-- > 0;)
            if (mesh.face(std::uint32_t(f)).size() == 3) ++triangles, first = f;
        if (triangles)
            throw MeshError(
                std::uint32_t(first),
                "acc draws quads only: " + std::to_string(triangles) + " of " +
                    std::to_string(mesh.faces()) + " faces are triangles, the first is face " +
                    std::to_string(first + 1) + "; gregory-stencil draws triangles too");
        bool const smooth_corners = mesh.boundary == BoundaryRule::EdgeOnly;
        StencilScheme s;
        s.kinds = {
            {{"regular quad", kRegularQuad},
             4,
             [](StencilBuffers const& buffers, PassSettings const& settings) {
                 return stencil_hull_program<StencilHullShader<TessellatorDomain::Quad>>(
                     buffers, 16, settings);
             },
             surface_program<RegularQuadDomainShader>,
             [=](Neighbourhood const& n) { return make_acc_stencils(n, true, smooth_corners); }},
            {{"ACC quad", kAccQuad},
             4,
             [](StencilBuffers const& buffers, PassSettings const& settings) {
                 return stencil_hull_program<AccHullShader<>>(buffers, AccLayout::kCosines,
                                                              settings);
             },
             surface_program<AccQuadDomainShader>,
             [=](Neighbourhood const& n) { return make_acc_stencils(n, false, smooth_corners); }}};
        s.kind_of = [&topology](std::uint32_t face) -> std::size_t {
            return is_regular(topology, face) ? kRegularQuad : kAccQuad;
        };
        return make_stencil_patch_mesh(topology, std::move(s));
    }
};

} // namespace

std::unique_ptr<Technique> make_acc_technique()
{
    return std::make_unique<AccTechnique>();
}

} // namespace tessemu
