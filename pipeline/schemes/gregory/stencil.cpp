// gregory-stencil: Gregory quads and triangles by stencils (LOOP09 3, 4.3), regular quads as
// bicubics.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/stencil_form.h"
#include "pipeline/schemes/gregory/programs.h"
#include "pipeline/schemes/gregory/stencils.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kGregoryQuad, kGregoryTriangle };

class GregoryStencils final : public StencilForm {
public:
    GregoryStencils(std::shared_ptr<RefinedMesh const> refined, Parameters const& parameters,
                    ThreadPool const* threads)
        : StencilForm(std::move(refined), {{"regular quad", PatchClass::RegularQuad},
                                           {"Gregory quad", PatchClass::IrregularQuad},
                                           {"Gregory triangle", PatchClass::Triangle}})
    {
        parameters_.lambda_scale = parameters.number("lambda");
        parameters_.r_scale = parameters.number("r");
        parameters_.smooth_corners = mesh().base().smooth_corners();
        std::vector<TypeAhead> ahead;
        if (parameters.word("matrices") == "ahead")
            for (ValenceType const& t : isolated_valence_types())
                ahead.push_back({t.inputs() == 16 ? kRegularQuad : kGregoryQuad, t});
        make_tables(threads, ahead);
    }

private:
    std::size_t kind_of(std::uint32_t face) const override
    {
        if (mesh().mesh().face(face).size() == 3) return kGregoryTriangle;
        return is_regular(mesh().topology(), face) ? kRegularQuad : kGregoryQuad;
    }
    PatchStencils stencils(std::size_t kind, Neighbourhood const& patch) const override
    {
        return make_gregory_stencils(patch, kind == kRegularQuad, parameters_);
    }
    HullShader hull_shader(std::size_t kind, RowBuffers const& buffers,
                           SurfaceSettings const& s) const override
    {
        if (kind == kGregoryTriangle)
            return stencil_hull_shader<StencilTriHullShader, 3>(buffers, 15, s);
        int const points = kind == kRegularQuad ? 16 : 20;
        return stencil_hull_shader<StencilQuadHullShader, 4>(buffers, points, s);
    }
    DomainShader domain_shader(std::size_t kind, SurfaceSettings const& s) const override
    {
        if (kind == kRegularQuad) return surface_shader<RegularQuadDomainShader>(s);
        if (kind == kGregoryQuad) return surface_shader<GregoryQuadDomainShader>(s);
        return surface_shader<GregoryTriangleDomainShader>(s);
    }

    GregoryParameters parameters_;
};

class GregoryStencil final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{
            "gregory-stencil",
            "LOOP09",
            "3, 4.3, 4.5, 4.6",
            "Gregory quads and triangles, regular quads as bicubics, stencils by connectivity type",
            {},
            gregory_parameters()};
        info.parameters.push_back({"matrices",
                                   "when the changes of basis of isolated extraordinary vertices "
                                   "are made: as patches ask for them, or all 10 before",
                                   0,
                                   {},
                                   {},
                                   {"demand", "ahead"}});
        info.takes.edges = StencilForm::kMostEdges;
        info.no_curvature = kNoGregoryCurvature;
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const& services) const override
    {
        return std::make_unique<GregoryStencils>(std::move(mesh), parameters, services.threads);
    }
};

} // namespace

std::vector<SchemeParameter> gregory_parameters()
{
    return {{"lambda", "multiplies the tangent length lambda(n) of interior vertices", 1, 0, 16},
            {"r", "multiplies the transversal vectors r of the face points", 1, -16, 16}};
}

std::unique_ptr<Scheme> make_gregory_stencil()
{
    return std::make_unique<GregoryStencil>();
}

} // namespace tessemu
