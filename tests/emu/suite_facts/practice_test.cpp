// Where the specification and drivers differ: the cut index, and factors that no suite tests.
// (S40F3 and S58F4 lie with the facts that they belong to.)
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/floating_point.h"
#include "emu/input_assembler.h"
#include "emu/tessellator.h"

#include <gtest/gtest.h>

#include <limits>

namespace tessemu::test {
namespace {

TEST(InputAssembler, F2R31TheCutIndexCutsEveryTopologyOrStripsOnly)
{
    std::vector<std::uint32_t> const wide{0, 1, ~0u, 9, ~0u, ~0u, 2000, 3000, 4000};
    std::vector<std::uint16_t> const narrow{0, 1, 0xffff, 9, 0xffff, 0xffff, 2000, 3000, 4000};
    // Index values by primitive.
    auto const indices = [](DrawCall const& call) {
        AssembledPrimitives const p = assemble_primitives(call);
        std::vector<std::uint32_t> out;
        for (std::uint32_t id : p.vertices) out.push_back(p.index(id));
        return out;
    };
    EXPECT_EQ(DrawCall{}.index_cut, IndexCut::EveryTopology);
    DrawCall call;
    for (bool is_wide : {true, false}) {
        if (is_wide)
            call.indices = std::span<std::uint32_t const>(wide);
        else
            call.indices = std::span<std::uint16_t const>(narrow);
        std::vector<std::uint32_t> all(wide);
        if (!is_wide) all.assign(narrow.begin(), narrow.end());
        using Indices = std::vector<std::uint32_t>;
        for (PrimitiveTopology list :
             {PrimitiveTopology::TriangleList, PrimitiveTopology::PatchList}) {
            call.topology = list;
            call.control_points = 3;
            call.index_cut = IndexCut::EveryTopology; // the specification
            EXPECT_EQ(indices(call), (Indices{2000, 3000, 4000}));
            call.index_cut = IndexCut::StripsOnly; // drivers: three primitives
            EXPECT_EQ(indices(call), all);
        }
        call.topology = PrimitiveTopology::LineList;
        call.index_cut = IndexCut::EveryTopology;
        EXPECT_EQ(indices(call), (Indices{0, 1, 2000, 3000}));
        call.index_cut = IndexCut::StripsOnly;
        EXPECT_EQ(indices(call).size(), 8u);
        // A strip is cut either way.
        for (IndexCut cut : {IndexCut::EveryTopology, IndexCut::StripsOnly}) {
            call.index_cut = cut;
            call.topology = PrimitiveTopology::TriangleStrip;
            EXPECT_EQ(indices(call), (Indices{2000, 3000, 4000}));
            call.topology = PrimitiveTopology::LineStrip;
            EXPECT_EQ(indices(call), (Indices{0, 1, 2000, 3000, 3000, 4000}));
        }
    }
}

TEST(Tessellator, G19NanFactorsCullOrAreTheLeastAndDenormalOnesAreKept)
{
    float const nan = std::numeric_limits<float>::quiet_NaN(), tiny = 0x1p-149f;
    using D = TessellatorDomain;
    using P = Partitioning;
    for (DenormalMode::Kind mode : {DenormalMode::Keep, DenormalMode::Flush}) {
        DenormalMode const guard(mode); // stages run in the flushing one
        for (D domain : {D::Quad, D::Tri, D::Isoline})
            for (P p : {P::Integer, P::Pow2, P::FractionalOdd, P::FractionalEven}) {
                TessellatorState const state{domain, p, OutputPrimitive::Point};
                auto const edges = std::size_t(edge_factor_count(domain)),
                           all = std::size_t(tess_factor_count(domain));
                TessFactors const plain{3, 4, 5, 6, 7, 8};
                for (std::size_t i = 0; i < all; ++i) {
                    auto const with = [&](float f) {
                        TessFactors factors = plain;
                        factors[i] = f;
                        return process_tess_factors(state, factors);
                    };
                    EXPECT_EQ(with(nan).culled, i < edges) << i;
                    EXPECT_EQ(with(-tiny).culled, i < edges) << i;
                    EXPECT_EQ(with(tiny), with(1.0f)) << i; // the least of the mode
                    if (i >= edges) {
                        EXPECT_EQ(with(nan), with(1.0f)) << i;
                    }
                }
            }
    }
}

} // namespace
} // namespace tessemu::test
