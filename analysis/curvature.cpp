// SPDX-License-Identifier: Apache-2.0
#include "analysis/curvature.h"

#include "analysis/compare.h"
#include "pipeline/mesh/placement.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tessemu {

double curvature_range(PatchMesh const& patches, FrameSettings settings, ThreadPool const& threads)
{
    settings.curvature = true;
    std::vector<double> size, weight;
    visit_surface(patches, settings, threads, [&](SurfacePatch const& p) {
        if (!p.has_curvature()) return;
        std::size_t const first = size.size();
        std::vector<glm::dvec3> position;
        for (std::size_t i = 0; i < p.points(); ++i) {
            SurfaceVertex const v = p.vertex(i);
            position.emplace_back(v.position);
            size.push_back(std::abs(double(v.curvature)));
        }
        weight.resize(size.size(), 0);
        auto const& index = p.triangles();
        for (std::size_t t = 0; t < index.size(); t += 3) {
            glm::dvec3 const a = position[index[t]], b = position[index[t + 1]],
                             c = position[index[t + 2]];
            double const third = length(cross(b - a, c - a)) / 6;
            for (std::size_t k = 0; k < 3; ++k) weight[first + index[t + k]] += third;
        }
        for (std::size_t i = first; i < size.size(); ++i)
            if (!std::isfinite(size[i]) || !std::isfinite(weight[i])) size[i] = weight[i] = 0;
    });
    double const diagonal = bounding_box_diagonal(patches.mesh().base());
    return std::max(quantile(size, weight, 0.99), diagonal > 0 ? 0.01 / diagonal : 0);
}

std::size_t patches_without_curvature(PatchMesh const& patches)
{
    SurfaceSettings settings;
    settings.curvature = true;
    std::size_t n = 0;
    patches.commands(settings).for_each_surface_draw([&](Draw const& d) {
        if (!d.has_curvature()) n += d.patches.size();
    });
    return n;
}

} // namespace tessemu
