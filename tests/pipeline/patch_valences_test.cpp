// Which extraordinary vertex a patch has, and the view that paints it.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/patch_valences.h"

#include "emu/error.h"
#include "pipeline/frame.h"
#include "tests/support/cages.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

namespace tessemu {
namespace {

SchemeOnMesh gregory(ControlMesh const& mesh, int subdivide)
{
    BuildOptions options;
    options.subdivide = subdivide;
    return build_scheme(find_scheme("gregory-stencil"), mesh, options);
}

using Counts = std::map<int, std::size_t>;
Counts counts(SchemeOnMesh const& on)
{
    Counts out;
    for (auto const& [v, patches] : count_valences(*on.patches)) out[v.valence] = patches;
    return out;
}

TEST(PatchValences, AStepLeavesNPatchesToEachExtraordinaryVertex)
{
    // Two poles of valence 7, fourteen vertices of valence 3, fourteen faces.
    ControlMesh const mesh = test::trapezohedron(7).mesh;
    EXPECT_EQ(counts(gregory(mesh, 0)), (Counts{{7, 14}}));
    EXPECT_EQ(counts(gregory(mesh, 1)), (Counts{{3, 14 * 3}, {7, 2 * 7}}));
    EXPECT_EQ(counts(gregory(mesh, 2)), (Counts{{3, 14 * 3}, {4, 14 * 16 - 56}, {7, 2 * 7}}));
}

TEST(PatchValences, TheValenceFurthestFromFourDecidesAndOfTwoTheLarger)
{
    auto const of = [](ControlMesh const& mesh) {
        std::set<int> out;
        Topology const t(mesh);
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) out.insert(patch_valence(t, f).valence);
        return out;
    };
    EXPECT_EQ(of(test::trapezohedron(5).mesh), std::set{5}); // 3 and 5
    EXPECT_EQ(of(test::ico_sphere(0).mesh), std::set{5});    // triangles: 3, and 5
    EXPECT_EQ(of(test::ico_sphere(1).mesh), std::set{6});
    EXPECT_EQ(of(test::torus(5, 4).mesh), std::set{4});
}

TEST(PatchValences, FacesAtTheBoundaryHaveAToneOfTheirOwnUnlessAVertexInsideIsExtraordinary)
{
    EXPECT_EQ(counts(gregory(test::grid(4, 3).mesh, 0)), (Counts{{0, 10}, {4, 2}}));
    // Three faces around a vertex inside: all are at the boundary.
    ControlMesh corner;
    corner.positions = {{0, 0, 0},  {1, 0, 0},   {1, 1, 0}, {0, 1, 0},
                        {-1, 0, 1}, {-1, -1, 0}, {0, -1, 1}};
    for (auto face : {std::vector<std::uint32_t>{0, 1, 2, 3}, {0, 3, 4, 5}, {0, 5, 6, 1}})
        corner.add_face(face);
    EXPECT_EQ(counts(gregory(corner, 0)), (Counts{{3, 3}}));
}

TEST(PatchValences, TheLegendSaysWhatOccursAndHowOften)
{
    std::string const legend = valence_legend(*gregory(test::trapezohedron(7).mesh, 2).patches);
    EXPECT_EQ(legend, "regular     grey          168 patches\n"
                      "valence 3   green          42 patches\n"
                      "valence 7   yellow         14 patches\n");
}

TEST(PatchValences, EachValenceFromThreeToTwelveHasAColorOfItsOwn)
{
    std::set<std::array<float, 3>> colors;
    std::set<std::string_view> names;
    for (int v : {PatchValence::kBoundary, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}) {
        colors.insert(PatchValence{v}.color());
        names.insert(PatchValence{v}.color_name());
    }
    EXPECT_EQ(colors.size(), 12u);
    EXPECT_EQ(names.size(), 12u);
    EXPECT_EQ(PatchValence{13}.color(), PatchValence{40}.color());
}

// Every pixel has a colour of the legend times one brightness, 0.45 to 1. Two channels are rounded
// products, each off by 2^-24 of itself at most, and none is above 1.
TEST(PatchValences, PixelsHaveTheColorsOfTheirPatches)
{
    for (bool displaced : {false, true}) {
        SchemeOnMesh const on = gregory(test::trapezohedron(7).mesh, 2);
        FrameSettings s;
        s.width = s.height = 128;
        s.tess_factor = 3;
        s.view = View::Valence;
        s.color_format = Format::R32G32B32A32_FLOAT;
        s.background = {0, 0, 1, 1};
        s.camera = frame_points(on.mesh->mesh().positions, {0.2f, 1, 0.3f}, 1);
        if (displaced)
            s.displacement = std::make_shared<Displacement>(Displacement::studs(0.2f, 0.02f));
        Frame const frame = draw_frame(*on.patches, s, ThreadPool(2));
        Counts pixels;
        for (int y = 0; y < s.height; ++y)
            for (int x = 0; x < s.width; ++x) {
                std::array<float, 4> const p = frame.color.load(x, y);
                if (p == s.background) continue;
                int found = -1;
                for (auto const& [v, patches] : count_valences(*on.patches)) {
                    std::array<float, 3> const c = v.color();
                    double const bright = double(p[0]) / double(c[0]);
                    bool same = bright >= 0.4499 && bright <= 1.0001;
                    for (std::size_t k = 1; k < 3; ++k)
                        same = same && std::abs(double(p[k]) - bright * double(c[k])) <= 0x1p-23;
                    if (same) found = v.valence;
                }
                ASSERT_NE(found, -1) << x << ' ' << y;
                ++pixels[found];
            }
        EXPECT_EQ(pixels.size(), 3u);
        // From above the pole is in the middle, in a ring of regular patches.
        EXPECT_GT(pixels[4], pixels[7]);
        EXPECT_GT(pixels[7], 100u);
    }
}

TEST(PatchValences, TheDirect3D10PathIsRefused)
{
    SchemeOnMesh const on = gregory(test::cube().mesh, 0);
    FrameSettings s;
    s.width = s.height = 16;
    s.view = View::Valence;
    s.direct3d10 = true;
    EXPECT_THROW(draw_frame(*on.patches, s, ThreadPool(1)), Error);
}

} // namespace
} // namespace tessemu
