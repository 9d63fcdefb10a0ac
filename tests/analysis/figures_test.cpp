// Pictures of errors, control meshes and the paper's figures.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/loop09_figures.h"
#include "io/model.h"
#include "pipeline/colored_mesh.h"

#include <gtest/gtest.h>

namespace tessemu {
namespace {

// Where the error is 0 the picture is blue, where it is what red stands for it is red.
TEST(ErrorView, IsBlueForNoneAndRedForTheLargest)
{
    EqualParameterErrors e;
    e.diagonal = 1;
    e.position = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    e.normal.assign(4, {0, 0, 1});
    e.triangles = {0, 1, 2, 0, 2, 3};
    e.distance.assign(4, 0);
    e.angle.assign(4, 0.5);
    FrameSettings s;
    s.width = s.height = 32;
    std::vector<glm::vec3> const points(e.position.begin(), e.position.end());
    s.camera = frame_points(points, {0, 0, 1}, 1);
    ErrorView const view = draw_error(e, s, 1, 0.5, ThreadPool(1));
    auto const blue = view.position.load(16, 16), red = view.normal.load(16, 16);
    EXPECT_EQ(blue[0], 0);
    EXPECT_GT(blue[2], 0.9f);
    EXPECT_GT(red[0], 0.9f);
    EXPECT_EQ(red[2], 0);
    EXPECT_EQ(draw_error(e, s, 0, 0, ThreadPool(1)).normal.load(16, 16)[0], 0) << "no scale";
}

TEST(Quantile, IsByWeight)
{
    EXPECT_EQ(quantile({1, 2, 3, 4}, {1, 1, 1, 1}, 0.5), 2);
    EXPECT_EQ(quantile({4, 3, 2, 1}, {0, 1, 1, 8}, 0.8), 1);
    EXPECT_EQ(quantile({4, 3, 2, 1}, {0, 1, 1, 8}, 1), 3);
    EXPECT_EQ(quantile({}, {}, 0.5), 0);
}

TEST(ControlMeshPicture, HasEachFaceAndEachEdgeOnce)
{
    ControlMesh const mesh = load_model("golem").mesh;
    ColoredMesh const picture = control_mesh_picture(Topology(mesh));
    EXPECT_EQ(picture.triangles.size(), mesh.faces() * 6);
    EXPECT_EQ(picture.lines.size(), 140u * 2);
}

TEST(Loop09Figures, HaveTheirPanels)
{
    std::vector<ControlMesh> const jug{load_model("jug").mesh}, golem{load_model("golem").mesh};
    FrameSettings s;
    s.width = s.height = 48;
    s.tess_factor = 4;
    auto const figure = [&](int number, std::vector<ControlMesh> const& meshes) {
        return reproduce_loop09_figure(number, meshes, s, ThreadPool(), {});
    };
    EXPECT_EQ(figure(1, jug).panels.size(), 4u);
    EXPECT_EQ(figure(9, {golem[0], jug[0]}).panels.size(), 8u);
    EXPECT_EQ(figure(3, {}).panels.size(), 8u);
    EXPECT_EQ(figure(10, jug).panels.size(), 3u);
    EXPECT_EQ(figure(12, {golem[0], jug[0]}).panels.size(), 6u);
    PaperFigure const errors = figure(11, golem);
    EXPECT_EQ(errors.panels.size(), 6u);
    ASSERT_EQ(errors.scales.size(), 2u);
    EXPECT_GT(errors.scales[0].max, 0);
    EXPECT_THROW(figure(2, jug), Error);
    EXPECT_THROW(figure(10, golem), Error) << "quads only";
    EXPECT_THROW(figure(11, jug), Error) << "acc draws no triangles";
    EXPECT_THROW(figure(1, {}), Error);
    // No panel is empty: something differs from the background.
    for (PaperFigure::Panel const& p : figure(1, jug).panels) {
        bool drawn = false;
        for (int y = 0; y < 48 && !drawn; ++y)
            for (int x = 0; x < 48; ++x)
                drawn |= std::abs(p.picture.load(x, y)[1] - s.background[1]) > 0.1f;
        EXPECT_TRUE(drawn) << p.caption;
    }
}

} // namespace
} // namespace tessemu
