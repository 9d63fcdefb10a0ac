// acc: bicubics with separate tangent patches (Loop and Schaefer 2008), as LOOP09 compares with
// them.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/stencil_form.h"
#include "pipeline/schemes/acc/programs.h"
#include "pipeline/schemes/acc/stencils.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kAccQuad };

class AccPatches final : public StencilForm {
public:
    AccPatches(std::shared_ptr<RefinedMesh const> refined, ThreadPool const* threads)
        : StencilForm(std::move(refined), {{"regular quad", PatchClass::RegularQuad},
                                           {"ACC quad", PatchClass::IrregularQuad}})
    {
        make_tables(threads);
    }

private:
    std::size_t kind_of(std::uint32_t face) const override
    {
        return is_regular(mesh().topology(), face) ? kRegularQuad : kAccQuad;
    }
    PatchStencils stencils(std::size_t kind, Neighbourhood const& patch) const override
    {
        return make_acc_stencils(patch, kind == kRegularQuad, mesh().base().smooth_corners());
    }
    HullShader hull_shader(std::size_t kind, RowBuffers const& buffers,
                           SurfaceSettings const& s) const override
    {
        if (kind == kRegularQuad)
            return stencil_hull_shader<StencilQuadHullShader, 4>(buffers, 16, s);
        return stencil_hull_shader<AccHullShader, 4>(buffers, AccLayout::kCosines, s);
    }
    DomainShader domain_shader(std::size_t kind, SurfaceSettings const& s) const override
    {
        if (kind == kRegularQuad) return surface_shader<RegularQuadDomainShader>(s);
        return surface_shader<AccQuadDomainShader>(s);
    }
};

class Acc final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{
            "acc", "LOOP09", "5, 6 (Loop and Schaefer 2008)",
            "ACC: bicubics with separate tangent patches, 25 control points; quads only"};
        info.takes.triangles = false;
        info.takes.edges = StencilForm::kMostEdges;
        info.no_curvature = "its normals are those of tangent patches, not of the positions, which "
                            "have kinks at the edges of irregular patches";
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh, Parameters const&,
                                     BuildServices const& services) const override
    {
        return std::make_unique<AccPatches>(std::move(mesh), services.threads);
    }
};

} // namespace

std::unique_ptr<Scheme> make_acc()
{
    return std::make_unique<Acc>();
}

} // namespace tessemu
