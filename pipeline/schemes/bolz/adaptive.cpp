// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/bolz/adaptive.h"

#include "pipeline/schemes/bolz/deviation.h"

#include <algorithm>
#include <memory>

namespace tessemu {

namespace {

constexpr int kMost = PatchDeviation::kMostLevel;

class Levels {
public:
    Levels(std::span<DrawnPatch const> drawn, MeshBasis const& basis, ControlMesh const& mesh,
           double distance, glm::dvec3 origin)
        : drawn_(drawn),
          deviations_(basis.types().size()),
          of_patch_(drawn.size()),
          nets_(drawn.size()),
          distances_(drawn.size()),
          inside_(drawn.size(), 0)
    {
        std::vector<glm::dvec3> points;
        for (std::size_t p = 0; p < nets_.size(); ++p) {
            BasisPatch const& patch = basis.patches()[drawn[p].patch];
            auto& deviation = deviations_[patch.type];
            if (!deviation) deviation = std::make_unique<PatchDeviation>(basis.types()[patch.type]);
            of_patch_[p] = deviation.get();
            points.clear();
            for (int k = 0; k < basis.types()[patch.type].points; ++k)
                points.emplace_back(
                    mesh.positions[basis.points()[patch.first_point + std::uint32_t(k)]]);
            nets_[p] = deviation->net_of(points, origin);
            while (bound(p) > distance && inside_[p] < kMost) ++inside_[p];
            // Finer neighbours are no help to a patch that is beyond it at all levels.
            distances_[p] = std::max(distance, bound(p));
        }
    }

    // Until no strip is beyond the distance. Levels only rise, so this ends.
    void settle()
    {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t p = 0; p < nets_.size(); ++p)
                while (rise_beside(p)) changed = true;
        }
    }

    // Edges at the lesser of both.
    GridLevels of(std::size_t p) const
    {
        GridLevels out{inside_[p], {}};
        for (std::size_t k = 0; k < 4; ++k) {
            std::uint32_t const other = drawn_[p].neighbours[k];
            out.edges[k] =
                other == DrawnPatch::kNone ? inside_[p] : std::min(inside_[p], inside_[other]);
        }
        return out;
    }
    double rounding(std::size_t p) const { return nets_[p].rounding; }
    double bound(std::size_t p, GridLevels const& levels) const
    {
        return of_patch_[p]->bound(nets_[p], levels);
    }

private:
    double bound(std::size_t p) const { return of_patch_[p]->bound(nets_[p], inside_[p]); }

    // Whether a level rose for a strip of the patch.
    bool rise_beside(std::size_t p)
    {
        GridLevels const levels = of(p);
        if (levels.is_regular()) return false;
        for (int k = 0; k < 4; ++k) {
            std::uint8_t const edge = levels.edges[std::size_t(k)];
            if (of_patch_[p]->strip_bound(nets_[p], levels.inside, k, edge) <= distances_[p])
                continue;
            std::uint32_t const other = drawn_[p].neighbours[std::size_t(k)];
            std::uint8_t& level = edge < levels.inside ? inside_[other] : inside_[p];
            if (level == kMost) continue;
            ++level;
            return true;
        }
        return false;
    }

    std::span<DrawnPatch const> drawn_;
    std::vector<std::unique_ptr<PatchDeviation const>> deviations_; // by type
    // By patch:
    std::vector<PatchDeviation const*> of_patch_;
    std::vector<PatchDeviation::Net> nets_;
    std::vector<double> distances_;
    std::vector<std::uint8_t> inside_;
};

} // namespace

AdaptiveLevels adaptive_levels(std::span<DrawnPatch const> drawn, MeshBasis const& basis,
                               ControlMesh const& mesh, double distance, glm::dvec3 origin)
{
    Levels levels(drawn, basis, mesh, distance, origin);
    levels.settle();
    AdaptiveLevels out;
    for (std::size_t p = 0; p < drawn.size(); ++p) {
        GridLevels const of_patch = levels.of(p);
        double const bound = levels.bound(p, of_patch);
        out.beyond += bound > distance;
        out.largest = std::max(out.largest, bound);
        out.rounding = std::max(out.rounding, levels.rounding(p));
        out.patches.push_back(of_patch);
    }
    return out;
}

} // namespace tessemu
