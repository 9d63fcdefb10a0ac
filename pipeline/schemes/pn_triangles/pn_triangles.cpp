// pn-triangles: curved PN triangles (Vlachos et al. 2001), a substitute that HOLL10 compares with.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/loop.h"
#include "pipeline/schemes/cage_normals.h"
#include "shaders_cpp/pn_triangles/pn_triangle.h"

namespace tessemu {

namespace {

class PnPatches final : public CageForm {
public:
    PnPatches(std::shared_ptr<RefinedMesh const> mesh, Parameters const& parameters)
        : CageForm(std::move(mesh), normals_of(parameters))
    {
    }

private:
    HullShader hull_shader(int, SurfaceSettings const& s) const override
    {
        return bind_hull_shader(PnHullShader{cage_hull_shader<TessellatorDomain::Tri>(s)},
                                s.machine);
    }
    DomainShader domain_shader(int, SurfaceSettings const& s) const override
    {
        return bind_domain_shader(PnTriangle{}, s.machine);
    }
};

class PnTriangles final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"pn-triangles", "HOLL10", "5 (Vlachos et al. 2001)",
                        "PN triangles: cubic positions and quadratic normals from the vertices'"};
        info.takes.quads = false;
        info.takes.step = loop_step;
        info.takes.steps_with_polygons = 0;
        info.no_curvature =
            "its normals are a quadratic of their own, not those of the positions, which have "
            "kinks at the edges";
        add_normals_parameter(info);
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const&) const override
    {
        return std::make_unique<PnPatches>(std::move(mesh), parameters);
    }
};

} // namespace

std::unique_ptr<Scheme> make_pn_triangles()
{
    return std::make_unique<PnTriangles>();
}

} // namespace tessemu
