// SPDX-License-Identifier: Apache-2.0
#include "emu/vector_code.h"

#include "emu/vector_instructions.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>
#include <utility>

namespace tessemu {

namespace {

using namespace detail;

// Registers for the vectors, each in one of them while any component is needed.
class Registers {
public:
    explicit Registers(VectorInstructions const& c) : at_(c.vectors.size())
    {
        constexpr int kEnd = std::numeric_limits<int>::max();
        std::vector<std::vector<int>> last; // read, by vector and component
        for (Vector const& v : c.vectors) last.emplace_back(v.written_by);
        auto const read = [&](Source const& s, int i) {
            if (s.bank == Source::Bank::Temporary)
                last[std::size_t(s.vector)][std::size_t(s.at)] = i;
        };
        std::vector<VectorInstruction> const& code = c.code;
        for (std::size_t i = 0; i < code.size(); ++i)
            for (auto const& operand : code[i].in)
                for (Source const& s : operand) read(s, int(i));
        for (Source const& s : c.results) read(s, kEnd);
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
            allocate(c.vectors[v], usual, at_[v]);
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

char const* name_of(VectorInstruction const& i)
{
    switch (i.kind) {
    case VectorOp::Add:
        return "ADD";
    case VectorOp::Mul:
        return "MUL";
    case VectorOp::Mad:
        return "MAD";
    case VectorOp::Min:
        return "MIN";
    case VectorOp::Max:
        return "MAX";
    case VectorOp::Floor:
        return "FLR";
    case VectorOp::Move:
        return "MOV";
    case VectorOp::Reciprocal:
        return "RCP";
    case VectorOp::ReciprocalRoot:
        return "RSQ";
    case VectorOp::Dot:
        return i.in[0].size() == 3 ? "DP3" : "DP4";
    default:
        return "TEX";
    }
}

// Text and counts.
class Listing {
public:
    Listing(VectorInstructions const& c, VectorCode& out) : registers_(c), out_(out)
    {
        for (VectorInstruction const& i : c.code) add(i);
        for (Source const& s : c.results) out_.results.push_back(temporary({s}));
        out_.registers = registers_.count();
        out_.constants = std::move(constants_.registers);
        out_.inputs = std::move(inputs_.registers);
    }

private:
    void add(VectorInstruction const& i)
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
            bool const own_order = i.kind == VectorOp::Texel || i.kind == VectorOp::Dot;
            line += ", " + text(own_order ? operand : ordered(operand));
        }
        if (i.kind == VectorOp::Texel) line += ", tex" + std::to_string(i.texture & 0xff);
        out_.listing.push_back(std::move(line));
        ++(i.kind == VectorOp::Add     ? out_.add
           : i.kind == VectorOp::Mul   ? out_.mul
           : i.kind == VectorOp::Mad   ? out_.mad
           : i.kind == VectorOp::Texel ? out_.tex
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
        Listing(select_instructions(graph, ids, widest), code);
        if (!best || code.instructions() < best->instructions()) best = std::move(code);
    }
    return *best;
}

} // namespace tessemu
