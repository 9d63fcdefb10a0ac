// The zebra and curvature views, through the pipeline.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/error.h"
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/cages.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>

namespace tessemu {
namespace {

SchemeOnMesh on(char const* scheme, ControlMesh const& mesh, ParameterTexts const& set = {})
{
    BuildOptions options;
    options.set = set;
    return build_scheme(find_scheme(scheme), mesh, options);
}

FrameSettings settings_for(SchemeOnMesh const& m, View view)
{
    FrameSettings s;
    s.width = 96;
    s.height = 64;
    s.tess_factor = 6;
    s.view = view;
    s.color_format = Format::R32G32B32A32_FLOAT;
    s.background = {0, 0, 1, 0};
    s.camera = frame_points(m.mesh->mesh().positions, {0.4f, 0.3f, 1}, 1.5f);
    return s;
}

std::vector<float> pixels(PatchMesh const& patches, FrameSettings const& s)
{
    Frame const frame = draw_frame(patches, s, ThreadPool(2));
    std::vector<float> out;
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x)
            for (float c : frame.color.load(x, y)) out.push_back(c);
    return out;
}

ControlMesh quad_grid()
{
    return test::grid(4, 4).mesh;
}

// On a plane the normal is known, so each pixel's stripe is. What the shader computes in singles is
// off by less than 1e-5 of a stripe; pixels so near to the edge of one, or on a pixel's width of it,
// may be either.
TEST(ZebraView, StripesOfAPlaneAreTheReflectionsOfTheCamerasAxis)
{
    SchemeOnMesh const m = on("gregory-stencil", quad_grid());
    glm::vec3 const normal = [&] {
        auto const face = m.mesh->mesh().face(0);
        auto const& p = m.mesh->mesh().positions;
        return glm::normalize(cross(p[face[1]] - p[face[0]], p[face[3]] - p[face[0]]));
    }();
    FrameSettings s = settings_for(m, View::Zebra);
    // Close and askew, so that many stripes are seen, each many pixels wide.
    s.width = 480;
    s.height = 320;
    s.camera.eye = s.camera.target + 0.35f * (s.camera.eye - s.camera.target);
    s.camera.focal = 0.6f;
    s.camera.up = {0.3f, 1, 0.1f};
    fit_depth_range(s.camera, m.mesh->mesh().positions);
    std::vector<float> const picture = pixels(*m.patches, s);
    Camera const& c = s.camera;
    glm::dvec3 const right(c.right()), up(c.true_up()), backward(c.backward()), n0(normal);
    std::size_t light = 0, dark = 0;
    auto const stripe = [&](double x, double y) {
        double const half = double(s.height) / 2;
        glm::dvec3 const v = normalize(
            backward -
            ((x - double(s.width) / 2) / half * right + (half - y) / half * up) / double(c.focal));
        glm::dvec3 const n = dot(n0, v) < 0 ? -n0 : n0;
        double const place = 7 * (2 * dot(n, v) * dot(n, up) - dot(v, up));
        return std::pair(place - std::floor(place), dot(n, v));
    };
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x) {
            float const* const p = picture.data() + 4 * (y * s.width + x);
            if (p[3] == 0) continue; // background
            double low = 1, high = 0;
            for (double dx : {-0.6, 1.6})
                for (double dy : {-0.6, 1.6}) {
                    double const f = stripe(x + dx, y + dy).first,
                                 off = std::min(f, 1 - f); // 1/4 at the edges
                    low = std::min(low, off), high = std::max(high, off);
                }
            double const shade = 0.6 + 0.4 * stripe(x + 0.5, y + 0.5).second;
            if (high < 0.2499) {
                EXPECT_NEAR(double(p[0]), 0.98 * shade, 1e-5) << x << ' ' << y;
                ++light;
            } else if (low > 0.2501) {
                EXPECT_NEAR(double(p[0]), 0.06 * shade, 1e-5) << x << ' ' << y;
                ++dark;
            }
            EXPECT_EQ(p[0], p[1]);
            EXPECT_EQ(p[0], p[2]);
        }
    EXPECT_GT(light, 10000u);
    EXPECT_GT(dark, 10000u);
}

TEST(ZebraView, IsDrawnOfEverySchemeDisplacedInAnyPoseAndByDirect3D10)
{
    for (auto const& scheme : schemes()) {
        MeshRequirements const takes = scheme->info().takes;
        SchemeOnMesh const m =
            on(scheme->info().name.c_str(), load_model(takes.quads ? "golem" : "spindle").mesh);
        FrameSettings s = settings_for(m, View::Zebra);
        std::vector<float> const plain = pixels(*m.patches, s);
        std::size_t dark = 0, light = 0;
        for (std::size_t i = 0; i < plain.size(); i += 4)
            if (plain[i + 3] == 1) ++(plain[i] < 0.3f ? dark : light);
        EXPECT_GT(dark, 50u) << scheme->info().name;
        EXPECT_GT(light, 50u) << scheme->info().name;
        s.direct3d10 = true;
        EXPECT_EQ(pixels(*m.patches, s), plain) << scheme->info().name;
        s.direct3d10 = false;
        s.displacement = std::make_shared<Displacement>(Displacement::studs(0.2f, 0.02f));
        EXPECT_NE(pixels(*m.patches, s), plain) << scheme->info().name;
        s.displacement = nullptr;
        s.pose = std::make_shared<Pose>(SpineRig(m.mesh->base()).sway(0.3));
        EXPECT_NE(pixels(*m.patches, s), plain) << scheme->info().name;
    }
}

// All ways in which schemes with second derivatives draw.
struct Way {
    char const *scheme, *edges, *regular;

    std::string text() const { return std::string(scheme) + ' ' + edges + ' ' + regular; }
};
constexpr Way kWays[] = {{"stam", "paper", "bezier"},      {"stam", "paper", "bspline"},
                         {"stam", "shared", "bezier"},     {"stam", "shared", "bspline"},
                         {"biseptic", "paper", "bezier"},  {"biseptic", "paper", "bspline"},
                         {"biseptic", "shared", "bezier"}, {"biseptic", "shared", "bspline"}};
SchemeOnMesh drawn(ControlMesh const& mesh, Way const& w)
{
    return on(w.scheme, mesh, {{"edges", w.edges}, {"regular", w.regular}});
}

struct Integrals {
    double mean = 0, steiner = 0, area = 0, lowest = INFINITY, highest = -INFINITY;
};
// The integral of 2 H over a closed surface is how fast the area of its parallel surfaces S + e N
// grows (Steiner), which needs points and normals alone.
Integrals integrals_of(PatchMesh const& patches, FrameSettings s)
{
    s.curvature = true;
    Integrals out;
    visit_surface(patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
        ASSERT_TRUE(p.has_curvature()) << p.kind().name;
        std::vector<SurfaceVertex> v;
        for (std::size_t i = 0; i < p.points(); ++i) {
            v.push_back(p.vertex(i));
            out.lowest = std::min(out.lowest, double(v.back().curvature));
            out.highest = std::max(out.highest, double(v.back().curvature));
        }
        auto const& index = p.triangles();
        for (std::size_t t = 0; t < index.size(); t += 3) {
            auto const area = [&](double e) {
                glm::dvec3 q[3];
                for (std::size_t k = 0; k < 3; ++k) {
                    SurfaceVertex const& w = v[index[t + k]];
                    q[k] = glm::dvec3(w.position) + e * glm::dvec3(w.normal);
                }
                return length(cross(q[1] - q[0], q[2] - q[0])) / 2;
            };
            double const e = 1e-3, h = double(v[index[t]].curvature) +
                                       double(v[index[t + 1]].curvature) +
                                       double(v[index[t + 2]].curvature);
            out.mean += 2 * h / 3 * area(0);
            out.steiner += (area(e) - area(-e)) / (2 * e);
            out.area += area(0);
        }
    });
    return out;
}

// Both integrals have an error of the second order in the size of a triangle, a radius of some 0.02
// here, so they differ by some (0.02)^2 of themselves, and by four times that where it is twice as
// large.
TEST(CurvatureView, IntegratesToTheGrowthOfParallelSurfaces)
{
    for (Way const& w : kWays) {
        SchemeOnMesh const m = drawn(test::cube().mesh, w);
        double off[2];
        for (int i : {0, 1}) {
            FrameSettings s;
            s.tess_factor = i ? 32 : 16;
            s.partitioning = Partitioning::Integer;
            Integrals const sum = integrals_of(*m.patches, s);
            off[i] = std::abs(sum.mean / sum.steiner - 1);
            EXPECT_GT(sum.lowest, 0) << w.text();
        }
        EXPECT_LT(off[1], 2e-4) << w.text();
        EXPECT_LT(off[1], off[0] / 3) << w.text();
    }
}

// Second derivatives of a patch whose side is 1/20 of the torus: singles, 6e-8 of the torus, change
// them by 6e-8 * 24 / (1/20)^2 < 1e-3 of the curvature of one as large as the torus, and a mean over
// all points by less.
TEST(CurvatureView, IsTheSameInAllWays)
{
    std::vector<Integrals> all;
    for (Way const& w : kWays) {
        SchemeOnMesh const m = drawn(test::torus(12, 8).mesh, w);
        FrameSettings s;
        s.tess_factor = 5;
        all.push_back(integrals_of(*m.patches, s));
        s.direct3d10 = true;
        Integrals const ten = integrals_of(*m.patches, s);
        EXPECT_EQ(ten.mean, all.back().mean);
        EXPECT_EQ(ten.highest, all.back().highest);
    }
    // The torus has regular patches alone, which are the same in both schemes.
    for (Integrals const& i : all) {
        EXPECT_NEAR(i.highest, all[0].highest, 1e-3 * all[0].highest);
        EXPECT_NEAR(i.lowest, all[0].lowest, 1e-3 * all[0].highest);
        EXPECT_NEAR(i.mean, all[0].mean, 1e-4 * all[0].mean);
    }
    EXPECT_GT(all[0].highest, 0);
}

// Points and normals are those of any other view, so what is closed stays closed.
TEST(CurvatureView, ChangesNoPositionAndNoNormal)
{
    for (Way const& w : kWays) {
        SchemeOnMesh const m = drawn(test::trapezohedron(13).mesh, w);
        std::vector<SurfaceVertex> vertices[2];
        for (bool curvature : {false, true}) {
            FrameSettings s;
            s.tess_factor = 4.3f;
            s.curvature = curvature;
            visit_surface(*m.patches, s, ThreadPool(2), [&](SurfacePatch const& p) {
                for (std::size_t i = 0; i < p.points(); ++i)
                    vertices[curvature].push_back(p.vertex(i));
            });
        }
        ASSERT_GT(vertices[0].size(), 1000u);
        ASSERT_EQ(vertices[0].size(), vertices[1].size());
        for (std::size_t i = 0; i < vertices[0].size(); ++i) {
            ASSERT_EQ(vertices[0][i].position, vertices[1][i].position);
            ASSERT_EQ(vertices[0][i].normal, vertices[1][i].normal);
            ASSERT_TRUE(std::isfinite(vertices[1][i].curvature));
        }
    }
}

// Red over green and blue where the surface bends away, blue where it bends towards its normal; the
// picture is the same by the Direct3D 10 path. Faces at a boundary are grey.
TEST(CurvatureView, IsRedWhereConvexBlueWhereConcaveAndGreyWhereThereIsNone)
{
    SchemeOnMesh m = drawn(test::cube().mesh, kWays[0]);
    FrameSettings s = settings_for(m, View::Curvature);
    auto const count = [&](auto const& is) {
        std::vector<float> const p = pixels(*m.patches, s);
        std::size_t n = 0, all = 0;
        for (std::size_t i = 0; i < p.size(); i += 4)
            if (p[i + 3] == 1) ++all, n += is(p[i], p[i + 1], p[i + 2]);
        EXPECT_GT(all, 500u);
        return double(n) / double(all);
    };
    auto const red = [](float r, float g, float b) { return r > 1.05f * g && r > 1.05f * b; };
    auto const blue = [](float r, float g, float b) { return b > 1.05f * r && b > 1.05f * g; };
    auto const grey = [](float r, float g, float b) { return r == g && g == b; };
    EXPECT_EQ(count(red), 1);
    std::vector<float> const eleven = pixels(*m.patches, s);
    s.direct3d10 = true;
    EXPECT_EQ(pixels(*m.patches, s), eleven);
    s.direct3d10 = false;
    s.curvature_max = 1e6f; // all but white
    EXPECT_EQ(count(red), 0);

    ControlMesh inside = test::cube().mesh;
    for (std::size_t f = 0; f < inside.faces(); ++f)
        std::reverse(inside.face_vertices.begin() + inside.face_start[f],
                     inside.face_vertices.begin() + inside.face_start[f + 1]);
    m = drawn(inside, kWays[3]);
    s.curvature_max = 1;
    EXPECT_EQ(count(blue), 1);

    m = drawn(quad_grid(), kWays[0]);
    s = settings_for(m, View::Curvature);
    double const without = count(grey);
    EXPECT_GT(without, 0.3);
    EXPECT_LT(without, 0.95);
}

TEST(CurvatureView, IsRefusedOfADisplacedSurface)
{
    SchemeOnMesh const m = drawn(test::cube().mesh, kWays[0]);
    FrameSettings s = settings_for(m, View::Curvature);
    s.displacement = std::make_shared<Displacement>(Displacement::studs(0.2f, 0.02f));
    EXPECT_THROW(pixels(*m.patches, s), Error);
}

TEST(CurvatureView, IsRefusedWhereNoPatchHasOne)
{
    SchemeOnMesh const m = on("phong", load_model("spindle").mesh, {});
    EXPECT_THROW(pixels(*m.patches, settings_for(m, View::Curvature)), Error);
}

TEST(CurvatureView, ASchemeWithoutItSaysWhyAndWhichHaveIt)
{
    std::size_t refused = 0, taken = 0;
    for (auto const& scheme : schemes()) {
        SchemeInfo const info = scheme->info();
        if (info.no_curvature.empty()) {
            EXPECT_NO_THROW(check_curvature(info));
            ++taken;
            continue;
        }
        try {
            check_curvature(info);
            ADD_FAILURE() << info.name;
        } catch (Error const& e) {
            std::string const what = e.what();
            EXPECT_EQ(what.find(info.name), 0u) << what;
            EXPECT_NE(what.find(info.no_curvature), std::string::npos) << what;
            EXPECT_NE(what.find("stam"), std::string::npos) << what;
            ++refused;
        }
    }
    EXPECT_GE(taken, 1u);
    EXPECT_GE(refused, 5u);
}

} // namespace
} // namespace tessemu
