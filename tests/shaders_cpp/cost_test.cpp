// Costs of the shaders: compile-time tallies against the papers' numbers and against run-time
// counts.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/tally.h"
#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/gregory/stencils.h"
#include "pipeline/schemes/scheme.h"
#include "shaders_cpp/acc/acc_quad.h"
#include "shaders_cpp/gregory/domain_shaders.h"
#include "shaders_cpp/stencil_form/stencil_hull_shader.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace tessemu {
namespace {

struct Cost {
    FlopCount flops;
    std::uint64_t control_points = 0, patch_constants = 0;
};

// The evaluation function by itself, up to the cross product.
template <class Inside> constexpr Cost evaluation_cost()
{
    Cost c;
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<typename Inside::template ControlPoint<Tally>> const patch(
            sink, Inside::kControlPoints, &c.control_points);
        DomainInput<Tally> const in{Tally(0.25, sink), Tally(0.5, sink), Tally(0.25, sink), 0};
        TangentFrame<Tally> const s = Inside::template evaluate<Tally>(patch, in, false);
        (void)cross(s.du, s.dv);
    });
    return c;
}

// LOOP10: 162 for the bicubic; docs/math/loop09.md, 8: 198 for Gregory with all scalar work, 258 for
// the triangle. LOOP10's 174 for Gregory are the 162, 8 weights and 4 divisions, without the 24
// multiplications that apply the weights to points.
static_assert(flops_loop10(evaluation_cost<RegularQuadInside>().flops) == 162);
static_assert(flops_loop10(evaluation_cost<GregoryQuadInside>().flops) == 198);
static_assert(flops_loop10(evaluation_cost<GregoryQuadInside>().flops) == 162 + (8 + 4) + 8 * 3);
static_assert(flops_loop10(evaluation_cost<GregoryTriangleInside>().flops) == 258);
static_assert(flops_loop10(evaluation_cost<AccQuadInside>().flops) == 272);
static_assert(evaluation_cost<GregoryQuadInside>().flops.div == 4);
static_assert(evaluation_cost<GregoryTriangleInside>().flops.div == 3);
static_assert(evaluation_cost<RegularQuadInside>().control_points == 16);
static_assert(evaluation_cost<GregoryQuadInside>().control_points == 20);
static_assert(evaluation_cost<GregoryTriangleInside>().control_points == 15);
static_assert(evaluation_cost<AccQuadInside>().control_points == 25);

// The whole domain shader at a point; the value of (u,v) decides between inside, edge and corner.
template <class Shader> constexpr Cost domain_cost(double u, double v)
{
    constexpr int N = Shader::kDomain == TessellatorDomain::Quad ? 4 : 3;
    Cost c;
    c.flops = tally([&](FlopCount* sink) {
        ControlPoints<typename Shader::template ControlPoint<Tally>> const patch(
            sink, Shader::kControlPoints, &c.control_points);
        ControlPoints<EdgeRegister<Tally>> const registers(sink, 6 * N, &c.patch_constants);
        DomainInput<Tally> const in{Tally(u, sink), Tally(v, sink), Tally(1 - u - v, sink), 0};
        (void)ProjectionEpilog{}(in, Shader{}(in, patch, registers));
    });
    return c;
}

// A stencil row costs 3 per input; with one extraordinary vertex there are 2n + 8 inputs: 6n + 24
// (LOOP10).
TEST(StencilRow, CostsThreeMultiplicationsPerInput)
{
    for (int n = 3; n <= 12; ++n) {
        int const inputs = 2 * n + 8;
        std::vector<float> const weights(std::size_t(inputs), 0.5f);
        std::vector<std::uint32_t> const masks{0xffffffffu}, words{0, 0, 1, 0, 0, 0, 0, 0};
        std::vector<std::uint8_t> order(static_cast<std::size_t>(inputs));
        std::iota(order.begin(), order.end(), std::uint8_t(0));
        SummedRows<4> const rows{
            {weights, 0, "w"}, {masks, 1, "m"}, {words, 2, "p"}, {order, 3, "o"}};
        FlopCount const c = tally([&](FlopCount* sink) {
            // A weight from memory is no constant: it meets the control point, which carries the
            // sink.
            ControlPoints<ControlVertex<Tally>> const in(sink, inputs);
            (void)rows.row<Tally>({0}, in, 0);
        });
        EXPECT_EQ(flops_loop10(c), std::uint64_t(6 * n + 24));
        EXPECT_EQ(c.mul, std::uint64_t(3 * inputs));
    }
}

StageStatistics const& stage(DrawStatistics const& s, std::string const& name)
{
    for (StageStatistics const& x : s.stages)
        if (x.stage == name) return x;
    throw std::runtime_error("no stage " + name);
}

std::uint64_t fetched(StageStatistics const& s, std::string const& resource)
{
    for (FetchStatistics const& f : s.fetches)
        if (f.resource == resource) return f.count;
    return 0;
}

// Run-time counts of each patch kind's domain shader = the tally at each of its points.
TEST(DomainShader, RunTimeCountsEqualTheTallySummedOverInvocations)
{
    std::set<std::string> kinds;
    for (auto [name, scheme] : {std::pair{"jug", "gregory-stencil"},
                                {"spindle", "gregory-stencil"},
                                {"saddle_star", "acc"}}) {
        SchemeOnMesh const on = build_scheme(find_scheme(scheme), load_model(name).mesh);
        for (Machine const& machine : test::machines()) {
            SurfaceSettings settings;
            settings.tess_factor = 5.3f;
            settings.machine = machine;
            CommandList const list = on.patches->commands(settings);
            list.for_each_surface_draw([&](Draw const& d) {
                std::string const& kind = d.kind.name;
                Cost expected;
                auto const visit = [&](ShadedPatch const& p) {
                    for (std::size_t i = 0; i < p.points->patch.points(); ++i) {
                        double const u = double(p.points->u[i]), v = double(p.points->v[i]);
                        Cost const c = kind == "regular quad"
                                           ? domain_cost<RegularQuadDomainShader>(u, v)
                                       : kind == "ACC quad" ? domain_cost<AccQuadDomainShader>(u, v)
                                       : kind == "Gregory quad"
                                           ? domain_cost<GregoryQuadDomainShader>(u, v)
                                           : domain_cost<GregoryTriangleDomainShader>(u, v);
                        expected.flops += c.flops;
                        expected.control_points += c.control_points;
                        expected.patch_constants += c.patch_constants;
                    }
                };
                DrawStatistics const s =
                    draw(GraphicsPipeline(d.pipeline), d.call, nullptr, visit, ThreadPool(2));
                StageStatistics const& ds = stage(s, "domain_shader");
                std::string const what = kind + ", " + testing::PrintToString(machine);
                EXPECT_EQ(ds.flops, expected.flops) << what;
                EXPECT_EQ(fetched(ds, "control_points"), expected.control_points) << what;
                EXPECT_EQ(fetched(ds, "patch_constants"), expected.patch_constants) << what;
                kinds.insert(kind);
            });
        }
    }
    EXPECT_EQ(kinds.size(), 4u) << "a patch kind was not drawn";
}

// The hull shader's: every row of every patch, 3 per non-zero weight.
TEST(HullShader, RunTimeCountsEqualThreePerNonZeroWeight)
{
    for (char const* name : {"jug", "spindle"}) {
        SchemeOnMesh const on = build_scheme(find_scheme("gregory-stencil"), load_model(name).mesh);
        Topology const& topology = on.mesh->topology();
        std::uint64_t expected = 0;
        Neighbourhood n;
        for (std::uint32_t f = 0; f < on.mesh->mesh().faces(); ++f) {
            find_neighbourhood(topology, f, n);
            PatchStencils const s = make_gregory_stencils(n, is_regular(topology, f), {});
            // Rows that run: control points, 4 an edge, one pair of tangents a corner.
            std::vector<std::size_t> rows(std::size_t(s.control_points + 4 * n.sides));
            std::iota(rows.begin(), rows.end(), std::size_t(0));
            for (int i = 0; i < n.sides; ++i)
                for (int k = 0; k < 2; ++k)
                    rows.push_back(std::size_t(s.corner_row[i] + 2 * n.ring_shift[i] + k));
            for (std::size_t r : rows)
                for (double w : s.rows[r]) expected += 3 * (float(w) != 0);
        }
        for (Machine const& machine : test::machines()) {
            FrameSettings settings;
            settings.machine = machine;
            DrawStatistics const s = visit_surface(*on.patches, settings, ThreadPool(2), {}).total;
            std::string const what = name + (", " + testing::PrintToString(machine));
            EXPECT_EQ(stage(s, "hull_shader").flops.mul, expected) << what;
            EXPECT_EQ(stage(s, "hull_shader").flops.add, expected) << what;
        }
    }
}

} // namespace
} // namespace tessemu
