// Graph: a scalar that records the expression it belongs to, with equal subexpressions shared.
//
// Papers quote instruction counts of compiled shaders. The graph gives the two figures between
// which a compiler lands: operations as written, and unique operations with products that feed
// exactly one sum fused into multiply-adds.
//
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "emu/counted.h"

#include <map>
#include <tuple>
#include <vector>

namespace tessemu {

/// The nodes of an expression. One arena per recording; a node is an index into it.
class ExpressionGraph {
public:
    enum class Op { Input, Constant, Add, Sub, Mul, Div, Sqrt, Neg, Mad, Min, Max };
    struct Node {
        Op op;
        int a, b, c;
        double value;
        friend auto operator<=>(Node const&, Node const&) = default;
    };

    /// The node of an operation; an equal one is found again (a + b and b + a are equal).
    int intern(Op op, int a, int b = -1, int c = -1, double value = 0)
    {
        bool const commutes =
            op == Op::Add || op == Op::Mul || op == Op::Min || op == Op::Max || op == Op::Mad;
        if (commutes && a > b) std::swap(a, b);
        Node const node{op, a, b, c, value};
        auto const [it, fresh] = ids_.try_emplace(node, int(nodes_.size()));
        if (fresh) nodes_.push_back(node);
        return it->second;
    }
    int input() { return intern(Op::Input, int(nodes_.size())); }

    std::vector<Node> const& nodes() const { return nodes_; }

    /// Unique operations.
    FlopCount shared() const
    {
        FlopCount c;
        for (Node const& n : nodes_) {
            if (n.op == Op::Add || n.op == Op::Sub) ++c.add;
            if (n.op == Op::Mul) ++c.mul;
            if (n.op == Op::Mad) ++c.mad;
            if (n.op == Op::Div) ++c.div;
            if (n.op == Op::Sqrt) ++c.sqrt;
            if (n.op == Op::Min || n.op == Op::Max) ++c.compare;
        }
        return c;
    }

    /// Unique operations, each product whose only use is a sum fused into that sum.
    FlopCount fused() const
    {
        std::vector<int> uses(nodes_.size());
        for (Node const& n : nodes_) {
            if (n.op == Op::Input || n.op == Op::Constant) continue;
            for (int id : {n.a, n.b, n.c})
                if (id >= 0) ++uses[std::size_t(id)];
        }
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

private:
    std::vector<Node> nodes_;
    std::map<Node, int> ids_;
};

struct Graph {
    using Op = ExpressionGraph::Op;
    ExpressionGraph* graph = nullptr; // null: a constant that no graph has seen yet
    int id = -1;
    double constant = 0;

    Graph() = default;
    Graph(double c) : constant(c) {}
    Graph(ExpressionGraph& g, int node) : graph(&g), id(node) {}
    static Graph input(ExpressionGraph& g) { return {g, g.input()}; }

    friend Graph operator+(Graph a, Graph b) { return node(Op::Add, a, b); }
    friend Graph operator-(Graph a, Graph b) { return node(Op::Sub, a, b); }
    friend Graph operator*(Graph a, Graph b) { return node(Op::Mul, a, b); }
    friend Graph operator/(Graph a, Graph b) { return node(Op::Div, a, b); }
    friend Graph operator-(Graph a) { return node(Op::Neg, a, a); }
    friend Graph sqrt(Graph a) { return node(Op::Sqrt, a, a); }
    friend Graph min(Graph a, Graph b) { return node(Op::Min, a, b); }
    friend Graph max(Graph a, Graph b) { return node(Op::Max, a, b); }
    friend Graph mad(Graph a, Graph b, Graph c)
    {
        ExpressionGraph* const g = a.graph ? a.graph : b.graph ? b.graph : c.graph;
        if (!g) return a.constant * b.constant + c.constant;
        return {*g, g->intern(Op::Mad, a.in(*g), b.in(*g), c.in(*g))};
    }
    /// A recording follows one side: comparisons are true for what guards a zero denominator.
    friend bool operator>(Graph, Graph) { return true; }
    friend bool operator==(Graph, Graph) { return false; }
    friend bool operator!=(Graph, Graph) { return true; }
    friend Graph select(bool m, Graph a, Graph b) { return m ? a : b; }

private:
    int in(ExpressionGraph& g) const
    {
        return graph ? id : g.intern(Op::Constant, -1, -1, -1, constant);
    }
    static Graph node(Op op, Graph a, Graph b)
    {
        ExpressionGraph* const g = a.graph ? a.graph : b.graph;
        if (!g) return fold(op, a.constant, b.constant);
        bool const unary = op == Op::Neg || op == Op::Sqrt;
        return {*g, g->intern(op, a.in(*g), unary ? -1 : b.in(*g))};
    }
    static double fold(Op op, double a, double b)
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
        case Op::Neg:
            return -a;
        case Op::Sqrt:
            return sqrt(a);
        case Op::Min:
            return min(a, b);
        case Op::Max:
            return max(a, b);
        default:
            return 0;
        }
    }
};

template <> struct ScalarTraits<Graph> {
    using Storage = float;
    using Mask = bool;
    using Int = std::int32_t;
    static constexpr int kLanes = 1;
    static constexpr bool kCounted = false, kTally = false, kSites = false;
};

} // namespace tessemu
