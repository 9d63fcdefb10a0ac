// HOLL10's figures 4 to 7: where subdivision shading begins, a triangle with different factors along
// its edges, reflection lines around extraordinary vertices, and substitutes beside subdivision.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/papers/paper.h"

namespace tessemu {

/// Subdivision shading from M0, M1 and M2, and the surface's own normals; a row for each mesh.
/// \param meshes  at least one
PaperFigure reproduce_holl10_figure4(std::vector<ControlMesh> const& meshes,
                                     FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress);

/// One triangle of M1 on Direct3D 11's tessellator, whose domain shader reads one table whatever
/// the factors.
PaperFigure reproduce_holl10_figure5(FrameSettings const& settings, ThreadPool const& threads);

/// QAS, PT, PN and SM at vertices of valence 4, 8 and 12: a row each.
PaperFigure reproduce_holl10_figure6(FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress);

/// M0, PT, PN, QAS and SM at level 5, a row for each mesh.
/// \param meshes  at least one
PaperFigure reproduce_holl10_figure7(std::vector<ControlMesh> const& meshes,
                                     FrameSettings const& settings, ThreadPool const& threads,
                                     PaperProgress const& progress);

/// Triangles around a vertex, rings of them, on a saddle.
/// \param valence  3 or more
ControlMesh triangle_star(int valence);

} // namespace tessemu
