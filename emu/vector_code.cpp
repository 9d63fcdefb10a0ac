// SPDX-License-Identifier: Apache-2.0
#include "emu/vector_code.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace tessemu {

namespace {

using Op = ExpressionGraph::Op;
using Node = ExpressionGraph::Node;

enum class Kind { Add, Mul, Mad, Min, Max, Floor, Move, Reciprocal, ReciprocalRoot, Dot, Texel };

bool commutes(Kind k)
{
    return k == Kind::Add || k == Kind::Mul || k == Kind::Mad || k == Kind::Min || k == Kind::Max;
}
// Those whose result is one number.
bool is_scalar(Kind k)
{
    return k == Kind::Reciprocal || k == Kind::ReciprocalRoot || k == Kind::Dot;
}

// A number that an instruction reads: a component of a temporary vector, or a leaf of the graph.
struct Source {
    enum class Bank { Temporary, Constant, Input };
    Bank bank;
    int vector; // of temporaries
    int at;     // component of the vector, or node
    bool negated = false, absolute = false;

    // Whether one operand can hold both.
    bool beside(Source const& o) const
    {
        return bank == o.bank && vector == o.vector && negated == o.negated &&
               absolute == o.absolute;
    }
    Source minus() const
    {
        Source s = *this;
        s.negated = !s.negated;
        return s;
    }
    friend auto operator<=>(Source const&, Source const&) = default;
};

struct Instruction {
    Kind kind;
    int vector;                              ///< that it writes
    std::vector<int> components;             ///< of it
    std::array<std::vector<Source>, 3> in{}; ///< each operand's components
    std::uint32_t texture = 0;               ///< of a fetch

    std::size_t width() const { return components.size(); }
};

// A vector of temporaries, and the instruction that writes each component.
struct Vector {
    std::vector<int> written_by;
    std::vector<int> place; ///< of each component where it is not free to choose, 0 to 3
};

class Compiler {
public:
    /// \param widest  components of an instruction
    Compiler(ExpressionGraph const& graph, std::vector<int> const& results, std::size_t widest)
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

    std::vector<Instruction> const& code() const { return code_; }
    std::vector<Vector> const& vectors() const { return vectors_; }
    std::vector<Source> const& results() const { return results_; }

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
        return needs_move ? append(Kind::Move, {s}) : s;
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
            return two(Kind::Mul, n);
        case Op::Min:
            return two(Kind::Min, n);
        case Op::Max:
            return two(Kind::Max, n);
        case Op::Mad: {
            Source const a = source(n.a), b = source(n.b), c = source(n.c);
            return append(Kind::Mad, {a, b, c});
        }
        case Op::Floor:
            return append(Kind::Floor, {source(n.a)});
        case Op::Sqrt:
            return scalar(Kind::Reciprocal, scalar(Kind::ReciprocalRoot, source(n.a)));
        case Op::Div: {
            Node const& one = node(n.a);
            if (one.op == Op::Constant && one.constant() == 1) return reciprocal(n.b);
            Source const a = source(n.a), b = reciprocal(n.b);
            return append(Kind::Mul, {a, b});
        }
        case Op::Texel:
            return fetch(id);
        default:
            assert(false && "a comparison is no operand");
            return {};
        }
    }
    Source two(Kind kind, Node const& n)
    {
        Source const a = source(n.a), b = source(n.b);
        return append(kind, {a, b});
    }
    Source reciprocal(int id)
    {
        if (node(id).op == Op::Sqrt) return scalar(Kind::ReciprocalRoot, source(node(id).a));
        return scalar(Kind::Reciprocal, source(id));
    }
    Source scalar(Kind kind, Source const& of)
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
            return append(Kind::Mad, {p, q, c});
        }
        Source const a = source(n.a), b = source(n.b);
        return append(Kind::Add, {a, n.op == Op::Sub ? b.minus() : b});
    }

    // Where each of two registers holds a factor of every product.
    std::optional<Source> make_dot(std::vector<int> const& products)
    {
        Instruction dot{Kind::Dot, 0, {}};
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
        bool const row = !code_.empty() && code_.back().kind == Kind::Dot &&
                         vectors_[std::size_t(code_.back().vector)].written_by.size() < 4;
        return write(std::move(dot), row ? code_.back().vector : new_vector());
    }

    // All channels of a texel that are needed.
    Source fetch(int id)
    {
        Node const& n = node(id);
        Source const column = source(n.a), row = source(n.b);
        auto const [x, y] = address(column, row);
        Instruction tex{Kind::Texel, new_vector(), {}};
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
            Instruction move{Kind::Move, 0, {}};
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
        Instruction const& first = code_[std::size_t(writer(s))];
        int const there = writer(beside);
        if (writer(s) > there || is_scalar(first.kind) || first.kind == Kind::Texel)
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
    Source write(Instruction&& instruction, int vector)
    {
        Vector& v = vectors_[std::size_t(vector)];
        int const component = int(v.written_by.size());
        v.written_by.push_back(int(code_.size()));
        instruction.vector = vector;
        instruction.components = {component};
        code_.push_back(std::move(instruction));
        return {Source::Bank::Temporary, vector, component};
    }

    Source append(Kind kind, std::vector<Source> in)
    {
        if (!is_scalar(kind))
            if (std::optional<Source> const s = join(kind, in)) return *s;
        Instruction instruction{kind, 0, {}};
        for (std::size_t k = 0; k < in.size(); ++k) instruction.in[k] = {in[k]};
        return write(std::move(instruction), new_vector());
    }
    // The first instruction in reach that takes it as one more component.
    std::optional<Source> join(Kind kind, std::vector<Source> in)
    {
        std::size_t crossed = 0; // the widest that it would move across
        int found = -1;
        for (int i = int(code_.size()) - 1; i >= 0; --i) {
            Instruction const& c = code_[std::size_t(i)];
            if (c.kind == Kind::Texel) break;
            if (c.width() >= crossed && takes(c, i, kind, in)) found = i;
            crossed = std::max(crossed, c.width());
        }
        if (found < 0) return std::nullopt;
        return add_component(found, std::move(in));
    }
    // To an instruction that takes it.
    Source add_component(int i, std::vector<Source> in)
    {
        Instruction& c = code_[std::size_t(i)];
        if (!fits(c, in)) std::swap(in[0], in[1]);
        Vector& v = vectors_[std::size_t(c.vector)];
        int const component = int(v.written_by.size());
        v.written_by.push_back(i);
        c.components.push_back(component);
        for (std::size_t k = 0; k < in.size(); ++k) c.in[k].push_back(in[k]);
        return {Source::Bank::Temporary, c.vector, component};
    }
    bool takes(Instruction const& c, int i, Kind kind, std::vector<Source> const& in) const
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
    static bool fits(Instruction const& c, std::vector<Source> const& in)
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

    std::vector<Instruction> code_;
    std::vector<Vector> vectors_;
    std::vector<Source> results_;
    std::map<int, Source> values_;
    std::map<std::pair<Kind, Source>, Source> scalars_;
    std::map<std::pair<Source, Source>, std::pair<Source, Source>> addresses_;
};

// Registers for the vectors, each in one of them while any component is needed.
class Registers {
public:
    Registers(Compiler const& c) : at_(c.vectors().size())
    {
        constexpr int kEnd = std::numeric_limits<int>::max();
        std::vector<std::vector<int>> last; // read, by vector and component
        for (Vector const& v : c.vectors()) last.emplace_back(v.written_by);
        auto const read = [&](Source const& s, int i) {
            if (s.bank == Source::Bank::Temporary)
                last[std::size_t(s.vector)][std::size_t(s.at)] = i;
        };
        std::vector<Instruction> const& code = c.code();
        for (std::size_t i = 0; i < code.size(); ++i)
            for (auto const& operand : code[i].in)
                for (Source const& s : operand) read(s, int(i));
        for (Source const& s : c.results()) read(s, kEnd);
        for (std::size_t i = 0; i < code.size(); ++i) {
            // What is read for the last time makes room for what is written.
            for (auto const& operand : code[i].in)
                for (Source const& s : operand)
                    if (s.bank == Source::Bank::Temporary &&
                        last[std::size_t(s.vector)][std::size_t(s.at)] == int(i))
                        free(place(s));
            auto const v = std::size_t(code[i].vector);
            if (!at_[v].empty()) continue;
            int usual = -1; // a sum stays where it is
            for (auto const& operand : code[i].in)
                if (!operand.empty() && operand[0].bank == Source::Bank::Temporary)
                    usual = place(operand[0]).number;
            allocate(c.vectors()[v], usual, at_[v]);
        }
    }
    struct Place {
        int number, component;
    };
    Place place(Source const& s) const { return at_[std::size_t(s.vector)][std::size_t(s.at)]; }
    Place place(int vector, int component) const
    {
        return at_[std::size_t(vector)][std::size_t(component)];
    }
    int count() const { return int(used_.size()); }

private:
    void free(Place p) { used_[std::size_t(p.number)][std::size_t(p.component)] = false; }
    // The fullest register that has room; of equals, the usual one.
    void allocate(Vector const& v, int usual, std::vector<Place>& at)
    {
        std::size_t const n = v.written_by.size();
        std::size_t best = used_.size();
        long least = 5;
        for (std::size_t r = 0; r < used_.size(); ++r) {
            bool fits = true;
            for (int component : v.place) fits &= !used_[r][std::size_t(component)];
            long const room = std::count(used_[r].begin(), used_[r].end(), false);
            bool const better = room < least || (room == least && int(r) == usual);
            if (fits && room >= long(n) && better) best = r, least = room;
        }
        if (best == used_.size()) used_.push_back({});
        for (std::size_t k = 0, component = 0; k < n; ++k) {
            if (!v.place.empty())
                component = std::size_t(v.place[k]);
            else
                while (used_[best][component]) ++component;
            used_[best][component] = true;
            at.push_back({int(best), int(component)});
        }
    }

    std::vector<std::vector<Place>> at_; // by vector and component
    std::vector<std::array<bool, 4>> used_;
};

// Constants or inputs in registers, laid out as operands want them.
class LeafRegisters {
public:
    /// The register that holds all of `leaves`.
    int hold(std::vector<int> leaves)
    {
        std::vector<int> once;
        for (int leaf : leaves)
            if (std::find(once.begin(), once.end(), leaf) == once.end()) once.push_back(leaf);
        leaves = std::move(once);
        int shares = -1;
        for (std::size_t r = 0; r < registers.size(); ++r) {
            auto const n = std::count_if(leaves.begin(), leaves.end(),
                                         [&](int leaf) { return component(int(r), leaf) >= 0; });
            if (std::size_t(n) == leaves.size()) return int(r);
            bool const wanted = n > 0 || (leaves.size() == 1 && only_single_[r]);
            if (wanted && room(r) + std::size_t(n) >= leaves.size()) shares = int(r);
        }
        if (shares < 0) {
            shares = int(registers.size());
            registers.push_back({kNone, kNone, kNone, kNone});
            only_single_.push_back(leaves.size() == 1);
        }
        for (int leaf : leaves)
            if (component(shares, leaf) < 0)
                *std::find(registers[std::size_t(shares)].begin(),
                           registers[std::size_t(shares)].end(), kNone) = leaf;
        return shares;
    }
    int component(int number, int leaf) const
    {
        auto const& r = registers[std::size_t(number)];
        auto const it = std::find(r.begin(), r.end(), leaf);
        return it == r.end() ? -1 : int(it - r.begin());
    }

    static constexpr int kNone = -1;
    std::vector<std::array<int, 4>> registers;

private:
    std::size_t room(std::size_t r) const
    {
        return std::size_t(std::count(registers[r].begin(), registers[r].end(), kNone));
    }
    std::vector<bool> only_single_;
};

char const* name_of(Instruction const& i)
{
    switch (i.kind) {
    case Kind::Add:
        return "ADD";
    case Kind::Mul:
        return "MUL";
    case Kind::Mad:
        return "MAD";
    case Kind::Min:
        return "MIN";
    case Kind::Max:
        return "MAX";
    case Kind::Floor:
        return "FLR";
    case Kind::Move:
        return "MOV";
    case Kind::Reciprocal:
        return "RCP";
    case Kind::ReciprocalRoot:
        return "RSQ";
    case Kind::Dot:
        return i.in[0].size() == 3 ? "DP3" : "DP4";
    default:
        return "TEX";
    }
}

// Text and counts.
class Listing {
public:
    Listing(Compiler const& c, VectorCode& out) : registers_(c), out_(out)
    {
        for (Instruction const& i : c.code()) add(i);
        for (Source const& s : c.results()) out_.results.push_back(temporary({s}));
        out_.registers = registers_.count();
        out_.constants = std::move(constants_.registers);
        out_.inputs = std::move(inputs_.registers);
    }

private:
    void add(Instruction const& i)
    {
        std::vector<Source> written;
        for (int component : i.components)
            written.push_back({Source::Bank::Temporary, i.vector, component});
        // A write mask has its components in order; so have the operands.
        std::vector<std::size_t> order(written.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return registers_.place(written[a]).component < registers_.place(written[b]).component;
        });
        auto const ordered = [&](std::vector<Source> const& s) {
            std::vector<Source> r;
            for (std::size_t k : order) r.push_back(s[k]);
            return r;
        };
        std::array<std::vector<Source>, 3> in = i.in;
        if (commutes(i.kind) && in[1][0].bank < in[0][0].bank) std::swap(in[0], in[1]);
        std::string line = std::string(name_of(i)) + " " + temporary(ordered(written), false);
        for (std::vector<Source> const& operand : in) {
            if (operand.empty()) break;
            bool const own_order = i.kind == Kind::Texel || i.kind == Kind::Dot;
            line += ", " + text(own_order ? operand : ordered(operand));
        }
        if (i.kind == Kind::Texel) line += ", tex" + std::to_string(i.texture & 0xff);
        out_.listing.push_back(std::move(line));
        ++(i.kind == Kind::Add     ? out_.add
           : i.kind == Kind::Mul   ? out_.mul
           : i.kind == Kind::Mad   ? out_.mad
           : i.kind == Kind::Texel ? out_.tex
                                   : out_.other);
    }

    std::string text(std::vector<Source> const& s)
    {
        std::string t;
        if (s[0].bank == Source::Bank::Temporary)
            t = temporary(s);
        else
            t = s[0].bank == Source::Bank::Constant ? leaf(constants_, "c", s)
                                                    : leaf(inputs_, "t", s);
        if (s[0].absolute) t = "|" + t + "|";
        return s[0].negated ? "-" + t : t;
    }
    // Equal components are one, as the language has it.
    static std::string components(std::vector<int> const& c, bool may_repeat)
    {
        if (may_repeat && std::equal(c.begin() + 1, c.end(), c.begin()))
            return std::string(1, "xyzw"[c[0]]);
        std::string t;
        for (int k : c) t += "xyzw"[k];
        return t;
    }
    std::string temporary(std::vector<Source> const& s, bool may_repeat = true) const
    {
        std::vector<int> c;
        for (Source const& one : s) c.push_back(registers_.place(one).component);
        return "R" + std::to_string(registers_.place(s[0]).number) + "." +
               components(c, may_repeat);
    }
    static std::string leaf(LeafRegisters& bank, char const* name, std::vector<Source> const& s)
    {
        std::vector<int> leaves, c;
        for (Source const& one : s) leaves.push_back(one.at);
        int const number = bank.hold(leaves);
        for (int id : leaves) c.push_back(bank.component(number, id));
        return name + std::to_string(number) + "." + components(c, true);
    }

    Registers registers_;
    LeafRegisters constants_, inputs_;
    VectorCode& out_;
};

} // namespace

VectorCode vector_code(ExpressionGraph& graph, std::span<Graph const> results)
{
    std::vector<int> ids;
    for (Graph const& r : results) {
        assert(!r.graph || r.graph == &graph);
        ids.push_back(r.graph ? r.id : graph.constant(r.constant));
    }
    std::optional<VectorCode> best;
    for (std::size_t widest : {4, 3, 2}) {
        VectorCode code;
        Listing(Compiler(graph, ids, widest), code);
        if (!best || code.instructions() < best->instructions()) best = std::move(code);
    }
    return *best;
}

} // namespace tessemu
