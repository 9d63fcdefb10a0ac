// The Catmull-Clark limit surface on a dyadic grid: refinement in double, then limit masks.
//
// Limit position and tangent plane by the formulas of LOOP09 3.3 and 4.6, which are exact on a
// refined mesh (docs/math/loop09.md, 2). At boundary vertices with more than two faces the tangent
// plane is that of the modified edge rule (the same, 4) and the refinement is the plain one; both
// agree everywhere else.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/poles.h"

#include <glm/vec3.hpp>

namespace tessemu {

class LimitSurface {
public:
    /// \param level  refinements, 1 to 7: each face of n sides becomes n 4^(level-1) quads
    /// Creases and corners of the mesh are smooth. \cost memory and time linear in the quads
    LimitSurface(Topology const& topology, int level);

    int level() const { return level_; }
    int grid() const { return 1 << level_; } ///< segments along an edge of a base quad

    std::vector<glm::dvec3> const& positions() const { return position_; }
    /// Of unit length; at a pole (pipeline/mesh/poles.h) the mean of the refined faces around.
    std::vector<glm::dvec3> const& normals() const { return normal_; }
    ControlMesh const& quads() const { return mesh_; }
    /// The first quad of a base face; those of the next face follow its last.
    std::size_t first_quad(std::uint32_t face) const { return first_quad_[face]; }

    /// Vertex at (i, j) / grid() of a base face that is a quad: i from corner 0 to corner 1, j from
    /// corner 0 to corner 3.
    std::uint32_t vertex(std::uint32_t face, int i, int j) const
    {
        auto const n = std::size_t(grid() + 1);
        return grid_[grid_start_[face] + std::size_t(j) * n + std::size_t(i)];
    }
    bool has_grid(std::uint32_t face) const { return grid_start_[face] != kNone; }

private:
    static constexpr std::size_t kNone = std::size_t(-1);
    void set_pole_normals(Poles const& poles, std::vector<glm::dvec3> const& x);

    int level_;
    ControlMesh mesh_; ///< the last refinement; its own positions are rounded
    std::vector<glm::dvec3> position_, normal_;
    std::vector<std::size_t> first_quad_; ///< base faces + 1
    std::vector<std::size_t> grid_start_; ///< by base face
    std::vector<std::uint32_t> grid_;
};

} // namespace tessemu
