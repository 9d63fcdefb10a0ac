// Subdivision by tables and kernels (LOOP10 section 3): figure 2, golden data in double through the
// kernels' own formulas, bits and counts of the dispatches.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/commands/subdivision.h"

#include "io/model.h"
#include "pipeline/commands/patch_mesh.h"
#include "pipeline/mesh/catmull_clark.h"
#include "shaders_cpp/subdivision/catmull_clark_kernels.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"
#include "tests/support/machines.h"
#include "tests/support/point_sets.h"
#include "tests/support/random_mesh.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <glm/geometric.hpp>

#include <cstring>
#include <set>

namespace tessemu {
namespace {

using Vec = glm::dvec3;
using Words = std::vector<std::uint32_t>;

// LOOP10's figure 1 and 2.
ControlMesh pyramid()
{
    ControlMesh m;
    m.positions = {{0, 0, 1}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    for (Words const& f : {Words{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}, {4, 3, 2, 1}})
        m.add_face(f);
    return m;
}

SubdivisionTables tables_of(ControlMesh const& mesh)
{
    Topology const topology(mesh);
    return catmull_clark_tables(topology, Sharpness(topology), 0, false);
}

// The row, begun at another pair.
bool is_turned(Words row, Words const& printed)
{
    for (std::size_t k = 0; k < row.size(); k += 2) {
        if (row == printed) return true;
        std::rotate(row.begin(), row.begin() + 2, row.end());
    }
    return false;
}

TEST(SubdivisionTables, AreThoseOfFigure2)
{
    SubdivisionTables const t = tables_of(pyramid());
    EXPECT_EQ(t.first_face_point(), 5u);
    EXPECT_EQ(t.first_edge_point(), 10u);
    EXPECT_EQ(t.first_vertex_point(), 18u);
    EXPECT_EQ(t.buffer_size(), 23u);
    EXPECT_EQ(t.face_offset_valence, (Words{0, 3, 3, 3, 6, 3, 9, 3, 12, 4}));
    EXPECT_EQ(t.face_index, (Words{0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1, 4, 3, 2, 1}));
    EXPECT_EQ(t.edge_index, (Words{0, 5, 2, 6, 1, 5, 0, 8, 2, 5, 1, 9, 0, 6, 3, 7,
                                   3, 6, 2, 9, 0, 7, 4, 8, 4, 7, 3, 9, 1, 8, 4, 9}));
    EXPECT_EQ(t.vertex_offset_valence, (Words{0, 4, 8, 3, 14, 3, 20, 3, 26, 3}));
    // Where a row begins is arbitrary in the figure.
    Words const printed[] = {{4, 8, 1, 5, 2, 6, 3, 7},
                             {4, 9, 2, 5, 0, 8},
                             {3, 6, 0, 5, 1, 9},
                             {4, 7, 0, 6, 2, 9},
                             {1, 8, 0, 7, 3, 9}};
    for (std::size_t v = 0; v < 5; ++v) {
        auto const first = t.vertex_index.begin() + t.vertex_offset_valence[2 * v];
        Words const row(first, first + 2 * std::ptrdiff_t(t.vertex_offset_valence[2 * v + 1]));
        EXPECT_TRUE(is_turned(row, printed[v])) << v;
    }
    EXPECT_TRUE(t.blended.target.empty());
}

// An open strip of two quads: a corner's vertex stays, the others on the boundary lie on a curve.
TEST(SubdivisionTables, HaveBoundariesInThePapersEncoding)
{
    ControlMesh m;
    m.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}};
    m.add_face(Words{0, 1, 4, 3});
    m.add_face(Words{1, 2, 5, 4});
    SubdivisionTables const t = tables_of(m);
    ASSERT_EQ(t.edges, 7u);
    for (std::size_t e = 0; e < 7; ++e) {
        std::uint32_t const* const row = t.edge_index.data() + 4 * e;
        bool const inner = std::set{row[0], row[2]} == std::set{1u, 4u} && row[0] != row[1];
        if (inner) {
            EXPECT_EQ((std::set{row[1], row[3]}), (std::set{6u, 7u}));
        } else {
            EXPECT_EQ(row[0], row[1]);
            EXPECT_EQ(row[2], row[3]);
        }
    }
    EXPECT_EQ(t.vertex_offset_valence, (Words{0, 0, 0, 1, 2, 0, 2, 0, 2, 1, 4, 0}));
    EXPECT_EQ(t.vertex_index, (Words{2, 0, 3, 5}));
    m.rules.boundary = BoundaryRule::EdgeOnly; // smooth through the corners
    EXPECT_EQ(tables_of(m).vertex_index.size(), 12u);
}

// A crease along an edge is a boundary to the tables; what ends in the step is blended.
TEST(SubdivisionTables, HaveSharpTagsInTheSameEncodingAndBlendTheRest)
{
    ControlMesh m = pyramid();
    m.creases = {{1, 2, 10}, {2, 3, 2.5f}};
    m.corners = {{0, 3}};
    SubdivisionTables t = tables_of(m);
    EXPECT_EQ(t.vertex_offset_valence[1], 0u);
    EXPECT_EQ(t.vertex_offset_valence[5], 1u) << "vertex 2 lies between two sharp edges";
    EXPECT_EQ(t.vertex_offset_valence[3], 3u) << "a dart is smooth";
    EXPECT_TRUE(t.blended.target.empty());
    m.corners = {{0, 0.5f}};
    t = tables_of(m);
    EXPECT_EQ(t.blended.target, Words{t.first_vertex_point()});
    m.corners = {};
    m.creases = {{1, 2, 0.25f}};
    t = tables_of(m);
    ASSERT_EQ(t.blended.target.size(), 1u) << "the edge; its ends are darts";
    double sum = 0;
    for (float w : t.blended.weights) sum += w;
    EXPECT_EQ(sum, 1);
    m.creases = {};
    m.rules.smooth_triangles = true;
    EXPECT_EQ(tables_of(m).blended.target.size(), 8u) << "every edge has a triangle";
}

// The kernels' formulas in double over a step's tables.
void run_in_double(SubdivisionTables const& t, std::vector<Vec>& x)
{
    auto const row = [&](Words const& index, std::size_t first) {
        return [&x, &index, first](int k) {
            Vec const& p = x[index[first + std::size_t(k)]];
            return float3<double>(p.x, p.y, p.z);
        };
    };
    auto const add = [&](float3<double> const& p) { x.emplace_back(p.x, p.y, p.z); };
    ASSERT_EQ(x.size(), t.first_face_point());
    for (std::size_t f = 0; f < t.faces; ++f)
        if (t.face_offset_valence.empty())
            add(mean_of_four<double>(row(t.face_index, 4 * f)));
        else
            add(face_point<double>(std::int32_t(t.face_offset_valence[2 * f + 1]),
                                   row(t.face_index, t.face_offset_valence[2 * f])));
    for (std::size_t e = 0; e < t.edges; ++e) add(mean_of_four<double>(row(t.edge_index, 4 * e)));
    for (std::size_t v = 0; v < t.vertices; ++v) {
        Vec const old = x[x.size() - t.new_points()];
        add(vertex_point<double>(std::int32_t(t.vertex_offset_valence[2 * v + 1]),
                                 {old.x, old.y, old.z},
                                 row(t.vertex_index, t.vertex_offset_valence[2 * v])));
    }
    for (std::size_t r = 0; r < t.blended.target.size(); ++r) {
        Vec sum(0);
        for (std::size_t k = t.blended.first[r]; k < t.blended.first[r + 1]; ++k)
            sum += double(t.blended.weights[k]) * x[t.blended.points[k]];
        x[t.blended.target[r]] = sum;
    }
}

nlohmann::json const& golden()
{
    static nlohmann::json const data = nlohmann::json::parse(
        test::read_gzip(test::golden("subdivision/catmull_clark_refine.json.gz")));
    return data.at("meshes");
}

ControlMesh mesh_of(nlohmann::json const& g)
{
    ControlMesh m;
    for (auto const& p : g["verts"]) m.positions.emplace_back(p[0], p[1], p[2]);
    for (auto const& f : g["faces"]) m.add_face(f.get<Words>());
    for (auto const& c : g["creases"]) m.creases.push_back({c[0], c[1], 10});
    return m;
}

// Data of magnitude about 1, means of up to 25 points: the golden data's own 1e-12.
TEST(SubdivisionKernels, AgreeWithGoldenDataInDouble)
{
    std::size_t second = 0;
    for (auto const& [name, g] : golden().items()) {
        SCOPED_TRACE(name);
        std::vector<Vec> x;
        for (auto const& p : g["verts"]) x.emplace_back(p[0], p[1], p[2]);
        RefinedMesh const refined(mesh_of(g), 2, catmull_clark_step);
        std::size_t first = refined.tables()[0].first_face_point();
        run_in_double(refined.tables()[0], x);
        EXPECT_LE(test::worst_distance(std::span(x).subspan(first), g["level1_verts"]), 1e-12);
        if (!g.contains("level2_verts")) continue; // of large meshes
        ++second;
        first = refined.tables()[1].first_face_point();
        run_in_double(refined.tables()[1], x);
        EXPECT_LE(test::worst_distance(std::span(x).subspan(first), g["level2_verts"]), 1e-12);
    }
    EXPECT_EQ(golden().size(), 23u);
    EXPECT_GE(second, 10u);
}

std::vector<std::pair<std::string, ControlMesh>> cages()
{
    std::vector<std::pair<std::string, ControlMesh>> out;
    for (char const* name : {"golem", "jug", "spindle", "saddle_star"})
        out.emplace_back(name, load_model(name).mesh);
    out.emplace_back("prism", test::prism(7));
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
        ControlMesh const m = test::join_faces(test::random_mesh(seed), seed);
        out.emplace_back("random " + std::to_string(seed), m);
        out.emplace_back("tagged " + std::to_string(seed), test::with_random_tags(m, seed));
    }
    return out;
}

// With u = 2^-24 and M the largest coordinate. All weights are positive and add up to 1, so a step
// hands its inputs' errors on at most. A face's mean of m points rounds m - 1 sums, a weight and a
// product; an edge point 3 sums; a vertex point 2n - 1 sums, two products, two weights and a sum:
// at most (2 n + 4) u M with n the most edges or sides. Blended weights may be as large as 4/3 and
// below 0 beside it (Chaikin), 5/3 in absolute sum; each of at most 2 n + 1 terms rounds its
// weight, its product and a sum, and multiplies its inputs' errors by 5/3. The references round as
// much in double.
TEST(SubdivisionKernels, AgreeWithTheMasksWithinRounding)
{
    bool rounds = false;
    for (auto const& [name, mesh] : cages()) {
        SCOPED_TRACE(name);
        RefinedMesh const refined(mesh, 3, catmull_clark_step);
        double most = 0, n = 4;
        for (glm::vec3 const& p : mesh.positions)
            for (int k = 0; k < 3; ++k) most = std::max(most, double(std::abs(p[k])));
        for (std::size_t f = 0; f < mesh.faces(); ++f) n = std::max(n, double(mesh.face(f).size()));
        for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
            n = std::max(n, double(refined.base_topology().valence(v)));
        std::vector<Vec> x(mesh.positions.begin(), mesh.positions.end());
        ControlMesh coarse = mesh;
        double bound = 0;
        for (int steps = 1; steps <= 3; ++steps) {
            Topology const topology(coarse);
            Sharpness const sharpness(topology);
            x = refined_points<CatmullClark, Vec>(topology, sharpness, x);
            ControlMesh next = split_mesh(topology, sharpness, x, false);
            RefinedMesh const m(mesh, steps, catmull_clark_step);
            std::vector<glm::vec3> const drawn = drawn_mesh(m, {}, ThreadPool(1)).mesh.positions;
            ASSERT_EQ(drawn.size(), x.size());
            double const blend = 5.0 / 3;
            bound = m.tables().back().blended.target.empty()
                        ? bound + (2 * n + 4) * 0x1p-24 * most
                        : blend * (bound + (2 * n + 4) * 0x1p-24 * most) +
                              3 * blend * (2 * n + 1) * 0x1p-24 * most;
            double worst = 0;
            for (std::size_t v = 0; v < x.size(); ++v)
                for (int k = 0; k < 3; ++k)
                    worst = std::max(worst, std::abs(double(drawn[v][k]) - x[v][k]));
            EXPECT_LE(worst, bound) << steps;
            rounds = rounds || worst > 0;
            coarse = std::move(next);
        }
    }
    EXPECT_TRUE(rounds);
}

TEST(SubdivisionKernels, GiveTheSameBitsAndCountsOnEveryMachineAtEveryLevel)
{
    for (auto const& [name, mesh] : cages()) {
        SCOPED_TRACE(name);
        for (int levels = 1; levels <= 3; ++levels) {
            RefinedMesh const refined(mesh, levels, catmull_clark_step);
            for (Contraction contraction :
                 {Contraction::None, Contraction::All, Contraction::Mixed}) {
                std::vector<float> first;
                ListStatistics counts;
                for (Machine const& machine : test::machines(contraction, 3))
                    for (int threads : {1, 3}) {
                        CommandList list;
                        SurfaceSettings s;
                        s.machine = machine;
                        VertexSource const points = add_vertices(list, refined, s);
                        ListStatistics const run = run_commands(list, ThreadPool(threads));
                        if (first.empty()) {
                            first.assign(points.floats.begin(), points.floats.end());
                            counts = run;
                            continue;
                        }
                        ASSERT_EQ(std::memcmp(first.data(), points.floats.data(),
                                              first.size() * sizeof(float)),
                                  0)
                            << machine.lanes << " lanes, " << threads << " threads";
                        ASSERT_EQ(run.total, counts.total);
                    }
            }
        }
    }
}

// What the threads of a kernel fetch and compute in all: tests/analysis/subdivision_cost_test.cpp.
TEST(SubdivisionKernels, ReadEveryEntryOfTheirTablesOnce)
{
    for (auto const& [name, mesh] : cages()) {
        SCOPED_TRACE(name);
        RefinedMesh const refined(mesh, 2, catmull_clark_step);
        CommandList list;
        add_vertices(list, refined, {});
        ListStatistics const run = run_commands(list, ThreadPool(2));
        EXPECT_GE(run.commands.size(), 6u);
        for (CommandStatistics const& c : run.commands)
            for (FetchStatistics const& f : c.statistics.stages.at(0).fetches) {
                bool const shared = f.resource == "vertices" || f.resource == "blended_starts";
                if (shared)
                    EXPECT_LE(f.unique_bytes, f.bytes) << c.name << " " << f.resource;
                else
                    EXPECT_EQ(f.unique_bytes, f.bytes) << c.name << " " << f.resource;
            }
    }
}

// Only the file's vertices are moved; the kernels subdivide what came of them.
TEST(SubdivisionKernels, RunOnTheMovedMesh)
{
    ControlMesh const mesh = load_model("golem").mesh;
    RefinedMesh const refined(mesh, 2, catmull_clark_step);
    SurfaceSettings s;
    s.pose = std::make_shared<Pose>(SpineRig(mesh).sway(0.3));
    CommandList list;
    add_vertices(list, refined, s);
    Dispatch const& skinning = std::get<Dispatch>(list.commands.at(0));
    EXPECT_EQ(skinning.name, "skinning");
    EXPECT_EQ(skinning.groups[0], (mesh.positions.size() + 63) / 64);
    ControlMesh moved = mesh;
    moved.positions = drawn_mesh(RefinedMesh(mesh, 0, catmull_clark_step), s, ThreadPool(1)).mesh.positions;
    EXPECT_NE(moved.positions, mesh.positions);
    auto const positions = [](RefinedMesh const& m, SurfaceSettings const& settings) {
        return drawn_mesh(m, settings, ThreadPool(1)).mesh.positions;
    };
    EXPECT_EQ(positions(refined, s), positions(RefinedMesh(moved, 2, catmull_clark_step), {}));
}

} // namespace
} // namespace tessemu
