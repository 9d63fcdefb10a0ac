// Gap G1: SV_TessFactor and SV_InsideTessFactor in the domain shader.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/emu/suite_facts/patches.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessemu::test {
namespace {

using D = TessellatorDomain;
using P = Partitioning;
using O = OutputPrimitive;

// The tess factors as the domain shader reads them.
template <class T> struct SeenFactors {
    float4<T> position;
    std::array<T, 6> factors;
    static constexpr auto signature()
    {
        return std::tuple{&SeenFactors::position, &SeenFactors::factors};
    }
};
template <D domain> struct ReadsFactors {
    static constexpr D kDomain = domain;
    template <class T> using ControlPoint = SceneVertex<T>;
    template <class T> using PatchConstant = Constant<T>;
    template <class T> using Output = SeenFactors<T>;
    template <class T>
    SeenFactors<T> operator()(DomainInput<T> const&, ControlPoints<SceneVertex<T>> const&,
                              ControlPoints<Constant<T>> const&,
                              TessFactorInput<T> const& factors) const
    {
        SeenFactors<T> o{{T(0), T(0), T(0), T(1)}, {}};
        for (int i = 0; i < factors.size(); ++i) o.factors[std::size_t(i)] = factors[i].value;
        return o;
    }
};
struct AtMostEight : PatchHull<D::Quad> {
    static constexpr float kMaxTessFactor = 8;
};

template <D domain, class Hull = PatchHull<domain>>
std::vector<TessFactors> factors_seen(P partitioning, TessFactors const& factors,
                                      Machine const& machine, DrawStatistics* statistics = nullptr)
{
    PatchScene s;
    s.use_patches(PatchHull<domain>{});
    Hull hull{};
    hull.factors = {factors};
    s.desc.hull_shader = bind_hull_shader(hull, machine);
    s.desc.domain_shader = bind_domain_shader(ReadsFactors<domain>{}, machine);
    s.desc.pixel_shader = nullptr;
    s.desc.partitioning = partitioning;
    s.desc.output_primitive = O::Point;
    s.stream_out(4, 6, 1 << 18);
    s.add(8, 8);
    s.draw();
    if (statistics) *statistics = s.statistics;
    std::vector<TessFactors> seen;
    for (auto const& v : s.streamed()) {
        TessFactors& f = seen.emplace_back();
        std::copy(v.begin(), v.end(), f.begin());
    }
    return seen;
}

template <D domain> void expect_as_written()
{
    auto const edges = std::size_t(edge_factor_count(domain)),
               count = std::size_t(tess_factor_count(domain));
    float const nan = std::numeric_limits<float>::quiet_NaN(),
                inf = std::numeric_limits<float>::infinity();
    for (Machine const& machine : machines())
        for (P p : {P::Integer, P::Pow2, P::FractionalOdd, P::FractionalEven})
            for (float edge : {0.3f, 2.5f, 63.7f, 100.0f, inf})
                for (float inside : {0.3f, -5.0f, 63.7f, 100.0f, nan}) {
                    TessFactors f = uniform(1);
                    f[0] = edge;
                    for (std::size_t i = edges; i < count; ++i) f[i] = inside;
                    TessFactors expected{}; // a register that nobody wrote is 0
                    std::copy_n(f.begin(), count, expected.begin());
                    auto const seen = factors_seen<domain>(p, f, machine);
                    ASSERT_FALSE(seen.empty());
                    for (TessFactors const& s : seen)
                        ASSERT_EQ(std::memcmp(s.data(), expected.data(), sizeof s), 0)
                            << edge << " " << inside << " seen as " << s[0] << " " << s[edges];
                }
}

TEST(TessFactorInputs, G1ADomainShaderReadsTessFactorsAsTheHullShaderWroteThem)
{
    expect_as_written<D::Quad>();
    expect_as_written<D::Tri>();
    expect_as_written<D::Isoline>();
}

TEST(TessFactorInputs, G1ADeclaredMaximumHoldsForWhatTheDomainShaderReads)
{
    auto const seen = factors_seen<D::Quad, AtMostEight>(P::Integer, {9, 3, 8, 1, 64, 2}, {});
    ASSERT_FALSE(seen.empty());
    EXPECT_EQ(seen[0], (TessFactors{8, 3, 8, 1, 8, 2}));
}

TEST(TessFactorInputs, G1ReadsOfTessFactorsAreCountedAndOthersCountNone)
{
    auto const row = [](DrawStatistics const& d) {
        std::vector<FetchStatistics> rows;
        for (StageStatistics const& s : d.stages)
            for (FetchStatistics const& f : s.fetches)
                if (f.resource == "tess_factors") rows.push_back(f);
        return rows;
    };
    for (Machine const& machine : machines()) {
        DrawStatistics d;
        factors_seen<D::Tri>(P::Integer, uniform(4), machine, &d);
        std::uint64_t const n = 19 * 4; // points times factors
        EXPECT_EQ(row(d), (std::vector<FetchStatistics>{
                              {"tess_factors", ResourceKind::PatchConstant, n, 4 * n, 4 * 4}}));
    }
    PatchScene s;
    s.use_patches(PatchHull<D::Tri>{1, {uniform(4)}}).add(8, 8);
    EXPECT_TRUE(row(s.draw()).empty());
}

} // namespace
} // namespace tessemu::test
