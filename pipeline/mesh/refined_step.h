// A step of any scheme's masks: faces and tags of the mesh that it makes.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pipeline/mesh/refinement.h"
#include "pipeline/mesh/subdivision.h"

#include <glm/vec3.hpp>

namespace tessemu {

/// The step's faces, tags and texture coordinates; sums have run in double and are rounded once.
///
/// \param points           of the step's vertices, as refined_points() gives them
/// \param keeps_triangles  RefinementStep::keeps_triangles
ControlMesh split_mesh(Topology const& topology, Sharpness const& sharpness,
                       std::span<glm::dvec3 const> points, bool keeps_triangles);

/// Gives the mesh that a step has made texture coordinates by the step's masks, as though seams were
/// boundaries: where coordinates differ on both sides of an edge, at either end, that edge is one.
///
/// \param coarse  that the step was taken of, with coordinates. Throws Error with rules that have no
///                masks for a part of the mesh (SectorRules::Biermann).
/// \cost  a step's
void smooth_coordinates(Topology const& coarse, RefinementStep const& step, ControlMesh& fine);

template <class Masks>
ControlMesh refined_mesh(Topology const& topology, Sharpness const& sharpness)
{
    std::vector<glm::dvec3> const x(topology.mesh().positions.begin(),
                                    topology.mesh().positions.end());
    return split_mesh(topology, sharpness,
                      refined_points<Masks, glm::dvec3>(topology, sharpness, x),
                      Masks::kKeepsTriangles);
}

/// A step whose points are all sums of weighted old ones: HOLL10's computational entries, a list of
/// weights and parents for each (2B). \cost  linear in the corners of faces
/// Throws LimitError as catmull_clark_tables().
template <class Masks> RefinedStep take_weighted_step(Topology const& topology, std::uint32_t first)
{
    Sharpness const sharpness(topology);
    std::vector<WeightedSum> x;
    for (std::uint32_t v = 0; v < topology.mesh().positions.size(); ++v) x.emplace_back(first + v);
    RefinedStep out;
    out.tables = weighted_tables(refined_points<Masks, WeightedSum>(topology, sharpness, x),
                                 std::uint32_t(x.size()), first);
    out.mesh = refined_mesh<Masks>(topology, sharpness);
    return out;
}

} // namespace tessemu
