// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/butterfly.h"

#include "pipeline/mesh/limit_points.h"

namespace tessemu {

LimitRules const butterfly_limits = limit_rules<Butterfly>;

RefinedStep take_butterfly_step(Topology const& topology, std::uint32_t first)
{
    RefinedStep out = take_weighted_step<Butterfly>(topology, first);
    out.mesh.creases.clear();
    out.mesh.corners.clear();
    return out;
}

} // namespace tessemu
