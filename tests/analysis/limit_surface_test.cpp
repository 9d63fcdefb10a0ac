// The limit surface against golden data made by OpenSubdiv, and against a surface known in closed
// form.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/limit_surface.h"
#include "io/model.h"
#include "tests/support/files.h"
#include "tests/support/limit_samples.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace tessemu {
namespace {

class GoldenLimit : public testing::TestWithParam<std::string> {};

// The sides of the limit grid's cells at a point of a face, along i and along j.
std::array<glm::dvec3, 2> segments(LimitSurface const& limit, std::uint32_t face, int i, int j)
{
    auto const at = [&](int a, int b) { return limit.positions()[limit.vertex(face, a, b)]; };
    int const n = limit.grid(), i0 = std::max(0, i - 1), i1 = std::min(n, i + 1),
              j0 = std::max(0, j - 1), j1 = std::min(n, j + 1);
    return {(at(i1, j) - at(i0, j)) / double(i1 - i0), (at(i, j1) - at(i, j0)) / double(j1 - j0)};
}

bool is_extraordinary(Topology const& topology, std::uint32_t face, int i, int j, int n)
{
    if (i % n != 0 || j % n != 0) return false;
    int const corner = j == 0 ? i / n : 3 - i / n;
    std::uint32_t const v = topology.mesh().face(face)[std::size_t(corner)];
    return topology.is_boundary(v) || topology.ring(v).size() != 4;
}

// The samples were made from the files' decimals; our control points are floats, each coordinate
// off by at most 2^-24 of itself, and so, at most, are those of the refined mesh and limit points,
// which are convex combinations of them. Samples are printed with 10 digits: 1e-9 of the diagonal.
//
// Normals have 8 decimals. A tangent is a difference of two convex combinations (of quadratic
// B-splines), so it is off by twice that of a control point, and turns by this over its length,
// which is a cell's of the grid; a normal turns by as much as both tangents together over the sine
// of the angle between them. At extraordinary vertices the samples themselves are off by up to
// 5e-6: OpenSubdiv's patches end at level 10, and the limit masks of an independent program differ
// by so much.
TEST_P(GoldenLimit, PositionsAndNormalsAgreeWhereTheGridsMeet)
{
    std::string const model = "models/" + GetParam() + ".obj",
                      golden = "golden/limit/" + GetParam() + ".csv.gz";
    TESSEMU_NEEDS_SHARED(model);
    TESSEMU_NEEDS_SHARED(golden);
    ControlMesh const mesh = load_model(test::shared(model).string()).mesh;
    Topology const topology(mesh);
    LimitSurface const limit(topology, 2);
    test::LimitSamples const wanted = test::read_limit_samples(test::shared(golden));
    double largest = 0;
    for (glm::vec3 const& p : mesh.positions)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double(p[k])));
    double const moved = std::sqrt(3.0) * 0x1p-24 * largest;
    std::size_t compared = 0;
    double worst = 0, worst_normal = 0;
    for (auto const& sample : wanted.samples) {
        std::uint32_t const face = sample.face;
        if (!limit.has_grid(face)) continue;
        double const x = sample.u * limit.grid(), y = sample.v * limit.grid();
        if (std::abs(x - std::round(x)) > 1e-6 || std::abs(y - std::round(y)) > 1e-6) continue;
        int const i = int(std::round(x)), j = int(std::round(y));
        std::uint32_t const v = limit.vertex(face, i, j);
        double const apart = glm::length(limit.positions()[v] - sample.position);
        EXPECT_LE(apart, 1e-9 * wanted.diagonal + moved) << sample.line;
        worst = std::max(worst, apart / wanted.diagonal);
        glm::dvec3 const& n = sample.normal;
        if (n != glm::dvec3(0)) {
            auto const [du, dv] = segments(limit, face, i, j);
            double const u = glm::length(du), w = glm::length(dv),
                         sine = glm::length(cross(du, dv)) / (u * w),
                         turned = 2 * moved * (1 / u + 1 / w) / sine,
                         samples =
                             std::sqrt(3.0) * 0.5e-8 +
                             (is_extraordinary(topology, face, i, j, limit.grid()) ? 5e-6 : 0);
            double const angle = glm::length(limit.normals()[v] - n);
            EXPECT_LE(angle, samples + turned) << sample.line;
            worst_normal = std::max(worst_normal, angle);
        }
        ++compared;
    }
    EXPECT_GE(compared, 4 * mesh.faces());
    RecordProperty("samples", std::to_string(compared));
    RecordProperty("worst_of_the_diagonal", std::to_string(worst * 1e9) + "e-9");
    RecordProperty("worst_normal_radians", std::to_string(worst_normal * 1e9) + "e-9");
}
INSTANTIATE_TEST_SUITE_P(Models, GoldenLimit,
                         testing::Values("bigguy", "monsterfrog", "catmark_torus", "catmark_cube",
                                         "spot_control"));

TEST(LimitSurface, RefusesALevelOutOfRange)
{
    ControlMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    Topology const topology(mesh);
    EXPECT_THROW(LimitSurface(topology, 0), LimitError);
    EXPECT_THROW(LimitSurface(topology, 8), LimitError);
}

// A single square: the boundary is the cubic B-spline of its corners, which are interpolated, and
// the surface stays in its plane.
TEST(LimitSurface, ASquareStaysFlatAndKeepsItsCorners)
{
    ControlMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    Topology const topology(mesh);
    LimitSurface const limit(topology, 3);
    EXPECT_EQ(limit.positions()[limit.vertex(0, 0, 0)], glm::dvec3(0, 0, 0));
    EXPECT_EQ(limit.positions()[limit.vertex(0, 8, 8)], glm::dvec3(1, 1, 0));
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 8; ++j) {
            std::uint32_t const v = limit.vertex(0, i, j);
            EXPECT_EQ(limit.normals()[v], glm::dvec3(0, 0, 1)) << i << " " << j;
            EXPECT_NEAR(limit.positions()[v].x, i / 8.0, 1e-15);
            EXPECT_NEAR(limit.positions()[v].y, j / 8.0, 1e-15);
        }
}

// A row of vertices on one point: the tip of a cone of eight sides, whose mean normal is the axis.
TEST(LimitSurface, HasANormalAtAPole)
{
    ControlMesh m;
    for (int row = 0; row < 3; ++row)
        for (int j = 0; j < 8; ++j) {
            int const x[] = {2, 1, 0, -1, -2, -1, 0, 1}, y[] = {0, 1, 2, 1, 0, -1, -2, -1};
            m.positions.emplace_back(float(row * x[j]), float(row * y[j]), float(-row));
        }
    for (std::uint32_t row = 0; row < 2; ++row)
        for (std::uint32_t j = 0; j < 8; ++j) {
            std::uint32_t const a = 8 * row + j, b = 8 * row + (j + 1) % 8;
            m.add_face(std::vector{a, a + 8, b + 8, b});
        }
    Topology const topology(m);
    LimitSurface const limit(topology, 3);
    std::size_t tips = 0;
    for (std::size_t v = 0; v < limit.positions().size(); ++v) {
        EXPECT_NEAR(glm::length(limit.normals()[v]), 1, 8 * 0x1p-53); // v/|v| has 8 roundings
        if (glm::length(limit.positions()[v]) > 0) continue;
        ++tips;
        EXPECT_NEAR(limit.normals()[v].z, 1, 8 * 0x1p-53); // coordinates are dyadic: sums are exact
    }
    EXPECT_EQ(tips, 8u * 8); // a segment of the tip's row has eight points at level 3
}

} // namespace
} // namespace tessemu
