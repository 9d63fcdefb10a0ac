// The limit surface of subdivision on a dyadic grid: refinement in double, then limit masks, with
// creases, corners, darts and boundaries as the mesh's tags have them.
//
// Masks are those of a step, Catmull-Clark's or Loop's; rules the mesh's, OpenSubdiv's or
// Biermann's (docs/compare.md says what the reference is for each tag; formulas:
// docs/math/subdivision.md, 1.6, 1.7, 5.2, 5.3 and 6.2).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/catmull_clark.h"

#include <glm/vec3.hpp>

namespace tessemu {

class LimitSurface {
public:
    /// \param level      refinements, 1 to 7: each face of n sides becomes n 4^(level-1) quads, or
    ///                   of triangles, where the step keeps them, 4^level triangles
    /// \param positions  in place of the mesh's, which are single precision; empty: those
    /// \param step       whose masks; one that keeps triangles takes no other faces: throws
    ///                   MeshError; one without RefinementStep::limit: Error
    /// \cost  memory and time linear in the faces
    LimitSurface(Topology const& topology, int level, std::span<glm::dvec3 const> positions = {},
                 RefinementStep const& step = catmull_clark_step);

    int level() const { return level_; }
    int grid() const { return 1 << level_; } ///< segments along an edge of a base face with a grid

    /// Points of the surface. A vertex on infinitely sharp edges is a point for each side, one
    /// after the other: the same position, its own normal.
    std::vector<glm::dvec3> const& positions() const { return position_; }
    /// Of unit length. Where a side of a vertex has no tangent plane (a pole, a sharp corner whose
    /// edges lie in one line) the mean of the refined faces around.
    std::vector<glm::dvec3> const& normals() const { return normal_; }
    /// Sides of every refined face: 4, or 3 by a step that keeps triangles.
    int sides() const { return sides_; }
    std::size_t faces() const { return corners_.size() / std::size_t(sides_); }
    /// A refined face by points, counter-clockwise.
    std::span<std::uint32_t const> face(std::size_t f) const
    {
        return std::span(corners_).subspan(f * std::size_t(sides_), std::size_t(sides_));
    }
    /// The first refined face of a base face; those of the next face follow its last.
    std::size_t first_face(std::uint32_t face) const { return first_face_[face]; }

    /// Point at (i, j) / grid() of a base face with a grid, on the face's side. Quad: i from corner
    /// 0 to corner 1, j from corner 0 to corner 3. Triangle: weights of corners 0 and 1,
    /// i + j <= grid().
    std::uint32_t vertex(std::uint32_t face, int i, int j) const
    {
        return grid_[grid_start_[face] + in_grid(i, j)];
    }
    /// Whether a base face has as many sides as refined ones.
    bool has_grid(std::uint32_t face) const { return grid_start_[face] != kNone; }

private:
    static constexpr std::size_t kNone = std::size_t(-1);
    std::size_t in_grid(int i, int j) const
    {
        return std::size_t(j * (grid() + 1) + i - (sides_ == 3 ? j * (j - 1) / 2 : 0));
    }
    void set_grids(ControlMesh const& base);

    int level_, sides_;
    std::vector<glm::dvec3> position_, normal_;
    std::vector<std::uint32_t> corners_;  ///< of refined faces, points
    std::vector<std::size_t> first_face_; ///< base faces + 1
    std::vector<std::size_t> grid_start_; ///< by base face
    std::vector<std::uint32_t> grid_;
};

} // namespace tessemu
