// LOOP10's patch types (4.4), and the tables that are made of them before a mesh is there.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/valence_type.h"

#include "pipeline/forms/stencil_form.h"
#include "pipeline/frame.h"
#include "pipeline/schemes/gregory/stencils.h"
#include "tests/support/cages.h"
#include "tests/support/machines.h"
#include "tests/support/random_mesh.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace tessemu {
namespace {

TEST(ValenceType, Loop10sNumbersOfTypes)
{
    std::vector<ValenceType> const all = valence_types();
    EXPECT_EQ(all.size(), 449u); // LOOP10 4.4
    EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
    EXPECT_EQ(valence_types(1000).size(), 2530u); // what 32 points leave out: all necklaces of ten
    std::set<ValenceType> reflected;
    for (ValenceType const& t : all) {
        EXPECT_TRUE(t.is_of_loop10());
        auto const& [a, b, c, d] = t.valence;
        EXPECT_LE(a + b + c + d, 24); // the same limit in valences
        reflected.insert(std::min(t, valence_type(std::array{d, c, b, a})));
    }
    EXPECT_EQ(reflected.size(), 291u);
}

TEST(ValenceType, IsolationLeavesNineBesidesTheRegularOneWith2nPlus8Inputs)
{
    std::vector<ValenceType> const ten = isolated_valence_types();
    std::set<ValenceType> irregular;
    for (int n = 3; n <= 12; ++n) {
        ValenceType const& t = ten.at(std::size_t(n - 3));
        EXPECT_EQ(t, valence_type(std::array{4, n, 4, 4}));
        EXPECT_EQ(t.inputs(), 2 * n + 8);
        EXPECT_TRUE(t.is_isolated() && t.is_of_loop10());
        if (n != 4) irregular.insert(t);
    }
    EXPECT_EQ(irregular.size(), 9u);
    std::vector<ValenceType> all = valence_types();
    EXPECT_EQ(std::count_if(all.begin(), all.end(), [](auto& t) { return t.is_isolated(); }), 10);
    EXPECT_FALSE(valence_type(std::array{4, 13, 4, 4}).is_of_loop10());
    EXPECT_FALSE(valence_type(std::array{4, 2, 4, 4}).is_of_loop10());
}

TEST(ValenceType, ACageOfATypeHasItsInputsAndIsOfIt)
{
    Neighbourhood n;
    for (ValenceType const& t : valence_types()) {
        ControlMesh const cage = one_ring_cage(t);
        EXPECT_EQ(int(cage.positions.size()), t.inputs());
        find_neighbourhood(Topology(cage), 0, n);
        EXPECT_EQ(int(n.inputs.size()), t.inputs());
        EXPECT_EQ(valence_type(n), t);
    }
}

ControlMesh together(std::vector<ControlMesh> const& parts)
{
    ControlMesh out;
    for (ControlMesh const& m : parts) {
        auto const first = std::uint32_t(out.positions.size());
        out.positions.insert(out.positions.end(), m.positions.begin(), m.positions.end());
        for (std::size_t f = 0; f < m.faces(); ++f) {
            std::vector<std::uint32_t> face(m.face(f).begin(), m.face(f).end());
            for (std::uint32_t& v : face) v += first;
            out.add_face(face);
        }
    }
    return out;
}
// Closed quads with every valence from 3 to `most`.
ControlMesh all_valences(int most)
{
    std::vector<ControlMesh> parts;
    for (int n = 3; n <= most; ++n) parts.push_back(test::trapezohedron(n).mesh);
    parts.push_back(test::torus(5, 4).mesh);
    return together(parts);
}

SchemeOnMesh gregory(ControlMesh const& mesh, char const* matrices, int subdivide)
{
    BuildOptions options;
    options.subdivide = subdivide;
    options.set = {{"matrices", matrices}};
    return build_scheme(find_scheme("gregory-stencil"), mesh, options);
}

TEST(ValenceType, AfterAStepGregoryPatchesOfValences3To12AreOfExactlyNineTypes)
{
    SchemeOnMesh const on = gregory(all_valences(12), "demand", 1);
    std::set<ValenceType> used;
    std::size_t patches = 0;
    for (PatchCount const& c : on.patches->patch_counts()) {
        bool const regular = c.kind.patch_class == PatchClass::RegularQuad;
        EXPECT_EQ(c.types, regular ? 1u : 9u) << c.kind.name;
        EXPECT_EQ(c.valence_types.size(), c.types);
        std::size_t of_types = 0;
        for (auto const& [type, n] : c.valence_types) used.insert(type), of_types += n;
        EXPECT_EQ(of_types, c.patches) << c.kind.name;
        patches += c.patches;
    }
    EXPECT_EQ(patches, on.mesh->mesh().faces());
    std::vector<ValenceType> const ten = isolated_valence_types();
    EXPECT_EQ(used, std::set<ValenceType>(ten.begin(), ten.end()));
}

// A row made of a type without a mesh, and of a patch of that type in a mesh.
TEST(ValenceType, RowsMadeOfATypeEqualThoseOfAnyPatchOfItBitForBit)
{
    std::set<ValenceType> seen;
    auto const expect_equal = [&](ControlMesh const& mesh) {
        Topology const topology(mesh);
        Neighbourhood of_mesh, of_type;
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
            find_neighbourhood(topology, f, of_mesh);
            std::optional<ValenceType> const type = valence_type(of_mesh);
            // Where vertices around coincide, as across a small torus, a type of its own.
            if (!type || int(of_mesh.inputs.size()) != type->inputs()) continue;
            ControlMesh const cage = one_ring_cage(*type);
            find_neighbourhood(Topology(cage), 0, of_type);
            ASSERT_EQ(of_mesh.key, of_type.key);
            PatchStencils const a = make_gregory_stencils(of_mesh, false, {}),
                                b = make_gregory_stencils(of_type, false, {});
            ASSERT_EQ(a.rows, b.rows);
            ASSERT_TRUE(std::equal(a.corner_row, a.corner_row + 4, b.corner_row));
            seen.insert(*type);
        }
    };
    expect_equal(load_model("golem").mesh);
    expect_equal(all_valences(12));
    expect_equal(gregory(all_valences(12), "demand", 1).mesh->mesh());
    EXPECT_GT(seen.size(), 15u);
}

TEST(ValenceType, AfterAStepNoTableIsMadeBesidesThoseMadeAhead)
{
    auto const weights = [](ControlMesh const& mesh) {
        SchemeOnMesh const on = gregory(mesh, "ahead", 1);
        return dynamic_cast<StencilForm const&>(*on.patches).tables().weights;
    };
    std::vector<float> const ten = weights(test::torus(5, 4).mesh); // regular quads alone
    EXPECT_GT(ten.size(), 9u * 20 * 14);
    EXPECT_EQ(weights(all_valences(12)), ten);
}

// Whether tables are made on demand or ahead changes their places and nothing else.
TEST(ValenceType, TablesMadeAheadDrawTheSameBitsAndCountTheSame)
{
    for (int subdivide : {0, 1}) {
        ControlMesh const mesh = all_valences(8);
        SchemeOnMesh const demand = gregory(mesh, "demand", subdivide),
                           ahead = gregory(mesh, "ahead", subdivide);
        auto const& a = dynamic_cast<StencilForm const&>(*demand.patches).tables();
        auto const& b = dynamic_cast<StencilForm const&>(*ahead.patches).tables();
        EXPECT_GT(b.weights.size(), a.weights.size()); // those of valences 9 to 12 too
        ASSERT_EQ(a.groups.size(), b.groups.size());
        std::size_t compared = 0;
        for (std::size_t g = 0; g < a.groups.size(); ++g) {
            auto const &x = a.groups[g], &y = b.groups[g];
            EXPECT_EQ(x.indices, y.indices);
            EXPECT_EQ(x.order, y.order);
            ASSERT_EQ(x.patches, y.patches);
            constexpr auto kWords = std::size_t(StencilPatchWords::count(4));
            for (std::size_t p = 0; p < x.patches.size(); ++p) {
                auto const *const v = x.words.data() + p * kWords, *const w =
                                                                       y.words.data() + p * kWords;
                ASSERT_TRUE(std::equal(v + StencilPatchWords::kRows, v + kWords,
                                       w + StencilPatchWords::kRows));
                std::size_t const rows = v[StencilPatchWords::kRows];
                auto const weights = [&](auto const& t, auto const* words) {
                    return t.weights.data() + words[StencilPatchWords::kWeights];
                };
                auto const masks = [&](auto const& t, auto const* words) {
                    return t.zero_masks.data() + words[StencilPatchWords::kMasks];
                };
                std::size_t const n = rows * std::size_t(x.inputs);
                ASSERT_TRUE(std::equal(weights(a, v), weights(a, v) + n, weights(b, w)));
                ASSERT_TRUE(std::equal(masks(a, v), masks(a, v) + rows, masks(b, w)));
                compared += n;
            }
        }
        EXPECT_GT(compared, 0u);

        FrameSettings s;
        s.tess_factor = 3;
        std::vector<float> points[2];
        DrawStatistics counts[2];
        for (std::size_t i : {0, 1})
            counts[i] = visit_surface(*(i ? ahead : demand).patches, s, ThreadPool(2),
                                      [&](SurfacePatch const& p) {
                                          for (std::size_t k = 0; k < p.points(); ++k) {
                                              std::vector<float> const x = p.scalars(k);
                                              points[i].insert(points[i].end(), x.begin(), x.end());
                                          }
                                      })
                            .total;
        EXPECT_FALSE(points[0].empty());
        EXPECT_EQ(points[0], points[1]);
        EXPECT_EQ(counts[0].stages, counts[1].stages);
        EXPECT_EQ(counts[0].pipeline.DSInvocations, counts[1].pipeline.DSInvocations);
    }
}

} // namespace
} // namespace tessemu
