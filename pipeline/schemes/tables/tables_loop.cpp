// tables-loop: Loop subdivision synthesized by tables of basis functions (Hollaender and Boubekeur
// 2010).
//
//     skinning ─> a step of Loop's ─> normals of M1 ─> domain shader: sums of B_i p_i and B_i n_i
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/table_form.h"
#include "pipeline/mesh/loop.h"

namespace tessemu {

namespace {

class TablesLoop final : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo info{"tables-loop", "HOLL10", "2",
                        "the limit surface of Loop subdivision with all its tags, from tables of "
                        "basis functions; subdivision shading"};
        info.takes.quads = false;
        info.takes.steps = 1;
        info.takes.steps_with_polygons = 1;
        info.takes.creases = info.takes.corners = true;
        info.takes.edges = LocalMesh::kMostEdges;
        info.takes.step = loop_step;
        info.parameters = TableForm::parameters();
        info.watertight_with = {{"tables", "enforced"}};
        info.no_curvature = "its tables have no second derivatives";
        return info;
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const> mesh,
                                     Parameters const& parameters,
                                     BuildServices const& services) const override
    {
        auto const make = TableForm::maker<Loop>(parameters);
        return std::make_unique<TableForm>(std::move(mesh), make, parameters, services);
    }
};

} // namespace

std::unique_ptr<Scheme> make_tables_loop()
{
    return std::make_unique<TablesLoop>();
}

} // namespace tessemu
