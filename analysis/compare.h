// Error of a scheme's surface against the limit surface of its own rules of subdivision, those of
// RefinedMesh::step(), as LOOP09's table 3 has it.
//
// Both surfaces are sampled at tess factor 2^level: the scheme's domain points by a draw, the limit
// surface on its dyadic grid, where both are exact. By equal parameter a sample is compared with
// the other surface's point of the same face and (u,v), in a triangle of the same weights, where it
// is on the grid: what the tessellator makes inside a triangle lies beside it. By closest point
// (Metro: Cignoni, Rocchini, Scopigno 1998) it is compared with the closest point of the other
// surface's triangles, found by Embree's point query, and the normal interpolated there. Triangles
// that face away from the sample are another sheet of a thin part and are passed over. A triangle
// of length h lies up to h^2/8 times the curvature inside the surface, which the distance includes.
// Samples weigh as the area around them. Faces that the mesh hides take no part.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/limit_surface.h"
#include "pipeline/frame.h"

#include <memory>

namespace tessemu {

/// Of a quantity over a surface.
struct ErrorStatistics {
    double max = 0, mean = 0, rms = 0;
    std::size_t samples = 0;
};

/// The scheme's surface with its error against the limit surface's point of equal parameter. Left
/// out: triangles with a corner beside the grid, and faces without one (LimitSurface::has_grid).
struct EqualParameterErrors {
    double diagonal = 0; ///< of the bounding box of RefinedMesh::base()
    std::vector<glm::dvec3> position, normal;
    std::vector<std::uint32_t> triangles; ///< three a triangle
    std::vector<double> distance;         ///< divided by the diagonal
    std::vector<double> angle;            ///< radians
    std::vector<double> weight;           ///< area of the limit surface around a point

    /// The same with points on a patch's sides and corners counted as if the patch went on: a mean
    /// over each patch's grid of samples, which leans to the sides. It depends on the level.
    std::vector<double> grid_weight;

    ErrorStatistics position_statistics() const { return statistics(distance, weight); }
    ErrorStatistics normal_statistics() const { return statistics(angle, weight); }
    ErrorStatistics normal_grid_statistics() const { return statistics(angle, grid_weight); }

private:
    static ErrorStatistics statistics(std::vector<double> const& values,
                                      std::vector<double> const& weights);
};

/// \param level  1 to 6: tess factor 2^level; the limit surface has up to 2^25 faces
EqualParameterErrors equal_parameter_errors(PatchMesh const& patches, FrameSettings settings,
                                            int level, ThreadPool const& threads);

/// What `share` of the weight, 0 to 1, stays at or below.
double quantile(std::vector<double> const& values, std::vector<double> const& weights,
                double share);

struct SurfaceComparison {
    double diagonal = 0; ///< of the bounding box of RefinedMesh::base(); divides distances
    ErrorStatistics to_limit, from_limit; ///< closest point: scheme's samples, limit's samples
    ErrorStatistics normal_to_limit, normal_from_limit; ///< angles there, radians
    ErrorStatistics equal_position, equal_normal;       ///< by equal parameter
    ErrorStatistics equal_normal_grid;                  ///< see EqualParameterErrors::grid_weight
};

/// \param settings  machine and normals; tess factor and partitioning are the comparison's
/// \param level     1 to 6. \cost 4^level points a face on both sides, and Embree's trees on them
SurfaceComparison compare_with_limit(PatchMesh const& patches, FrameSettings settings, int level,
                                     ThreadPool const& threads);

/// What a frame shows, against the limit surface: the facets that a tess factor leaves count as an
/// error too, so it falls as the factor grows until the scheme's own distance is left.
struct DrawnError {
    ErrorStatistics position, normal; ///< diagonals, radians
    std::size_t points = 0;           ///< of the surface, a patch at a time
    ListStatistics counts;            ///< of the frame's geometry, without rasterization
};

/// Samples of a limit surface, for any number of schemes and tess factors.
class DrawnErrors {
public:
    /// \param mesh   of which schemes draw the base or a refinement
    /// \param level  1 to 6; triangles of factor F are sampled well from log2(F) + 2 on
    DrawnErrors(RefinedMesh const& mesh, int level);
    ~DrawnErrors();

    /// From each sample, by the area around it, to the closest point of the triangles that the
    /// settings' factors and partitioning draw.
    DrawnError of(PatchMesh const& patches, FrameSettings const& settings,
                  ThreadPool const& threads) const;

private:
    struct Samples;
    std::unique_ptr<Samples const> samples_;
};

} // namespace tessemu
