// The limit surface of Catmull-Clark subdivision on a dyadic grid: refinement in double, then limit
// masks, with creases, corners, darts and boundaries as the mesh's tags have them.
//
// Rules are the mesh's, OpenSubdiv's or Biermann's (docs/compare.md says what the reference is for
// each tag; formulas: docs/math/subdivision.md, 1.6, 1.7, 5.2 and 5.3).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"

#include <glm/vec3.hpp>

#include <array>

namespace tessemu {

class LimitSurface {
public:
    using Quad = std::array<std::uint32_t, 4>;

    /// \param level      refinements, 1 to 7: each face of n sides becomes n 4^(level-1) quads
    /// \param positions  in place of the mesh's, which are single precision; empty: those
    /// \cost  memory and time linear in the quads
    LimitSurface(Topology const& topology, int level, std::span<glm::dvec3 const> positions = {});

    int level() const { return level_; }
    int grid() const { return 1 << level_; } ///< segments along an edge of a base quad

    /// Points of the surface. A vertex on infinitely sharp edges is a point for each side, one
    /// after the other: the same position, its own normal.
    std::vector<glm::dvec3> const& positions() const { return position_; }
    /// Of unit length. Where a side of a vertex has no tangent plane (a pole, a sharp corner whose
    /// edges lie in one line) the mean of the refined faces around.
    std::vector<glm::dvec3> const& normals() const { return normal_; }
    /// By points, counter-clockwise.
    std::vector<Quad> const& quads() const { return quads_; }
    /// The first quad of a base face; those of the next face follow its last.
    std::size_t first_quad(std::uint32_t face) const { return first_quad_[face]; }

    /// Point at (i, j) / grid() of a base face that is a quad, on the face's side: i from corner 0
    /// to corner 1, j from corner 0 to corner 3.
    std::uint32_t vertex(std::uint32_t face, int i, int j) const
    {
        auto const n = std::size_t(grid() + 1);
        return grid_[grid_start_[face] + std::size_t(j) * n + std::size_t(i)];
    }
    bool has_grid(std::uint32_t face) const { return grid_start_[face] != kNone; }

private:
    static constexpr std::size_t kNone = std::size_t(-1);
    /// Points of the last refinement's vertices, and its quads by points.
    void add_points(Topology const& fine, std::vector<glm::dvec3> const& x);
    void set_grids(ControlMesh const& base);

    int level_;
    std::vector<glm::dvec3> position_, normal_;
    std::vector<Quad> quads_;
    std::vector<std::size_t> first_quad_; ///< base faces + 1
    std::vector<std::size_t> grid_start_; ///< by base face
    std::vector<std::uint32_t> grid_;
};

} // namespace tessemu
