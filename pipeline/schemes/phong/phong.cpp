// phong: Phong tessellation (Boubekeur and Alexa 2008), a substitute that HOLL10 compares with.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/loop.h"
#include "pipeline/schemes/cage_normals.h"
#include "shaders_cpp/phong/phong_triangle.h"

namespace tessemu {

namespace {

class PhongPatches final : public CageForm {
public:
    PhongPatches(std::shared_ptr<RefinedMesh const> mesh, Parameters const& parameters)
        : CageForm(std::move(mesh), normals_of(parameters)),
          alpha_(float(parameters.number("alpha")))
    {
    }

private:
    DomainShader domain_shader(int, SurfaceSettings const& s) const override
    {
        return bind_domain_shader(PhongTriangle{alpha_}, s.machine);
    }

    float alpha_;
};

class Phong final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{
            "phong", "HOLL10", "5 (Boubekeur and Alexa 2008)",
            "Phong tessellation: triangles pulled towards their vertices' tangent planes"};
        info.takes.quads = false;
        info.takes.step = loop_step;
        info.takes.steps_with_polygons = 0;
        info.no_curvature =
            "its normals are blended from the vertices', not those of the positions, "
            "which have kinks at the edges";
        info.parameters = {{"alpha", "how far, 0: flat", 0.75, 0, 1}};
        add_normals_parameter(info);
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const&) const override
    {
        return std::make_unique<PhongPatches>(std::move(mesh), parameters);
    }
};

} // namespace

std::unique_ptr<Scheme> make_phong()
{
    return std::make_unique<Phong>();
}

} // namespace tessemu
