// Tables of basis functions: against golden data and Stam's evaluation, and what they must be by
// symmetry; what patches share has equal bits.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/basis_tables/generator.h"

#include "pipeline/basis_tables/symmetry.h"
#include "pipeline/basis_tables/table_store.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/limit.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"
#include "tests/support/patch_types.h"
#include "tests/support/stam_evaluation.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <random>
#include <set>

namespace tessemu {
namespace {

using Table = std::vector<double> BasisTables::*;
constexpr Table kTables[] = {&BasisTables::position, &BasisTables::du, &BasisTables::dv};

double at(std::vector<double> const& table, int point, int i, int j)
{
    return table[std::size_t(point * kTableSamples + j * kTableSide + i)];
}

PatchType golden_type(nlohmann::json const& g)
{
    auto const kind = g["kind"].get<std::string>();
    int const k = g["k"];
    PatchType type = kind == "smooth" ? smooth_type(k)
                     : kind == "dart" ? dart_type(k, g["t"])
                                      : sector_type(k, g["j"], kind != "boundary");
    if (kind == "concave") type.corner.concave = {0};
    if (kind != "smooth") {
        type.sectors = SectorRules::Biermann;
        type.flatness = 0;
    }
    return type;
}

// What an edge that leans to the corner V changes at its other end P, next to V after the golden
// data's two steps, whose masks are those of plain edges. In the next step its edge point moves by
// (cos(theta)/4) (V - P), which has 1/9 in the position's mask and 4/(12 h), h = 1/8, in that of
// the tangent along the edge. By control point of V's ring.
std::vector<double> lean_after_two_steps(PatchType const& type, std::size_t edge)
{
    VertexRing const& c = type.corner;
    RingSharpness sharp = c.sharpness(type.sectors, type.flatness);
    double const w = CatmullClark::lean(sharp.leans()[edge].cos_theta);
    auto const size = std::size_t(type.ring_points());
    auto const unit = [&](std::size_t i) {
        RingWeights x(0.0, size);
        x[i] = 1;
        return x;
    };
    Ring<RingWeights> ring{unit(0), {}, {}};
    for (std::size_t j = 0; j < c.edge_count(); ++j) ring.edge.push_back(unit(1 + 2 * j));
    for (std::size_t j = 0; j < c.faces; ++j) ring.face.push_back(unit(2 + 2 * j));
    for (int step = 0; step < 2; ++step, sharp = sharp.after_step())
        ring = refined_ring<CatmullClark>(ring, sharp);
    RingWeights const out = w * (ring.vertex - ring.edge[edge]);
    return {std::begin(out), std::end(out)};
}

// Weights of magnitude up to 1, derivatives up to 32: the golden data's own 1e-12. At (0,0) only
// the tangents' directions.
TEST(BasisTables, AgreeWithGoldenDataInDouble)
{
    auto const data = nlohmann::json::parse(
        test::read_gzip(test::golden("subdivision/bolz_tables_level2.json.gz")));
    std::size_t compared = 0, leaning = 0;
    std::set<std::string> kinds;
    for (auto const& g : data.at("tables")) {
        PatchType const type = golden_type(g);
        SCOPED_TRACE(type.in_words());
        BasisTables const ours = make_basis_tables(type);
        ASSERT_EQ(std::size_t(ours.points), g["names"].size());
        // Both name V, e 0, f 0, ... and then the grid's points in the same order.
        char const* const names[] = {"pos", "du", "dv"};
        for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 5; ++column)
                for (int t = 0; t < 3; ++t) {
                    // Beside the corner on an edge that leans.
                    std::vector<double> change(std::size_t(ours.points), 0);
                    for (std::size_t edge : {0u, 1u}) {
                        if (row != int(edge) || column != 1 - int(edge)) continue;
                        std::size_t const e =
                            (type.corner.position + edge) % type.corner.edge_count();
                        if (type.sectors != SectorRules::Biermann || !type.corner.leans(e))
                            continue;
                        double const mask = t == 0 ? 1 / 9.0 : t == 1 + int(edge) ? -8 / 3.0 : 0;
                        auto const lean = lean_after_two_steps(type, e);
                        for (std::size_t k = 0; k < lean.size(); ++k) change[k] = mask * lean[k];
                        ++leaning;
                    }
                    auto const& theirs = g[names[t]][std::size_t(row)][std::size_t(column)];
                    double dot = 0, aa = 0, bb = 0, worst = 0;
                    for (int k = 0; k < ours.points; ++k) {
                        double const a = at(ours.*kTables[t], k, 8 * column, 8 * row),
                                     b = double(theirs[std::size_t(k)]) + change[std::size_t(k)];
                        dot += a * b, aa += a * a, bb += b * b;
                        worst = std::max(worst, std::abs(a - b));
                    }
                    ++compared;
                    if (row == 0 && column == 0 && t > 0)
                        EXPECT_NEAR(dot / std::sqrt(aa * bb), 1, 1e-12) << names[t];
                    else
                        EXPECT_LE(worst, 1e-12) << names[t] << " " << column << " " << row;
                }
        kinds.insert(g["kind"]);
    }
    EXPECT_EQ(compared, 35u * 25 * 3);
    EXPECT_EQ(kinds.size(), 5u);
    EXPECT_GT(leaning, 50u);
}

// Stam's net has the ring as we do, then (2,2) (2,1) (2,0) (2,-1) (1,2) (0,2) (-1,2).
TEST(BasisTables, OfSmoothVerticesAreStamsWeights)
{
    std::size_t compared = 0;
    for (int n = 3; n <= 12; ++n) {
        BasisTables const ours = make_basis_tables(smooth_type(n));
        test::Evaluation<double> stam(n);
        int const ring = 2 * n + 1, outer[] = {2, 1, 0, 5, 3, 4, 6}; // of ours, by Stam's
        for (int k = 0; k < 2 * n + 8; ++k) {
            std::vector<std::array<double, 3>> net(std::size_t(2 * n + 8), {0, 0, 0});
            net[std::size_t(k)] = {1, 0, 0};
            stam.project(net);
            int const point = k < ring ? k : ring + outer[k - ring];
            for (int j = 0; j < kTableSide; ++j)
                for (int i = j == 0 ? 1 : 0; i < kTableSide; ++i) {
                    auto const s = stam.at(i / 32.0, j / 32.0);
                    EXPECT_NEAR(at(ours.position, point, i, j), s.position.x, 1e-12);
                    EXPECT_NEAR(at(ours.du, point, i, j), s.du.x, 1e-12)
                        << n << " " << k << " " << i << " " << j;
                    EXPECT_NEAR(at(ours.dv, point, i, j), s.dv.x, 1e-12);
                    ++compared;
                }
        }
    }
    EXPECT_EQ(compared, 230u * (kTableSamples - 1));
}

// Sums of up to 32 weights below 1, and of derivatives below 32, each rounded some ten times.
TEST(BasisTables, WeightsSumTo1AndDerivativesTo0)
{
    for (SectorRules sectors : {SectorRules::OpenSubdiv, SectorRules::Biermann})
        for (PatchType const& type : test::all_types(7, sectors)) {
            BasisTables const b = make_basis_tables(type);
            for (int j = 0; j < kTableSide; ++j)
                for (int i = 0; i < kTableSide; ++i) {
                    double sum[3] = {-1, 0, 0};
                    for (int t = 0; t < 3; ++t)
                        for (int k = 0; k < b.points; ++k) sum[t] += at(b.*kTables[t], k, i, j);
                    EXPECT_LE(std::abs(sum[0]), 32 * 10 * 0x1p-53) << type.in_words();
                    for (int t : {1, 2})
                        EXPECT_LE(std::abs(sum[t]), 32 * 32 * 10 * 0x1p-53) << type.in_words();
                }
        }
}

// Control point k of a type in its mirror image: by name.
std::vector<int> mirrored_points(PatchType const& type)
{
    VertexRing const& c = type.corner;
    int const n = c.faces, edges = int(c.edge_count()), first = c.closed ? 1 : n;
    auto const wrapped = [&](int i) { return c.closed ? (i % n + n) % n : i; };
    std::vector<int> out{0};
    for (int i = 0; i < edges; ++i) {
        out.push_back(1 + 2 * wrapped(first - i));
        if (i < n) out.push_back(2 + 2 * wrapped(first - 1 - i));
    }
    int const ring = type.ring_points();
    for (int k : {4, 3, 2, 1, 0}) out.push_back(ring + k);
    if (type.has_lower() && type.has_left())
        out.insert(out.end(), {ring + 6, ring + 5});
    else if (type.has_lower() || type.has_left())
        out.push_back(ring + 5);
    return out;
}

PatchType mirrored(PatchType type)
{
    VertexRing& c = type.corner;
    int const n = c.faces;
    std::vector<float> edges = c.edges;
    for (int i = 0; i < int(edges.size()); ++i)
        c.edges[std::size_t(i)] = edges[std::size_t(c.closed ? ((1 - i) % n + n) % n : n - i)];
    if (!c.closed) c.position = std::uint16_t(n - 1 - c.position);
    return type;
}

// Sums are taken in another order, in each of some five steps and in the limit: half an ulp of 1,
// or of 32, each.
TEST(BasisTables, OfAMirrorImageAreMirrored)
{
    std::size_t compared = 0;
    for (SectorRules sectors : {SectorRules::OpenSubdiv, SectorRules::Biermann})
        for (PatchType const& type : test::all_types(6, sectors)) {
            BasisTables const a = make_basis_tables(type), b = make_basis_tables(mirrored(type));
            auto const other = mirrored_points(type);
            ASSERT_EQ(a.points, b.points);
            for (int k = 0; k < a.points; ++k)
                for (int j = 0; j < kTableSide; ++j)
                    for (int i = j == 0 ? 1 : 0; i < kTableSide; ++i) {
                        int const m = other[std::size_t(k)];
                        EXPECT_NEAR(at(a.position, k, i, j), at(b.position, m, j, i), 1e-14);
                        EXPECT_NEAR(at(a.du, k, i, j), at(b.dv, m, j, i), 32e-14)
                            << type.in_words() << " " << k << " " << i << " " << j;
                        ++compared;
                    }
        }
    EXPECT_GT(compared, 1000000u);
}

// Differences over one cell and over two: their errors are as 1 to 4, where third derivatives are
// piecewise constant as here away from the corner; nearly, for pieces meet.
TEST(BasisTables, TangentsAreTheDerivativesOfPositions)
{
    std::size_t compared = 0;
    for (SectorRules sectors : {SectorRules::OpenSubdiv, SectorRules::Biermann})
        for (PatchType const& type : test::all_types(6, sectors)) {
            BasisTables const b = make_basis_tables(type);
            for (int direction : {0, 1}) {
                double error[2] = {0, 0};
                for (int k = 0; k < b.points; ++k)
                    for (int j = 0; j < kTableSide; ++j)
                        for (int i = 18; i < kTableSide - 2; ++i) {
                            auto const value = [&](std::vector<double> const& t, int d) {
                                return direction == 0 ? at(t, k, i + d, j) : at(t, k, j, i + d);
                            };
                            double const exact = value(direction == 0 ? b.du : b.dv, 0);
                            for (int d : {1, 2}) {
                                double const difference =
                                    (value(b.position, d) - value(b.position, -d)) * 16 / d;
                                error[d - 1] = std::max(error[d - 1], std::abs(difference - exact));
                            }
                        }
                EXPECT_LT(error[0], 4e-3) << type.in_words(); // h^2/6 of third derivatives up to 24
                EXPECT_GT(error[1], 3 * error[0]) << type.in_words();
                EXPECT_LT(error[1], 5 * error[0]) << type.in_words();
                ++compared;
            }
        }
    EXPECT_GT(compared, 300u);
}

TEST(TableSet, HasThePapersCounts)
{
    std::map<PatchFamily, std::size_t> tables, types;
    for (TableFamily const& f : table_families(1, 12, {.sectors = SectorRules::Biermann}))
        for (PatchType const& t : f.types) {
            if (f.family == PatchFamily::Smooth && t.corner.faces < 3) continue;
            if (f.family == PatchFamily::Dart && t.corner.faces < 3) continue;
            EXPECT_TRUE(t.family() == f.family || t.family() == PatchFamily::Regular);
            tables[f.family] += std::size_t(t.points());
            ++types[f.family];
        }
    EXPECT_EQ(tables[PatchFamily::Smooth], 230u);
    EXPECT_EQ(tables[PatchFamily::Crease], 1978u);
    EXPECT_EQ(tables[PatchFamily::ConvexCorner], 1978u);
    EXPECT_EQ(tables[PatchFamily::ConcaveCorner], 1978u - 9);
    EXPECT_EQ(tables[PatchFamily::Dart], 1890u);
}

TEST(PatchType, HasBytesOfItsOwn)
{
    std::set<std::string> seen;
    std::vector<PatchType> types = test::all_types(6, SectorRules::Biermann);
    PatchType semi = smooth_type(5);
    semi.corner.edges = {0, 1.5f, 0, kInfinitelySharp, 0.25f};
    semi.corner.vertex = 2;
    semi.crease_method = CreaseMethod::Chaikin;
    semi.outer = {0, 1, 0, 0, 2};
    semi.beyond[PatchType::UpperVertex] = sector_type(3, 1).corner;
    types.push_back(semi);
    semi.flatness = 0.25;
    types.push_back(semi);
    for (PatchType const& type : types) {
        std::string const bytes = type.bytes();
        EXPECT_TRUE(seen.insert(bytes).second);
        EXPECT_EQ(type.bytes(), bytes);
    }
}

std::vector<PatchTypeTables> in_single_precision(std::vector<PatchType> const& types)
{
    std::vector<PatchTypeTables> out;
    for (PatchType const& t : types)
        out.push_back(tessemu::in_single_precision(t, make_basis_tables(t)));
    return out;
}

// 4 classes off the corner, and 2 of the points beyond the ring, for any valence and tag: the
// paper's. At a tag a side has no mirror image in itself, so that directed classes stay apart: 6.
TEST(Symmetry, HasThePapersClasses)
{
    auto tables = in_single_precision(test::all_types(6));
    auto const report = enforce_symmetry(tables, possible_joints(tables), {}, CountClasses::Yes);
    EXPECT_EQ(report.off_corner.undirected, 4u);
    EXPECT_EQ(report.off_corner.directed, 8u);
    EXPECT_EQ(report.off_corner_at_a_tag.directed, 6u);
    EXPECT_EQ(report.two_ring.directed, 2u);
    EXPECT_LE(report.passes, 2u);
    // What is equal stays so.
    auto const again = enforce_symmetry(tables, possible_joints(tables), {});
    EXPECT_EQ(again.changed, 0u);
    EXPECT_EQ(again.entries, report.entries);
}

} // namespace
} // namespace tessemu
