// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/schemes/tables/table_scheme.h"

namespace tessemu {

std::unique_ptr<Scheme> make_tables_catmull_clark()
{
    SchemeInfo info;
    info.name = "tables-catmull-clark";
    info.summary = "the limit surface of Catmull-Clark subdivision with all its tags, from tables "
                   "of basis functions; subdivision shading";
    info.takes.steps = info.takes.steps_with_polygons = 1;
    return std::make_unique<TableScheme<CatmullClark>>(std::move(info));
}

} // namespace tessemu
