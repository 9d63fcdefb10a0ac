// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/loop.h"

#include "pipeline/mesh/limit_points.h"

namespace tessemu {

LimitRules const loop_limits = limit_rules<Loop>;

RefinedStep take_loop_step(Topology const& topology, std::uint32_t first)
{
    return take_weighted_step<Loop>(topology, first);
}

} // namespace tessemu
