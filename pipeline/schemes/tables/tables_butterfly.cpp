// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/butterfly.h"
#include "pipeline/schemes/tables/table_scheme.h"

namespace tessemu {

std::unique_ptr<Scheme> make_tables_butterfly()
{
    SchemeInfo info;
    info.name = "tables-butterfly";
    info.summary =
        "the surface that Modified Butterfly subdivision interpolates the vertices with, "
        "from tables of basis functions; subdivision shading";
    info.takes.quads = false;
    // A triangle's weights depend on two rings of faces: one extraordinary vertex in them.
    info.takes.steps = info.takes.steps_with_polygons = 2;
    info.takes.step = butterfly_step;
    return std::make_unique<TableScheme<Butterfly>>(std::move(info));
}

} // namespace tessemu
