// gregory-two-stage: the same patches by a vertex shader over one-rings and a hull shader over
// corners (LOOP09 4.1, 4.2).
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/two_stage_form.h"
#include "pipeline/schemes/gregory/programs.h"
#include "pipeline/schemes/gregory/ring_constants.h"
#include "pipeline/schemes/scheme.h"

namespace tessemu {

namespace {

enum Kind { kRegularQuad, kGregoryQuad, kGregoryTriangle };

class GregoryTwoStagePatches final : public TwoStageForm {
public:
    GregoryTwoStagePatches(std::shared_ptr<RefinedMesh const> refined, Parameters const& parameters)
        : TwoStageForm(std::move(refined), {{{"regular quad", PatchClass::RegularQuad}, 4},
                                            {{"Gregory quad", PatchClass::IrregularQuad}, 4},
                                            {{"Gregory triangle", PatchClass::Triangle}, 3}}),
          lambda_scale_(parameters.number("lambda")),
          r_(float(parameters.number("r"))),
          smooth_corners_(mesh().base().smooth_corners())
    {
        for (double c : make_ring_constants(lambda_scale_)) constants_.push_back(float(c));
        make_tables();
    }

private:
    std::size_t kind_of(std::uint32_t face) const override
    {
        if (mesh().mesh().face(face).size() == 3) return kGregoryTriangle;
        return is_regular(mesh().topology(), face) ? kRegularQuad : kGregoryQuad;
    }
    VertexShader vertex_shader(RingTextures const& textures,
                               SurfaceSettings const& s) const override
    {
        return bind_vertex_shader(
            RingVertexShader<>{{textures, {constants_, 3, "ring_constants"}, r_, smooth_corners_}},
            s.machine);
    }
    std::vector<double> wide_constants(int faces, bool boundary) const override
    {
        return ring_constants_of(faces, boundary, lambda_scale_);
    }
    ComputeShader window_shader(RingTextures const& textures, WindowBuffers const& b,
                                SurfaceSettings const& s) const override
    {
        RingWindowShader const cs{
            {textures, {b.constants, 3, "ring_constants"}, r_, smooth_corners_},
            {b.corners, 4, "corners"},
            {b.windows, 5, "ring_windows"}};
        return bind_compute_shader(cs, s.machine);
    }
    HullShader hull_shader(std::size_t kind, CornerBuffers const& buffers,
                           SurfaceSettings const& s) const override
    {
        constexpr auto kQuad = TessellatorDomain::Quad, kTri = TessellatorDomain::Tri;
        if (kind == kRegularQuad) return corner_hull_shader<CornerHullShader<kQuad, 4>>(buffers, s);
        if (kind == kGregoryQuad) return corner_hull_shader<CornerHullShader<kQuad, 5>>(buffers, s);
        return corner_hull_shader<CornerHullShader<kTri, 5>>(buffers, s);
    }
    DomainShader domain_shader(std::size_t kind, SurfaceSettings const& s) const override
    {
        if (kind == kRegularQuad) return surface_shader<RegularCornersDomainShader>(s);
        if (kind == kGregoryQuad) return surface_shader<GregoryQuadCornersDomainShader>(s);
        return surface_shader<GregoryTriangleCornersDomainShader>(s);
    }

    std::vector<float> constants_;
    double lambda_scale_;
    float r_;
    bool smooth_corners_;
};

class GregoryTwoStage final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{
            "gregory-two-stage",
            "LOOP09",
            "3, 4.1, 4.2, 4.5, 4.6",
            "the same patches by a vertex shader over one-rings and a hull shader over corners",
            {},
            gregory_parameters()};
        info.takes.edges = CornerWindow::kMost;
        info.no_curvature = kNoGregoryCurvature;
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const&) const override
    {
        return std::make_unique<GregoryTwoStagePatches>(std::move(mesh), parameters);
    }
};

} // namespace

std::unique_ptr<Scheme> make_gregory_two_stage()
{
    return std::make_unique<GregoryTwoStage>();
}

} // namespace tessemu
