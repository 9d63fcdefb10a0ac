// SPDX-License-Identifier: Apache-2.0
#include "emu/pixel_shader.h"

namespace tessemu {

PixelShaderCost PixelProgram::probe(ShaderBinding const& binding) const
{
    constexpr std::size_t kGroup = 16; // whole groups are read and written
    float zeros[kGroup] = {}, colors[kMaxRenderTargets * 4][kGroup], depth[kGroup];
    std::int32_t no[kGroup] = {}, coverage[kGroup], discard[kGroup];
    std::vector<float const*> const attributes(std::size_t(input_floats()), zeros);
    float* rows[kMaxRenderTargets * 4];
    for (std::size_t i = 0; i < std::size(rows); ++i) rows[i] = colors[i];
    StageCounters counters;
    run(binding,
        {1,
         {zeros, zeros, zeros, zeros},
         attributes.data(),
         no,
         no,
         no,
         no,
         nullptr,
         nullptr,
         rows,
         depth,
         coverage,
         discard},
        counters, StageBuffers({}));
    return {counters.features, counters.flops};
}

} // namespace tessemu
