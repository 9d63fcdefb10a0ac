// Biseptic patches against golden data, the conditions that their basis is derived from, and what
// they cost.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/tally.h"
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/biseptic/basis.h"
#include "pipeline/schemes/biseptic/programs.h"
#include "pipeline/schemes/scheme.h"
#include "pipeline/schemes/stam/eigen.h"
#include "tests/support/biseptic_evaluation.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"
#include "tests/support/machines.h"
#include "tests/support/printed.h"
#include "tests/support/shapes.h"
#include "tests/support/vertex_neighbourhood.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace tessemu {
namespace {

using Json = nlohmann::json;
using Frame = SecondOrderFrame<double>;

Json golden_basis()
{
    return Json::parse(test::read_gzip(test::golden("subdivision/biseptic_basis.json.gz")));
}

glm::dvec3 vec(float3<double> const& v)
{
    return {v.x, v.y, v.z};
}

// The B-spline of a grid's 16 points.
Frame bspline_at(std::vector<std::array<double, 3>> const& grid, double u, double v)
{
    struct Point {
        float3<double> position;
    };
    std::vector<Point> points;
    for (auto const& p : grid) points.push_back({{p[0], p[1], p[2]}});
    return bspline_quad<double, SecondOrderBsplineBasis<double>>(points, u, v);
}

// Mean and Gaussian curvature.
std::pair<double, double> curvatures(Frame const& s)
{
    glm::dvec3 const du = vec(s.du), dv = vec(s.dv), n = normalize(cross(du, dv));
    double const E = dot(du, du), F = dot(du, dv), G = dot(dv, dv), L = -dot(n, vec(s.duu)),
                 M = -dot(n, vec(s.duv)), N = -dot(n, vec(s.dvv)), d = E * G - F * F;
    return {(E * N - 2 * F * M + G * L) / (2 * d), (L * N - M * M) / d};
}

TEST(BisepticBasis, IsTheGoldenFiles)
{
    Json const golden = golden_basis();
    std::size_t weights = 0;
    for (auto const& [name, j] : golden["valences"].items()) {
        BisepticBasis const basis(std::stoi(name));
        for (int i = 0; i < kBisepticSide; ++i)
            for (int k = 0; k < kBisepticSide; ++k) {
                Json const& row = j["matrix"][std::size_t(kBisepticSide * i + k)];
                ASSERT_EQ(row.size(), std::size_t(basis.points()));
                for (std::size_t p = 0; p < row.size(); ++p, ++weights)
                    ASSERT_NEAR(basis.weights(i, k)[p], double(row[p]), 1e-12)
                        << "valence " << name << ", point " << i << " " << k << ", weight " << p;
            }
    }
    EXPECT_EQ(weights, 64u * 230);
}

// 31 additions of weights below 1 round by 31 2^-53 at most.
TEST(BisepticBasis, WeightsAddUpToOne)
{
    for (int n = kMinBisepticValence; n <= kMaxBisepticValence; ++n) {
        BisepticBasis const basis(n);
        for (int i = 0; i < kBisepticSide; ++i)
            for (int j = 0; j < kBisepticSide; ++j) {
                double sum = 0;
                for (double w : basis.weights(i, j)) sum += w;
                EXPECT_NEAR(sum, 1, 2 * 31 * 0x1p-53) << n << ": " << i << " " << j;
            }
    }
}

// To the bit: what the two patches at a spoke must agree on.
TEST(BisepticBasis, BothPatchesAtASpokeGiveItsPointsTheSameWeights)
{
    for (int n = kMinBisepticValence; n <= kMaxBisepticValence; ++n) {
        BisepticBasis const basis(n);
        std::vector<int> const own = basis.spoke(), next = basis.next_spoke();
        ASSERT_EQ(own.size(), std::size_t(2 * n + 4));
        ASSERT_EQ(next.size(), own.size());
        for (int i = 0; i < kBisepticSide; ++i) {
            double elsewhere = 0; // |weights| of points that the spoke does not depend on
            for (std::size_t p = 0; p < std::size_t(basis.points()); ++p) {
                bool const here = std::find(own.begin(), own.end(), int(p)) != own.end();
                if (here) continue;
                elsewhere += std::abs(basis.weights(i, 0)[p]) + std::abs(basis.weights(i, 1)[p]);
            }
            EXPECT_EQ(elsewhere, 0) << n << ": " << i;
            for (std::size_t k = 0; k < own.size(); ++k)
                EXPECT_EQ(basis.weights(i, 0)[std::size_t(own[k])],
                          basis.weights(0, i)[std::size_t(next[k])])
                    << n << ": " << i << " " << k;
        }
    }
}

// Of valence 4 it is the bicubic B-spline itself, but for the stored weights' error, 1e-13: sums of
// 16 of them with points of size 3 are off by less than 1e-12 / 2, derivatives by 14 times it.
TEST(BisepticBasis, OfFourEdgesIsTheBspline)
{
    test::VertexNeighbourhood const around(4, 7);
    for (int patch = 0; patch < 4; ++patch) {
        auto const net = around.net(patch);
        test::BisepticEvaluation<double> const biseptic(4, net);
        std::vector<std::array<double, 3>> grid;
        for (int x = -1; x <= 2; ++x)
            for (int y = -1; y <= 2; ++y) grid.push_back(net[std::size_t(stam_net_point(4, x, y))]);
        for (double u : {0.0, 0.25, 0.7, 1.0})
            for (double v : {0.0, 0.5, 0.9, 1.0}) {
                Frame const a = biseptic.second_order_at(u, v), b = bspline_at(grid, u, v);
                EXPECT_LE(length(vec(a.position) - vec(b.position)), 1e-12);
                EXPECT_LE(length(vec(a.du) - vec(b.du)), 1e-11);
                EXPECT_LE(length(vec(a.dv) - vec(b.dv)), 1e-11);
            }
    }
}

template <class F> class BisepticOn : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(BisepticOn, Scalars);

// double: 1e-12, as the golden data were compared; derivatives are 7 differences of sizes up to 2,
// which is 14 times it. float, u = 2^-24: on the way of an input are its own and its weight's
// rounding, a product and K sums (K = 2n + 8); 14 roundings of each basis, a product and 8 sums for
// each: at most K + 51, and one more for a difference, of terms whose weights' sizes, some of them
// negative, add up to 1.2 at most.
TYPED_TEST(BisepticOn, AgreesWithGoldenSamples)
{
    using F = TypeParam;
    constexpr bool kDouble = sizeof(F) == 8;
    Json const nets = Json::parse(test::read_text(test::golden("subdivision/stam.json")));
    Json const golden = golden_basis();
    std::size_t samples = 0;
    for (Json const& j : nets["nets"]) {
        int const n = j["n"];
        double largest = 0;
        for (Json const& p : j["net"])
            for (double x : p) largest = std::max(largest, std::abs(x));
        double const unit = 1.2 * largest * (2 * n + 8 + 52) * 0x1p-24;
        test::BisepticEvaluation<F> const biseptic(n, j["net"]);
        for (Json const& s : golden["valences"][std::to_string(n)]["samples_on_stam_net"]) {
            TangentFrame<F> const got = biseptic.at(s[0], s[1]);
            F const values[3][3] = {{got.position.x, got.position.y, got.position.z},
                                    {got.du.x, got.du.y, got.du.z},
                                    {got.dv.x, got.dv.y, got.dv.z}};
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t c = 0; c < 3; ++c) {
                    double const scale = k == 0 ? 1 : 7; // a seventh of the derivatives
                    double const tolerance = (k == 0 ? 1 : 2) * (kDouble ? 1e-12 : unit);
                    EXPECT_NEAR(double(values[k][c]), double(s[2 + k][c]) / scale, tolerance)
                        << "valence " << n << " at " << s[0] << " " << s[1] << ", value " << k;
                }
            ++samples;
        }
    }
    EXPECT_EQ(samples, 60u);
}

using Patches = std::vector<test::BisepticEvaluation<double>>;

Patches patches_around(test::VertexNeighbourhood const& around, int n)
{
    Patches out;
    for (int i = 0; i < n; ++i) out.emplace_back(n, around.net(i));
    return out;
}
// Of the two patches at spoke i.
std::pair<Frame, Frame> at_spoke(Patches const& patches, std::size_t i, double t)
{
    std::size_t const n = patches.size();
    return {patches[i].second_order_at(t, 0), patches[(i + n - 1) % n].second_order_at(0, t)};
}

// With two derivatives to the bicubics outside, with one tangent plane across spokes, with one
// curvature at the vertex. Weights are 1e-13 from the equations' solution; 1e-12 is left for sums of
// them, times 7 * 6 = 42 for second derivatives, 1e-11 where these make a curvature. On spokes both
// patches have the same weights and add them up in two orders: 32 additions of 2^-53 are below 1e-13.
TEST(BisepticQuad, MeetsItsConditions)
{
    for (int n = kMinBisepticValence; n <= kMaxBisepticValence; ++n) {
        test::VertexNeighbourhood const around(n, unsigned(n));
        Patches const patches = patches_around(around, n);
        auto const [H0, K0] = curvatures(patches[0].second_order_at(0, 0));
        for (std::size_t i = 0; i < patches.size(); ++i) {
            // The bicubic beyond edge 1 has the columns x = 0 to 3 of the grid, of which the last
            // does not count on the edge: any will do.
            auto const net = around.net(int(i));
            std::vector<std::array<double, 3>> grid;
            for (int x = 0; x <= 2; ++x)
                for (int y = -1; y <= 2; ++y)
                    grid.push_back(net[std::size_t(stam_net_point(n, x, y))]);
            for (int y = 0; y < 4; ++y) grid.push_back({1, 2, 3});
            for (double v : {0.0, 0.3, 0.8, 1.0}) {
                Frame const a = patches[i].second_order_at(1, v), b = bspline_at(grid, 0, v);
                for (auto d : {&Frame::position, &Frame::du, &Frame::dv, &Frame::duu, &Frame::duv,
                               &Frame::dvv})
                    EXPECT_LE(length(vec(a.*d) - vec(b.*d)), 1e-12 * 42) << n << ": " << v;
            }
            for (int k = 0; k <= 16; ++k) {
                auto const [a, b] = at_spoke(patches, i, k / 16.0);
                EXPECT_LE(length(vec(a.position) - vec(b.position)), 1e-13) << n;
                glm::dvec3 const na = normalize(cross(vec(a.du), vec(a.dv))),
                                 nb = normalize(cross(vec(b.du), vec(b.dv)));
                EXPECT_LE(length(cross(na, nb)), 1e-12) << n << ": " << k;
            }
            auto const [H, K] = curvatures(patches[i].second_order_at(0, 0));
            EXPECT_NEAR(H, H0, 1e-11) << n << ", patch " << i;
            EXPECT_NEAR(K, K0, 1e-11) << n << ", patch " << i;
        }
    }
}

// What the conditions cannot have at once: the last column of the page's table, which is the script's
// that made the weights.
TEST(BisepticQuad, HasAsNearlyOneCurvatureAcrossSpokesAsThePageSays)
{
    auto const largest_of = [](Frame const& f) { // of the principal curvatures
        auto const [H, K] = curvatures(f);
        return std::abs(H) + std::sqrt(std::max(H * H - K, 0.0));
    };
    int valences = 0;
    for (auto const& cells : test::table_of("docs/math/subdivision.md", "| n | alpha | b0 | w |")) {
        int const n = std::stoi(cells.at(0));
        test::VertexNeighbourhood const saddle(n, [](double x, double y) {
            return test::VertexNeighbourhood::Point{x, y, 0.3 * x * x - 0.1 * y * y};
        });
        Patches const patches = patches_around(saddle, n);
        double largest = 0, jump = 0;
        for (std::size_t i = 0; i < patches.size(); ++i)
            for (int k = 0; k <= 40; ++k) {
                auto const [a, b] = at_spoke(patches, i, k / 40.0);
                largest = std::max({largest, largest_of(a),
                                    largest_of(patches[i].second_order_at(k / 40.0, k / 40.0))});
                jump = std::max(jump, std::abs(curvatures(a).first - curvatures(b).first));
            }
        if (n == 4)
            EXPECT_LE(jump / largest, 1e-11);
        else
            EXPECT_TRUE(test::printed(cells.at(4)).rounds_from(jump / largest))
                << n << ": " << jump / largest << " is not " << cells.at(4);
        ++valences;
    }
    EXPECT_EQ(valences, kMaxBisepticValence - kMinBisepticValence + 1);
}

struct Cost {
    FlopCount flops;
    std::uint64_t control_points = 0;
};

// LOOP10's 568 have no cross product, its 162 of a bicubic have.
TEST(BisepticQuad, Costs568Multiplications)
{
    Cost c;
    auto const patch = [&](FlopCount* sink) {
        ControlPoints<PackedPoints<2, Tally>> const points(sink, BisepticInside::kControlPoints,
                                                           &c.control_points);
        return BisepticInside::evaluate<Tally>(
            points, {Tally(0.3, sink), Tally(0.6, sink), Tally(0), 0}, false);
    };
    c.flops = tally([&](FlopCount* sink) { (void)patch(sink); });
    EXPECT_EQ(flops_loop10(c.flops), 568u);
    EXPECT_EQ(c.control_points, 64u);
    FlopCount const with_normal = tally([&](FlopCount* sink) {
        TangentFrame<Tally> const s = patch(sink);
        (void)cross(s.du, s.dv);
    });
    EXPECT_EQ(flops_loop10(with_normal), 574u);
}

StageStatistics const& stage(DrawStatistics const& s, std::string const& name)
{
    for (StageStatistics const& x : s.stages)
        if (x.stage == name) return x;
    throw std::runtime_error("no stage " + name);
}

// 32 threads of two rows of 2n + 8 terms, 12n + 48 each; and the domain shader's tally.
TEST(BisepticQuad, RunTimeCountsAreThePapersAndTheTallys)
{
    FlopCount const point = tally([&](FlopCount* sink) {
        ControlPoints<PackedPoints<2, Tally>> const points(sink, BisepticInside::kControlPoints);
        ControlPoints<ControlVertex<Tally>> const none(sink, 0);
        DomainInput<Tally> const in{Tally(0.3, sink), Tally(0.6, sink), Tally(0), 0};
        (void)ProjectionEpilog{}(in, BisepticDomainShader{}(in, points, none));
    });
    std::set<std::size_t> valences;
    for (ControlMesh const& mesh :
         {load_model("spindle").mesh, load_model("jug").mesh, test::trapezohedron(12).mesh}) {
        SchemeOnMesh const on = build_scheme(find_scheme("biseptic"), mesh);
        for (Machine const& machine : test::machines()) {
            SurfaceSettings settings;
            settings.tess_factor = 5.3f;
            settings.machine = machine;
            CommandList const list = on.patches->commands(settings);
            for (Command const& command : list.commands)
                if (Dispatch const* const d = std::get_if<Dispatch>(&command))
                    dispatch(d->shader, d->groups, ThreadPool(1));
            list.for_each_surface_draw([&](Draw const& d) {
                if (d.kind.name.find("biseptic") != 0) return;
                auto const inputs = std::uint64_t(d.pipeline.input_control_points);
                DrawStatistics const s =
                    draw(GraphicsPipeline(d.pipeline), d.call, nullptr, {}, ThreadPool(2));
                std::string const what = d.kind.name + ", " + testing::PrintToString(machine);
                std::uint64_t const n = (inputs - 8) / 2;
                EXPECT_EQ(s.pipeline.HSControlPointInvocations, d.patches.size() * 32) << what;
                EXPECT_EQ(flops_loop10(stage(s, "hull_shader").flops),
                          d.patches.size() * 32 * (12 * n + 48))
                    << what;
                EXPECT_EQ(stage(s, "domain_shader").flops, point * s.pipeline.DSInvocations)
                    << what;
                for (FetchStatistics const& f : stage(s, "domain_shader").fetches)
                    if (f.resource == "control_points") {
                        EXPECT_EQ(f.count, 64 * s.pipeline.DSInvocations) << what;
                    }
                valences.insert(std::size_t(n));
            });
        }
    }
    for (std::size_t n : {3, 5, 6, 7, 8, 12}) EXPECT_TRUE(valences.count(n)) << "valence " << n;
}

} // namespace
} // namespace tessemu
