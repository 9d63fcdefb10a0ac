// SPDX-License-Identifier: Apache-2.0
#include "pipeline/camera.h"

#include "emu/error.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace tessemu {
namespace {

// x, y, z by w of a point in the picture.
glm::vec3 seen(Camera const& camera, float aspect, glm::vec3 p)
{
    Matrix4 const m = view_projection(camera, aspect);
    auto const row = [&](std::size_t r) {
        return m[r][0] * p.x + m[r][1] * p.y + m[r][2] * p.z + m[r][3];
    };
    return glm::vec3(row(0), row(1), row(2)) / row(3);
}

// In units of 2^-24: a cross product stands off a right angle by 3, its unit vector by 1 more, and
// the dot product here by 3. A unit vector's length is off by 4.5 (half of the square's 3, a root,
// a quotient, a product), its square by 9 and 3 of the dot product. Both are below 16.
void expect_right_angles(Camera const& c)
{
    for (auto const& [a, b] : {std::pair(c.right(), c.true_up()),
                               {c.right(), c.backward()},
                               {c.true_up(), c.backward()}})
        EXPECT_NEAR(glm::dot(a, b), 0, 0x1p-20f);
    for (glm::vec3 const& a : {c.right(), c.true_up(), c.backward()})
        EXPECT_NEAR(glm::dot(a, a), 1, 0x1p-20f);
}

TEST(Camera, HasAFrameWhereUpRunsAlongTheViewOrIsZero)
{
    for (glm::vec3 const& eye : {glm::vec3(3, 0, 0),
                                 {0, 3, 0},
                                 {0, 0, 3},
                                 {-3, 0, 0},
                                 {0, -3, 0},
                                 {1, 2, 3},
                                 {-3, 0.1f, 0}})
        for (glm::vec3 const& up : {glm::vec3(0), eye, -eye, 1e-30f * eye, 1e30f * eye}) {
            Camera c;
            c.eye = eye;
            c.up = up;
            expect_right_angles(c);
        }
    Camera above; // x is to the right
    above.eye = {0, 3, 0};
    EXPECT_EQ(above.right(), glm::vec3(1, 0, 0));
}

TEST(Camera, LengthsOfUpAndOfTheViewDoNotMatter)
{
    Camera c;
    c.eye = {1, 2, 3};
    c.up = {0.1f, 1, 0.3f};
    for (int k : {-120, -60, 60, 120}) {
        Camera other = c;
        auto const scaled = [&](glm::vec3 v) {
            return glm::vec3(std::ldexp(v.x, k), std::ldexp(v.y, k), std::ldexp(v.z, k));
        };
        other.eye = scaled(c.eye);
        other.up = scaled(c.up);
        EXPECT_EQ(other.right(), c.right()) << k;
        EXPECT_EQ(other.true_up(), c.true_up()) << k;
        EXPECT_EQ(other.backward(), c.backward()) << k;
    }
}

TEST(Camera, RefusesWhatCanShowNothing)
{
    check_camera({});
    Camera c;
    c.eye = c.target;
    EXPECT_THROW(check_camera(c), Error);
    c = {};
    c.eye.x = INFINITY;
    EXPECT_THROW(check_camera(c), Error);
    c = {};
    c.eye.x = 3e38f, c.target.x = -3e38f;
    EXPECT_THROW(check_camera(c), Error);
    for (float focal : {0.0f, -1.0f, NAN, INFINITY}) {
        c = {};
        c.focal = focal;
        EXPECT_THROW(check_camera(c), Error);
    }
}

// Whatever stands off the points by no more than the reach, in any direction, is in the picture
// and between the planes.
RC_GTEST_PROP(Camera, FramesWhatReachesOffThePoints, ())
{
    auto const number = [](int most) { return float(*rc::gen::inRange(-most, most + 1)) / 16; };
    auto const vector = [&](int most) {
        return glm::vec3(number(most), number(most), number(most));
    };
    glm::vec3 const direction = vector(16);
    RC_PRE(direction != glm::vec3(0));
    std::vector<glm::vec3> points;
    for (int i = 0; i < 5; ++i) points.push_back(vector(32));
    float const reach = float(*rc::gen::inRange(0, 160)) / 16,
                aspect = *rc::gen::element(0.25f, 1.0f, 3.0f);
    Camera const c = frame_points(points, direction, aspect, reach);
    for (glm::vec3 const& p : points)
        for (int i = 0; i < 8; ++i) {
            glm::vec3 const n = vector(16);
            if (n == glm::vec3(0)) continue;
            glm::vec3 const s = seen(c, aspect, p + reach * glm::normalize(n));
            RC_ASSERT(std::abs(s.x) < 1);
            RC_ASSERT(std::abs(s.y) < 1);
            RC_ASSERT(s.z >= 0);
            RC_ASSERT(s.z <= 1);
        }
}

} // namespace
} // namespace tessemu
