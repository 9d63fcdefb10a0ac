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
    /// A little more than that of the sphere around the box.
    float radius() const { return std::max(glm::length(high - low) * 0.5f * 1.02f, 1e-6f); }
};
// Of the far plane's distance: the least of the near plane's.
constexpr float kNearest = 1e-3f;

Bounds bounds_of(std::span<glm::vec3 const> points, float reach)
{
    if (points.empty()) throw Error("a mesh without vertices cannot be framed");
    Bounds b{points[0], points[0]};
    for (glm::vec3 const& p : points) b.low = glm::min(b.low, p), b.high = glm::max(b.high, p);
    return {b.low - reach, b.high + reach};
}

// Times a power of two, which changes no direction, so that squares neither vanish nor overflow.
glm::vec3 of_usual_length(glm::vec3 v)
{
    constexpr int kUsual = 20;
    int exponent = 0;
    std::frexp(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}), &exponent);
    if (std::abs(exponent) <= kUsual) return v;
    return {std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent), std::ldexp(v.z, -exponent)};
}

bool is_finite(glm::vec3 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
} // namespace

glm::vec3 Camera::backward() const
{
    return glm::normalize(of_usual_length(eye - target));
}

glm::vec3 Camera::right() const
{
    glm::vec3 const b = backward(), u = of_usual_length(up), side = glm::cross(u, b);
    if (glm::dot(side, side) > 1e-12f * glm::dot(u, u)) return glm::normalize(side);
    glm::vec3 const axis = std::abs(b.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, -1);
    return glm::normalize(axis - glm::dot(axis, b) * b);
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

void check_camera(Camera const& c)
{
    if (!is_finite(c.eye)) throw Error("the camera's eye is too far off for single precision");
    if (!is_finite(c.target))
        throw Error("the camera's target is too far off for single precision");
    if (!is_finite(c.eye - c.target)) throw Error("the camera's eye and target are too far apart");
    if (c.eye == c.target)
        throw Error("the camera's eye and target are the same point, in single precision");
    if (!is_finite(c.up)) throw Error("the camera's up is too long for single precision");
    if (!(c.focal > 0 && std::isfinite(c.focal)))
        throw Error("the camera's focal length is " + std::to_string(c.focal) +
                    ", it must be above 0");
}

Camera frame_points(std::span<glm::vec3 const> points, glm::vec3 direction, float width_over_height,
                    float reach)
{
    Bounds const box = bounds_of(points, reach);
    Camera c;
    c.target = box.center();
    c.eye = c.target + glm::normalize(of_usual_length(direction));
    glm::vec3 const r = c.right(), u = c.true_up(), b = c.backward();
    constexpr float kMargin = 1.06f;
    float distance = 0;
    // What is seen of a point, in half pictures, at distance 1; what has to fit.
    auto const half_pictures = [&](glm::vec3 q) {
        return std::max(std::abs(glm::dot(q, r)) / width_over_height, std::abs(glm::dot(q, u)));
    };
    auto const hold = [&](glm::vec3 p) {
        glm::vec3 const q = p - c.target;
        distance = std::max(distance, glm::dot(q, b) + kMargin * c.focal * half_pictures(q));
    };
    for (glm::vec3 const& p : points) hold(p);
    if (reach > 0) {
        // Off a point in the worst direction, with half the margin; and the corners of its box.
        float const focal = (1 + (kMargin - 1) / 2) * c.focal,
                    across = focal / std::min(width_over_height, 1.0f),
                    worst = reach * std::sqrt(1 + across * across);
        for (glm::vec3 const& p : points) {
            glm::vec3 const q = p - c.target;
            distance = std::max(distance, glm::dot(q, b) + focal * half_pictures(q) + worst);
            hold(p - reach);
            hold(p + reach);
        }
    }
    if (!(distance > 0)) {
        distance = 1;
    } else { // nothing may come nearer than the near plane
        float front = 0;
        for (glm::vec3 const& p : points) front = std::max(front, glm::dot(p - c.target, b));
        constexpr float kNear = 1.01f * kNearest;
        distance = std::max(distance, (front + reach + kNear * box.radius()) / (1 - kNear));
    }
    c.eye = c.target + distance * b;
    fit_depth_range(c, points, reach);
    return c;
}

void fit_depth_range(Camera& c, std::span<glm::vec3 const> points, float reach)
{
    Bounds const box = bounds_of(points, reach);
    float const radius = box.radius();
    float const distance = glm::dot(c.eye - box.center(), c.backward());
    c.far_plane = std::max(distance + radius, 1e-5f);
    c.near_plane = std::max(distance - radius, c.far_plane * kNearest);
}

} // namespace tessemu
