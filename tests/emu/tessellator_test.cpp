// The tessellator against golden data, closed forms and exhaustion.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/domain_points.h"

#include "emu/floating_point.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <sstream>

namespace tessemu {
namespace {

struct Case {
    TessellatorState state;
    TessFactors factors{};
};

Case parse_case(std::string const& line)
{
    std::istringstream in(line);
    std::string d, p, o, hex;
    in >> d >> p >> o;
    Case c{{*tessellator_domain_from_name(d), *partitioning_from_name(p),
            *output_primitive_from_name(o)},
           {}};
    for (std::size_t i = 0; in >> hex; ++i)
        c.factors[i] = std::bit_cast<float>(std::uint32_t(std::stoul(hex, nullptr, 16)));
    return c;
}

TessellatedPatch run(Case const& c)
{
    TessellatedPatch out;
    tessellate(c.state, process_tess_factors(c.state, c.factors), out);
    return out;
}

std::uint64_t fnv(std::uint64_t h, std::uint32_t word)
{
    for (int k = 0; k < 4; ++k) h = (h ^ ((word >> (8 * k)) & 255)) * 0x100000001b3u;
    return h;
}

TEST(Tessellator, I1I10AllGoldenCasesMatchBitForBit)
{
    std::istringstream cases(test::read_text(test::golden("tessellator/cases.txt")));
    std::istringstream expected(test::read_text(test::golden("tessellator/expected.txt")));
    std::string line, answer;
    std::size_t n = 0;
    // The stage's door must hold against a caller that flushes denormals.
    DenormalMode const flush(DenormalMode::Flush);
    while (std::getline(cases, line) && std::getline(expected, answer)) {
        TessellatedPatch const p = run(parse_case(line));
        std::uint64_t points = 0xcbf29ce484222325u, indices = points;
        for (std::size_t i = 0; i < p.points(); ++i) points = fnv(fnv(points, p.u[i]), p.v[i]);
        for (std::uint32_t i : p.indices) indices = fnv(indices, i);
        char text[128];
        std::snprintf(text, sizeof text, "%zu %zu %016llx %016llx", p.points(), p.indices.size(),
                      static_cast<unsigned long long>(points),
                      static_cast<unsigned long long>(indices));
        ASSERT_EQ(answer, text) << line;
        ++n;
    }
    EXPECT_EQ(n, 6000u);
}

std::vector<std::uint32_t> numbers_after(std::string const& line, std::string const& key)
{
    std::vector<std::uint32_t> out;
    std::size_t i = line.find("\"" + key + "\": [");
    i = line.find('[', i) + 1;
    while (line[i] != ']') {
        std::size_t used = 0;
        out.push_back(std::uint32_t(std::stoul(line.substr(i, 12), &used)));
        i += used;
        while (line[i] == ',' || line[i] == ' ') ++i;
    }
    return out;
}

TEST(Tessellator, AllGoldenListingsMatchPointByPoint)
{
    std::istringstream in(test::read_text(test::golden("tessellator/listings.jsonl")));
    std::string line;
    std::size_t n = 0;
    while (std::getline(in, line)) {
        std::size_t const begin = line.find("\"case\": \"") + 9;
        std::string const text = line.substr(begin, line.find('"', begin) - begin);
        TessellatedPatch const p = run(parse_case(text));
        ASSERT_EQ(p.u, numbers_after(line, "u")) << text;
        ASSERT_EQ(p.v, numbers_after(line, "v")) << text;
        ASSERT_EQ(p.indices, numbers_after(line, "indices")) << text;
        ++n;
    }
    EXPECT_EQ(n, 155u);
}

// Rules R65, R66 by exhaustion: every 16.16 factor of a fractional mode.
void expect_symmetric_spans(std::uint32_t lowest, std::uint32_t highest, bool odd)
{
    std::uint64_t factors = 0, backward = 0;
    for (std::uint32_t f = lowest; f <= highest; ++f) {
        std::vector<std::uint32_t> const p = span_positions(f, odd);
        bool symmetric = p.front() == 0 && p.back() == kFixedOne, steps_back = false;
        for (std::size_t i = 0; i < p.size(); ++i) {
            symmetric = symmetric && p[i] == kFixedOne - p[p.size() - 1 - i] && p[i] <= kFixedOne;
            steps_back = steps_back || (i > 0 && p[i] < p[i - 1]);
        }
        ASSERT_TRUE(symmetric) << f;
        backward += steps_back;
        ++factors;
    }
    EXPECT_EQ(factors, 4063233u);
    EXPECT_EQ(backward, odd ? 0u : 420u); // the reference's fold just above 6 and 30
}

TEST(Span, EveryFractionalOddFactorIsSymmetric)
{
    expect_symmetric_spans(65536, 63 * 65536, true);
}
TEST(Span, EveryFractionalEvenFactorIsSymmetric)
{
    expect_symmetric_spans(2 * 65536, 64 * 65536, false);
}

rc::Gen<Case> any_case()
{
    return rc::gen::exec([] {
        Case c;
        c.state.domain = *rc::gen::element(TessellatorDomain::Quad, TessellatorDomain::Tri);
        c.state.partitioning =
            *rc::gen::element(Partitioning::Integer, Partitioning::Pow2,
                              Partitioning::FractionalOdd, Partitioning::FractionalEven);
        c.state.output =
            *rc::gen::element(OutputPrimitive::TriangleCw, OutputPrimitive::TriangleCcw);
        for (float& f : c.factors) f = float(*rc::gen::inRange(1, 64 * 64)) / 64.0f;
        return c;
    });
}

RC_GTEST_PROP(Tessellator, SignedAreasAddUpToTheDomainExactly, ())
{
    Case const c = *any_case();
    TessellatedPatch const p = run(c);
    std::int64_t area = 0;
    std::vector<char> used(p.points(), 0);
    for (std::size_t i = 0; i < p.indices.size(); i += 3) {
        std::int64_t u[3], v[3];
        for (std::size_t k = 0; k < 3; ++k) {
            u[k] = p.u[p.indices[i + k]], v[k] = p.v[p.indices[i + k]];
            used[p.indices[i + k]] = 1;
        }
        area += (u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]);
    }
    std::int64_t const whole =
        c.state.domain == TessellatorDomain::Quad ? std::int64_t(1) << 33 : std::int64_t(1) << 32;
    RC_ASSERT(area == (c.state.output == OutputPrimitive::TriangleCw ? whole : -whole));
    RC_ASSERT(std::find(used.begin(), used.end(), 0) == used.end());
}

RC_GTEST_PROP(Tessellator, EveryInnerEdgeHasExactlyTwoTriangles, ())
{
    Case const c = *any_case();
    TessellatedPatch const p = run(c);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::size_t i = 0; i < p.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            std::uint32_t const a = p.indices[i + k], b = p.indices[i + (k + 1) % 3];
            RC_ASSERT((++edges[{a, b}]) == 1); // each direction once
        }
    std::size_t open = 0;
    for (auto const& [e, n] : edges) open += !edges.count({e.second, e.first});
    // The open ones are the segments of ring 0.
    FixedFactors const f = process_tess_factors(c.state, c.factors);
    std::size_t ring = 0;
    for (int e = 0; e < edge_factor_count(c.state.domain); ++e)
        ring += span_positions(f.value[std::size_t(e)], f.odd[std::size_t(e)]).size() - 1;
    RC_ASSERT(open == ring);
}

TEST(Tessellator, R64OneDimensionalGoldenPositions)
{
    using V = std::vector<std::uint32_t>;
    auto const at = [](double f) { return std::uint32_t(f * 65536); };
    EXPECT_EQ(span_positions(at(3), true), (V{0, 21845, 43691, 65536}));
    EXPECT_EQ(span_positions(at(2.5), true), (V{0, 16384, 49152, 65536}));
    EXPECT_EQ(span_positions(at(5.5), true),
              (V{0, 12171, 14511, 26682, 38854, 51025, 53365, 65536}));
    EXPECT_EQ(span_positions(at(4.5), false), (V{0, 15019, 17750, 32768, 47786, 50517, 65536}));
}

TEST(Tessellator, R56R57R58CullsByEdgesAndClampsInsides)
{
    TessellatorState const s{TessellatorDomain::Quad, Partitioning::Integer,
                             OutputPrimitive::TriangleCw};
    for (float bad : {0.0f, -0.0f, -1.0f, NAN, -INFINITY}) {
        EXPECT_TRUE(process_tess_factors(s, {bad, 1, 1, 1, 1, 1}).culled);
        EXPECT_FALSE(process_tess_factors(s, {1, 1, 1, 1, bad, bad}).culled);
    }
    EXPECT_FALSE(process_tess_factors(s, {1e-40f, 1, 1, 1, 1, 1}).culled); // I-11
    EXPECT_EQ(process_tess_factors(s, {INFINITY, 1, 1, 1, 1, 1}).value[0], 64u * 65536);
}

TEST(TessellatorCache, ServesThePatternItWouldMake)
{
    TessellatorState const s{};
    TessellatorCache cache(s, 2);
    for (int turn = 0; turn < 3; ++turn)
        for (float f : {1.0f, 3.3f, 7.0f, 64.0f}) {
            auto const found = cache.find({f, f, f, f, f, f});
            Case const c{s, {f, f, f, f, f, f}};
            TessellatedPatch const made = run(c);
            EXPECT_EQ(found->patch.u, made.u);
            EXPECT_EQ(found->patch.indices, made.indices);
            for (std::size_t i = 0; i < made.points(); ++i)
                ASSERT_EQ(found->u[i] * 65536.0f, float(made.u[i]));
        }
    auto const held = cache.find({2, 2, 2, 2, 2, 2});
    EXPECT_EQ(cache.find({2, 2, 2, 2, 2, 2}), held);
}

} // namespace
} // namespace tessemu
