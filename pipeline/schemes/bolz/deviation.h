// How far a patch's surface lies from its triangles: an upper bound from its control points.
//
// A sample S(q) = sum_i b_i(q) P_i is compared with the point T = sum_j w_j S(q_j) of a triangle
// whose corners are the vertices q_j: their difference is sum_i delta_i(q) P_i with
//
//     delta_i(q) = b_i(q) - sum_j w_j b_i(q_j),      sum_i delta_i(q) = 0.
//
// Control points are a flat net, an affine image of the type's chart (x_i, y_i) in the plane, and
// what is left of them, their discrete curvature: P_i = C + x_i A + y_i B + R_i. So, the maxima
// running over some samples q,
//
//     |S(q) - T| <= |A| max |sum_i delta_i(q) x_i| + |B| max |sum_i delta_i(q) y_i|
//                   + sum_i |R_i| max |delta_i(q)|
//
// That holds for any chart, any fit and any triangle and weights; the choices make it small. The
// chart is the net that a smooth mesh comes near to as it is refined, and T has q's place in the
// chart, so that the maxima of x and y are 0 but where the chart bulges over its triangles. What is
// left are second differences of the control points (docs/adaptive.md).
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/basis_tables/symmetry.h"
#include "pipeline/schemes/bolz/grid.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <map>
#include <span>

namespace tessemu {

/// Control points' places in the plane: a ring at equal angles around (0,0), those of a sector from
/// one sharp edge to the other, whose points are the eigenvectors of the step of subdivision that
/// four regular faces around the other corners make. Of a regular patch it is the grid.
/// \param beyond  control points behind those of PatchType::points(), by number in beyond_points():
///                in the ring of their vertex, at equal angles and bent to what is known of it
std::vector<glm::dvec2> chart_of(PatchType const& type, std::span<std::uint16_t const> beyond = {});

/// The bounds of a patch type.
class PatchDeviation {
public:
    static constexpr int kMostLevel = kTableSteps;
    /// Samples that bounds are for: twice as fine as the finest grid, so that it has a bound too.
    static constexpr int kSampleLevel = kMostLevel + 1;

    /// \param tables  say which control points there are; their weights are made anew
    explicit PatchDeviation(PatchTypeTables const& tables);

    /// What the bounds know of a patch.
    struct Net {
        double a = 0, b = 0;          ///< lengths of A and B
        std::vector<double> residual; ///< lengths of the R_i
        double rounding = 0;          ///< what single precision may add, see docs/adaptive.md
    };
    /// \param points  in the order of the tables
    /// \param origin  what is taken off the control points before they are summed
    Net net_of(std::span<glm::dvec3 const> points, glm::dvec3 origin = glm::dvec3(0)) const;

    /// No sample lies further from the triangles of a regular grid of 2^level segments.
    double bound(Net const& net, int level) const;
    /// No sample of the strip at an edge, where the grid is not regular, lies further from the
    /// strip's triangles. \param edge_level  at most `level`, which is at least 1
    double strip_bound(Net const& net, int level, int edge, int edge_level) const;
    /// Of all samples of a grid.
    double bound(Net const& net, GridLevels const& levels) const;

private:
    /// Maxima over samples of a region: of x, of y, of each control point.
    using Row = std::vector<double>;
    using Rows = std::vector<Row>; // by region
    struct Triangle {
        std::array<std::uint32_t, 3> sample; // of its corners
    };

    Rows const& rows(int level) const;
    Rows const& strip_rows(int level, int edge, int edge_level) const;
    double largest(Net const& net, Rows const& rows) const;
    void add_sample(std::uint32_t sample, std::span<Triangle const> triangles, Row& row) const;

    int points_;
    std::vector<glm::dvec2> chart_;
    std::vector<double> weights_;     // [sample][control point]
    std::vector<glm::dvec2> samples_; // in the chart
    double reach_ = 0;                // largest sum of a sample's weights, without signs
    std::vector<double> fit_;         // [C, A, B][control point]
    mutable std::map<std::array<int, 3>, Rows> made_; // on demand: many are never asked for
};

} // namespace tessemu
