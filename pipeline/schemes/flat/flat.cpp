// flat: the triangles as they are with interpolated normals, what HOLL10's substitutes start from.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/loop.h"
#include "pipeline/schemes/cage_normals.h"
#include "shaders_cpp/flat/flat_triangle.h"

namespace tessemu {

namespace {

class FlatPatches final : public CageForm {
public:
    FlatPatches(std::shared_ptr<RefinedMesh const> mesh, Parameters const& parameters)
        : CageForm(std::move(mesh), normals_of(parameters))
    {
    }

private:
    DomainShader domain_shader(int, SurfaceSettings const& s) const override
    {
        return bind_domain_shader(FlatTriangle{}, s.machine);
    }
};

class Flat final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"flat", "HOLL10", "5", "the mesh's triangles, flat, with blended normals"};
        info.takes.quads = false;
        info.takes.step = loop_step;
        info.takes.steps_with_polygons = 0;
        info.no_curvature =
            "its triangles are flat, and its normals are blended from the vertices'";
        add_normals_parameter(info);
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const&) const override
    {
        return std::make_unique<FlatPatches>(std::move(mesh), parameters);
    }
};

} // namespace

std::unique_ptr<Scheme> make_flat()
{
    return std::make_unique<Flat>();
}

} // namespace tessemu
