// Poles: vertices at which a smooth surface has no normal of its own, for its tangents there are
// parallel or zero. Rows of vertices on one point make them, and corners whose edges lie in a line.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/topology.h"

#include <array>

namespace tessemu {

/// Of each vertex the smallest of those that edges of no length join it to, or itself.
/// \cost  linear in the faces
std::vector<std::uint32_t> points_of(ControlMesh const& mesh);

struct Poles {
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::vector<std::uint32_t> of_vertex; ///< a vertex's pole, or kNone; empty: there is no pole
    std::vector<std::uint32_t> first;     ///< [pole + 1]: where its faces begin
    /// Of each face around a pole, once, in the order of the faces: x_0 to x_3, where
    /// (x_2 - x_0) x (x_3 - x_1) is twice its area times its normal; x_3 = x_0 in a triangle.
    std::vector<std::array<std::uint32_t, 4>> faces;

    bool empty() const { return of_vertex.empty(); }
    std::size_t size() const { return first.empty() ? 0 : first.size() - 1; }
    std::uint32_t at(std::uint32_t vertex) const
    {
        return of_vertex.empty() ? kNone : of_vertex[vertex];
    }
    /// Whether both ends of an edge are the same pole.
    bool collapsed(std::uint32_t a, std::uint32_t b) const
    {
        return at(a) != kNone && at(a) == at(b);
    }
};

/// Every vertex a pole of its own: of the mean normals of the faces around the vertex's point.
/// \cost  linear in the faces around points
Poles vertices_as_poles(ControlMesh const& mesh);

/// The poles of a mesh of triangles and quads, at rest. Poles that an edge of no length joins are
/// one.
///
/// A vertex is one where the limit tangents of its ring (LOOP09 3.3, 4.6) span less than 2^-16 of
/// the square of its distance to the farthest point of the ring: there rounding to float may turn
/// their cross product anywhere.
/// \cost  linear in the faces
Poles find_poles(Topology const& topology);

} // namespace tessemu
