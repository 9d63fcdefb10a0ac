// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/refinement_pattern.h"

#include <cassert>

namespace tessemu {

int uniform_segments(float tess_factor)
{
    assert(tess_factor > 0 && tess_factor <= float(kMaxTessFactor));
    int n = 1;
    while (float(n) < tess_factor) n *= 2;
    return n;
}

std::shared_ptr<DomainPoints const> uniform_pattern(TessellatorDomain domain, int n)
{
    assert(domain != TessellatorDomain::Isoline);
    bool const triangle = domain == TessellatorDomain::Tri;
    auto out = std::make_shared<DomainPoints>();
    std::vector<std::uint32_t> first;
    for (int j = 0; j <= n; ++j) {
        first.push_back(std::uint32_t(out->u.size()));
        for (int i = 0; i <= (triangle ? n - j : n); ++i) {
            out->patch.u.push_back(std::uint32_t(i) * (kFixedOne / std::uint32_t(n)));
            out->patch.v.push_back(std::uint32_t(j) * (kFixedOne / std::uint32_t(n)));
            out->u.push_back(float(i) / float(n));
            out->v.push_back(float(j) / float(n));
        }
    }
    auto const at = [&](int i, int j) { return first[std::size_t(j)] + std::uint32_t(i); };
    auto& indices = out->patch.indices;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < (triangle ? n - j : n); ++i) {
            indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
            if (!triangle || i + j + 1 < n)
                indices.insert(indices.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return out;
}

} // namespace tessemu
