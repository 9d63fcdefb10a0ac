// Rays against a closed triangle mesh: Embree as a witness, 113-bit arithmetic as the judge.
//
// A ray from outside must meet a front before any back. Embree's own answers are not exact: it
// loses rays that pass close to vertices, in robust mode too. So each ray that seems to slip
// through is traced again over all triangles near it in 113-bit arithmetic, whose decisions at an edge are
// the same for both of its triangles, and at a vertex for all of them. Through a closed surface as
// many fronts as backs are crossed on the whole way: where they do not balance the ray found a
// hole. Where they do, Embree lost a hit, or the surface is folded over itself and shows its
// inside.
//
// Rays run in the mesh's own frame, near the origin and of a size near 1, to which its floats are
// moved without rounding: so neither where it lies nor how large it is makes a difference.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/parallel.h"
#include "pipeline/camera.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tessemu {

/// Counter-clockwise from outside.
struct RayMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint32_t> targets; ///< pairs of vertices: segments to aim at
    /// Positions with those made equal that ought to be, for a run of the same rays beside; or
    /// none.
    std::vector<glm::vec3> control;
};

enum class RayAim {
    Segments, ///< the inside of a target segment
    Inside,   ///< the inside of a triangle
    Vertices, ///< a vertex of a triangle: where Embree itself fails
};

struct RayMiss {
    glm::vec3 target;       ///< where the mesh lies
    std::uint32_t triangle; ///< or target segment that was aimed at
};

struct RayCheck {
    std::uint64_t rays = 0;
    std::uint64_t misses = 0;  ///< of Embree
    std::uint64_t refuted = 0; ///< misses that 113-bit arithmetic finds to meet a front
    std::uint64_t folds = 0;   ///< misses of a surface that is closed there, but inside out
    std::uint64_t past = 0;    ///< rays that pass the outline of the surface by a rounding
    /// Of the same rays on the control, run where there are misses.
    std::uint64_t control_misses = 0;
    std::vector<RayMiss> confirmed;
};

/// \param rays  at random, entering at 17 degrees from grazing at least. Throws Error for a mesh
///              without triangles, or with a point that is not finite.
/// \cost  about a second a million, and where rays miss a tree of the triangles and their way
///        through it
RayCheck check_rays(RayMesh const& mesh, RayAim aim, std::uint64_t rays, std::uint32_t seed,
                    ThreadPool const& threads);

/// By how much the view's transform, in floats, may be off at most in dot(axis, p - eye) for points
/// whose coordinates are up to `size`. A clip coordinate is that times a scale.
double clip_rounding(glm::vec3 axis, glm::vec3 eye, glm::dvec3 size);

/// A picture's visible triangles against Embree's first hits, pixel by pixel.
struct VisibilityCheck {
    /// Why nothing is compared: the near or far plane cuts the surface, or single precision places
    /// its points too coarsely in the picture. Empty: all is.
    std::string skipped;
    std::uint64_t pixels = 0;      ///< that either of them sees the surface in
    std::uint64_t edges = 0;       ///< differ where another face lies within 1/64 pixel and the
                                   ///< rounding of the transform
    std::uint64_t silhouettes = 0; ///< differ where the background does
    std::uint64_t depths = 0;      ///< differ where both faces are as far away, to 1e-4
    std::vector<std::array<int, 2>> unexplained;
};

/// \param face_of_triangle  of the mesh
/// \param seen              the face that the raster shows in each pixel, row after row; -1: none
/// The raster rounds vertices to 1/256 pixel, so edges may lie a little beside Embree's.
VisibilityCheck check_visibility(RayMesh const& mesh,
                                 std::vector<std::uint32_t> const& face_of_triangle,
                                 std::vector<std::int64_t> const& seen, Camera const& camera,
                                 int width, int height, ThreadPool const& threads);

} // namespace tessemu
