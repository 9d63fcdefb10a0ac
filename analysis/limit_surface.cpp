// SPDX-License-Identifier: Apache-2.0
#include "analysis/limit_surface.h"

#include "pipeline/mesh/limit_points.h"

#include <array>
#include <memory>

namespace tessemu {

namespace {

using Vec = glm::dvec3;
using GridPoint = std::array<int, 2>;

GridPoint middle(GridPoint const& a, GridPoint const& b)
{
    return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
}

// Corners of a face's child on the grid, as split_mesh() has them.
std::array<GridPoint, 4> child_of_quad(std::array<GridPoint, 4> const& c, std::size_t child)
{
    std::size_t const after = (child + 1) % 4, before = (child + 3) % 4;
    return {c[child], middle(c[child], c[after]), middle(c[child], c[(child + 2) % 4]),
            middle(c[before], c[child])};
}
std::array<GridPoint, 4> child_of_triangle(std::array<GridPoint, 4> const& c, std::size_t child)
{
    if (child == 3) return {middle(c[0], c[1]), middle(c[1], c[2]), middle(c[2], c[0])};
    return {c[child], middle(c[child], c[(child + 1) % 3]), middle(c[(child + 2) % 3], c[child])};
}

} // namespace

LimitSurface::LimitSurface(Topology const& topology, int level, std::span<Vec const> positions,
                           RefinementStep const& step)
    : level_(level),
      sides_(step.keeps_triangles ? 3 : 4)
{
    if (level < 1 || level > 7)
        throw LimitError("refinement level", std::uint64_t(std::max(level, 0)), 7);
    ControlMesh const& base = topology.mesh();
    std::size_t const descendants = std::size_t(1) << (2 * (level - 1)); // of a child
    first_face_.push_back(0);
    for (std::uint32_t f = 0; f < base.faces(); ++f) {
        std::size_t const n = base.face(f).size();
        if (sides_ == 3 && n != 3)
            throw MeshError(f, std::string(step.name) + "'s limit surface is of triangles, face " +
                                   std::to_string(base.file_face(f) + 1) + " has " +
                                   std::to_string(n) + " sides");
        first_face_.push_back(first_face_.back() + std::size_t(step.children(n)) * descendants);
    }
    if (!step.limit) throw Error(std::string(step.name) + " subdivision has no limits here");
    LimitRules const& rules = *step.limit;
    std::vector<Vec> x(base.positions.begin(), base.positions.end());
    if (!positions.empty()) x.assign(positions.begin(), positions.end());
    std::unique_ptr<ControlMesh const> mesh;
    std::unique_ptr<Topology const> fine;
    for (int l = 0; l < level; ++l) {
        Topology const& coarse = fine ? *fine : topology;
        Sharpness const sharpness(coarse);
        x = rules.refined(coarse, sharpness, x);
        auto next = std::make_unique<ControlMesh const>(
            split_mesh(coarse, sharpness, x, step.keeps_triangles));
        fine.reset(); // reads mesh
        mesh = std::move(next);
        fine = std::make_unique<Topology const>(*mesh);
    }
    LimitPoints points = rules.limits(*fine, x);
    position_ = std::move(points.position);
    normal_ = std::move(points.normal);
    corners_ = std::move(points.of_corner);
    set_grids(base);
}

void LimitSurface::set_grids(ControlMesh const& base)
{
    // Four children each: the digits of a descendant's number in base 4 say where it lies.
    grid_start_.assign(base.faces(), kNone);
    int const n = grid();
    auto const of_child = sides_ == 3 ? child_of_triangle : child_of_quad;
    std::array<GridPoint, 4> const face =
        sides_ == 3 ? std::array<GridPoint, 4>{{{n, 0}, {0, n}, {0, 0}}}
                    : std::array<GridPoint, 4>{{{0, 0}, {n, 0}, {n, n}, {0, n}}};
    std::size_t const points = 1 + (sides_ == 3 ? in_grid(0, n) : in_grid(n, n));
    for (std::uint32_t f = 0; f < base.faces(); ++f) {
        if (base.face(f).size() != std::size_t(sides_)) continue;
        grid_start_[f] = grid_.size();
        grid_.resize(grid_.size() + points);
        for (std::size_t d = 0; d < std::size_t(1) << (2 * level_); ++d) {
            std::array<GridPoint, 4> c = face;
            for (int l = level_ - 1; l >= 0; --l) c = of_child(c, d >> (2 * l) & 3);
            auto const corners = this->face(first_face_[f] + d);
            for (std::size_t k = 0; k < corners.size(); ++k)
                grid_[grid_start_[f] + in_grid(c[k][0], c[k][1])] = corners[k];
        }
    }
}

} // namespace tessemu
