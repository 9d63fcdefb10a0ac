// The limit surface against golden data made by OpenSubdiv, and against a surface known in closed
// form.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/limit_surface.h"
#include "io/model.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <sstream>

namespace tessemu {
namespace {

class GoldenLimit : public testing::TestWithParam<std::string> {};

// Bounds of the golden data's README: 1e-9 of the diagonal, normals 2e-5 rad. They were made from
// the files' decimals; our control meshes hold floats, each off by at most 2^-24 of itself, and a
// limit point is a convex combination of them.
TEST_P(GoldenLimit, PositionsAndNormalsAgreeWhereTheGridsMeet)
{
    std::string const model = "models/" + GetParam() + ".obj",
                      golden = "golden/limit/" + GetParam() + ".csv.gz";
    TESSEMU_NEEDS_SHARED(model);
    TESSEMU_NEEDS_SHARED(golden);
    ControlMesh const mesh = load_model(test::shared(model).string()).mesh;
    Topology const topology(mesh);
    LimitSurface const limit(topology, 2);
    std::istringstream in(test::read_gzip(test::shared(golden)));
    std::string line;
    std::getline(in, line);
    double const diagonal = std::stod(line.substr(line.find("bbox_diag=") + 10));
    std::getline(in, line);
    std::size_t compared = 0;
    double worst = 0, worst_normal = 0;
    while (std::getline(in, line)) {
        std::istringstream row(line);
        double c[10];
        for (double& x : c) {
            row >> x;
            row.ignore();
        }
        auto const face = std::uint32_t(c[0]);
        if (!limit.has_grid(face)) continue;
        double const i = c[2] * limit.grid(), j = c[3] * limit.grid();
        if (std::abs(i - std::round(i)) > 1e-6 || std::abs(j - std::round(j)) > 1e-6) continue;
        std::uint32_t const v = limit.vertex(face, int(std::round(i)), int(std::round(j)));
        worst = std::max(worst, glm::length(limit.positions()[v] - glm::dvec3(c[4], c[5], c[6])) /
                                    diagonal);
        glm::dvec3 const n(c[7], c[8], c[9]);
        if (n != glm::dvec3(0))
            worst_normal = std::max(worst_normal, glm::length(limit.normals()[v] - n));
        ++compared;
    }
    EXPECT_GE(compared, 4 * mesh.faces());
    double largest = 0;
    for (glm::vec3 const& p : mesh.positions)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double(p[k])));
    EXPECT_LE(worst, 1e-9 + std::sqrt(3.0) * 0x1p-24 * largest / diagonal);
    EXPECT_LE(worst_normal, 2e-5);
    std::printf("%s: %zu samples, worst %.2g of the diagonal, normals %.2g rad\n",
                GetParam().c_str(), compared, worst, worst_normal);
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

} // namespace
} // namespace tessemu
