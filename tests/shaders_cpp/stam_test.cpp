// Stam's evaluation against golden data, and what it costs.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/tally.h"
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/scheme.h"
#include "pipeline/schemes/stam/eigen.h"
#include "pipeline/schemes/stam/programs.h"
#include "tests/support/files.h"
#include "tests/support/machines.h"
#include "tests/support/shapes.h"
#include "tests/support/stam_evaluation.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace tessemu {
namespace {

using Json = nlohmann::json;

using test::Evaluation;

// How large the terms of a sum get: the formula with every number replaced by its size and every
// difference by a sum, in double. A result with L roundings on the way of any input is off by at
// most L u / (1 - L u) of it (Higham, Accuracy and Stability of Numerical Algorithms, 3.1).
struct Size {
    double position = 0, du = 0, dv = 0;
};
Size size_of_terms(StamEigen const& eigen, Json const& net, std::size_t coordinate, double u,
                   double v)
{
    struct Basis {
        double b[4], d[4];
        explicit Basis(double t)
        {
            double const s = 1 - t, ss = s * s, st = s * t, tt = t * t;
            double const B[4] = {ss * s, 3 * ss * t, 3 * tt * s, tt * t};
            double const D[4] = {3 * ss, 3 * ss + 6 * st, 6 * st + 3 * tt, 3 * tt};
            set(b, B);
            set(d, D);
        }
        static void set(double (&to)[4], double const (&x)[4])
        {
            to[0] = x[0] / 6;
            to[3] = x[3] / 6;
            to[1] = 2. / 3 * (x[0] + x[1]) + x[2] / 3 + to[3];
            to[2] = to[0] + x[1] / 3 + 2. / 3 * (x[2] + x[3]);
        }
    };
    StamRing<double> const at(u, v);
    Basis const A(at.a), B(at.b);
    auto const size = std::size_t(eigen.functions());
    std::vector<double> const& spline = eigen.splines[std::size_t(at.sub_patch)];
    Size out;
    for (std::size_t f = 0; f < size; ++f) {
        double C = 0, q[4] = {}, dq[4] = {};
        for (std::size_t p = 0; p < size; ++p)
            C += std::abs(eigen.inverse[f * size + p] * double(net[p][coordinate]));
        for (std::size_t c = 0; c < 4; ++c)
            for (std::size_t r = 0; r < 4; ++r) {
                double const x = std::abs(spline[(4 * c + r) * size + f]);
                q[c] += B.b[r] * x;
                dq[c] += B.d[r] * x;
            }
        auto const along = [&](double const(&x)[4]) {
            return x[1] + A.b[0] * (x[0] + x[1]) + A.b[2] * (x[2] + x[1]) + A.b[3] * (x[3] + x[1]);
        };
        double power = 1;
        for (int k = 0; k < at.k; ++k) power *= std::abs(eigen.eigenvalues[f]);
        out.position += power * along(q) * C;
        out.du += power * (A.d[0] * q[0] + A.d[1] * q[1] + A.d[2] * q[2] + A.d[3] * q[3]) * C;
        out.dv += power * along(dq) * C;
    }
    out.du *= at.scale;
    out.dv *= at.scale;
    return out;
}

template <class F> class StamOn : public testing::Test {
};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(StamOn, Scalars);

// Bounds. double: 1e-12, as the golden data were compared. float, u = 2^-24: on the way of an input
// are, for a point of the net, its own rounding, a product and up to K sums (K = 2n + 8); for an
// eigen function its rounding, the basis's 8 (3 of a Bernstein polynomial, 5 of the change of
// basis) and a product and 3 sums of the rows, a difference, the other basis's 8, a product and 3
// sums; the power, its product; the product of both and K sums: 2 K + 32 at most. The golden data's
// own error is below 1e-13.
TYPED_TEST(StamOn, AgreesWithGoldenData)
{
    using F = TypeParam;
    constexpr bool kDouble = sizeof(F) == 8;
    Json const j = Json::parse(test::read_text(test::golden("subdivision/stam.json")));
    std::size_t samples = 0;
    double worst = 0;
    for (Json const& net : j["nets"]) {
        int const n = net["n"];
        Evaluation<F> evaluation(n);
        evaluation.project(net["net"]);
        double const u = 0x1p-24, roundings = 2 * evaluation.eigen.functions() + 32,
                     unit = roundings * u / (1 - roundings * u);
        for (Json const& s : net["samples"]) {
            TangentFrame<F> const got = evaluation.at(s[0], s[1]);
            F const values[3][3] = {{got.position.x, got.position.y, got.position.z},
                                    {got.du.x, got.du.y, got.du.z},
                                    {got.dv.x, got.dv.y, got.dv.z}};
            for (std::size_t c = 0; c < 3; ++c) {
                Size const size = size_of_terms(evaluation.eigen, net["net"], c, s[0], s[1]);
                double const sizes[3] = {size.position, size.du, size.dv};
                for (std::size_t k = 0; k < 3; ++k) {
                    double const error = std::abs(double(values[k][c]) - double(s[2 + k][c]));
                    ASSERT_LE(error, kDouble ? 1e-12 : unit * sizes[k] + 1e-13)
                        << "valence " << n << " at " << s[0] << " " << s[1] << ", value " << k
                        << ", coordinate " << c;
                    if (k == 0) worst = std::max(worst, error);
                }
            }
            ++samples;
        }
        TangentFrame<F> const corner = evaluation.at(0, 0);
        float3<F> const normal = unit_or_zero(cross(corner.du, corner.dv));
        F const at[3] = {corner.position.x, corner.position.y, corner.position.z},
                turned[3] = {normal.x, normal.y, normal.z};
        // Sums of K products. A normal turns by what a tangent is off, over its length, for both
        // tangents, over the sine of the angle between them; a cross product and a length have 8
        // roundings.
        double off[3] = {}, length[3] = {};
        std::array<double, 3> const vectors[3] = {
            {double(at[0]), double(at[1]), double(at[2])},
            {double(corner.du.x), double(corner.du.y), double(corner.du.z)},
            {double(corner.dv.x), double(corner.dv.y), double(corner.dv.z)}};
        auto const size = std::size_t(evaluation.eigen.functions());
        for (std::size_t f = 0; f < 3; ++f) {
            for (std::size_t c = 0; c < 3; ++c) {
                double sum = 0;
                for (std::size_t p = 0; p < size; ++p)
                    sum +=
                        std::abs(evaluation.eigen.inverse[f * size + p] * double(net["net"][p][c]));
                off[f] += sum * sum;
                length[f] += vectors[f][c] * vectors[f][c];
            }
            off[f] = double(size + 2) * u * std::sqrt(off[f]);
            length[f] = std::sqrt(length[f]);
        }
        float3<F> const across = cross(corner.du, corner.dv);
        double const sine = std::sqrt(double(dot(across, across))) / (length[1] * length[2]);
        double const turn = (off[1] / length[1] + off[2] / length[2]) / sine + 8 * u;
        for (std::size_t c = 0; c < 3; ++c) {
            EXPECT_NEAR(double(at[c]), double(net["corner_pos"][c]), kDouble ? 1e-12 : off[0]);
            EXPECT_NEAR(double(turned[c]), double(net["corner_normal"][c]), kDouble ? 1e-12 : turn);
        }
    }
    EXPECT_EQ(samples, 120u);
    this->RecordProperty("worst_position", std::to_string(worst * 1e9) + "e-9");
}

TEST(StamEigen, ValuesAreThoseOfTheGoldenData)
{
    Json const j = Json::parse(test::read_text(test::golden("subdivision/stam.json")));
    for (Json const& net : j["nets"]) {
        std::vector<double> mine = stam_eigen(net["n"]).eigenvalues;
        std::sort(mine.rbegin(), mine.rend());
        Json const& golden = net["eigenvalues_descending"];
        ASSERT_EQ(mine.size(), golden.size());
        // Theirs come from a numeric routine, to which the 0 of valence 3 is 1e-16.
        for (std::size_t i = 0; i < mine.size(); ++i)
            EXPECT_NEAR(mine[i], double(golden[i]), 1e-14) << net["n"] << ", eigenvalue " << i;
    }
    StamEigen const three = stam_eigen(3);
    EXPECT_EQ(std::count(three.eigenvalues.begin(), three.eigenvalues.end(), 0.0), 1);
}

// Far beyond the paper's valences too: V^-1 is V's inverse where the functions' coefficients times
// the projected net give the net's own subdivision. A net of one point 1 and all others 0 has the
// fine points of the subdivision's masks.
TEST(StamEigen, AStepOfAnyValenceIsTheMasks)
{
    for (int n : {3, 4, 5, 6, 7, 8, 11, 12, 13, 16, 31, 64}) {
        StamEigen const e = stam_eigen(n);
        auto const size = std::size_t(e.functions());
        // The fine net's EV, e_0 and f_0 are points (0,0), (1,0) and (1,1) of sub-patch 1.
        struct {
            std::size_t cell;
            std::map<int, double> mask;
        } rows[3];
        rows[0].cell = 0;
        rows[0].mask[0] = 1 - 7 / (4.0 * n);
        for (int i = 0; i < n; ++i) {
            rows[0].mask[1 + 2 * i] = 3 / (2.0 * n * n);
            rows[0].mask[2 + 2 * i] = 1 / (4.0 * n * n);
        }
        auto const at = [&](int x, int y) { return stam_net_point(n, x, y); };
        rows[1].cell = 4;
        rows[1].mask = {{at(0, 0), 3. / 8}, {at(1, 0), 3. / 8}};
        for (int p : {at(0, 1), at(1, 1), at(0, -1), at(1, -1)}) rows[1].mask[p] = 1. / 16;
        rows[2].cell = 5;
        rows[2].mask = {{at(0, 0), .25}, {at(1, 0), .25}, {at(0, 1), .25}, {at(1, 1), .25}};
        for (auto const& row : rows)
            for (std::size_t p = 0; p < size; ++p) {
                double sum = 0;
                for (std::size_t f = 0; f < size; ++f)
                    sum += e.splines[1][row.cell * size + f] * e.inverse[f * size + p];
                auto const mask = row.mask.find(int(p));
                ASSERT_NEAR(sum, mask == row.mask.end() ? 0 : mask->second, 1e-12)
                    << "valence " << n << ", fine point " << row.cell << ", point " << p;
            }
    }
}

// (u,v) on a line between two rings or two sub-patches belongs to one of them; 16.16 fixed point
// has 17 rings.
TEST(StamRing, IsTheLargestPowerThatFits)
{
    for (int k = 0; k <= 16; ++k) {
        StamRing<float> const at(std::ldexp(1.0f, -k), 0);
        EXPECT_EQ(at.k, k);
        EXPECT_EQ(at.sub_patch, 0);
        EXPECT_EQ(at.a, 1);
        EXPECT_EQ(at.b, 0);
        if (k == 16) continue;
        StamRing<float> const within(std::ldexp(1.0f, -k) - 0x1p-16f * (k < 15),
                                     std::ldexp(0.75f, -k));
        EXPECT_EQ(within.k, k);
        EXPECT_EQ(within.sub_patch, 1);
        EXPECT_EQ(within.b, 0.5f);
    }
    StamRing<float> const above(0.25f, 1);
    EXPECT_EQ(above.sub_patch, 2);
    EXPECT_EQ(above.a, 0.5f);
    EXPECT_EQ(above.b, 1);
}

struct Cost {
    FlopCount flops;
    std::uint64_t control_points = 0;
};

Cost evaluation_cost(Evaluation<float> const& e, double u, double v)
{
    Cost c;
    StamPointsInside const inside{e.tables()};
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<ControlVertex<Tally>> const net(sink, e.eigen.functions(), &c.control_points);
        TangentFrame<Tally> const s =
            inside.evaluate<Tally>(net, {Tally(u, sink), Tally(v, sink), Tally(0), 0}, false);
        (void)cross(s.du, s.dv);
    });
    return c;
}

// LOOP10 estimates 108n + 534 = 54 (2n + 8) + 102.
TEST(StamQuad, Costs54MultiplicationsAFunction)
{
    for (int n = 3; n <= 12; ++n) {
        Evaluation<float> const e(n);
        for (auto [u, v] : {std::pair{0.75, 0.25}, {0.75, 0.75}, {0.25, 0.75}, {0.01, 0.001}}) {
            Cost const c = evaluation_cost(e, u, v);
            EXPECT_EQ(flops_loop10(c.flops), std::uint64_t(54 * (2 * n + 8) + 67)) << n;
            EXPECT_EQ(c.flops.div + c.flops.sqrt, 0u);
            EXPECT_EQ(c.control_points, std::uint64_t(2 * n + 8));
        }
        EXPECT_EQ(flops_loop10(evaluation_cost(e, 0, 0).flops), 6u); // the cross product
    }
}

StageStatistics const& stage(DrawStatistics const& s, std::string const& name)
{
    for (StageStatistics const& x : s.stages)
        if (x.stage == name) return x;
    throw std::runtime_error("no stage " + name);
}

// 2n + 8 threads of 6n + 24; and the domain shader's tally at each point.
TEST(StamQuad, RunTimeCountsAreThePapersAndTheTallys)
{
    std::map<std::size_t, std::size_t> valences;
    for (ControlMesh const& mesh :
         {load_model("spindle").mesh, load_model("jug").mesh, test::trapezohedron(12).mesh}) {
        SchemeOnMesh const on = build_scheme(find_scheme("stam"), mesh);
        for (Machine const& machine : test::machines()) {
            SurfaceSettings settings;
            settings.tess_factor = 5.3f;
            settings.machine = machine;
            CommandList const list = on.patches->commands(settings);
            for (Command const& command : list.commands)
                if (Dispatch const* const d = std::get_if<Dispatch>(&command))
                    dispatch(d->shader, d->groups, ThreadPool(1));
            list.for_each_surface_draw([&](Draw const& d) {
                if (d.kind.name.find("Stam") != 0) return;
                auto const functions = std::size_t(d.pipeline.input_control_points);
                Evaluation<float> const e(int(functions - 8) / 2);
                FlopCount expected;
                std::uint64_t control_points = 0;
                std::map<std::pair<float, float>, Cost> known; // all patches have one pattern
                auto const visit = [&](ShadedPatch const& p) {
                    for (std::size_t i = 0; i < p.points->patch.points(); ++i) {
                        float const u = p.points->u[i], v = p.points->v[i];
                        auto const [at, fresh] = known.try_emplace({u, v});
                        Cost& c = at->second;
                        if (fresh)
                            c.flops = tally([&](FlopCount* sink) {
                                ControlPoints<ControlVertex<Tally>> const net(sink, int(functions),
                                                                              &c.control_points);
                                ControlPoints<ControlVertex<Tally>> const none(sink, 0);
                                DomainInput<Tally> const in{Tally(double(u), sink),
                                                            Tally(double(v), sink), Tally(0), 0};
                                StamPointsDomainShader const shader{{e.tables()}};
                                (void)ProjectionEpilog{}(in, shader(in, net, none));
                            });
                        expected += c.flops;
                        control_points += c.control_points;
                    }
                };
                DrawStatistics const s =
                    draw(GraphicsPipeline(d.pipeline), d.call, nullptr, visit, ThreadPool(2));
                std::string const what = d.kind.name + ", " + testing::PrintToString(machine);
                EXPECT_EQ(stage(s, "hull_shader").flops.mul,
                          d.patches.size() * functions * 3 * functions)
                    << what;
                EXPECT_EQ(stage(s, "domain_shader").flops, expected) << what;
                for (FetchStatistics const& f : stage(s, "domain_shader").fetches)
                    if (f.resource == "control_points") {
                        EXPECT_EQ(f.count, control_points) << what;
                    }
                ++valences[(functions - 8) / 2];
            });
        }
    }
    for (std::size_t n : {3, 5, 6, 7, 8, 12}) EXPECT_GT(valences[n], 0u) << "valence " << n;
}

} // namespace
} // namespace tessemu
