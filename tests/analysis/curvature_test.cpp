// The range of the curvature view's colours.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/curvature.h"

#include "analysis/compare.h"
#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>

namespace tessemu {
namespace {

SchemeOnMesh stam(ControlMesh const& mesh)
{
    return build_scheme(find_scheme("stam"), mesh);
}
FrameSettings settings()
{
    FrameSettings s;
    s.tess_factor = 4;
    return s;
}

// In a tessellated plane all but 1 % of the area is below the range and no more than that.
TEST(CurvatureRange, IsWhat99PercentOfTheAreaStaysBelow)
{
    SchemeOnMesh const m = stam(load_model("golem").mesh);
    FrameSettings s = settings();
    double const range = curvature_range(*m.patches, s, ThreadPool(2));
    s.curvature = true;
    double below = 0, all = 0;
    visit_surface(*m.patches, s, ThreadPool(1), [&](SurfacePatch const& p) {
        auto const& index = p.triangles();
        for (std::size_t t = 0; t < index.size(); t += 3) {
            glm::dvec3 q[3];
            for (std::size_t k = 0; k < 3; ++k) q[k] = p.vertex(index[t + k]).position;
            double const area = glm::length(cross(q[1] - q[0], q[2] - q[0])) / 2;
            all += area;
            for (std::size_t k = 0; k < 3; ++k)
                if (std::abs(double(p.vertex(index[t + k]).curvature)) <= range) below += area / 3;
        }
    });
    EXPECT_GE(below, 0.99 * all * (1 - 1e-12));
    EXPECT_LT(below, 0.992 * all); // one vertex more or less
    for (int threads : {1, 3})
        EXPECT_EQ(curvature_range(*m.patches, settings(), ThreadPool(threads)), range);
}

TEST(CurvatureRange, OfAPlaneIsNextToFlatWhateverItsRounding)
{
    for (bool askew : {false, true}) {
        ControlMesh mesh = test::grid(6, 6).mesh;
        if (askew)
            for (glm::vec3& p : mesh.positions)
                p = {p.x + 0.1f * p.y + 0.37f, p.y - p.x / 3 + 0.3f * p.z, p.x / 7 + p.z};
        SchemeOnMesh const m = stam(mesh);
        EXPECT_EQ(curvature_range(*m.patches, settings(), ThreadPool(2)),
                  0.01 / bounding_box_diagonal(m.mesh->base()));
    }
}

TEST(CurvatureRange, ScalesAsOneOverLength)
{
    ControlMesh mesh = load_model("golem").mesh;
    double const one = curvature_range(*stam(mesh).patches, settings(), ThreadPool(2));
    for (glm::vec3& p : mesh.positions) p *= 4.0f;
    EXPECT_EQ(curvature_range(*stam(mesh).patches, settings(), ThreadPool(2)), one / 4);
}

TEST(CurvatureRange, PatchesWithoutSecondDerivativesAreCountedAndTakeNoPart)
{
    EXPECT_EQ(patches_without_curvature(*stam(test::cube().mesh).patches), 0u);
    SchemeOnMesh const open = stam(test::grid(4, 3).mesh);
    // A step leaves 8 x 6 faces, 24 of them at the boundary.
    EXPECT_EQ(patches_without_curvature(*open.patches), 24u);
}

} // namespace
} // namespace tessemu
