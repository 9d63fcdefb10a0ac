// The domain shaders recorded as expressions: the recording is the shader's formula bit by bit, and
// its counts are the shader's.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/graph.h"
#include "emu/tally.h"
#include "shaders_cpp/acc/acc_quad.h"
#include "shaders_cpp/gregory/corner_domain_shaders.h"
#include "shaders_cpp/pm/pm_patch.h"

#include <gtest/gtest.h>

#include <random>

namespace tessemu {
namespace {

using Op = ExpressionGraph::Op;

constexpr int kRegisters = 48; // no scheme writes more

/// A domain shader's inside. All its inputs are nodes: u, v and w come first.
template <class Shader> struct Recording {
    ExpressionGraph graph;
    SurfacePoint<Graph> result;

    explicit Recording(Shader const& shader)
    {
        ControlPoints<typename Shader::template ControlPoint<Graph>> const patch(
            graph, Shader::kControlPoints);
        ControlPoints<EdgeRegister<Graph>> const registers(graph, kRegisters);
        DomainInput<Graph> const in{Graph::input(graph), Graph::input(graph), Graph::input(graph),
                                    0};
        result = shader(in, patch, registers);
    }
};

/// Inputs of a domain shader on any scalar whose values are floats.
template <class Shader> struct Inputs {
    using ControlPoint = typename Shader::template ControlPoint<float>;
    static constexpr int kFetchScalars = ControlPoints<ControlPoint>::kFetchScalars;
    static constexpr int kScalars = scalar_count<ControlPoint>();

    std::vector<float> patch = std::vector<float>(std::size_t(Shader::kControlPoints * kScalars));
    std::vector<float> registers = std::vector<float>(4 * std::size_t(kRegisters));
    float u, v, w;

    explicit Inputs(std::mt19937& random)
    {
        std::uniform_real_distribution<float> number(-1, 1);
        for (float& f : patch) f = number(random);
        for (float& f : registers) f = number(random);
        // Dyadic, as domain points are, and of the sector that a recording follows.
        std::uniform_int_distribution<int> fraction(1, 0xffff);
        bool const quad = Shader::kDomain == TessellatorDomain::Quad;
        do {
            u = float(fraction(random)) / 0x10000;
            v = float(fraction(random)) / 0x10000;
            w = 1.0f - u - v;
        } while (quad ? !(u < v && u + v > 1) : !(u < v && v < w));
    }

    template <class T> SurfacePoint<T> run(Shader const& shader) const
    {
        ControlPoints<typename Shader::template ControlPoint<T>> const p(patch.data(),
                                                                         Shader::kControlPoints);
        ControlPoints<EdgeRegister<T>> const r(registers.data(), kRegisters);
        return shader(DomainInput<T>{T(u), T(v), T(w), 0}, p, r);
    }

    float of(ExpressionGraph::Node const& leaf) const
    {
        if (leaf.op == Op::Constant) return leaf.constant();
        if (leaf.op == Op::Input) return leaf.a == 0 ? u : leaf.a == 1 ? v : w;
        if (leaf.a == 0) return patch[std::size_t(leaf.b * kFetchScalars + leaf.c)];
        return registers[std::size_t(leaf.b * 4 + leaf.c)];
    }
};

/// The bits of the scalars of `result`.
template <class Shader>
std::vector<std::uint32_t> evaluate(ExpressionGraph const& graph, SurfacePoint<Graph> const& result,
                                    Inputs<Shader> const& inputs)
{
    std::vector<float> values;
    auto const of = [&](int id) { return id < 0 ? 0.0f : values[std::size_t(id)]; };
    for (ExpressionGraph::Node const& n : graph.nodes())
        values.push_back(n.is_leaf() ? inputs.of(n)
                         : n.op >= Op::Less
                             ? 0.0f // no operand of anything
                             : ExpressionGraph::apply(n.op, of(n.a), of(n.b), of(n.c)));
    std::vector<std::uint32_t> bits;
    for_each_scalar(result, [&](Graph const& s) {
        bits.push_back(std::bit_cast<std::uint32_t>(s.graph ? of(s.id) : s.constant));
    });
    return bits;
}

std::vector<std::uint32_t> bits_of(SurfacePoint<float> const& p)
{
    std::vector<std::uint32_t> bits;
    for_each_scalar(p, [&](float s) { bits.push_back(std::bit_cast<std::uint32_t>(s)); });
    return bits;
}

template <class Shader> class GraphOf : public testing::Test {
};
using Shaders = testing::Types<RegularQuadDomainShader, GregoryQuadDomainShader,
                               GregoryTriangleDomainShader, RegularCornersDomainShader,
                               GregoryQuadCornersDomainShader, GregoryTriangleCornersDomainShader,
                               AccQuadDomainShader, PmQuadDomainShader, PmTriangleDomainShader>;
TYPED_TEST_SUITE(GraphOf, Shaders);

TYPED_TEST(GraphOf, GivesTheBitsOfTheShaderOnFloat)
{
    std::mt19937 random(20261124);
    for (bool true_normals : {false, true}) {
        TypeParam const shader{true_normals};
        Recording<TypeParam> const recorded(shader);
        for (int i = 0; i < 200; ++i) {
            Inputs<TypeParam> const inputs(random);
            EXPECT_EQ(evaluate(recorded.graph, recorded.result, inputs),
                      bits_of(inputs.template run<float>(shader)))
                << "at " << inputs.u << ' ' << inputs.v << " case " << i;
        }
    }
}

TYPED_TEST(GraphOf, CountsWhatTheTallyAndTheCountedScalarCount)
{
    std::mt19937 random(20261124);
    Inputs<TypeParam> const inputs(random);
    for (bool true_normals : {false, true}) {
        TypeParam const shader{true_normals};
        Recording<TypeParam> const recorded(shader);
        FlopCount const written = recorded.graph.written();

        execution = {};
        (void)inputs.template run<Counted<float>>(shader);
        EXPECT_EQ(written, execution.take());

        std::uint64_t fetches = 0;
        FlopCount const tallied = tally([&](FlopCount* sink) {
            ControlPoints<typename TypeParam::template ControlPoint<Tally>> const patch(
                sink, TypeParam::kControlPoints, &fetches);
            ControlPoints<EdgeRegister<Tally>> const registers(sink, kRegisters, &fetches);
            DomainInput<Tally> const in{Tally(double(inputs.u), sink),
                                        Tally(double(inputs.v), sink),
                                        Tally(double(inputs.w), sink), 0};
            (void)shader(in, patch, registers);
        });
        EXPECT_EQ(written, tallied);
        EXPECT_EQ(recorded.graph.loads(), fetches); // each shader fetches a control point once
    }
}

TYPED_TEST(GraphOf, SharesAndFusesWithoutLosingAnOperation)
{
    ExpressionGraph const graph = Recording<TypeParam>(TypeParam{}).graph;
    FlopCount const written = graph.written(), shared = graph.shared(), fused = graph.fused();
    EXPECT_LE(shared.add, written.add);
    EXPECT_LE(shared.mul, written.mul);
    EXPECT_LE(shared.div, written.div);
    EXPECT_LE(shared.sqrt, written.sqrt);
    EXPECT_LE(shared.compare, written.compare);
    EXPECT_GT(fused.mad, 0u);
    EXPECT_EQ(fused.add + fused.mad, shared.add + shared.mad);
    EXPECT_EQ(fused.mul + fused.mad, shared.mul + shared.mad);
}

// Of each part of the regular quad (bezier.h, record.h, records.h), mul and add as written:
//     1 - u, 1 - v for the edges' parameters         0, 2
//     the two cubic bases                           24, 6
//     4 rows of 2 sums of 4 products, 3 components  96, 72
//     3 sums of 4 products, 3 components            36, 27
//     the cross product                              6, 3
//     the normal's square, and its scaling           3 + 3, 2
// The bases have 1 - u and 1 - v too: 2 sums fewer. A sum of n products keeps one product, n - 1
// are fused; the bases' differences are of products that other sums use as well.
TEST(RegularQuadGraph, HasTheOperationsThatItsFormulaHas)
{
    ExpressionGraph const graph = Recording<RegularQuadDomainShader>({}).graph;
    EXPECT_EQ(graph.written(),
              (FlopCount{.add = 112, .mul = 168, .div = 1, .sqrt = 1, .compare = 5}));
    EXPECT_EQ(graph.shared(),
              (FlopCount{.add = 110, .mul = 168, .div = 1, .sqrt = 1, .compare = 5}));
    EXPECT_EQ(graph.fused(), (FlopCount{.add = 110 - 104,
                                        .mul = 168 - 104,
                                        .mad = 72 + 27 + 3 + 2, // 104
                                        .div = 1,
                                        .sqrt = 1,
                                        .compare = 5}));
    EXPECT_EQ(graph.loads(), 16u);
}

// The regular quad's, U = 1 - u and V = 1 - v once more, and for each of the four face points: mul
// 2 + 6, add 1 + 3 and the 3 of a difference that only true normals need, a division, a comparison.
// A face point's 3 sums are of two products each.
TEST(GregoryQuadGraph, HasTheOperationsThatItsFormulaHas)
{
    ExpressionGraph const graph = Recording<GregoryQuadDomainShader>({}).graph;
    EXPECT_EQ(graph.written(),
              (FlopCount{.add = 142, .mul = 200, .div = 5, .sqrt = 1, .compare = 9}));
    EXPECT_EQ(graph.shared(),
              (FlopCount{.add = 138, .mul = 200, .div = 5, .sqrt = 1, .compare = 9}));
    EXPECT_EQ(graph.fused(), (FlopCount{.add = 138 - 116,
                                        .mul = 200 - 116,
                                        .mad = 104 + 4 * 3, // 116
                                        .div = 5,
                                        .sqrt = 1,
                                        .compare = 9}));
    EXPECT_EQ(graph.loads(), 20u);
}

// On the boundary the shader has other formulas, of registers that the recording never reads.
TEST(GraphOfTheInside, OnAnEdgeIsStillTheInside)
{
    std::mt19937 random(20261124);
    Recording<RegularQuadDomainShader> const recorded({});
    Inputs<RegularQuadDomainShader> inputs(random);
    inputs.v = 0;
    ControlPoints<ControlVertex<float>> const patch(inputs.patch.data(), 16);
    TangentFrame<float> const frame = regular_quad<float>(patch, inputs.u, inputs.v);
    SurfacePoint<float> const inside{frame.position, unit_or_zero(cross(frame.du, frame.dv))};
    auto const of_graph = evaluate(recorded.graph, recorded.result, inputs);
    EXPECT_EQ(of_graph, bits_of(inside));
    EXPECT_NE(of_graph, bits_of(inputs.run<float>({})));
}

} // namespace
} // namespace tessemu
