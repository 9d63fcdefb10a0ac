// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/loop.h"
#include "pipeline/schemes/tables/table_scheme.h"

namespace tessemu {

std::unique_ptr<Scheme> make_tables_loop()
{
    SchemeInfo info;
    info.name = "tables-loop";
    info.summary = "the limit surface of Loop subdivision with all its tags, from tables of basis "
                   "functions; subdivision shading";
    info.takes.quads = false;
    info.takes.steps = info.takes.steps_with_polygons = 1;
    info.takes.step = loop_step;
    return std::make_unique<TableScheme<Loop>>(std::move(info));
}

} // namespace tessemu
