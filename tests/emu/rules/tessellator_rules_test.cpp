// Rules R56 to R79 and the invariance properties V1 to V18 of public conformance suites.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/tessellator.h"
#include "tests/support/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace tessemu::test {
namespace {

using D = TessellatorDomain;
using P = Partitioning;
using O = OutputPrimitive;

TessellatedPatch tessellated(D domain, P partitioning, TessFactors const& f, O out = O::TriangleCw)
{
    TessellatorState const state{domain, partitioning, out};
    TessellatedPatch patch;
    tessellate(state, process_tess_factors(state, f), patch);
    return patch;
}
TessFactors uniform(float f)
{
    return {f, f, f, f, f, f};
}
constexpr P kSpacings[] = {P::Integer, P::FractionalOdd, P::FractionalEven};

using Point = std::array<std::uint32_t, 3>; // u, v, w; w is 0 on a quad
Point point(D domain, TessellatedPatch const& t, std::uint32_t i)
{
    return {t.u[i], t.v[i], domain == D::Tri ? kFixedOne - t.u[i] - t.v[i] : 0};
}
using Triangle = std::array<Point, 3>;
std::vector<Triangle> triangles(D domain, TessellatedPatch const& t)
{
    std::vector<Triangle> out;
    for (std::size_t i = 0; i + 2 < t.indices.size(); i += 3) {
        Triangle r{point(domain, t, t.indices[i]), point(domain, t, t.indices[i + 1]),
                   point(domain, t, t.indices[i + 2])};
        out.push_back(r);
    }
    return out;
}
// As sets: neither order of triangles nor of corners.
std::multiset<Triangle> triangle_set(D domain, TessellatedPatch const& t)
{
    std::multiset<Triangle> out;
    for (Triangle r : triangles(domain, t)) {
        std::sort(r.begin(), r.end());
        out.insert(r);
    }
    return out;
}
// Does a point lie on edge k of the domain, in Direct3D's order?
bool on_edge(D domain, int k, Point const& p)
{
    if (domain == D::Tri) return p[std::size_t(k)] == 0;
    return k == 0 ? p[0] == 0 : k == 1 ? p[1] == 0 : k == 2 ? p[0] == kFixedOne : p[1] == kFixedOne;
}
std::uint32_t along(D domain, int k, Point const& p)
{
    if (domain == D::Tri) return p[std::size_t((k + 1) % 3)];
    return k % 2 ? p[0] : p[1];
}
// Places along edge k, without repetition.
std::set<std::uint32_t> edge_points(D domain, TessellatedPatch const& t, int k)
{
    std::set<std::uint32_t> out;
    for (std::uint32_t i = 0; i < t.points(); ++i)
        if (Point const p = point(domain, t, i); on_edge(domain, k, p))
            out.insert(along(domain, k, p));
    return out;
}
int edges(D domain)
{
    return domain == D::Tri ? 3 : 4;
}
// The suite's level sets (V10): inner, then outer.
std::vector<TessFactors> level_sets()
{
    std::vector<TessFactors> sets{
        {1, 1, 1, 1, 1, 1}, {15, 42, 10, 12, 63, 24}, {6, 8, 7, 9, 3, 2},
        {2, 3, 1, 4, 4, 6}, {6, 8, 7, 9, 2, 2},       {1, 1, 1, 1, 5, 6},
        {2, 3, 1, 4, 1, 6}, {2, 3, 1, 4, 5, 1},       {2.9f, 3.4f, 1.5f, 4.1f, 5.2f, 1.6f}};
    std::uint32_t seed = 7;
    for (int i = 0; i < 10; ++i) {
        TessFactors f;
        for (float& x : f) {
            seed = seed * 1664525u + 1013904223u;
            x = 1 + float(seed >> 8) / float(1 << 24) * 15;
        }
        sets.push_back(f);
    }
    return sets;
}
// A tri takes its one inside factor from place 3.
TessFactors of(D domain, TessFactors f)
{
    if (domain == D::Tri) f[3] = f[4];
    return f;
}

TEST(Tessellator, R72R73V10CountsFollowTheFormulas)
{
    auto const clamp = [](P p, float x, bool inside, bool frame) {
        float const low = p == P::FractionalEven ? 2.0f : 1.0f,
                    high = p == P::FractionalOdd ? 63.0f : 64.0f;
        if (!(x >= low)) x = low;
        x = std::min(x, high);
        int n = int(std::ceil(x));
        if (p == P::FractionalOdd && n % 2 == 0) ++n;
        if (p == P::FractionalEven && n % 2 == 1) ++n;
        if (inside && n == 1 && frame) n = p == P::FractionalOdd ? 3 : 2;
        return n;
    };
    for (P p : kSpacings)
        for (TessFactors f : level_sets())
            for (D domain : {D::Quad, D::Tri}) {
                f = of(domain, f);
                int const sides = edges(domain), insides = domain == D::Tri ? 1 : 2;
                bool frame = false;
                for (int i = 0; i < sides + insides; ++i)
                    frame = frame || clamp(p, f[std::size_t(i)], false, false) > 1;
                int sum = 0;
                for (int i = 0; i < sides; ++i) sum += clamp(p, f[std::size_t(i)], false, frame);
                int points = 0, count = 0;
                if (!frame) {
                    points = sides, count = sides - 2;
                } else if (domain == D::Quad) {
                    int const m = clamp(p, f[4], true, true), n = clamp(p, f[5], true, true);
                    count = sum + 2 * (m - 2) * (n - 2) + 2 * (m - 2) + 2 * (n - 2);
                    points = sum + (m - 1) * (n - 1);
                } else {
                    int const m = clamp(p, f[3], true, true);
                    count = points = sum;
                    for (int r = 1; r <= m / 2; ++r) {
                        int const q = m - 2 * r;
                        count += q == 1 ? 4 : 6 * q;
                        points += q == 0 ? 1 : 3 * q;
                    }
                }
                TessellatedPatch const t = tessellated(domain, p, f);
                EXPECT_EQ(t.points(), std::size_t(points));
                EXPECT_EQ(t.indices.size() / 3, std::size_t(count));
            }
    for (auto [p, n] : {std::pair{P::Integer, 4u}, {P::FractionalOdd, 4u}, {P::FractionalEven, 9u}})
        EXPECT_EQ(tessellated(D::Quad, p, uniform(1)).points(), n); // R72
}

TEST(Tessellator, R56R57R58R59R60I11ClampAndRoundAsPrescribed)
{
    TessellatorState state{D::Quad, P::Integer, O::TriangleCw};
    auto const fixed = [&](P p, float edge, float inside) {
        state.partitioning = p;
        return process_tess_factors(state, {edge, edge, edge, edge, inside, inside});
    };
    float const nan = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();
    for (float bad : {0.0f, -0.0f, -1.0f, nan}) EXPECT_TRUE(fixed(P::Integer, bad, 4).culled);
    EXPECT_FALSE(fixed(P::Integer, 1e-40f, 4).culled); // I-11
    EXPECT_EQ(fixed(P::Integer, 2.5f, 2).value[0], 3 * kFixedOne);
    EXPECT_EQ(fixed(P::Pow2, 5.0f, 2).value[0], 5 * kFixedOne); // as integer
    EXPECT_EQ(fixed(P::Integer, inf, 2).value[0], 64 * kFixedOne);
    EXPECT_EQ(fixed(P::FractionalOdd, 64.5f, 2).value[0], 63 * kFixedOne);
    EXPECT_EQ(fixed(P::FractionalEven, 0.5f, 2).value[0], 2 * kFixedOne);
    EXPECT_EQ(fixed(P::FractionalOdd, 2.5f, nan).value[4], kFixedOne + 1); // the picture frame
    EXPECT_EQ(fixed(P::FractionalEven, 2.5f, -5).value[4], 2 * kFixedOne);
    EXPECT_EQ(fixed(P::FractionalOdd, 2.5f + 0x1p-17f, 2).value[0], 163840u); // RNE
}

TEST(Tessellator, R61R62R63SegmentsGrowByPairsAndMeetTheIntegerPlaces)
{
    for (bool odd : {true, false})
        for (std::uint32_t n = odd ? 3u : 2u; n < 62; n += 2) {
            auto const whole = span_positions(n * kFixedOne, odd);
            EXPECT_EQ(whole.size(), n + 1);
            // Equal spacing at whole factors, but for a reciprocal that was rounded to 1/65536 and
            // counted from the nearer end: half a unit an interval, and a rounding.
            for (std::uint32_t i = 0; i <= n; ++i)
                EXPECT_LE(std::abs(std::int64_t(whole[i]) * n - std::int64_t(i) * kFixedOne),
                          std::int64_t(n) * (std::min(i, n - i) + 1) / 2 + n);
            EXPECT_EQ(span_positions(n * kFixedOne + 1000, odd).size(), n + 3);
        }
}

TEST(Tessellator, R65R66V2V3V4V8V9V18EdgesDependOnTheirFactorAloneAndAreSymmetric)
{
    for (P p : kSpacings)
        for (float level :
             {1.0f, 1.2f, 1.9f, 2.3f, 2.8f, 3.3f, 3.8f, 10.2f, 1.6f, 24.4f, 24.7f, 63.0f}) {
            std::set<std::uint32_t> first;
            for (D domain : {D::Quad, D::Tri})
                for (int k = 0; k < edges(domain); ++k)
                    for (TessFactors f : level_sets()) {
                        f = of(domain, f);
                        // Inside factors above 1: otherwise inner points lie on the edge (V18).
                        for (std::size_t i = std::size_t(edges(domain)); i < 6; ++i)
                            f[i] = std::max(f[i], 2.0f);
                        f[std::size_t(k)] = level;
                        TessellatedPatch const t = tessellated(domain, p, f);
                        auto const e = edge_points(domain, t, k);
                        if (first.empty()) first = e;
                        ASSERT_EQ(e, first) << level;
                        for (std::uint32_t i = 0; i < t.points(); ++i)
                            for (std::uint32_t c : {t.u[i], t.v[i]}) {
                                ASSERT_LE(c, kFixedOne); // V8
                                float const x = float(c) / 65536;
                                ASSERT_EQ(1 - (1 - x), x);
                                ASSERT_EQ(x + (1 - x), 1.0f); // V9
                            }
                    }
            for (std::uint32_t c : first) EXPECT_TRUE(first.count(kFixedOne - c));
            EXPECT_TRUE(first.count(0) && first.count(kFixedOne));
        }
}

TEST(Tessellator, R67TriWeightsAddUpToOneAndTheEvenCentreIsFixed)
{
    for (P p : kSpacings)
        for (TessFactors f : level_sets()) {
            TessellatedPatch const t = tessellated(D::Tri, p, of(D::Tri, f));
            for (std::uint32_t i = 0; i < t.points(); ++i) ASSERT_LE(t.u[i] + t.v[i], kFixedOne);
        }
    TessellatedPatch const t = tessellated(D::Tri, P::Integer, uniform(2));
    EXPECT_TRUE(t.u.back() == 21845 && t.v.back() == 21845);
}

TEST(Tessellator, R69V1V5WindingTurnsAndTheTrianglesStay)
{
    for (P p : kSpacings)
        for (TessFactors f : level_sets())
            for (D domain : {D::Quad, D::Tri}) {
                f = of(domain, f);
                TessellatedPatch const cw = tessellated(domain, p, f),
                                       ccw = tessellated(domain, p, f, O::TriangleCcw),
                                       again = tessellated(domain, p, f);
                EXPECT_EQ(cw.indices, again.indices); // V1
                EXPECT_EQ(cw.u, again.u);
                EXPECT_EQ(triangle_set(domain, cw), triangle_set(domain, ccw));
                for (Triangle const& t : triangles(domain, cw)) {
                    auto const d = [&](int i, int c) {
                        return std::int64_t(t[std::size_t(i)][std::size_t(c)]) -
                               std::int64_t(t[0][std::size_t(c)]);
                    };
                    // Clockwise but for slivers of a few 1/65536.
                    ASSERT_GE(d(1, 0) * d(2, 1) - d(2, 0) * d(1, 1), -8 * std::int64_t(kFixedOne));
                }
            }
}

TEST(Tessellator, R70R71V6V7TrianglesInsideDependOnInsideFactorsOnly)
{
    for (P p : kSpacings)
        for (D domain : {D::Quad, D::Tri}) {
            std::multiset<Triangle> inner;
            std::vector<std::multiset<Triangle>> at_edge(4);
            bool first = true;
            for (TessFactors f : level_sets()) {
                f = of(domain, f);
                f[std::size_t(edges(domain))] = 5.3f;
                f[5] = 4.4f;
                if (domain == D::Quad) f[4] = 5.3f;
                f[0] = 6.7f; // V7 looks at edge 0
                TessellatedPatch const t = tessellated(domain, p, f);
                std::multiset<Triangle> in, edge0;
                for (Triangle const& r : triangle_set(domain, t)) {
                    bool outer = false, zero = false;
                    for (Point const& q : r)
                        for (int k = 0; k < edges(domain); ++k) {
                            outer = outer || on_edge(domain, k, q);
                            zero = zero || (k == 0 && on_edge(domain, 0, q));
                        }
                    // Corners lie on two edges: only triangles with two points on edge 0 are its
                    // own.
                    int const on = int(std::count_if(
                        r.begin(), r.end(), [&](Point const& q) { return on_edge(domain, 0, q); }));
                    if (!outer) in.insert(r);
                    if (zero && on == 2) edge0.insert(r);
                }
                if (first) inner = in, at_edge[0] = edge0;
                EXPECT_EQ(in, inner);
                EXPECT_EQ(edge0, at_edge[0]);
                first = false;
            }
        }
}

TEST(Tessellator, R74V14IsolinesLieAtIOverDensityAndTheirSpacingFollowsTheDetail)
{
    TessellatedPatch const t = tessellated(D::Isoline, P::Integer, {3, 4, 0, 0, 0, 0}, O::Line);
    EXPECT_EQ(t.points(), 3u * 5);
    EXPECT_EQ(t.indices.size(), 2u * 12);
    EXPECT_EQ(*std::max_element(t.v.begin(), t.v.end()), 43691u); // never at v = 1
    for (float detail = 7; detail < 62.4f; detail += detail < 9.95f ? 0.1f : 1) {
        TessellatedPatch const l =
            tessellated(D::Isoline, P::FractionalOdd, {1, detail, 0, 0, 0, 0}, O::Line);
        std::map<std::uint32_t, int> lengths; // within 0.001
        for (std::size_t i = 0; i + 1 < l.points(); ++i) ++lengths[(l.u[i + 1] - l.u[i] + 32) / 66];
        EXPECT_EQ(l.u.front(), 0u);
        EXPECT_EQ(l.u.back(), kFixedOne);
        std::size_t groups = 0;
        int last = -10;
        for (auto const& [length, n] : lengths) {
            groups += int(length) - last > 1;
            last = int(length);
        }
        EXPECT_LE(groups, 2u) << detail;
    }
}

TEST(Tessellator, R75R76R77R78I10PointOutputGivesEachPointOnce)
{
    for (TessFactors f : {uniform(5), TessFactors{4, 3, 6, 5, 7, 2}}) {
        TessellatedPatch const t = tessellated(D::Quad, P::Integer, f, O::Point);
        std::set<std::pair<std::uint32_t, std::uint32_t>> unique;
        for (std::uint32_t i = 0; i < t.points(); ++i) unique.emplace(t.u[i], t.v[i]);
        EXPECT_EQ(unique.size(), t.points());
    }
    // Just above a whole factor neighbours coincide, and degenerate triangles come out.
    TessellatedPatch const t = tessellated(D::Quad, P::FractionalOdd, {1.00001f, 1, 1, 1, 1, 1});
    EXPECT_EQ(t.points(), 10u);
    EXPECT_EQ(t.indices.size() / 3, 12u);
}

TEST(Tessellator, V11V12V13WholeLevelsGiveTheAnalyticGrid)
{
    // A place is a number q times the reciprocal 65536/m, rounded to a whole number, so off by q/2
    // at most; q counts from the nearer end.
    auto const cell = [](std::uint32_t place, int m) {
        auto const q = int((2ll * place * m + kFixedOne) / (2 * kFixedOne));
        EXPECT_LE(2 * std::abs(std::int64_t(place) * m - std::int64_t(kFixedOne) * q),
                  m * std::min(q, m - q))
            << place << " of " << m;
        return q;
    };
    for (auto [p, m, n] : {std::tuple{P::Integer, 4, 7},
                           {P::Integer, 64, 3},
                           {P::FractionalOdd, 5, 9},
                           {P::FractionalOdd, 33, 63},
                           {P::FractionalEven, 6, 4},
                           {P::FractionalEven, 46, 64}}) {
        TessellatedPatch const t =
            tessellated(D::Quad, p, {float(n), float(m), float(n), float(m), float(m), float(n)});
        EXPECT_EQ(t.points(), std::size_t((m + 1) * (n + 1)));
        std::set<std::pair<int, int>> cells;
        for (std::uint32_t i = 0; i < t.points(); ++i)
            cells.emplace(cell(t.u[i], m), cell(t.v[i], n));
        EXPECT_EQ(cells.size(), t.points());
    }
    // V13: an inner level of 1 beside larger ones acts as 2 (integer) or 3 (odd).
    EXPECT_EQ(tessellated(D::Quad, P::Integer, {3, 3, 3, 3, 1, 1}).indices,
              tessellated(D::Quad, P::Integer, {3, 3, 3, 3, 2, 2}).indices);
    EXPECT_EQ(tessellated(D::Quad, P::FractionalOdd, {3, 3, 3, 3, 1, 1}).indices,
              tessellated(D::Quad, P::FractionalOdd, {3, 3, 3, 3, 3, 3}).indices);
}

TEST(Tessellator, V15NonPositiveRelevantLevelsDiscard)
{
    for (float bad : {0.0f, -0.42f})
        for (D domain : {D::Quad, D::Tri, D::Isoline})
            for (std::size_t i = 0; i < 6; ++i) {
                TessFactors f = uniform(3);
                f[i] = bad;
                bool const relevant = int(i) < edge_factor_count(domain);
                EXPECT_EQ(tessellated(domain, P::Integer, f,
                                      domain == D::Isoline ? O::Line : O::TriangleCw)
                                  .points() == 0,
                          relevant);
            }
}

TEST(Tessellator, R52FactorsBelongToTheirEdgesInDirect3DsOrder)
{
    for (D domain : {D::Quad, D::Tri}) {
        TessFactors f{3, 4, 5, 6, 7, 7};
        if (domain == D::Tri) f[3] = 7;
        TessellatedPatch const t = tessellated(domain, P::Integer, f);
        for (int k = 0; k < edges(domain); ++k)
            EXPECT_EQ(edge_points(domain, t, k).size(), std::size_t(3 + k + 1));
    }
    // Isoline: density along v, then detail along u.
    TessellatedPatch const t = tessellated(D::Isoline, P::Integer, {2, 5, 0, 0, 0, 0}, O::Line);
    EXPECT_EQ(std::set<std::uint32_t>(t.v.begin(), t.v.end()).size(), 2u);
    EXPECT_EQ(std::set<std::uint32_t>(t.u.begin(), t.u.end()).size(), 6u);
}

// V17: a tessellated quad over the whole viewport.
template <class T> struct None {
    T nothing;
    static constexpr auto signature() { return std::tuple{&None::nothing}; }
};
struct FlatHull {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    template <class T> using Input = SceneVertex<T>;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = None<T>;
    float level = 5;
    int control_points() const { return 1; }
    int patch_constants() const { return 0; }
    template <class T>
    SceneVertex<T> control_point(PatchInput, ControlPoints<SceneVertex<T>> const& in,
                                 int_of<T>) const
    {
        return in[0];
    }
    template <class T>
    None<T> patch_constant(PatchInput, ControlPoints<SceneVertex<T>> const&,
                           ControlPoints<SceneVertex<T>> const&, int_of<T>) const
    {
        return {};
    }
    template <class T>
    std::array<T, 6> tess_factors(PatchInput, ControlPoints<SceneVertex<T>> const&,
                                  ControlPoints<SceneVertex<T>> const&,
                                  ControlPoints<None<T>> const&) const
    {
        T const l(level);
        return {l, l, l, l, l, l};
    }
};
struct FlatDomain {
    static constexpr TessellatorDomain kDomain = TessellatorDomain::Quad;
    static constexpr int kControlPoints = 1;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = None<T>;
    template <class T> using Output = SceneVertex<T>;
    float flip = 1;
    template <class T>
    SceneVertex<T> operator()(DomainInput<T> const& in, ControlPoints<SceneVertex<T>> const&,
                              ControlPoints<None<T>> const&) const
    {
        T const x = T(2) * in.u - T(1), y = T(flip) * (T(1) - T(2) * in.v);
        return {{x, y, T(0.5), T(1)}, {T(1), T(1), T(1), T(1)}};
    }
};

TEST(Tessellator, R69V17WindingFrontFaceAndFlipDecideWhetherAQuadIsDrawn)
{
    for (bool ccw : {false, true})
        for (bool front_ccw : {false, true})
            for (float flip : {1.0f, -1.0f})
                for (CullMode cull : {CullMode::Back, CullMode::Front}) {
                    Scene s(32, 32);
                    s.call.topology = PrimitiveTopology::PatchList;
                    s.call.control_points = 1;
                    s.desc.hull_shader = bind_hull_shader(FlatHull{}, {});
                    s.desc.domain_shader = bind_domain_shader(FlatDomain{flip}, {});
                    s.desc.output_primitive = ccw ? O::TriangleCcw : O::TriangleCw;
                    s.desc.input_control_points = 1;
                    s.target.rasterizer.cull = cull;
                    s.target.rasterizer.front_counter_clockwise = front_ccw;
                    s.add(0, 0);
                    s.draw();
                    bool const clockwise = ccw == (flip < 0);
                    bool const front = clockwise != front_ccw;
                    EXPECT_EQ(s.covered(), front == (cull == CullMode::Back) ? 32 * 32 : 0);
                }
}

TEST(Tessellator, R2R54R78I1PatchesLeaveThePipelineInOrder)
{
    Scene s(32, 32);
    s.call.topology = PrimitiveTopology::PatchList;
    s.call.control_points = 1;
    s.desc.hull_shader = bind_hull_shader(FlatHull{3}, {});
    s.desc.domain_shader = bind_domain_shader(FlatDomain{}, {});
    s.desc.input_control_points = 1;
    for (int i = 0; i < 100; ++i) s.add(0, 0);
    s.call.set_vertices(s.vertices, 8);
    s.call.vertex_count = 100;
    for (int threads : {1, 4}) {
        std::uint32_t next = 0;
        draw(
            GraphicsPipeline(s.desc), s.call, nullptr,
            [&](ShadedPatch const& p) { EXPECT_EQ(p.primitive_id, next++); }, ThreadPool(threads));
        EXPECT_EQ(next, 100u);
    }
}

TEST(Tessellator, R75PointsAndLinesOfATessellatedPatchAreDrawn)
{
    Scene s(32, 32);
    s.call.topology = PrimitiveTopology::PatchList;
    s.call.control_points = 1;
    s.desc.hull_shader = bind_hull_shader(FlatHull{3}, {});
    s.desc.domain_shader = bind_domain_shader(FlatDomain{}, {});
    s.desc.output_primitive = O::Point;
    s.desc.partitioning = P::Integer;
    s.desc.input_control_points = 1;
    s.add(0, 0);
    DrawStatistics const& n = s.draw();
    EXPECT_EQ(n.pipeline.CInvocations, 16u);
    EXPECT_EQ(n.pipeline.DSInvocations, 16u); // R160: the unique points
    EXPECT_GE(s.covered(), 9);
}

} // namespace
} // namespace tessemu::test
