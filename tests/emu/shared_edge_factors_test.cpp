// By exhaustion: whatever the factor of a shared edge, both patches have the same points on it,
// quad beside quad, quad beside triangle, in every orientation.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/parallel.h"
#include "emu/tessellator.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

namespace tessemu {
namespace {

constexpr std::uint32_t kStep = test::kSlow ? 499 : 1;

TessellatedPatch tessellated(TessellatorState const& state, TessFactors const& f)
{
    TessellatedPatch p;
    tessellate(state, process_tess_factors(state, f), p);
    return p;
}

// Parameters of the points on each edge, from the corner where the edge starts.
std::vector<std::vector<std::uint32_t>> edge_points(TessellatorDomain domain,
                                                    TessellatedPatch const& p)
{
    bool const quad = domain == TessellatorDomain::Quad;
    std::vector<std::vector<std::uint32_t>> out(quad ? 4 : 3);
    std::uint32_t const one = kFixedOne;
    for (std::size_t i = 0; i < p.points(); ++i) {
        std::uint32_t const u = p.u[i], v = p.v[i], w = one - u - v;
        if (quad) {
            if (v == 0) out[0].push_back(u);
            if (u == one) out[1].push_back(v);
            if (v == one) out[2].push_back(one - u);
            if (u == 0) out[3].push_back(one - v);
        } else {
            if (w == 0) out[0].push_back(v);
            if (u == 0) out[1].push_back(w);
            if (v == 0) out[2].push_back(u);
        }
    }
    for (auto& edge : out) std::sort(edge.begin(), edge.end());
    return out;
}

// All edges of both domains at one factor: equal, and equal to themselves reversed, which is how a
// neighbour sees them.
bool edges_agree(Partitioning partitioning, float factor, float inside)
{
    std::vector<std::uint32_t> first;
    for (TessellatorDomain domain : {TessellatorDomain::Quad, TessellatorDomain::Tri}) {
        TessFactors f;
        f.fill(factor);
        if (domain == TessellatorDomain::Quad)
            f[4] = f[5] = inside;
        else
            f[3] = inside;
        TessellatedPatch const p =
            tessellated({domain, partitioning, OutputPrimitive::TriangleCw}, f);
        for (auto const& edge : edge_points(domain, p)) {
            if (first.empty()) first = edge;
            if (edge != first) return false;
            for (std::size_t i = 0; i < edge.size(); ++i)
                if (edge[i] != kFixedOne - edge[edge.size() - 1 - i]) return false;
        }
    }
    return first.front() == 0 && first.back() == kFixedOne;
}

// \param inside  small, and such that no inner point lies on an edge
void expect_agreement(Partitioning partitioning, std::uint32_t lowest, std::uint32_t highest,
                      float inside, std::uint32_t step = kStep)
{
    std::atomic<std::uint64_t> factors{0}, wrong{0};
    constexpr std::uint32_t kPiece = 1 << 14;
    ThreadPool const threads;
    threads.parallel_for((highest - lowest) / kPiece + 1, [&](std::size_t piece) {
        std::uint32_t const begin = lowest + std::uint32_t(piece) * kPiece;
        for (std::uint32_t f = begin; f < begin + kPiece && f <= highest; f += step) {
            ++factors;
            wrong += !edges_agree(partitioning, float(f) / 65536, inside);
        }
    });
    EXPECT_EQ(wrong, 0u);
    EXPECT_GE(factors, (highest - lowest) / step);
}

TEST(SharedEdgeFactors, EveryFractionalOddFactorGivesBothSidesTheSamePoints)
{
    expect_agreement(Partitioning::FractionalOdd, 65536, 63 * 65536, 3);
}
TEST(SharedEdgeFactors, EveryFractionalEvenFactorGivesBothSidesTheSamePoints)
{
    expect_agreement(Partitioning::FractionalEven, 2 * 65536, 64 * 65536, 4);
}
TEST(SharedEdgeFactors, EveryWholeFactorGivesBothSidesTheSamePoints)
{
    expect_agreement(Partitioning::Integer, 65536, 64 * 65536, 3, 16384);
    expect_agreement(Partitioning::Pow2, 65536, 64 * 65536, 4, 16384);
}

// The check can fail: factors that differ, however little the points move.
TEST(SharedEdgeFactors, OtherFactorsGiveOtherPoints)
{
    TessFactors f{3, 3.0001f, 3, 3, 3, 3};
    auto const edges = edge_points(
        TessellatorDomain::Quad, tessellated({TessellatorDomain::Quad, Partitioning::FractionalOdd,
                                              OutputPrimitive::TriangleCw},
                                             f));
    EXPECT_NE(edges[0], edges[1]);
}

} // namespace
} // namespace tessemu
