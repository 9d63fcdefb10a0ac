// Camera: a perspective view without sines and tangents.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/projection.h"

#include <glm/vec3.hpp>

#include <span>

namespace tessemu {

/// Right-handed, looking from eye to target. `focal` is the focal length in half image heights: 2.4
/// is a field of view of 45 degrees. Lengths of `up` and of the view do not matter, however small
/// or large; where `up` runs along the view, or is 0, x is to the right, and -z where the view runs
/// along x.
struct Camera {
    glm::vec3 eye{0, 0, 3}, target{0, 0, 0}, up{0, 1, 0};
    float focal = 2.4f;
    float near_plane = 0.1f, far_plane = 100;

    glm::vec3 backward() const; ///< unit, from target to eye
    glm::vec3 right() const;
    glm::vec3 true_up() const;
};

/// Clip space of Direct3D: x right, y up, z from 0 (near plane) to w (far plane).
Matrix4 view_projection(Camera const& camera, float width_over_height);

/// Throws Error that names what is wrong with a camera that can show nothing: a number that is not
/// finite, an eye at the target, a focal length that is not above 0.
void check_camera(Camera const& camera);

/// Looks at a point set so that its bounding box fits the picture. `direction` points from the set
/// to the eye.
/// \param reach  how far a surface may stand off the points, as by displacement: it fits too
/// Throws Error for an empty set.
Camera frame_points(std::span<glm::vec3 const> points, glm::vec3 direction, float width_over_height,
                    float reach = 0);

/// Puts the near and far plane around the bounding sphere of the points and of what reaches off
/// them.
void fit_depth_range(Camera& camera, std::span<glm::vec3 const> points, float reach = 0);

} // namespace tessemu
