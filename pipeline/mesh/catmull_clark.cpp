// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/catmull_clark.h"

#include "pipeline/mesh/limit_points.h"

namespace tessemu {

LimitRules const catmull_clark_limits = limit_rules<CatmullClark>;

RefinedStep take_catmull_clark_step(Topology const& topology, std::uint32_t first)
{
    Sharpness const sharpness(topology);
    RefinedStep out;
    out.tables = catmull_clark_tables(topology, sharpness, first, first > 0); // or refuses
    out.mesh = refined_mesh<CatmullClark>(topology, sharpness);
    return out;
}

} // namespace tessemu
