// Graph: a scalar that records the expression it belongs to, with equal subexpressions shared.
//
//     ExpressionGraph graph;
//     ControlPoints<ControlVertex<Graph>> const patch(graph, 16);
//     (void)regular_quad<Graph>(patch, Graph::input(graph), Graph::input(graph));
//     graph.fused();
//
// Papers quote instruction counts of compiled shaders. A compiler that drops no operation lands
// between two figures of the graph: operations as written, and unique operations with products
// that feed exactly one sum fused into multiply-adds. What no result needs is counted as well.
//
// A recording has no values, so it follows one side of each branch, as if by an order: constants
// compare as numbers; what is recorded is greater than any constant, and greater than what was
// recorded before it; only a node equals itself. So a denominator is not the zero that it is
// guarded against, a squared length is above 0, and a domain coordinate equals neither 0 nor 1: a
// domain shader is recorded at an interior point, which is the formula of all points but those on
// the patch's boundary. Of a shader with cases inside the patch, such as sectors, it is one.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/counted.h"
#include "emu/record.h"

#include <cassert>
#include <compare>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace tessemu {

/// The nodes of an expression, each after its operands. One arena per recording; a node is an index
/// into it.
class ExpressionGraph {
public:
    enum class Op {
        // leaves
        Input,    ///< a: its own index
        Constant, ///< bits
        Fetch,    ///< of control points: a: view, b: record or vector, c: scalar of it
        Load,     ///< of a buffer: a: slot, b: index
        Uniform,  ///< of a constant buffer: a: buffer, b: index
        // a read of memory
        Texel, ///< a component: a, b: nodes, the point in texels; c: component; bits: TexelSource
        // operations on nodes a, b, c
        Add,
        Sub,
        Mul,
        Div,
        Sqrt,
        Neg,
        Mad,
        Min,
        Max,
        Floor,
        Abs,
        // comparisons, which the recording answers: no node has one as its operand
        Less,
        LessEqual,
        Equal
    };
    struct Node {
        Op op;
        int a = -1, b = -1, c = -1;
        std::uint32_t bits = 0; ///< of a constant, which may be -0 or NaN
        friend auto operator<=>(Node const&, Node const&) = default;

        bool is_leaf() const { return op <= Op::Uniform; }
        float constant() const { return std::bit_cast<float>(bits); }
        /// work(node) for each operand.
        template <class Work> void for_each_operand(Work&& work) const
        {
            if (is_leaf()) return;
            for (int id : {a, b, op == Op::Texel ? -1 : c})
                if (id >= 0) work(id);
        }
    };
    /// What a texel is read from.
    struct TexelSource {
        int slot, level = 0, slice = 0;
        std::uint32_t bits() const
        {
            return std::uint32_t(slot) | std::uint32_t(level) << 8 | std::uint32_t(slice) << 16;
        }
    };

    /// The node of an operation; an equal one is found again (a + b and b + a are equal).
    int operation(Op op, int a, int b = -1, int c = -1)
    {
        bool const commutes = op == Op::Add || op == Op::Mul || op == Op::Min || op == Op::Max ||
                              op == Op::Mad || op == Op::Equal;
        if (commutes && a > b) std::swap(a, b);
        count(op, written_);
        return intern({op, a, b, c});
    }
    int input() { return intern({Op::Input, int(nodes_.size())}); }
    int constant(float value)
    {
        return intern({Op::Constant, -1, -1, -1, std::bit_cast<std::uint32_t>(value)});
    }
    int fetch(int view, int unit, int scalar) { return intern({Op::Fetch, view, unit, scalar}); }
    int load(int slot, int index) { return intern({Op::Load, slot, index}); }
    /// \param buffer  whose address tells constant buffers apart
    int uniform(void const* buffer, int index)
    {
        int const number = int(constant_buffers_.size());
        return intern(
            {Op::Uniform, constant_buffers_.try_emplace(buffer, number).first->second, index});
    }
    int texel(TexelSource source, int x, int y, int component)
    {
        return intern({Op::Texel, x, y, component, source.bits()});
    }

    /// A number for another view of control points.
    int new_view() { return views_++; }

    std::vector<Node> const& nodes() const { return nodes_; }

    /// Operations as the shader writes them, those on constants alone left out.
    FlopCount written() const { return written_; }

    /// Unique operations.
    FlopCount shared() const
    {
        FlopCount c;
        for (Node const& n : nodes_) count(n.op, c);
        return c;
    }

    /// Unique operations, each product whose only use is a sum fused into that sum.
    FlopCount fused() const
    {
        std::vector<int> uses(nodes_.size());
        for (Node const& n : nodes_) n.for_each_operand([&](int id) { ++uses[std::size_t(id)]; });
        FlopCount c = shared();
        for (Node const& n : nodes_) {
            if (n.op != Op::Add && n.op != Op::Sub) continue;
            for (int id : {n.a, n.b}) {
                auto const i = std::size_t(id);
                if (nodes_[i].op != Op::Mul || uses[i] != 1) continue;
                --c.add, --c.mul, ++c.mad;
                break;
            }
        }
        return c;
    }

    /// Unique reads: one each for a control point, a vector of one, a buffer's element, a texel.
    std::uint64_t loads() const
    {
        std::set<std::tuple<Op, int, int, std::uint32_t>> units;
        for (Node const& n : nodes_)
            if (n.op == Op::Fetch || n.op == Op::Load || n.op == Op::Texel)
                units.emplace(n.op, n.a, n.b, n.bits);
        return units.size();
    }

    /// An operation's result, rounded as a shader's; not of a comparison.
    static float apply(Op op, float a, float b, float c)
    {
        switch (op) {
        case Op::Add:
            return a + b;
        case Op::Sub:
            return a - b;
        case Op::Mul:
            return a * b;
        case Op::Div:
            return a / b;
        case Op::Sqrt:
            return sqrt(a);
        case Op::Neg:
            return -a;
        case Op::Mad:
            return mad(a, b, c);
        case Op::Min:
            return min(a, b);
        case Op::Max:
            return max(a, b);
        case Op::Floor:
            return floor(a);
        case Op::Abs:
            return abs(a);
        default:
            assert(false);
            return 0;
        }
    }

private:
    int intern(Node const& node)
    {
        auto const [it, fresh] = ids_.try_emplace(node, int(nodes_.size()));
        if (fresh) nodes_.push_back(node);
        return it->second;
    }
    static void count(Op op, FlopCount& c)
    {
        if (op == Op::Add || op == Op::Sub) ++c.add;
        if (op == Op::Mul) ++c.mul;
        if (op == Op::Mad) ++c.mad;
        if (op == Op::Div) ++c.div;
        if (op == Op::Sqrt) ++c.sqrt;
        if (op == Op::Min || op == Op::Max || op >= Op::Less) ++c.compare;
    }

    std::vector<Node> nodes_;
    std::map<Node, int> ids_;
    std::map<void const*, int> constant_buffers_; // numbered as they are met
    FlopCount written_;
    int views_ = 0;
};

struct Graph {
    using Op = ExpressionGraph::Op;
    ExpressionGraph* graph = nullptr; // null: a constant, which no graph has seen yet
    int id = -1;
    float constant = 0;

    Graph() = default;
    Graph(float c) : constant(c) {}
    Graph(ExpressionGraph& g, int node) : graph(&g), id(node) {}
    static Graph input(ExpressionGraph& g) { return {g, g.input()}; }

    // What views of memory ask of a scalar that records.
    static int new_view(ExpressionGraph& g) { return g.new_view(); }
    static Graph fetch(ExpressionGraph& g, int view, int unit, int scalar)
    {
        return {g, g.fetch(view, unit, scalar)};
    }
    static Graph load(ExpressionGraph& g, int slot, int index) { return {g, g.load(slot, index)}; }
    static Graph uniform(ExpressionGraph& g, void const* buffer, int index)
    {
        return {g, g.uniform(buffer, index)};
    }
    static float4<Graph> texel(ExpressionGraph& g, ExpressionGraph::TexelSource source, Graph x,
                               Graph y)
    {
        int const column = x.in(g), row = y.in(g);
        auto const component = [&](int c) { return Graph(g, g.texel(source, column, row, c)); };
        return {component(0), component(1), component(2), component(3)};
    }

    friend Graph operator+(Graph a, Graph b) { return binary(Op::Add, a, b); }
    friend Graph operator-(Graph a, Graph b) { return binary(Op::Sub, a, b); }
    friend Graph operator*(Graph a, Graph b) { return binary(Op::Mul, a, b); }
    friend Graph operator/(Graph a, Graph b) { return binary(Op::Div, a, b); }
    friend Graph operator-(Graph a) { return unary(Op::Neg, a); }
    friend Graph sqrt(Graph a) { return unary(Op::Sqrt, a); }
    friend Graph floor(Graph a) { return unary(Op::Floor, a); }
    friend Graph abs(Graph a) { return unary(Op::Abs, a); }
    friend Graph min(Graph a, Graph b) { return binary(Op::Min, a, b); }
    friend Graph max(Graph a, Graph b) { return binary(Op::Max, a, b); }
    friend Graph mad(Graph a, Graph b, Graph c)
    {
        ExpressionGraph* const g = a.graph ? a.graph : common(b, c);
        if (!g) return ExpressionGraph::apply(Op::Mad, a.constant, b.constant, c.constant);
        return {*g, g->operation(Op::Mad, a.in(*g), b.in(*g), c.in(*g))};
    }

    friend bool operator<(Graph a, Graph b) { return compare(Op::Less, a, b) < 0; }
    friend bool operator>(Graph a, Graph b) { return compare(Op::Less, b, a) < 0; }
    friend bool operator<=(Graph a, Graph b) { return compare(Op::LessEqual, a, b) <= 0; }
    friend bool operator>=(Graph a, Graph b) { return compare(Op::LessEqual, b, a) <= 0; }
    friend bool operator==(Graph a, Graph b) { return compare(Op::Equal, a, b) == 0; }
    friend bool operator!=(Graph a, Graph b) { return compare(Op::Equal, a, b) != 0; }
    friend Graph select(bool m, Graph a, Graph b) { return m ? a : b; }

private:
    int in(ExpressionGraph& g) const
    {
        assert(!graph || graph == &g);
        return graph ? id : g.constant(constant);
    }
    static ExpressionGraph* common(Graph a, Graph b) { return a.graph ? a.graph : b.graph; }
    static Graph unary(Op op, Graph a)
    {
        if (!a.graph) return ExpressionGraph::apply(op, a.constant, 0, 0);
        return {*a.graph, a.graph->operation(op, a.id)};
    }
    static Graph binary(Op op, Graph a, Graph b)
    {
        ExpressionGraph* const g = common(a, b);
        if (!g) return ExpressionGraph::apply(op, a.constant, b.constant, 0);
        return {*g, g->operation(op, a.in(*g), b.in(*g))};
    }
    /// Records a comparison and answers it by the order at the head of this file.
    static std::partial_ordering compare(Op op, Graph a, Graph b)
    {
        ExpressionGraph* const g = common(a, b);
        if (!g) return a.constant <=> b.constant;
        g->operation(op, a.in(*g), b.in(*g));
        if (!a.graph || !b.graph) return (a.graph != nullptr) <=> (b.graph != nullptr);
        return a.id <=> b.id;
    }
};

template <> struct ScalarTraits<Graph> {
    using Storage = float;
    using Mask = bool;
    using Int = std::int32_t;
    using Recording = ExpressionGraph;
    static constexpr int kLanes = 1;
    static constexpr bool kCounted = false, kTally = false, kSites = false;
};

} // namespace tessemu
