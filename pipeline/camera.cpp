// SPDX-License-Identifier: Apache-2.0
#include "pipeline/camera.h"

#include "emu/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tessemu {

namespace {
struct Bounds {
    glm::vec3 low, high;
    glm::vec3 center() const { return (low + high) * 0.5f; }
    float radius() const { return glm::length(high - low) * 0.5f; }
};

Bounds bounds_of(std::span<glm::vec3 const> points)
{
    if (points.empty()) throw Error("a mesh without vertices cannot be framed");
    Bounds b{points[0], points[0]};
    for (glm::vec3 const& p : points) b.low = glm::min(b.low, p), b.high = glm::max(b.high, p);
    return b;
}
} // namespace

glm::vec3 Camera::backward() const
{
    return glm::normalize(eye - target);
}

glm::vec3 Camera::right() const
{
    glm::vec3 const side = glm::cross(up, backward());
    if (glm::dot(side, side) < 1e-12f) return {1, 0, 0}; // looking along `up`
    return glm::normalize(side);
}

glm::vec3 Camera::true_up() const
{
    return glm::cross(backward(), right());
}

Matrix4 view_projection(Camera const& c, float width_over_height)
{
    glm::vec3 const r = c.right(), u = c.true_up(), b = c.backward();
    float const sx = c.focal / width_over_height, sy = c.focal;
    float const range = c.far_plane / (c.far_plane - c.near_plane);
    // Distance along the view is w = -b.p + b.eye.
    float const w0 = glm::dot(b, c.eye);
    auto const row = [&](glm::vec3 axis, float scale) {
        return std::array<float, 4>{scale * axis.x, scale * axis.y, scale * axis.z,
                                    -scale * glm::dot(axis, c.eye)};
    };
    Matrix4 m;
    m[0] = row(r, sx);
    m[1] = row(u, sy);
    m[2] = {-range * b.x, -range * b.y, -range * b.z, range * (w0 - c.near_plane)};
    m[3] = {-b.x, -b.y, -b.z, w0};
    return m;
}

Camera frame_points(std::span<glm::vec3 const> points, glm::vec3 direction, float width_over_height)
{
    Bounds const box = bounds_of(points);
    Camera c;
    c.target = box.center();
    c.eye = c.target + glm::normalize(direction);
    glm::vec3 const r = c.right(), u = c.true_up(), b = c.backward();
    constexpr float kMargin = 1.06f;
    float distance = 0;
    for (glm::vec3 const& p : points) {
        glm::vec3 const q = p - c.target;
        float const x = std::abs(glm::dot(q, r)) / width_over_height, y = std::abs(glm::dot(q, u));
        distance = std::max(distance, glm::dot(q, b) + kMargin * c.focal * std::max(x, y));
    }
    if (!(distance > 0)) distance = 1;
    c.eye = c.target + distance * b;
    fit_depth_range(c, points);
    return c;
}

void fit_depth_range(Camera& c, std::span<glm::vec3 const> points)
{
    Bounds const box = bounds_of(points);
    float const radius = std::max(box.radius() * 1.02f, 1e-6f);
    float const distance = glm::dot(c.eye - box.center(), c.backward());
    c.far_plane = std::max(distance + radius, 1e-5f);
    c.near_plane = std::max(distance - radius, c.far_plane * 1e-3f);
}

} // namespace tessemu
