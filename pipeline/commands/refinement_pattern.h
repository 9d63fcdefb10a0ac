// Uniform refinement patterns (Boubekeur and Schlick 2008, HOLL10's reference [9]): the vertices of
// an instanced draw that refines each face alike, without a tessellator.
//
//     (0,1)
//       | \           n x n triangles or quads of two triangles; all points at i/n, j/n, row after
//       *--*          row of v
//       | \| \                                                                                  .
//     (0,0)*-(1,0)    n = 2
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/domain_points.h"

namespace tessemu {

/// The pattern's segments along an edge for a tess factor: rounded up to a power of two.
/// \param tess_factor  above 0, at most kMaxTessFactor
int uniform_segments(float tess_factor);

/// n^2 triangles of a triangle, 2 n^2 of a quad, counter-clockwise in (u, v).
/// \param domain  Tri or Quad
/// \param n       a power of two, 1 to 64
std::shared_ptr<DomainPoints const> uniform_pattern(TessellatorDomain domain, int n);

} // namespace tessemu
