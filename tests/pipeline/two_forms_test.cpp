// The stencil and the two-stage form of the Gregory scheme give the same picture but for samples
// that lie on an edge as far as 16.8 fixed point can tell.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/builtin_models.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace tessemu {
namespace {

constexpr int kSize = 512;

struct Point {
    double x, y;
};
struct Edge {
    Point a, b;
};

// The surface in pixels, not snapped.
struct OnScreen {
    std::vector<Edge> edges; ///< of all triangles
    std::map<MeshPoint, Point> points;
    double least_w = INFINITY, reach = 0; ///< the largest |x/w| and |y/w|
};

OnScreen on_screen(PatchMesh const& patches, FrameSettings const& s)
{
    OnScreen out;
    CommandOptions options;
    options.visit = [&](SurfacePatch const& p) {
        auto const at = [&](std::uint32_t i) -> Point {
            std::vector<float> const v = p.scalars(i);
            double const w = double(v[3]), x = double(v[0]) / w, y = double(v[1]) / w;
            out.least_w = std::min(out.least_w, w);
            out.reach = std::max({out.reach, std::abs(x), std::abs(y)});
            return {(x + 1) * kSize / 2, (1 - y) * kSize / 2};
        };
        auto const& index = p.triangles();
        for (std::size_t t = 0; t + 2 < index.size(); t += 3)
            for (std::size_t k = 0; k < 3; ++k)
                out.edges.push_back({at(index[t + k]), at(index[t + (k + 1) % 3])});
        TessellatedPatch const& tess = p.domain().patch;
        for (std::uint32_t i = 0; i < tess.points(); ++i)
            out.points[mesh_point(patches.mesh().base(), p.place(), tess.u[i], tess.v[i])] = at(i);
    };
    run_commands(frame_commands(patches, s, seen_surface(s)), ThreadPool(2), options);
    return out;
}

// The other form's point of a name.
struct Namesake {
    Point at;
    bool exact; ///< else it is the nearest one
};

// The forms begin a triangle at different corners, and the tessellator rounds the points inside it
// to 1/65536 from where it begins: there the nearest is meant, which is nearer by far than the next
// one, a step of 2/3 of a 9th away.
Namesake namesake(OnScreen const& surface, MeshPoint const& name, ControlMesh const& mesh)
{
    if (auto const found = surface.points.find(name); found != surface.points.end())
        return {found->second, true};
    EXPECT_TRUE(name.kind == MeshPoint::Kind::Face && mesh.face(name.a).size() == 3);
    auto const distance = [](std::uint32_t x, std::uint32_t y) { return x < y ? y - x : x - y; };
    Point out{};
    std::uint32_t nearest = MeshPoint::kOne;
    for (auto p = surface.points.lower_bound({name.kind, name.a, name.b, 0, 0});
         p != surface.points.end() && p->first.a == name.a && p->first.b == name.b; ++p) {
        std::uint32_t const d =
            std::max(distance(p->first.s, name.s), distance(p->first.t, name.t));
        if (d < nearest) nearest = d, out = p->second;
    }
    EXPECT_LT(nearest, MeshPoint::kOne / 27 / 8);
    return {out, false};
}

// How far apart rounding alone may put the forms' points of one name, in pixels.
//
// Where no path from an input to a result meets more than K roundings, sums and products of floats
// err by at most K u / (1 - K u) times the result of the same sums and products of magnitudes, u =
// 2^-24. Of a mesh whose largest coordinate is L the magnitudes are, in units of L and for valences
// from 3 on (docs/math/loop09.md, 2 and 4; |C|, |cos|, |sin| <= 1, lambda < .66, d >= 3):
//
//     two-stage form                               magnitude    K
//     m, c                                                1    5: 3 sums, 1/3, a product
//     A, B        2 (1 - sigma cos(pi/n)) + 4 sigma   < 3.5   37: a weight, a product, 30 sums
//       boundary  with x = 4c - v - d - d', which is 7 <= 4   39
//     p                                                   1   38
//     e           1 + 2/3 lambda sqrt(2) 3.5          < 3.2   43: a weight, a product, 2 sums
//       boundary  1 + (1 + 4)/3
//     r           2; of a boundary edge 4              <= 4    9
//     f           [ p + (d + 3) e + 2 e + r ] / d    < 10.3   52: d - 2C - C' has 3, then 6
//
// so less than 11 through at most 52 roundings. A stencil's weights are these trees with equal
// inputs gathered, which makes no magnitude larger; 32 inputs meet 33 roundings. Each form then
// takes sums with weights that are not negative and add up to 1, through at most 24 roundings
// (tests/shaders_cpp/gregory_golden_test.cpp), and a row of the camera's matrix, through 4. That is
// 52 + 33 + 2 24 + 2 4 of both forms together, and 1 more for what is of second order.
double rounding_in_pixels(ControlMesh const& mesh, Camera const& camera,
                          OnScreen const (&surface)[2])
{
    double largest = 0;
    for (glm::vec3 const& p : mesh.positions)
        for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(double(p[k])));
    Matrix4 const matrix = view_projection(camera, 1);
    auto const of_row = [&](std::size_t i) {
        auto const magnitude = [&](std::size_t k) { return std::abs(double(matrix[i][k])); };
        return 0x1p-24 * ((52 + 33 + 2 * 24 + 2 * 4 + 1) * 11 * largest *
                              (magnitude(0) + magnitude(1) + magnitude(2)) +
                          2 * 4 * magnitude(3));
    };
    // x/w - x'/w' = ((x - x') - x'/w' (w - w')) / w
    double const w = std::min(surface[0].least_w, surface[1].least_w),
                 reach = std::max(surface[0].reach, surface[1].reach);
    auto const in_pixels = [&](std::size_t axis) {
        return kSize / 2 * (of_row(axis) + reach * of_row(3)) / w;
    };
    return std::hypot(in_pixels(0), in_pixels(1));
}

double distance(Point p, Edge const& e)
{
    double const dx = e.b.x - e.a.x, dy = e.b.y - e.a.y, length = dx * dx + dy * dy;
    double const t =
        length > 0 ? std::clamp(((p.x - e.a.x) * dx + (p.y - e.a.y) * dy) / length, 0.0, 1.0) : 0;
    return std::hypot(p.x - e.a.x - t * dx, p.y - e.a.y - t * dy);
}

struct Difference {
    int samples = 0;     ///< that are covered another number of times
    double apart = 0;    ///< the largest distance between points of exactly one name, in pixels
    double rounding = 0; ///< what rounding alone may make of it
};

// Samples that differ in coverage: they lie on an edge as far as the rasterizer can tell. `lambda`
// is the two-stage form's.
//
// Such a sample lies between an edge as one form has it and the same edge of the other, or on one
// of them, and so not farther from either form's edge than its vertices are moved: by snapping to
// 1/256 pixel, 1/512 along each axis; before it by the viewport's roundings, three of numbers up to
// 256 and one of a number up to 512; and by what the forms' vertices are apart. That is measured:
// forms with equal parameters are to be held to `rounding`, others are apart on purpose.
Difference compare_forms(std::string const& model, float factor, std::string const& lambda = "1")
{
    CoverageCounts* counts[2];
    std::unique_ptr<Frame> frames[2];
    OnScreen surface[2];
    Difference out;
    double apart = 0; // of all points
    ThreadPool const threads(2);
    ControlMesh const mesh = load_model(model).mesh;
    Camera const camera = frame_points(mesh.positions, {0.5f, 0.4f, 1}, 1);
    for (int k = 0; k < 2; ++k) {
        BuildOptions options;
        if (k) options.set = {{"lambda", lambda}};
        SchemeOnMesh const m =
            build_scheme(find_scheme(k ? "gregory-two-stage" : "gregory-stencil"), mesh, options);
        FrameSettings s;
        s.tess_factor = factor;
        s.width = s.height = kSize;
        s.view = View::Coverage;
        s.camera = camera;
        frames[k] = std::make_unique<Frame>(s);
        draw_frame(*m.patches, s, threads, *frames[k]);
        counts[k] = frames[k]->coverage.get();
        surface[k] = on_screen(*m.patches, s);
    }
    for (auto const& [name, p] : surface[0].points) {
        Namesake const q = namesake(surface[1], name, mesh);
        double const d = std::hypot(p.x - q.at.x, p.y - q.at.y);
        apart = std::max(apart, d);
        if (q.exact) out.apart = std::max(out.apart, d);
    }
    out.rounding = rounding_in_pixels(mesh, camera, surface);
    double const moved = std::sqrt(2.0) * (1.0 / 512 + (3 * 256 + 512) * 0x1p-24) + apart;
    int covered = 0;
    std::string where;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            std::uint32_t const a = counts[0]->at(x, y, 0), b = counts[1]->at(x, y, 0);
            covered += a != 0;
            if (a == b) continue;
            ++out.samples;
            double nearest = 1;
            for (Edge const& e : surface[0].edges)
                nearest = std::min(nearest, distance({x + 0.5, y + 0.5}, e));
            EXPECT_LE(nearest, moved) << model << ": pixel " << x << ", " << y << " is covered "
                                      << a << " and " << b << " times";
            where += fmt::format(" ({}, {}): {:.6f}", x, y, nearest);
        }
    std::string const key = std::filesystem::path(model).stem().string();
    testing::Test::RecordProperty(key + "_covered", covered);
    testing::Test::RecordProperty(key + "_differing", out.samples);
    testing::Test::RecordProperty(key + "_distance_to_an_edge", where);
    testing::Test::RecordProperty(key + "_apart_and_rounding",
                                  fmt::format("{} {}", out.apart, out.rounding));
    EXPECT_GT(covered, 0);
    return out;
}

// As docs/gregory.md says.
TEST(TwoForms, NoSampleOfABuiltInCageDiffersInCoverage)
{
    for (BuiltinModel const& model : builtin_models()) {
        Difference const d = compare_forms(std::string(model.name), 9);
        EXPECT_EQ(d.samples, 0) << model.name;
        EXPECT_LE(d.apart, d.rounding) << model.name;
    }
}

// Forms that are a little apart, so that some samples differ; and those that are not.
TEST(TwoForms, SamplesThatDifferInCoverageLieOnAnEdge)
{
    EXPECT_GT(compare_forms("jug", 9, "1.001").samples, 0);
    for (char const* model : {"bigguy", "monsterfrog"}) {
        std::string const file = std::string("models/") + model + ".obj";
        TESSEMU_NEEDS_SHARED(file);
        Difference const d = compare_forms(test::shared(file).string(), 9);
        EXPECT_LE(d.apart, d.rounding) << model;
    }
}

// The comparison sees a surface that is another one, by its points, which are farther apart than
// rounding takes them, and by its samples.
TEST(TwoForms, AnotherSurfaceDiffersInCoverage)
{
    Difference const d = compare_forms("jug", 9, "1.1");
    EXPECT_GT(d.apart, d.rounding);
    EXPECT_GT(d.samples, 0);
}

} // namespace
} // namespace tessemu
