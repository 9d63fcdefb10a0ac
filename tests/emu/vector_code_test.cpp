// Listings of four-wide instructions: the loops that BOLZ03 prints with the counts that it prints,
// small shaders counted by hand, and every listing run against the expression that it came from.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/vector_code.h"

#include "emu/memory.h"
#include "emu/texture.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <sstream>

namespace tessemu {
namespace {

using Op = ExpressionGraph::Op;
using Node = ExpressionGraph::Node;
using Four = std::array<double, 4>;

// ---- a machine that runs listings

// Channel c of a texel: no two alike, small whole numbers of the point.
double texel(std::uint32_t slot, double x, double y, int c)
{
    return std::floor(x) * 3 + std::floor(y) * 5 + 7 * c + 2 * double(slot) + 1;
}

// What leaves are: small whole numbers, so that sums and products are exact in any order.
double leaf_value(Node const& n, int id)
{
    return n.op == Op::Constant ? double(n.constant()) : double(id * 7 % 13 + 1);
}

std::vector<double> evaluate(ExpressionGraph const& g)
{
    std::vector<double> v;
    for (Node const& n : g.nodes()) {
        auto const in = [&](int id) { return v[std::size_t(id)]; };
        int const id = int(v.size());
        switch (n.op) {
        case Op::Add:
            v.push_back(in(n.a) + in(n.b));
            break;
        case Op::Sub:
            v.push_back(in(n.a) - in(n.b));
            break;
        case Op::Mul:
            v.push_back(in(n.a) * in(n.b));
            break;
        case Op::Div:
            v.push_back(in(n.a) / in(n.b));
            break;
        case Op::Mad:
            v.push_back(in(n.a) * in(n.b) + in(n.c));
            break;
        case Op::Sqrt:
            v.push_back(std::sqrt(in(n.a)));
            break;
        case Op::Neg:
            v.push_back(-in(n.a));
            break;
        case Op::Abs:
            v.push_back(std::abs(in(n.a)));
            break;
        case Op::Floor:
            v.push_back(std::floor(in(n.a)));
            break;
        case Op::Min:
            v.push_back(std::min(in(n.a), in(n.b)));
            break;
        case Op::Max:
            v.push_back(std::max(in(n.a), in(n.b)));
            break;
        case Op::Texel:
            v.push_back(texel(n.bits & 0xff, in(n.a), in(n.b), n.c));
            break;
        default:
            v.push_back(n.is_leaf() ? leaf_value(n, id) : 0);
        }
    }
    return v;
}

class ListingMachine {
public:
    ListingMachine(ExpressionGraph const& g, VectorCode const& code) : registers_(32)
    {
        auto const fill = [&](std::vector<std::array<int, 4>> const& from, std::vector<Four>& to) {
            for (std::array<int, 4> const& ids : from) {
                Four f{-1000, -1000, -1000, -1000};
                for (std::size_t k = 0; k < 4; ++k)
                    if (ids[k] >= 0) f[k] = leaf_value(g.nodes()[std::size_t(ids[k])], ids[k]);
                to.push_back(f);
            }
        };
        fill(code.constants, constants_);
        fill(code.inputs, inputs_);
    }
    void run(std::vector<std::string> const& listing)
    {
        for (std::string const& line : listing) step(line);
    }
    double read(std::string const& place) { return operand(place, 1)[0]; }

private:
    static int component(char c) { return int(std::string("xyzw").find(c)); }
    std::vector<double> operand(std::string t, std::size_t n)
    {
        bool const negated = t[0] == '-';
        if (negated) t.erase(0, 1);
        bool const absolute = t[0] == '|';
        if (absolute) t = t.substr(1, t.size() - 2);
        std::vector<Four> const& bank = t[0] == 'R'   ? registers_
                                        : t[0] == 'c' ? constants_
                                                      : inputs_;
        std::size_t const dot = t.find('.');
        Four const& from = bank.at(std::size_t(std::stoi(t.substr(1, dot - 1))));
        std::string const swizzle = t.substr(dot + 1);
        EXPECT_TRUE(swizzle.size() == 1 || swizzle.size() == n) << t;
        std::vector<double> out;
        for (std::size_t k = 0; k < n; ++k) {
            char const c = swizzle.size() == 1 ? swizzle[0] : swizzle.at(k);
            double v = from[std::size_t(component(c))];
            if (absolute) v = std::abs(v);
            out.push_back(negated ? -v : v);
        }
        return out;
    }
    void step(std::string const& line)
    {
        std::string const op = line.substr(0, 3);
        std::istringstream words(line.substr(4));
        std::vector<std::string> w;
        for (std::string one; std::getline(words, one, ',');)
            w.push_back(one.substr(one.find_first_not_of(' ')));
        std::size_t const dot = w[0].find('.');
        std::string const mask = w[0].substr(dot + 1);
        std::size_t const n = mask.size();
        EXPECT_TRUE(std::is_sorted(mask.begin(), mask.end(), [](char a, char b) {
            return component(a) < component(b);
        })) << line;
        std::vector<double> result(n);
        if (op == "TEX") {
            auto const at = operand(w[1], 2);
            for (std::size_t k = 0; k < n; ++k)
                result[k] = texel(std::uint32_t(std::stoi(w[2].substr(3))), at[0], at[1],
                                  component(mask[k]));
        } else if (op == "DP3" || op == "DP4") {
            std::size_t const terms = op == "DP3" ? 3 : 4;
            auto const a = operand(w[1], terms), b = operand(w[2], terms);
            for (std::size_t i = 0; i < terms; ++i) result[0] += a[i] * b[i];
        } else {
            auto const a = operand(w[1], n);
            auto const b = w.size() > 2 ? operand(w[2], n) : a;
            auto const c = w.size() > 3 ? operand(w[3], n) : a;
            for (std::size_t k = 0; k < n; ++k)
                result[k] = op == "ADD"   ? a[k] + b[k]
                            : op == "MUL" ? a[k] * b[k]
                            : op == "MAD" ? a[k] * b[k] + c[k]
                            : op == "MIN" ? std::min(a[k], b[k])
                            : op == "MAX" ? std::max(a[k], b[k])
                            : op == "FLR" ? std::floor(a[k])
                            : op == "RCP" ? 1 / a[k]
                            : op == "RSQ" ? 1 / std::sqrt(a[k])
                            : op == "MOV" ? a[k]
                                          : std::nan("");
        }
        Four& to = registers_.at(std::size_t(std::stoi(w[0].substr(1, dot - 1))));
        for (std::size_t k = 0; k < n; ++k) to[std::size_t(component(mask[k]))] = result[k];
    }

    std::vector<Four> registers_, constants_, inputs_;
};

std::string text(VectorCode const& code)
{
    std::string t;
    for (std::string const& line : code.listing) t += line + "\n";
    return t;
}

// Whether a listing gives the results of the expression: exactly, or within the roundings of a root
// and two quotients where there are such.
bool gives_results(ExpressionGraph const& g, VectorCode const& code,
                   std::vector<Graph> const& results, bool exact = true)
{
    std::vector<double> const values = evaluate(g);
    ListingMachine machine(g, code);
    machine.run(code.listing);
    for (std::size_t i = 0; i < results.size(); ++i) {
        double const wanted =
            results[i].graph ? values[std::size_t(results[i].id)] : double(results[i].constant);
        double const is = machine.read(code.results[i]);
        double const bound = exact ? 0 : 8 * std::abs(wanted) * 0x1p-52;
        if (!(std::abs(is - wanted) <= bound)) return false;
    }
    return true;
}

struct Counts {
    std::uint64_t add, mul, mad, tex, other;
    int registers;
    friend bool operator==(Counts const&, Counts const&) = default;
    friend std::ostream& operator<<(std::ostream& os, Counts const& c)
    {
        return os << c.add << " ADD " << c.mul << " MUL " << c.mad << " MAD " << c.tex << " TEX "
                  << c.other << " other, " << c.registers << " registers";
    }
};

VectorCode expect_code(ExpressionGraph& g, std::vector<Graph> const& results, Counts const& counts,
                       bool exact = true)
{
    VectorCode const code = vector_code(g, results);
    EXPECT_EQ((Counts{code.add, code.mul, code.mad, code.tex, code.other, code.registers}), counts)
        << text(code);
    EXPECT_EQ(code.instructions(), code.listing.size());
    EXPECT_TRUE(gives_results(g, code, results, exact)) << text(code);
    return code;
}

// ---- BOLZ03, section 3

// An unrolled loop over two iterations, since they can share an addition:
//     R1.xyzw = OffSet01.xyzw + TEXCOORD0.xyxy;
//     R1.x = TEX0[R1.xy]; R0 += R1.x * cp0
//     R1.x = TEX0[R1.zw]; R0 += R1.x * cp1
struct BitExactLoop {
    Texture2D tables;
    ConstantBuffer<float> offsets, points;

    template <class T> float3<T> operator()(float2<T> const& at, int terms) const
    {
        float3<T> sum(T(0), T(0), T(0));
        for (int i = 0; i < terms; i += 2) {
            float4<T> offset;
            int k = 2 * i;
            for_each_scalar(offset, [&](T& s) { s = load<T>(offsets, k++); });
            float4<T> const r = offset + float4<T>(at.x, at.y, at.x, at.y);
            sum = sum + fetch_texel<T>(tables, {r.x, r.y}).x * point<T>(i);
            sum = sum + fetch_texel<T>(tables, {r.z, r.w}).x * point<T>(i + 1);
        }
        return sum;
    }
    template <class T> float3<T> point(int i) const
    {
        return {load<T>(points, 3 * i), load<T>(points, 3 * i + 1), load<T>(points, 3 * i + 2)};
    }
};

// Four iterations, without the order:
//     R0 = 33*i + TEXCOORD0; R1 = TEX0[R0];
//     R0 += R1.x * cp0; R0 += R1.y * cp1;
//     R0 += R1.z * cp2; R0 += R1.w * cp3;
struct PackedLoop {
    Texture2D tables;
    ConstantBuffer<float> step, points; ///< step: (33, 0)
    bool literal = false;               ///< 33*i is a number of the program

    template <class T> float3<T> operator()(float2<T> const& at, int terms) const
    {
        float3<T> sum(T(0), T(0), T(0));
        for (int i = 0; 4 * i < terms; ++i) {
            float4<T> const r = fetch_texel<T>(tables, address(at, i));
            T const weight[4] = {r.x, r.y, r.z, r.w};
            for (int k = 0; k < std::min(4, terms - 4 * i); ++k) {
                float3<T> const p = BitExactLoop{{}, {}, points}.template point<T>(4 * i + k);
                sum = sum + weight[k] * p;
            }
        }
        return sum;
    }
    template <class T> float2<T> address(float2<T> const& at, int i) const
    {
        if (literal) return {T(float(33 * i)) + at.x, T(0) + at.y};
        return T(float(i)) * float2<T>(load<T>(step, 0), load<T>(step, 1)) + at;
    }
};

struct Recording {
    ExpressionGraph g;
    float2<Graph> at{Graph::input(g), Graph::input(g)};
    Texture2D tables{std::span<float const>(), 1, 1, 0, "tables", 1, 1, &g};
    std::vector<float> memory = std::vector<float>(4);
    ConstantBuffer<float> a{std::span(memory).first(1), &g}, b{std::span(memory).subspan(1, 1), &g};
};

std::vector<Graph> vector_of(float3<Graph> const& v)
{
    return {v.x, v.y, v.z};
}

TEST(VectorCode, TheBitExactLoopHas40And65InstructionsInTwoRegisters)
{
    for (auto [terms, instructions] : {std::pair{16, 40u}, {26, 65u}}) {
        Recording r;
        float3<Graph> const sum = BitExactLoop{r.tables, r.a, r.b}(r.at, terms);
        auto const n = std::uint64_t(terms);
        VectorCode const code = expect_code(r.g, vector_of(sum), {n / 2, 0, n, n, 0, 2});
        EXPECT_EQ(code.instructions(), instructions); // BOLZ03 3.1
    }
}

TEST(VectorCode, ThePackedLoopHas24And40InstructionsInTwoRegisters)
{
    for (auto [terms, instructions] : {std::pair{16, 24u}, {26, 40u}}) {
        auto const n = std::uint64_t(terms), groups = (n + 3) / 4;
        for (bool literal : {false, true}) {
            Recording r;
            float3<Graph> const sum = PackedLoop{r.tables, r.a, r.b, literal}(r.at, terms);
            VectorCode const code =
                expect_code(r.g, vector_of(sum),
                            {literal ? groups : 0, 0, literal ? n : n + groups, groups, 0, 2});
            EXPECT_EQ(code.instructions(), instructions); // BOLZ03 3.1
        }
    }
}

TEST(VectorCode, TheListingReadsLikeTheLoopThatIsPrinted)
{
    Recording r;
    float3<Graph> const sum = BitExactLoop{r.tables, r.a, r.b}(r.at, 4);
    VectorCode const code = vector_code(r.g, vector_of(sum));
    EXPECT_EQ(text(code), "ADD R0.xyzw, c0.xyzw, t0.xyxy\n"
                          "TEX R0.x, R0.xy, tex0\n"
                          "MAD R1.xyz, R0.x, c1.xyz, c2.x\n"
                          "TEX R0.x, R0.zw, tex0\n"
                          "MAD R1.xyz, R0.x, c3.xyz, R1.xyz\n"
                          "ADD R0.xyzw, c4.xyzw, t0.xyxy\n"
                          "TEX R0.x, R0.xy, tex0\n"
                          "MAD R1.xyz, R0.x, c5.xyz, R1.xyz\n"
                          "TEX R0.x, R0.zw, tex0\n"
                          "MAD R1.xyz, R0.x, c6.xyz, R1.xyz\n");
    EXPECT_EQ(code.results, (std::vector<std::string>{"R1.x", "R1.y", "R1.z"}));
    EXPECT_EQ(code.inputs, (std::vector<std::array<int, 4>>{{r.at.x.id, r.at.y.id, -1, -1}}));
}

// ---- small shaders, counted by hand

struct Inputs {
    ExpressionGraph g;
    Graph in() { return Graph::input(g); }
    float3<Graph> vector()
    {
        float3<Graph> v;
        for_each_scalar(v, [&](Graph& s) { s = in(); });
        return v;
    }
    // One that an instruction has made: 1 ADD.
    float3<Graph> made() { return vector() + vector(); }
};

TEST(VectorCode, ADotProductIsOneInstruction)
{
    Inputs s;
    float3<Graph> const a = s.vector(), b = s.vector();
    VectorCode const code = expect_code(s.g, {dot(a, b)}, {0, 0, 0, 0, 1, 1});
    EXPECT_EQ(code.listing[0], "DP3 R0.x, t0.xyz, t1.xyz");
}

TEST(VectorCode, ACrossProductIsAMulAndAMad)
{
    Inputs s;
    float3<Graph> const a = s.vector(), b = s.vector();
    expect_code(s.g, vector_of(cross(a, b)), {0, 1, 1, 0, 0, 1});
    Inputs of;
    float3<Graph> const c = of.made(), d = of.made();
    // The factors' 2 ADD; the MUL needs a third register, the MAD takes a factor's.
    expect_code(of.g, vector_of(cross(c, d)), {2, 1, 1, 0, 0, 3});
}

TEST(VectorCode, NormalizingIsADotProductARootAndAMul)
{
    Inputs s;
    float3<Graph> const v = s.vector();
    VectorCode const code = expect_code(s.g, vector_of(normalize(v)), {0, 1, 0, 0, 2, 1}, false);
    EXPECT_EQ(text(code), "DP3 R0.x, t0.xyz, t0.xyz\n"
                          "RSQ R0.x, R0.x\n"
                          "MUL R0.xyz, R0.x, t0.xyz\n");
}

TEST(VectorCode, ALengthIsTwoScalarsAfterADotProduct)
{
    Inputs s;
    float3<Graph> const v = s.vector();
    expect_code(s.g, {sqrt(Graph(dot(v, v)))}, {0, 0, 0, 0, 3, 1}, false);
}

TEST(VectorCode, ADivisionByANumberIsOneReciprocalForAllComponents)
{
    Inputs s;
    float3<Graph> const v = s.vector();
    Graph const w = s.in();
    expect_code(s.g, {v.x / w, v.y / w, v.z / w}, {0, 1, 0, 0, 1, 1}, false);
}

TEST(VectorCode, ALerpIsAnAddAndAMad)
{
    Inputs s;
    float3<Graph> const a = s.vector(), b = s.vector();
    expect_code(s.g, vector_of(lerp(a, b, s.in())), {1, 0, 1, 0, 0, 1});
}

TEST(VectorCode, AProductWithTwoUsesStaysAMul)
{
    Inputs s;
    Graph const a = s.in(), b = s.in(), p = a * b;
    // p + a and p - b are of two kinds: one operand is negated.
    expect_code(s.g, {p + a, p - b}, {2, 1, 0, 0, 0, 1});
    expect_code(s.g, {p, p + a}, {1, 1, 0, 0, 0, 1});
}

TEST(VectorCode, SumsByComponentsAreSumsOfVectors)
{
    Inputs whole, parts;
    for (Inputs* s : {&whole, &parts}) {
        float3<Graph> p[5];
        Graph w[5];
        for (int i = 0; i < 5; ++i) p[i] = s->vector(), w[i] = s->in();
        float3<Graph> sum = w[0] * p[0];
        if (s == &whole)
            for (int i = 1; i < 5; ++i) sum = sum + w[i] * p[i];
        else
            components([&](auto const& of) {
                for (int i = 1; i < 5; ++i) of(sum) = of(sum) + w[i] * of(p[i]);
            });
        expect_code(s->g, vector_of(sum), {0, 1, 4, 0, 0, 1});
    }
}

TEST(VectorCode, DotProductsInARowFillARegister)
{
    Inputs s;
    float3<Graph> const v = s.vector(), row[3] = {s.vector(), s.vector(), s.vector()};
    float3<Graph> const p(dot(row[0], v), dot(row[1], v), dot(row[2], v));
    expect_code(s.g, vector_of(Graph(2) * p), {0, 1, 0, 0, 3, 1});
}

TEST(VectorCode, NothingMovesAcrossAFetchAndAnAddressIsOneRegister)
{
    Inputs s;
    Texture2D const t(std::span<float const>(), 1, 1, 3, "t", 1, 1, &s.g);
    Graph const x = s.in(), y = s.in();
    // A product and a sum: by two instructions, so one is moved beside the other.
    Graph const u = x * y, v = x + y;
    float4<Graph> const texel = fetch_texel<Graph>(t, {u, v});
    VectorCode const code = expect_code(s.g, {texel.y, texel.w}, {1, 1, 0, 1, 1, 1});
    EXPECT_EQ(code.listing.back().substr(0, 9), "TEX R0.yw");
    EXPECT_EQ(code.listing.back().substr(code.listing.back().size() - 4), "tex3");
    // Another texture at the same point needs no other move.
    Texture2D const more(std::span<float const>(), 1, 1, 4, "more", 1, 1, &s.g);
    Graph const other = fetch_texel<Graph>(more, {u, v}).x;
    expect_code(s.g, {texel.y, texel.w, other, other + x}, {2, 1, 0, 2, 1, 2});
}

TEST(VectorCode, OperationsStayBehindAFetchAndBehindWiderInstructions)
{
    Inputs s;
    Texture2D const t(std::span<float const>(), 1, 1, 0, "t", 1, 1, &s.g);
    Graph const a = s.in(), b = s.in(), c = s.in();
    Graph const sum = a + b, texel = fetch_texel<Graph>(t, {a, b}).x, more = a + c;
    expect_code(s.g, {sum, texel, more}, {2, 0, 0, 1, 0, 2});
    expect_code(s.g, {sum, more}, {1, 0, 0, 0, 0, 1}); // nothing between
    // Sums, three products, another sum: it joins three sums, not two, across the products.
    for (int n : {2, 3}) {
        Inputs of;
        float3<Graph> const x = of.vector(), y = of.vector();
        std::vector<Graph> results{x.x + y.x, x.y + y.y};
        if (n == 3) results.push_back(x.z + y.z);
        for (Graph const& product : {x.x * y.x, x.y * y.y, x.z * y.z}) results.push_back(product);
        results.push_back(x.x + y.y);
        expect_code(of.g, results, {n == 2 ? 2u : 1u, 1, 0, 0, 0, 2});
    }
}

TEST(VectorCode, NegationAbsoluteValueAndWhatNoResultNeedsAreFree)
{
    Inputs s;
    float3<Graph> const a = s.vector(), b = s.vector();
    (void)cross(a, b);
    float3<Graph> const d = a - b;
    expect_code(s.g, {abs(a.x) * -b.x, abs(a.y) * -b.y, d.x + abs(d.y)}, {2, 1, 0, 0, 0, 1});
}

TEST(VectorCode, AResultThatNoOperationMadeIsMoved)
{
    Inputs s;
    Graph const a = s.in();
    expect_code(s.g, {a, -a, Graph(0.5f)}, {0, 0, 0, 0, 3, 1});
    expect_code(s.g, {min(a, Graph(1)), max(a, Graph(2)), floor(a)}, {0, 0, 0, 0, 3, 1});
}

// Any expression: its listing computes it, and has no more arithmetic than operations.
RC_GTEST_PROP(VectorCode, AnyListingGivesItsExpression, ())
{
    Inputs s;
    Texture2D const t(std::span<float const>(), 1, 1, 1, "t", 1, 1, &s.g);
    std::vector<Graph> pool;
    for (int i = 0; i < 6; ++i) pool.push_back(s.in());
    pool.emplace_back(2.0f), pool.emplace_back(0.0f);
    auto const any = [&] { return pool[std::size_t(*rc::gen::inRange(0, int(pool.size())))]; };
    auto const any_vector = [&] {
        Graph const x = any(), y = any(), z = any();
        return float3<Graph>(x, y, z);
    };
    std::uint64_t fetches = 0;
    for (int turn = *rc::gen::inRange(1, 12); turn > 0; --turn) {
        float3<Graph> const a = any_vector(), b = any_vector();
        float3<Graph> r = a;
        switch (*rc::gen::inRange(0, 8)) {
        case 0:
            r = a + b;
            break;
        case 1:
            r = a - b;
            break;
        case 2:
            r = any() * a + b;
            break;
        case 3:
            r = cross(a, b);
            break;
        case 4: {
            float4<Graph> const texel = fetch_texel<Graph>(t, {a.x, b.y});
            r = {texel.x, texel.w, texel.z};
            ++fetches;
            break;
        }
        case 5:
            r.x = dot(a, b);
            break;
        case 6:
            r = {min(a.x, b.x), max(a.y, b.y), abs(a.z)};
            break;
        default:
            r = {-a.x, floor(b.y), mad(a.x, b.y, a.z)};
        }
        for (Graph const& x : {r.x, r.y, r.z}) pool.push_back(x);
    }
    // Numbers stay exact below 2^53; products of products may not.
    std::vector<double> const values = evaluate(s.g);
    for (double v : values) RC_PRE(std::abs(v) < 1e12);
    std::vector<Graph> const results(pool.end() - 3, pool.end());
    VectorCode const code = vector_code(s.g, results);
    RC_ASSERT(gives_results(s.g, code, results));
    FlopCount const ops = s.g.shared();
    RC_ASSERT(code.add + code.mul + code.mad <= ops.add + ops.mul + ops.mad);
    RC_ASSERT(code.tex <= fetches);
}

// What the machine that runs listings is worth: any line left out, and any component of any operand
// replaced by another, shows in the results.
TEST(VectorCode, AMutatedListingGivesOtherResults)
{
    Recording r;
    float3<Graph> const v = BitExactLoop{r.tables, r.a, r.b}(r.at, 6);
    std::vector<Graph> const results = vector_of(cross(v, float3<Graph>(r.at.x, r.at.y, v.x)));
    VectorCode const right = vector_code(r.g, results);
    ASSERT_TRUE(gives_results(r.g, right, results));
    int mutations = 0, seen = 0;
    for (std::size_t i = 0; i < right.listing.size(); ++i) {
        VectorCode wrong = right;
        wrong.listing.erase(wrong.listing.begin() + long(i));
        ++mutations, seen += !gives_results(r.g, wrong, results);
        std::string const& line = right.listing[i];
        for (std::size_t k = line.find(','); k < line.size(); ++k) {
            std::size_t const c = std::string("xyzw").find(line[k]);
            if (c == std::string::npos || line.compare(k, 3, "tex") == 0) continue;
            if (line[k - 1] == 'e' || line[k + 1] == 'e') continue; // of "tex"
            wrong = right;
            wrong.listing[i][k] = "xyzw"[(c + 1) % 4];
            ++mutations, seen += !gives_results(r.g, wrong, results);
        }
    }
    EXPECT_GT(mutations, 60);
    EXPECT_EQ(seen, mutations);
}

} // namespace
} // namespace tessemu
