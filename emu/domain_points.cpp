// SPDX-License-Identifier: Apache-2.0
#include "emu/domain_points.h"

#include <algorithm>

namespace tessemu {

std::size_t TessellatorCache::Hash::operator()(FixedFactors const& f) const
{
    std::uint64_t h = 0xcbf29ce484222325u;
    for (std::size_t i = 0; i < f.value.size(); ++i)
        h = (h ^ (f.value[i] * 2 + (f.odd[i] ? 1 : 0))) * 0x100000001b3u;
    return std::size_t(h);
}

namespace {

template <int kLanes> std::vector<DomainPoints::Strip<kLanes>> find_strips(DomainPoints const& d)
{
    std::size_t const triangles = d.patch.indices.size() / 3, points = d.patch.points();
    std::size_t const groups = (triangles + std::size_t(kLanes) - 1) / std::size_t(kLanes);
    std::vector<DomainPoints::Strip<kLanes>> strips(groups);
    for (std::size_t g = 0; g < groups; ++g) {
        auto& s = strips[g];
        // The padding's corners, all 0, would spoil the last group's runs: they take any place.
        std::size_t const first = g * std::size_t(kLanes);
        std::size_t const live = std::min(std::size_t(kLanes), triangles - first);
        std::vector<std::uint32_t> used;
        for (auto const& corner : d.corner)
            used.insert(used.end(), corner.begin() + std::ptrdiff_t(first),
                        corner.begin() + std::ptrdiff_t(first + live));
        std::sort(used.begin(), used.end());
        s.run[0] = used.front();
        auto const second = std::find_if(used.begin(), used.end(), [&](std::uint32_t i) {
            return i >= s.run[0] + std::uint32_t(kLanes);
        });
        s.run[1] = second == used.end() ? s.run[0] : *second;
        s.gather = points < std::size_t(kLanes) || used.back() >= s.run[1] + std::uint32_t(kLanes);
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < std::size_t(kLanes); ++i) {
                std::uint32_t const v = i < live ? d.corner[k][first + i] : s.run[0];
                bool const in_first = v < s.run[0] + std::uint32_t(kLanes);
                s.place[k][i] = std::uint8_t(in_first ? v - s.run[0] : kLanes + v - s.run[1]);
            }
    }
    return strips;
}

} // namespace

std::shared_ptr<DomainPoints const> TessellatorCache::find(TessFactors const& factors)
{
    FixedFactors const key = process_tess_factors(state_, factors);
    if (auto const it = entries_.find(key); it != entries_.end()) return it->second;

    auto points = std::make_shared<DomainPoints>();
    tessellate(state_, key, points->patch);
    std::size_t const n = points->patch.points();
    constexpr std::size_t kPadding = 16; // the widest group
    points->u.resize(n ? n + kPadding : 0);
    points->v.resize(points->u.size());
    for (std::size_t i = 0; i < points->u.size(); ++i) {
        std::size_t const k = std::min(i, n - 1);
        points->u[i] = float(points->patch.u[k]) / float(kFixedOne);
        points->v[i] = float(points->patch.v[k]) / float(kFixedOne);
    }
    if (state_.output == OutputPrimitive::TriangleCw ||
        state_.output == OutputPrimitive::TriangleCcw) {
        std::vector<std::uint32_t> const& index = points->patch.indices;
        std::size_t const triangles = index.size() / 3;
        for (std::size_t k = 0; k < 3; ++k) {
            points->corner[k].assign((triangles + kPadding - 1) / kPadding * kPadding, 0);
            for (std::size_t t = 0; t < triangles; ++t) points->corner[k][t] = index[3 * t + k];
        }
        points->strips16 = find_strips<16>(*points);
        points->strips8 = find_strips<8>(*points);
    }
    if (entries_.size() >= capacity_) entries_.clear();
    return entries_.emplace(key, std::move(points)).first->second;
}

} // namespace tessemu
