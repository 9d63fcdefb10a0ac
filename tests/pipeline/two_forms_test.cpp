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
};

OnScreen on_screen(PatchMesh const& patches, FrameSettings const& s)
{
    OnScreen out;
    CommandOptions options;
    options.visit = [&](SurfacePatch const& p) {
        auto const at = [&](std::uint32_t i) -> Point {
            std::vector<float> const v = p.scalars(i);
            double const w = double(v[3]);
            return {(double(v[0]) / w + 1) * kSize / 2, (1 - double(v[1]) / w) * kSize / 2};
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

// The other form's point of a name. The forms begin a triangle at different corners, and the
// tessellator rounds the points inside it to 1/65536 from where it begins: there the nearest is
// meant, which is nearer by far than the next one, a step of 2/3 of a 9th away.
Point namesake(std::map<MeshPoint, Point> const& points, MeshPoint const& name)
{
    if (auto const found = points.find(name); found != points.end()) return found->second;
    EXPECT_EQ(name.kind, MeshPoint::Kind::Face);
    auto const distance = [](std::uint32_t x, std::uint32_t y) { return x < y ? y - x : x - y; };
    Point out{};
    std::uint32_t nearest = MeshPoint::kOne;
    for (auto p = points.lower_bound({name.kind, name.a, name.b, 0, 0});
         p != points.end() && p->first.a == name.a && p->first.b == name.b; ++p) {
        std::uint32_t const d =
            std::max(distance(p->first.s, name.s), distance(p->first.t, name.t));
        if (d < nearest) nearest = d, out = p->second;
    }
    EXPECT_LT(nearest, MeshPoint::kOne / 27 / 8);
    return out;
}

double distance(Point p, Edge const& e)
{
    double const dx = e.b.x - e.a.x, dy = e.b.y - e.a.y, length = dx * dx + dy * dy;
    double const t =
        length > 0 ? std::clamp(((p.x - e.a.x) * dx + (p.y - e.a.y) * dy) / length, 0.0, 1.0) : 0;
    return std::hypot(p.x - e.a.x - t * dx, p.y - e.a.y - t * dy);
}

// Pixels that differ in coverage: they lie on an edge as far as the rasterizer can tell. `lambda`
// is the two-stage form's.
//
// Such a sample lies between an edge as one form has it and the same edge of the other, or on one
// of them, and so not farther from either form's edge than its vertices are moved: by snapping to
// 1/256 pixel, 1/512 along each axis; before it by the viewport's roundings, three of numbers up to
// 256 and one of a number up to 512; and by what the forms' vertices are apart, which is measured.
int differing_pixels(std::string const& model, float factor, std::string const& lambda = "1")
{
    CoverageCounts* counts[2];
    std::unique_ptr<Frame> frames[2];
    OnScreen surface[2];
    ThreadPool const threads(2);
    for (int k = 0; k < 2; ++k) {
        BuildOptions options;
        if (k) options.set = {{"lambda", lambda}};
        SchemeOnMesh const m =
            build_scheme(find_scheme(k ? "gregory-two-stage" : "gregory-stencil"),
                         load_model(model).mesh, options);
        FrameSettings s;
        s.tess_factor = factor;
        s.width = s.height = kSize;
        s.view = View::Coverage;
        s.camera = frame_points(m.mesh->mesh().positions, {0.5f, 0.4f, 1}, 1);
        frames[k] = std::make_unique<Frame>(s);
        draw_frame(*m.patches, s, threads, *frames[k]);
        counts[k] = frames[k]->coverage.get();
        surface[k] = on_screen(*m.patches, s);
    }
    double apart = 0;
    for (auto const& [name, p] : surface[0].points) {
        Point const q = namesake(surface[1].points, name);
        apart = std::max(apart, std::hypot(p.x - q.x, p.y - q.y));
    }
    double const moved = std::sqrt(2.0) * (1.0 / 512 + (3 * 256 + 512) * 0x1p-24) + apart;
    int covered = 0, differing = 0;
    std::string where;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            std::uint32_t const a = counts[0]->at(x, y, 0), b = counts[1]->at(x, y, 0);
            covered += a != 0;
            if (a == b) continue;
            ++differing;
            double nearest = 1;
            for (Edge const& e : surface[0].edges)
                nearest = std::min(nearest, distance({x + 0.5, y + 0.5}, e));
            EXPECT_LE(nearest, moved) << model << ": pixel " << x << ", " << y << " is covered "
                                      << a << " and " << b << " times";
            where += fmt::format(" ({}, {}): {:.6f}", x, y, nearest);
        }
    std::string const key = std::filesystem::path(model).stem().string();
    testing::Test::RecordProperty(key + "_covered", covered);
    testing::Test::RecordProperty(key + "_differing", differing);
    testing::Test::RecordProperty(key + "_distance_to_an_edge", where);
    EXPECT_GT(covered, 10000);
    return differing;
}

// As docs/gregory.md says.
TEST(TwoForms, NoSampleOfABuiltInCageDiffersInCoverage)
{
    for (BuiltinModel const& model : builtin_models())
        EXPECT_EQ(differing_pixels(std::string(model.name), 9), 0) << model.name;
}

// Forms that are a little apart, so that some samples differ; and those that are not.
TEST(TwoForms, SamplesThatDifferInCoverageLieOnAnEdge)
{
    EXPECT_GT(differing_pixels("jug", 9, "1.001"), 0);
    for (char const* model : {"bigguy", "monsterfrog"}) {
        std::string const file = std::string("models/") + model + ".obj";
        TESSEMU_NEEDS_SHARED(file);
        differing_pixels(test::shared(file).string(), 9);
    }
}

// The comparison sees a surface that is another one.
TEST(TwoForms, AnotherSurfaceDiffersInCoverage)
{
    EXPECT_GT(differing_pixels("jug", 9, "1.1"), 50);
}

} // namespace
} // namespace tessemu
