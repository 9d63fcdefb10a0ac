// pm: Pm-patches (Myles, Ni and Peters 2008) in two-stage form, as LOOP09 ran them.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/two_stage_form.h"
#include "pipeline/schemes/pm/constants.h"
#include "pipeline/schemes/pm/programs.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kPmQuad, kPmTriangle };

class PmPatches final : public TwoStageForm {
public:
    explicit PmPatches(std::shared_ptr<RefinedMesh const> refined)
        : TwoStageForm(std::move(refined), {{{"regular quad", PatchClass::RegularQuad}, 4},
                                            {{"P4", PatchClass::IrregularQuad}, 4},
                                            {{"P3", PatchClass::Triangle}, 3}})
    {
        for (double c : make_pm_constants()) constants_.push_back(float(c));
        make_tables();
    }

private:
    std::size_t kind_of(std::uint32_t face) const override
    {
        if (mesh().mesh().face(face).size() == 3) return kPmTriangle;
        return is_regular(mesh().topology(), face) ? kRegularQuad : kPmQuad;
    }
    VertexShader vertex_shader(RingTextures const& textures,
                               SurfaceSettings const& s) const override
    {
        return bind_vertex_shader(PmVertexShader<>{textures, {constants_, 3, "ring_constants"}},
                                  s.machine);
    }
    HullShader hull_shader(std::size_t kind, CornerBuffers const& buffers,
                           SurfaceSettings const& s) const override
    {
        constexpr auto kQuad = TessellatorDomain::Quad, kTri = TessellatorDomain::Tri;
        if (kind == kRegularQuad) return corner_hull_shader<PmRegularHullShader<>>(buffers, s);
        if (kind == kPmQuad) return corner_hull_shader<PmHullShader<kQuad>>(buffers, s);
        return corner_hull_shader<PmHullShader<kTri>>(buffers, s);
    }
    DomainShader domain_shader(std::size_t kind, SurfaceSettings const& s) const override
    {
        if (kind == kRegularQuad) return surface_shader<RegularCornersDomainShader>(s);
        if (kind == kPmQuad) return surface_shader<PmQuadDomainShader>(s);
        return surface_shader<PmTriangleDomainShader>(s);
    }

    std::vector<float> constants_;
};

class Pm final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{
            "pm", "LOOP09", "5, 6 (Myles, Ni and Peters 2008)",
            "Pm-patches: quartic Bezier triangles around a centre, 25 coefficients for a quad, 19 "
            "for a triangle; closed meshes only"};
        info.takes.boundary = false;
        info.takes.edges = RingLayout::kEdges;
        info.no_curvature =
            "its irregular patches are quartic triangles that share the tangent plane "
            "alone, so curvature jumps at their edges and inside them";
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh, Parameters const&,
                                     BuildServices const&) const override
    {
        return std::make_unique<PmPatches>(std::move(mesh));
    }
};

} // namespace

std::unique_ptr<Scheme> make_pm()
{
    return std::make_unique<Pm>();
}

} // namespace tessemu
