// The stencil and the two-stage form of the Gregory scheme give the same picture but for samples
// that lie on an edge as far as 16.8 fixed point can tell.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/frame.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tessemu {
namespace {

constexpr int kSize = 512;

struct Point {
    double x, y;
};
struct Edge {
    Point a, b;
};

// All triangle edges in pixels, not snapped.
std::vector<Edge> screen_edges(PatchMesh const& patches, FrameSettings const& s)
{
    PassSettings settings;
    settings.tess_factor = s.tess_factor;
    settings.view_projection = view_projection(s.camera, 1);
    std::vector<Edge> out;
    for (DrawPass const& pass : patches.passes(settings)) {
        draw(
            pass.pipeline, pass.call, nullptr,
            [&](ShadedPatch const& p) {
                auto const at = [&](std::uint32_t i) -> Point {
                    double const w = double(p.outputs[3 * p.stride + i]);
                    return {(double(p.outputs[i]) / w + 1) * kSize / 2,
                            (1 - double(p.outputs[p.stride + i]) / w) * kSize / 2};
                };
                auto const& index = p.points->patch.indices;
                for (std::size_t t = 0; t + 2 < index.size(); t += 3)
                    for (std::size_t k = 0; k < 3; ++k)
                        out.push_back({at(index[t + k]), at(index[t + (k + 1) % 3])});
            },
            ThreadPool(2));
    }
    return out;
}

double distance(Point p, Edge const& e)
{
    double const dx = e.b.x - e.a.x, dy = e.b.y - e.a.y, length = dx * dx + dy * dy;
    double const t =
        length > 0 ? std::clamp(((p.x - e.a.x) * dx + (p.y - e.a.y) * dy) / length, 0.0, 1.0) : 0;
    return std::hypot(p.x - e.a.x - t * dx, p.y - e.a.y - t * dy);
}

// Pixels that differ in coverage. `lambda` is the two-stage form's.
int differing_pixels(std::string const& model, float factor, double lambda = 1)
{
    CoverageCounts* counts[2];
    std::unique_ptr<Frame> frames[2];
    std::vector<Edge> edges;
    ThreadPool const threads(2);
    for (int k = 0; k < 2; ++k) {
        Technique const& technique = find_technique(k ? "gregory-two-stage" : "gregory-stencil");
        PreparedMesh const mesh = prepare_mesh(load_model(model).mesh, technique);
        auto const patches = technique.build(*mesh.topology, {{"lambda", k ? lambda : 1}});
        FrameSettings s;
        s.tess_factor = factor;
        s.width = s.height = kSize;
        s.view = View::Coverage;
        s.camera = frame_points(mesh.mesh->positions, {0.5f, 0.4f, 1}, 1);
        frames[k] = std::make_unique<Frame>(s);
        draw_frame(*patches, s, threads, *frames[k]);
        counts[k] = frames[k]->coverage.get();
        auto const more = screen_edges(*patches, s);
        edges.insert(edges.end(), more.begin(), more.end());
    }
    int covered = 0, differing = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            std::uint32_t const a = counts[0]->at(x, y, 0), b = counts[1]->at(x, y, 0);
            covered += a != 0;
            if (a == b) continue;
            ++differing;
            if (lambda != 1) continue;
            double nearest = 1;
            for (Edge const& e : edges)
                nearest = std::min(nearest, distance({x + 0.5, y + 0.5}, e));
            std::printf("%s: pixel (%d, %d) is covered %u and %u times, an edge lies %.6f away\n",
                        model.c_str(), x, y, a, b, nearest);
            EXPECT_LE(nearest, 1.0 / 256);
        }
    std::printf("%s at %g: %d pixels, %d differ\n", model.c_str(), double(factor), covered,
                differing);
    EXPECT_GT(covered, 10000);
    return differing;
}

TEST(TwoForms, SamplesThatDifferInCoverageLieOnAnEdge)
{
    std::vector<std::string> models{"jug", "spindle", "saddle_star"};
    if (std::filesystem::exists(test::shared("models/bigguy.obj")))
        models.push_back(test::shared("models/bigguy.obj").string());
    for (std::string const& model : models) EXPECT_LT(differing_pixels(model, 9), 100) << model;
}

// The comparison sees a surface that is another one.
TEST(TwoForms, AnotherSurfaceDiffersInCoverage)
{
    EXPECT_GT(differing_pixels("jug", 9, 1.1), 50);
}

} // namespace
} // namespace tessemu
