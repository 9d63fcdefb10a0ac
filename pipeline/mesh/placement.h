// Where a mesh stands in its file: far or tiny ones are moved and scaled to where single precision
// serves.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <glm/vec3.hpp>

#include <span>

namespace tessemu {

struct ControlMesh;

/// Of a mesh at rest.
double bounding_box_diagonal(ControlMesh const& mesh);

/// A shift and a power of two between the file's frame and the mesh's own, both exact: points of
/// the mesh keep all of their bits. What reads a file makes it; what writes positions and lengths,
/// or reads them from a user, asks it.
class Placement {
public:
    /// The file's own frame.
    Placement() = default;
    /// Of a mesh in its file. One whose centre is further off than kFar diagonals of its bounding
    /// box is moved by a multiple of a power of two of at least the diagonal, along each axis on
    /// which all of it is at least so far from 0; one whose diagonal is not 2^-kScale to 2^kScale
    /// is scaled into this range by a power of 2^(2 kScale), so that files which differ by such a
    /// power give the same mesh, bit for bit; any other stays as it is. Throws Error for no points,
    /// and for a diagonal that is 0 or not kSmallest to kLargest.
    explicit Placement(std::span<glm::dvec3 const> points);

    static constexpr int kFar = 8, kScale = 20;
    static constexpr double kSmallest = 1e-100, kLargest = 1e100;

    bool is_moved() const { return shift_ != glm::dvec3(0); }
    /// Whether the mesh stands as in its file.
    bool is_identity() const { return !is_moved() && scale_ == 1; }

    /// Rounded once; a point too far off for single precision comes out infinite.
    glm::vec3 from_file(glm::dvec3 p) const { return glm::vec3((p - shift_) * scale_); }
    glm::dvec3 to_file(glm::dvec3 p) const { return is_identity() ? p : p / scale_ + shift_; }
    double length_from_file(double length) const { return length * scale_; }
    double length_to_file(double length) const { return length / scale_; }

private:
    glm::dvec3 shift_{0}; ///< taken off the file's coordinates, then
    double scale_ = 1;    ///< multiplied with them
};

} // namespace tessemu
