// Pictures of errors, control meshes and the paper's figures.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/papers/loop09/figures.h"
#include "io/model.h"
#include "io/sha256.h"
#include "pipeline/colored_mesh.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

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

constexpr int kSize = 96;

FrameSettings panel_settings()
{
    FrameSettings s;
    s.width = s.height = kSize;
    s.tess_factor = 4;
    s.color_format = Format::R32G32B32A32_FLOAT; // every bit of a shader's colour
    return s;
}

PaperFigure figure(int number, std::vector<char const*> const& models)
{
    std::vector<ControlMesh> meshes;
    for (char const* model : models) meshes.push_back(load_model(model).mesh);
    return reproduce_loop09_figure(number, meshes, panel_settings(), ThreadPool(), {});
}

enum class Hue { Background, Ink, RegularQuad, IrregularQuad, Triangle, Other };

// A patch's colour is its class's colour times a shade, 1 at most in a channel. The smallest
// channel, which stays below 1, tells the shade; it and the channel compared have rounded once
// each, by 2^-24 of themselves. A control mesh's colour is interpolated between equal values, which
// changes no bit: a + (b1 0 + b2 0).
Hue hue_of(std::array<float, 4> const& pixel)
{
    if (pixel == panel_settings().background) return Hue::Background;
    if (pixel == std::array<float, 4>{0.05f, 0.06f, 0.08f, 1}) return Hue::Ink;
    for (auto const& [hue, patch_class] : {std::pair(Hue::RegularQuad, PatchClass::RegularQuad),
                                           {Hue::IrregularQuad, PatchClass::IrregularQuad},
                                           {Hue::Triangle, PatchClass::Triangle}}) {
        std::array<float, 3> const c = color_of(patch_class);
        auto const least = std::size_t(std::min_element(c.begin(), c.end()) - c.begin());
        double const shade = double(pixel[least]) / double(c[least]);
        bool same = true;
        for (std::size_t k = 0; k < 3; ++k) {
            double const expected = std::min(1.0, double(c[k]) * shade);
            same = same && std::abs(double(pixel[k]) - expected) <= 2 * 0x1p-24 * expected;
        }
        if (same) return hue;
    }
    return Hue::Other;
}

std::map<Hue, int> hues_of(ColorTarget const& picture)
{
    std::map<Hue, int> n;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) ++n[hue_of(picture.load(x, y))];
    return n;
}
std::set<Hue> hues_in(ColorTarget const& picture)
{
    std::set<Hue> out;
    for (auto const& [hue, n] : hues_of(picture)) out.insert(hue);
    return out;
}
std::vector<bool> covered(ColorTarget const& picture)
{
    std::vector<bool> out;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            out.push_back(picture.load(x, y) != panel_settings().background);
    return out;
}

// The control mesh and the patches have the colours of the classes that the mesh has, and no other;
// the patches cover what the surface covers.
void expect_classes(ColorTarget const& cage, ColorTarget const& patches, ColorTarget const& surface,
                    std::set<Hue> const& classes)
{
    std::set<Hue> expected = classes;
    expected.insert(Hue::Background);
    EXPECT_EQ(hues_in(patches), expected);
    expected.insert(Hue::Ink);
    EXPECT_EQ(hues_in(cage), expected);
    EXPECT_EQ(covered(patches), covered(surface));
}

std::set<Hue> const kJug{Hue::RegularQuad, Hue::IrregularQuad, Hue::Triangle},
    kGolem{Hue::RegularQuad, Hue::IrregularQuad};

TEST(Loop09Figures, PatchesHaveTheColoursOfTheirClasses)
{
    PaperFigure const rows = figure(9, {"golem", "jug"});
    ASSERT_EQ(rows.panels.size(), 8u);
    for (std::size_t i : {0u, 1u}) {
        PaperFigure::Panel const* const p = rows.panels.data() + 4 * i;
        expect_classes(p[0].picture, p[1].picture, p[2].picture, i ? kJug : kGolem);
        EXPECT_NE(covered(p[2].picture), covered(p[3].picture)) << "displaced";
    }
    PaperFigure const gallery = figure(12, {"golem", "jug"});
    ASSERT_EQ(gallery.panels.size(), 6u);
    for (std::size_t i : {0u, 1u})
        expect_classes(gallery.panels[i].picture, gallery.panels[2 + i].picture,
                       gallery.panels[4 + i].picture, i ? kJug : kGolem);
    // A vertex where triangles meet quads, from near.
    PaperFigure const near = figure(10, {"jug"});
    ASSERT_EQ(near.panels.size(), 3u);
    expect_classes(near.panels[0].picture, near.panels[1].picture, near.panels[2].picture, kJug);
}

TEST(Loop09Figures, PatternsHaveMoreLinesForALargerFactor)
{
    PaperFigure const patterns = figure(3, {});
    ASSERT_EQ(patterns.panels.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
        auto const n = hues_of(patterns.panels[i].picture);
        EXPECT_GT(n.at(Hue::Ink), i % 4 ? hues_of(patterns.panels[i - 1].picture).at(Hue::Ink) : 0)
            << patterns.panels[i].caption;
    }
}

// Where a colour lies between blue, 0, and red, 1: heat_color turned round, of any shade.
double heat_of(std::array<float, 4> const& c)
{
    double const most = double(std::max({c[0], c[1], c[2]}));
    double const r = double(c[0]) / most, g = double(c[1]) / most, b = double(c[2]) / most;
    return b > 0 ? (g + 1 - b) / 4 : r > 0 ? (2 + r + 1 - g) / 4 : 0.5;
}

// One scale for a column, which the worst scheme reaches: somewhere it is red and nothing else. The
// mean heat of the picture goes in the order of the paper's table 3.
TEST(Loop09Figures, ErrorsShareAScaleAndHaveTheOrderOfTable3)
{
    PaperFigure const errors = figure(11, {"golem"});
    ASSERT_EQ(errors.panels.size(), 6u);
    ASSERT_EQ(errors.scales.size(), 2u);
    double heat[2][3] = {}; // position, normal: acc, pm, gregory-stencil
    for (std::size_t column : {0u, 1u}) {
        bool red = false;
        for (std::size_t scheme : {0u, 1u, 2u}) {
            ColorTarget const& picture = errors.panels[2 * scheme + column].picture;
            int n = 0;
            for (int y = 0; y < kSize; ++y)
                for (int x = 0; x < kSize; ++x) {
                    std::array<float, 4> const c = picture.load(x, y);
                    if (c == panel_settings().background) continue;
                    ++n;
                    heat[column][scheme] += heat_of(c);
                    red = red || (c[0] > 0 && c[1] == 0 && c[2] == 0);
                }
            heat[column][scheme] /= n;
        }
        EXPECT_TRUE(red) << errors.scales[column].label;
        EXPECT_GT(errors.scales[column].max, 0);
    }
    EXPECT_GT(heat[0][0], heat[0][2]);
    EXPECT_GT(heat[0][2], heat[0][1]);
    EXPECT_GT(heat[1][0], heat[1][1]);
    EXPECT_GT(heat[1][1], heat[1][2]);
    for (std::size_t scheme : {0u, 1u, 2u})
        EXPECT_EQ(covered(errors.panels[2 * scheme].picture),
                  covered(errors.panels[2 * scheme + 1].picture));
}

TEST(Loop09Figures, RefuseWhatTheyCannotShow)
{
    EXPECT_THROW(figure(2, {"jug"}), Error);
    EXPECT_THROW(figure(10, {"golem"}), Error) << "quads only";
    EXPECT_THROW(figure(11, {"jug"}), Error) << "acc draws no triangles";
    EXPECT_THROW(figure(1, {}), Error);
}

// Every panel's pixels, by their hash. tests/golden/loop09_figures.txt tells where they come from.
TEST(Loop09Figures, PanelsAreTheStoredOnes)
{
    std::string panels;
    for (auto const& [number, models] :
         std::vector<std::pair<int, std::vector<char const*>>>{{1, {"jug"}},
                                                               {3, {}},
                                                               {9, {"golem", "jug"}},
                                                               {10, {"jug"}},
                                                               {11, {"golem"}},
                                                               {12, {"golem", "jug"}}}) {
        PaperFigure const f = figure(number, models);
        for (PaperFigure::Panel const& p : f.panels) {
            Sha256 hash;
            for (int y = 0; y < kSize; ++y) hash.add(p.picture.texel(0, y), p.picture.row_bytes());
            panels += std::to_string(number) + " " + hash.hex() + " " + p.caption + "\n";
        }
    }
    std::string stored;
    std::istringstream lines(test::read_text(test::golden("loop09_figures.txt")));
    for (std::string line; std::getline(lines, line);)
        if (!line.starts_with("#")) stored += line + "\n";
    EXPECT_EQ(panels, stored);
}

} // namespace
} // namespace tessemu
