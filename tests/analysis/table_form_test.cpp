// The table form on Loop's scheme: limits of another implementation, closed edges, tables.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/table_form.h"

#include "analysis/watertight.h"
#include "io/model.h"
#include "pipeline/mesh/loop.h"
#include "tests/support/edges.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

namespace tessemu {
namespace {

using Vec = glm::dvec3;

SchemeOnMesh loop_on(ControlMesh mesh, ParameterTexts set = {})
{
    return build_scheme(find_scheme("tables-loop"), std::move(mesh), {.set = std::move(set)});
}

struct LimitSamples {
    double diagonal = 0;
    struct Sample {
        Vec position, normal;
    };
    /// Face; weights of its corners 1 and 2 in eighths.
    std::map<std::array<int, 3>, Sample> at;
};

LimitSamples read_samples(std::filesystem::path const& path)
{
    LimitSamples out;
    std::istringstream in(test::read_gzip(path));
    std::string line;
    std::getline(in, line);
    out.diagonal = std::stod(line.substr(line.find("bbox_diag=") + 10));
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::istringstream row(line);
        double c[10];
        for (double& x : c) {
            row >> x;
            row.ignore();
        }
        auto const eighth = [](double x) { return int(std::lround(8 * x)); };
        // Printed with 10 digits.
        EXPECT_NEAR(8 * c[2], eighth(c[2]), 1e-9) << "a sample between our rows";
        out.at[{int(c[0]), eighth(c[2]), eighth(c[3])}] = {{c[4], c[5], c[6]}, {c[7], c[8], c[9]}};
    }
    return out;
}

// The pattern has all dyadic points: 4 segments on half an edge are eighths of it.
void expect_limit(std::filesystem::path const& model, std::filesystem::path const& samples)
{
    LimitSamples const limit = read_samples(samples);
    ASSERT_GT(limit.at.size(), 0u);
    SchemeOnMesh const m = loop_on(load_model(model.string()).mesh, {{"mesher", "pattern"}});
    FrameSettings s;
    s.tess_factor = 4;
    double worst = 0;
    std::map<std::array<int, 3>, int> met;
    visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& patch) {
        for (std::size_t i = 0; i < patch.points(); ++i) {
            UnitPoint const at =
                domain_to_unit(patch.place(), patch.domain().u[i], patch.domain().v[i]);
            std::array const key{int(m.mesh->base().file_face(patch.place().face)), int(8 * at.v),
                                 int(8 * (1 - at.u - at.v))};
            auto const found = limit.at.find(key);
            if (found == limit.at.end()) continue; // of a coarser grid
            ++met[key];
            worst =
                std::max(worst, distance(Vec(patch.vertex(i).position), found->second.position) /
                                    limit.diagonal);
        }
    });
    EXPECT_EQ(met.size(), limit.at.size());
    // Weights and positions are floats: M1 and a sum of up to 20 products round some 40 times, each
    // by 2^-24 of at most 0.9 diagonals, 2.1e-6 if all went one way.
    EXPECT_LT(worst, 2e-6);
    testing::Test::RecordProperty("worst_distance_in_diagonals",
                                  std::to_string(worst * 1e9) + "e-9");
}

TEST(TablesLoop, PatternsPointsAreLimitsWithSemiSharpCreases)
{
    expect_limit(test::golden("limit/loop_cube_creases1.obj"),
                 test::golden("limit/loop_cube_creases1.loop.csv.gz"));
}

TEST(TablesLoop, PatternsPointsAreLimitsAtABoundary)
{
    expect_limit(test::golden("limit/loop_saddle_edgeonly.obj"),
                 test::golden("limit/loop_saddle_edgeonly.loop.csv.gz"));
}

class LoopLimitOf : public testing::TestWithParam<char const*> {};

TEST_P(LoopLimitOf, PatternsPointsAreThoseOfAnotherImplementation)
{
    std::string const name = GetParam();
    TESSEMU_NEEDS_SHARED("golden/limit/" + name + ".loop.csv.gz");
    expect_limit(test::shared("models/" + name + ".obj"),
                 test::shared("golden/limit/" + name + ".loop.csv.gz"));
}
INSTANTIATE_TEST_SUITE_P(Models, LoopLimitOf,
                         testing::Values("loop_cube", "loop_icosahedron", "loop_xord_interior",
                                         "knight_tri_1k"));

ControlMesh icosahedron()
{
    ControlMesh m;
    float const g = 1.618034f;
    m.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    using Face = std::array<std::uint32_t, 3>;
    for (Face const& f :
         {Face{0, 11, 5}, {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
          {11, 10, 2},    {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
          {3, 8, 9},      {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}})
        m.add_face(f);
    return m;
}

// A triangle strip round an infinitely sharp crease that ends: darts, crease vertices, a corner.
ControlMesh creased_icosahedron()
{
    ControlMesh m = icosahedron();
    auto const f = m.face(0);
    m.creases.push_back({f[0], f[1], kInfinitelySharp});
    m.creases.push_back({f[1], f[2], kInfinitelySharp});
    auto const g = m.face(7);
    m.creases.push_back({g[0], g[1], 2.5f});
    m.corners.push_back({m.face(13)[0], kInfinitelySharp});
    return m;
}

std::map<std::string, ControlMesh> tagged_meshes()
{
    std::map<std::string, ControlMesh> out;
    out["creased icosahedron"] = creased_icosahedron();
    ControlMesh chaikin = creased_icosahedron();
    auto const g = chaikin.face(7);
    chaikin.creases.push_back({g[1], g[2], 1.25f});
    chaikin.rules.crease_method = CreaseMethod::Chaikin;
    out["Chaikin"] = chaikin;
    ControlMesh loop = icosahedron(); // a closed crease: normals of two sides
    Topology const t(loop);
    for (HalfEdge h : t.ring(0)) {
        HalfEdge const across = t.next(h);
        loop.creases.push_back(
            {t.vertex_of(across), t.vertex_of(t.next(across)), kInfinitelySharp});
    }
    out["closed crease"] = loop;
    out["saddle"] = load_model(test::golden("limit/loop_saddle_edgeonly.obj").string()).mesh;
    return out;
}

TEST(TablesLoop, SharedEdgesHaveEqualBitsWithBothMeshersAndAllTags)
{
    ThreadPool const threads;
    for (auto const& [name, mesh] : tagged_meshes())
        for (std::array<char const*, 2> const& choice :
             {std::array{"tessellator", "shading"}, std::array{"tessellator", "tangents"},
              std::array{"pattern", "shading"}, std::array{"pattern", "tangents"}}) {
            SCOPED_TRACE(name + ", " + choice[0] + ", " + choice[1]);
            SchemeOnMesh const m = loop_on(mesh, {{"mesher", choice[0]}, {"normals", choice[1]}});
            bool const is_pattern = std::string(choice[0]) == "pattern";
            std::vector<float> const factors =
                is_pattern ? std::vector{1.0f, 8.0f, 32.0f} : std::vector{1.0f, 4.0f, 7.3f, 64.0f};
            for (Machine const& machine : test::contraction_policies(20))
                for (std::size_t i = 0; i < factors.size(); ++i) {
                    if (!test::meets_case(machine, i, factors.size())) continue;
                    FrameSettings s;
                    s.tess_factor = factors[i];
                    s.machine = machine;
                    test::EdgeComparison const c = test::compare_edges(*m.patches, s, threads);
                    ASSERT_GT(c.shared_points, 0u);
                    ASSERT_EQ(c.lonely_points, 0u);
                    ASSERT_EQ(c.differing_positions, 0u) << c.first_difference;
                    if (!m.patches->has_creases()) {
                        ASSERT_EQ(c.differing_normals, 0u) << c.first_difference;
                    }
                }
        }
}

TEST(TablesLoop, PassesTheCrackCheckInAllPartitioningsAndWithMixedFactors)
{
    ThreadPool const threads;
    for (auto const& [name, mesh] : tagged_meshes()) {
        for (char const* normals : {"shading", "tangents"})
            for (Partitioning p : {Partitioning::Integer, Partitioning::Pow2,
                                   Partitioning::FractionalOdd, Partitioning::FractionalEven})
                for (bool mixed : {false, true}) {
                    SCOPED_TRACE(name + " " + normals + " " + std::to_string(int(p)));
                    SchemeOnMesh const m = loop_on(mesh, {{"normals", normals}});
                    WatertightSettings s;
                    s.frame.tess_factor = 5.5f;
                    s.frame.partitioning = p;
                    s.frame.width = s.frame.height = 200;
                    s.frame.camera = frame_points(m.mesh->base().positions, {1, 2, 3}, 1);
                    if (mixed) s.frame.adaptive = {AdaptiveFactors::Kind::Pixels, 9};
                    s.rays = 2000;
                    auto const verdicts = check_watertight(*m.patches, s, threads);
                    EXPECT_TRUE(any_checked(verdicts));
                    for (CheckedVerdict const& v : verdicts)
                        EXPECT_NE(v.verdict, Verdict::Fail) << v.name;
                }
    }
}

TEST(TablesLoop, CracksWhereTablesAreNotEnforced)
{
    SchemeOnMesh const m = loop_on(icosahedron(), {{"tables", "unenforced"}});
    FrameSettings s;
    s.tess_factor = 8;
    test::EdgeComparison const c = test::compare_edges(*m.patches, s, ThreadPool());
    EXPECT_GT(c.differing_positions, 10u);
}

TEST(MeshTables, WeightsSumToOneAndTangentsToZero)
{
    for (auto const& [name, mesh] : tagged_meshes()) {
        SCOPED_TRACE(name);
        SchemeOnMesh const m = loop_on(mesh);
        auto const& tables = static_cast<TableForm const&>(*m.patches).tables();
        for (TypeOfTables const& t : tables.types()) {
            auto const samples = std::size_t(t.grid.samples());
            EXPECT_EQ(samples, 561u);
            for (std::size_t s = 0; s < samples; ++s) {
                double sums[3] = {};
                for (std::size_t k = 0; k < std::size_t(t.points); ++k) {
                    sums[0] += double(t.position[k * samples + s]);
                    for (int i : {0, 1}) sums[1 + i] += double(t.tangents[i][k * samples + s]);
                }
                EXPECT_NEAR(sums[0], 1, 1e-6);
                EXPECT_NEAR(sums[1], 0, 1e-6);
                EXPECT_NEAR(sums[2], 0, 1e-6);
            }
        }
    }
}

// Corner triangles around vertices of valence 5, and the middle ones; 5 + 6 and 12 points.
TEST(MeshTables, TypesOfAnIcosahedronAreTwo)
{
    SchemeOnMesh const m = loop_on(icosahedron());
    auto const& tables = static_cast<TableForm const&>(*m.patches).tables();
    ASSERT_EQ(tables.types().size(), 2u);
    EXPECT_EQ(std::min(tables.types()[0].points, tables.types()[1].points), 11);
    EXPECT_EQ(std::max(tables.types()[0].points, tables.types()[1].points), 12);
    EXPECT_EQ(tables.vertices().size(), 42u);
    EXPECT_FALSE(tables.has_creases());
}

// k triangles around vertex 0, all around or from one boundary edge to the other.
ControlMesh fan(std::uint32_t k, bool is_closed)
{
    ControlMesh m;
    m.positions.push_back({0, 0, 0});
    std::uint32_t const rim = is_closed ? k : k + 1;
    for (std::uint32_t i = 0; i < rim; ++i) {
        float const t = 2 * float(i) / float(rim) - 1; // no matter where
        m.positions.push_back({t, 1 - t * t, 0});
    }
    for (std::uint32_t i = 0; i < k; ++i)
        m.add_face(std::array<std::uint32_t, 3>{0, 1 + i, 1 + (i + 1) % rim});
    m.rules.boundary = BoundaryRule::EdgeOnly;
    return m;
}

// HOLL10 section 3: "about 9 MB for tables of level 5 for interior and boundary cases up to valence
// 18". Its layout is not printed: rows of one length, 18 + 6 weights, come nearest.
TEST(MeshTables, TheirSizeUpToValence18IsThePapers9MegabytesWhenPadded)
{
    std::set<LocalMesh> types;
    std::size_t interior = 0, boundary = 0, most = 0;
    auto const add = [&](std::uint32_t k, bool is_closed) {
        RefinedMesh const m(fan(k, is_closed), 1, loop_step);
        auto const make = [](LocalMesh const& type) {
            return make_local_tables<Loop>(type, MeshTables::kSteps);
        };
        MeshTables const tables(m.topology(), make, {});
        std::uint32_t const center = std::uint32_t(m.tables()[0].edges);
        for (MeshTables::Patch const& p : tables.patches()) {
            auto const face = m.mesh().face(p.face);
            TypeOfTables const& t = tables.types()[p.type];
            if (std::find(face.begin(), face.end(), center) == face.end()) continue;
            if (!types.insert(t.type).second) continue;
            (is_closed ? interior : boundary) += std::size_t(t.points);
            most = std::max(most, std::size_t(t.points));
        }
    };
    for (std::uint32_t n = 3; n <= 18; ++n) add(n, true);
    for (std::uint32_t k = 1; k <= 17; ++k) add(k, false);
    EXPECT_EQ(interior, 264u);
    // Of three triangles at a boundary the first and the last are one type, turned: counted by
    // their places there is one more, of 9 points.
    EXPECT_EQ(boundary, 2822u - 9);
    EXPECT_EQ(types.size() + 1, 16u + 17 * 18 / 2);
    EXPECT_EQ(most, 24u);
    std::size_t const bytes = 561 * sizeof(float);
    EXPECT_NEAR(double(bytes * (interior + boundary)) / 1e6, 6.9, 0.05);       // as long as needed
    EXPECT_NEAR(double(bytes * (types.size() + 1) * most) / 1e6, 9.10, 0.005); // all alike
}

} // namespace
} // namespace tessemu
