// A tessellated surface by the names of its points: what patches have at the edges that they share.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "analysis/ray_check.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/sharpness.h"

#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

namespace tessemu {

/// A point of the surface as one patch has it, or several with the same values.
struct SeenPoint {
    static constexpr std::size_t kPosition = 0, kNormal = 3, kDisplaced = 6;
    std::uint32_t face = 0, patch = 0;      ///< of the first patch
    std::array<std::uint32_t, 9> bits = {}; ///< smooth position, normal, displaced position
    int patches = 1;                        ///< that have the point on their outline
    std::uint8_t edge = 0;                  ///< see SharedEdges::edge_in_words
    /// Of the infinitely sharp edges that the point lies on, where each side has a normal.
    std::uint16_t side = 0;

    glm::vec3 displaced() const;
};

/// Collects the surface in one tessellation.
/// \cost  memory for all points on patches' edges; for all triangles where they are kept
class SharedEdges {
public:
    /// \param keep_triangles  for rays()
    SharedEdges(PatchMesh const& patches, FrameSettings const& frame, bool keep_triangles,
                ThreadPool const& threads);

    struct Hash {
        std::size_t operator()(MeshPoint const& p) const;
    };
    /// Different values of a point, in the order of the patches.
    using Points = std::unordered_map<MeshPoint, std::vector<SeenPoint>, Hash>;
    Points const& points() const { return points_; }

    /// A patch's edge on a line; a point of a patch on a line.
    struct Interval {
        std::uint32_t low, high, patch;
    };
    struct OnLine {
        std::uint32_t t, patch;
        MeshPoint point;
    };
    struct Line {
        std::vector<Interval> intervals;
        std::vector<OnLine> points;
    };
    std::map<MeshLine, Line> const& lines() const { return lines_; }
    /// What the patches call the edge that has the point inside (PatchKind::edges); empty where
    /// none has a word for it, and at corners.
    std::string const& edge_in_words(std::vector<SeenPoint> const& seen) const;
    std::uint32_t face_of_patch(std::uint32_t patch) const { return face_of_patch_[patch]; }
    /// Pieces of lines that one patch alone has, and that several have.
    std::size_t open_edges() const { return count_pieces(1, 1); }
    std::size_t shared_edges() const { return count_pieces(2, std::size_t(-1)); }

    /// What all points have, as far as they are numbers: the box that they fill, and their distance
    /// from the eye along the view.
    struct Extent {
        glm::vec3 low{INFINITY}, high{-INFINITY};
        double nearest = INFINITY, farthest = -INFINITY;
        bool finite = true; ///< none is infinite or no number
    };
    Extent const& extent() const { return extent_; }

    RayMesh const& rays() const { return rays_; }
    std::vector<std::uint32_t> const& face_of_triangle() const { return face_of_triangle_; }
    std::vector<std::uint32_t> const& face_of_target() const { return face_of_target_; }

private:
    /// Points on the outline of a patch's triangles. With fractional_odd spacing and an inside
    /// factor of 1, points of inner rings lie on the patch's edges too (V18); those are inside the
    /// triangulation.
    struct Outline {
        std::vector<char> on;
        std::vector<std::uint32_t> segments; ///< pairs of points
    };
    static Outline outline_of(TessellatedPatch const& patch);

    std::size_t count_pieces(std::size_t least, std::size_t most) const;
    void add(SurfacePatch const& patch, bool keep_triangles);
    void extend(glm::vec3 position);
    std::uint8_t number_of_word(std::string const& word);
    std::uint16_t side_of(MeshPoint const& point, std::uint32_t face) const;
    /// Gives the point as the first patch has it.
    glm::vec3 record(MeshPoint const& point, SeenPoint const& seen);

    ControlMesh const& mesh_;
    Topology const& topology_;
    std::optional<Sharpness> sharpness_; ///< of a surface that has creases
    glm::dvec3 eye_, backward_;
    Points points_;
    std::map<MeshLine, Line> lines_;
    Extent extent_;
    std::vector<std::uint32_t> face_of_patch_;
    std::vector<std::string> words_{""};
    std::map<std::vector<std::uint32_t>, Outline> outlines_; // by a pattern's indices
    RayMesh rays_;
    std::vector<std::uint32_t> face_of_triangle_, face_of_target_;
};

} // namespace tessemu
