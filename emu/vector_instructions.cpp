// SPDX-License-Identifier: Apache-2.0
#include "emu/vector_instructions.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <optional>
#include <utility>

namespace tessemu::detail {

namespace {

using Op = ExpressionGraph::Op;
using Node = ExpressionGraph::Node;

// Those whose result is one number.
bool is_scalar(VectorOp k)
{
    return k == VectorOp::Reciprocal || k == VectorOp::ReciprocalRoot || k == VectorOp::Dot;
}

class Selector {
public:
    /// \param widest  components of an instruction
    Selector(ExpressionGraph const& graph, std::vector<int> const& results, std::size_t widest)
        : nodes_(graph.nodes()),
          widest_(widest),
          live_(nodes_.size()),
          uses_(nodes_.size()),
          inside_sum_(nodes_.size()),
          part_of_dot_(nodes_.size()),
          fused_by_(nodes_.size(), -1)
    {
        for (int r : results) use(r);
        for (std::size_t i = nodes_.size(); i-- > 0;)
            if (live_[i]) nodes_[i].for_each_operand([&](int id) { use(id); });
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (live_[i]) find_products(int(i));
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (live_[i]) find_dot(int(i));
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (live_[i] && !is_made_on_demand(int(i))) source(int(i));
        for (int r : results) results_.push_back(result(r));
    }

    VectorInstructions take()
    {
        return {std::move(code_), std::move(vectors_), std::move(results_)};
    }

private:
    Node const& node(int id) const { return nodes_[std::size_t(id)]; }
    void use(int id)
    {
        live_[std::size_t(id)] = true;
        ++uses_[std::size_t(id)];
    }
    bool is_used_once(int id, Op op) const
    {
        return node(id).op == op && uses_[std::size_t(id)] == 1;
    }

    // Which product a sum takes, and which sum is inside another.
    void find_products(int id)
    {
        Node const& n = node(id);
        if (n.op != Op::Add && n.op != Op::Sub) return;
        for (int operand : {n.a, n.b})
            if (is_used_once(operand, Op::Mul)) {
                fused_by_[std::size_t(operand)] = id;
                break;
            }
        for (int operand : {n.a, n.b})
            if (is_used_once(operand, Op::Add)) inside_sum_[std::size_t(operand)] = true;
    }
    // A whole sum of three or four products.
    void find_dot(int id)
    {
        if (node(id).op != Op::Add || inside_sum_[std::size_t(id)]) return;
        std::vector<int> products, sums;
        if (!flatten(id, products, sums) || (products.size() != 3 && products.size() != 4)) return;
        for (int i : sums) part_of_dot_[std::size_t(i)] = true;
        for (int i : products) part_of_dot_[std::size_t(i)] = true;
        // Which product of a sum is recorded first is the compiler's choice.
        std::sort(products.begin(), products.end(), [&](int a, int b) {
            return std::pair(node(a).a, node(a).b) < std::pair(node(b).a, node(b).b);
        });
        dots_[id] = std::move(products);
    }
    // The products that make a sum, and the sums inside it; false if there are other terms.
    bool flatten(int id, std::vector<int>& products, std::vector<int>& sums) const
    {
        for (int operand : {node(id).a, node(id).b}) {
            if (is_used_once(operand, Op::Mul)) {
                products.push_back(operand);
            } else if (is_used_once(operand, Op::Add)) {
                sums.push_back(operand);
                if (!flatten(operand, products, sums)) return false;
            } else {
                return false;
            }
        }
        return true;
    }
    // No instruction of its own, or made where it is needed.
    bool is_made_on_demand(int id) const
    {
        Node const& n = node(id);
        auto const i = std::size_t(id);
        return n.is_leaf() || n.op == Op::Neg || n.op == Op::Abs || n.op == Op::Sqrt ||
               n.op >= Op::Less || part_of_dot_[i] || fused_by_[i] >= 0;
    }

    Source result(int id)
    {
        Source const s = source(id);
        bool const needs_move = s.bank != Source::Bank::Temporary || s.negated || s.absolute;
        return needs_move ? append(VectorOp::Move, {s}) : s;
    }

    Source source(int id)
    {
        Node const& n = node(id);
        switch (n.op) {
        case Op::Constant:
        case Op::Uniform:
            return {Source::Bank::Constant, 0, id};
        case Op::Input:
        case Op::Fetch:
        case Op::Load:
            return {Source::Bank::Input, 0, id};
        case Op::Neg:
            return source(n.a).minus();
        case Op::Abs: {
            Source s = source(n.a);
            s.absolute = true, s.negated = false;
            return s;
        }
        default: {
            auto const known = values_.find(id);
            if (known != values_.end()) return known->second;
            Source const s = make(id);
            values_.emplace(id, s);
            return s;
        }
        }
    }

    Source make(int id)
    {
        Node const& n = node(id);
        switch (n.op) {
        case Op::Add:
        case Op::Sub:
            return make_sum(id);
        case Op::Mul:
            return two(VectorOp::Mul, n);
        case Op::Min:
            return two(VectorOp::Min, n);
        case Op::Max:
            return two(VectorOp::Max, n);
        case Op::Mad: {
            Source const a = source(n.a), b = source(n.b), c = source(n.c);
            return append(VectorOp::Mad, {a, b, c});
        }
        case Op::Floor:
            return append(VectorOp::Floor, {source(n.a)});
        case Op::Sqrt:
            return scalar(VectorOp::Reciprocal, scalar(VectorOp::ReciprocalRoot, source(n.a)));
        case Op::Div: {
            Node const& one = node(n.a);
            if (one.op == Op::Constant && one.constant() == 1) return reciprocal(n.b);
            Source const a = source(n.a), b = reciprocal(n.b);
            return append(VectorOp::Mul, {a, b});
        }
        case Op::Texel:
            return fetch(id);
        default:
            assert(false && "a comparison is no operand");
            return {};
        }
    }
    Source two(VectorOp kind, Node const& n)
    {
        Source const a = source(n.a), b = source(n.b);
        return append(kind, {a, b});
    }
    Source reciprocal(int id)
    {
        if (node(id).op == Op::Sqrt) return scalar(VectorOp::ReciprocalRoot, source(node(id).a));
        return scalar(VectorOp::Reciprocal, source(id));
    }
    Source scalar(VectorOp kind, Source const& of)
    {
        auto const known = scalars_.find({kind, of});
        if (known != scalars_.end()) return known->second;
        return scalars_[{kind, of}] = append(kind, {of});
    }

    Source make_sum(int id)
    {
        if (auto const dot = dots_.find(id); dot != dots_.end())
            if (std::optional<Source> const s = make_dot(dot->second)) return *s;
        Node const& n = node(id);
        for (int operand : {n.a, n.b}) {
            if (fused_by_[std::size_t(operand)] != id) continue;
            Source p = source(node(operand).a);
            Source const q = source(node(operand).b);
            Source c = source(operand == n.a ? n.b : n.a);
            if (n.op == Op::Sub) (operand == n.a ? c : p) = (operand == n.a ? c : p).minus();
            return append(VectorOp::Mad, {p, q, c});
        }
        Source const a = source(n.a), b = source(n.b);
        return append(VectorOp::Add, {a, n.op == Op::Sub ? b.minus() : b});
    }

    // Where each of two registers holds a factor of every product.
    std::optional<Source> make_dot(std::vector<int> const& products)
    {
        VectorInstruction dot{VectorOp::Dot, 0, {}};
        for (int id : products) {
            Source a = source(node(id).a), b = source(node(id).b);
            if (!dot.in[0].empty() && !(a.beside(dot.in[0][0]) && b.beside(dot.in[1][0])))
                std::swap(a, b);
            if (!dot.in[0].empty() && !(a.beside(dot.in[0][0]) && b.beside(dot.in[1][0])))
                return std::nullopt;
            dot.in[0].push_back(a);
            dot.in[1].push_back(b);
        }
        // Dot products in a row fill one register.
        bool const row = !code_.empty() && code_.back().kind == VectorOp::Dot &&
                         vectors_[std::size_t(code_.back().vector)].written_by.size() < 4;
        return write(std::move(dot), row ? code_.back().vector : new_vector());
    }

    // All channels of a texel that are needed.
    Source fetch(int id)
    {
        Node const& n = node(id);
        Source const column = source(n.a), row = source(n.b);
        auto const [x, y] = address(column, row);
        VectorInstruction tex{VectorOp::Texel, new_vector(), {}};
        tex.in[0] = {x, y};
        tex.texture = n.bits;
        auto const at = int(code_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            Node const& m = nodes_[i];
            if (!live_[i] || m.op != Op::Texel || m.a != n.a || m.b != n.b || m.bits != n.bits)
                continue;
            Vector& v = vectors_.back();
            int const component = int(v.written_by.size());
            v.written_by.push_back(at);
            v.place.push_back(m.c);
            tex.components.push_back(component);
            values_[int(i)] = {Source::Bank::Temporary, tex.vector, component};
        }
        code_.push_back(std::move(tex));
        return values_[id];
    }
    // Two numbers as two components of one register.
    std::pair<Source, Source> address(Source x, Source y)
    {
        if (x.beside(y) && !x.negated && !x.absolute) return {x, y};
        auto const known = addresses_.find({x, y});
        if (known != addresses_.end()) return known->second;
        auto const has_room = [&](Source const& s) {
            if (s.bank != Source::Bank::Temporary || s.negated || s.absolute) return false;
            Vector const& v = vectors_[std::size_t(s.vector)];
            return v.place.empty() && v.written_by.size() < 4;
        };
        auto const moved = [&](Source const& s, int vector) {
            VectorInstruction move{VectorOp::Move, 0, {}};
            move.in[0] = {s};
            return write(std::move(move), vector);
        };
        std::pair<Source, Source> out{x, y};
        if (std::optional<Source> const again = repeated(y, x)) {
            out.second = *again;
        } else if (has_room(x)) {
            out.second = moved(y, x.vector);
        } else if (has_room(y)) {
            out.first = moved(x, y.vector);
        } else {
            int const vector = new_vector();
            out.first = moved(x, vector);
            out.second = moved(y, vector);
        }
        addresses_.emplace(std::pair{x, y}, out);
        return out;
    }

    // A number that was made before, made again beside another: one more component costs nothing.
    std::optional<Source> repeated(Source const& s, Source const& beside)
    {
        for (Source const& one : {s, beside})
            if (one.bank != Source::Bank::Temporary || one.negated || one.absolute)
                return std::nullopt;
        auto const writer = [&](Source const& one) {
            return vectors_[std::size_t(one.vector)].written_by[std::size_t(one.at)];
        };
        VectorInstruction const& first = code_[std::size_t(writer(s))];
        int const there = writer(beside);
        if (writer(s) > there || is_scalar(first.kind) || first.kind == VectorOp::Texel)
            return std::nullopt;
        auto const lane =
            std::size_t(std::find(first.components.begin(), first.components.end(), s.at) -
                        first.components.begin());
        std::vector<Source> in;
        for (std::vector<Source> const& operand : first.in)
            if (!operand.empty()) in.push_back(operand[lane]);
        if (!takes(code_[std::size_t(there)], there, first.kind, in)) return std::nullopt;
        return add_component(there, std::move(in));
    }

    int new_vector()
    {
        vectors_.emplace_back();
        return int(vectors_.size()) - 1;
    }
    // Adds an instruction that writes one more component of a vector.
    Source write(VectorInstruction&& instruction, int vector)
    {
        Vector& v = vectors_[std::size_t(vector)];
        int const component = int(v.written_by.size());
        v.written_by.push_back(int(code_.size()));
        instruction.vector = vector;
        instruction.components = {component};
        code_.push_back(std::move(instruction));
        return {Source::Bank::Temporary, vector, component};
    }

    Source append(VectorOp kind, std::vector<Source> in)
    {
        if (!is_scalar(kind))
            if (std::optional<Source> const s = join(kind, in)) return *s;
        VectorInstruction instruction{kind, 0, {}};
        for (std::size_t k = 0; k < in.size(); ++k) instruction.in[k] = {in[k]};
        return write(std::move(instruction), new_vector());
    }
    // The first instruction in reach that takes it as one more component.
    std::optional<Source> join(VectorOp kind, std::vector<Source> in)
    {
        std::size_t crossed = 0; // the widest that it would move across
        int found = -1;
        for (int i = int(code_.size()) - 1; i >= 0; --i) {
            VectorInstruction const& c = code_[std::size_t(i)];
            if (c.kind == VectorOp::Texel) break;
            if (c.width() >= crossed && takes(c, i, kind, in)) found = i;
            crossed = std::max(crossed, c.width());
        }
        if (found < 0) return std::nullopt;
        return add_component(found, std::move(in));
    }
    // To an instruction that takes it.
    Source add_component(int i, std::vector<Source> in)
    {
        VectorInstruction& c = code_[std::size_t(i)];
        if (!fits(c, in)) std::swap(in[0], in[1]);
        Vector& v = vectors_[std::size_t(c.vector)];
        int const component = int(v.written_by.size());
        v.written_by.push_back(i);
        c.components.push_back(component);
        for (std::size_t k = 0; k < in.size(); ++k) c.in[k].push_back(in[k]);
        return {Source::Bank::Temporary, c.vector, component};
    }
    bool takes(VectorInstruction const& c, int i, VectorOp kind,
               std::vector<Source> const& in) const
    {
        if (c.kind != kind || c.width() >= widest_ ||
            vectors_[std::size_t(c.vector)].written_by.size() >= 4)
            return false;
        for (Source const& s : in)
            if (s.bank == Source::Bank::Temporary &&
                vectors_[std::size_t(s.vector)].written_by[std::size_t(s.at)] >= i)
                return false;
        if (fits(c, in)) return true;
        if (!commutes(kind)) return false;
        std::vector<Source> swapped = in;
        std::swap(swapped[0], swapped[1]);
        return fits(c, swapped);
    }
    static bool fits(VectorInstruction const& c, std::vector<Source> const& in)
    {
        for (std::size_t k = 0; k < in.size(); ++k)
            if (!in[k].beside(c.in[k][0])) return false;
        return true;
    }

    std::vector<Node> const& nodes_;
    std::size_t widest_;
    std::vector<bool> live_;
    std::vector<int> uses_;
    std::vector<bool> inside_sum_, part_of_dot_;
    std::vector<int> fused_by_; ///< the sum that takes a product
    std::map<int, std::vector<int>> dots_;

    std::vector<VectorInstruction> code_;
    std::vector<Vector> vectors_;
    std::vector<Source> results_;
    std::map<int, Source> values_;
    std::map<std::pair<VectorOp, Source>, Source> scalars_;
    std::map<std::pair<Source, Source>, std::pair<Source, Source>> addresses_;
};

} // namespace

VectorInstructions select_instructions(ExpressionGraph const& graph,
                                       std::vector<int> const& results, std::size_t widest)
{
    return Selector(graph, results, widest).take();
}

} // namespace tessemu::detail
