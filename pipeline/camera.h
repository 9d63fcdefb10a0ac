// Camera: a perspective view without sines and tangents.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "shaders_cpp/projection.h"

#include <glm/vec3.hpp>

#include <span>

namespace tessemu {

/// Right-handed, looking from eye to target. `focal` is the focal length in half image heights: 2.4
/// is a field of view of 45 degrees.
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

/// Looks at a point set so that its bounding box fits the picture. `direction` points from the set
/// to the eye. Throws Error for an empty set.
Camera frame_points(std::span<glm::vec3 const> points, glm::vec3 direction,
                    float width_over_height);

/// Puts the near and far plane around the points' bounding sphere.
void fit_depth_range(Camera& camera, std::span<glm::vec3 const> points);

} // namespace tessemu
