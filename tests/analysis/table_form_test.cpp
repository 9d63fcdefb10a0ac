// The table form on its schemes: limits of another implementation, closed edges, tables.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forms/table_form.h"

#include "analysis/watertight.h"
#include "io/model.h"
#include "pipeline/mesh/limit_points.h"
#include "pipeline/mesh/loop.h"
#include "pipeline/mesh/placement.h"
#include "tests/analysis/loop_stam.h"
#include "tests/support/edges.h"
#include "tests/support/limit_samples.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>
#include <map>
#include <set>

namespace tessemu {
namespace {

using Vec = glm::dvec3;

SchemeOnMesh tables_on(std::string const& scheme, ControlMesh mesh, ParameterTexts set = {})
{
    return build_scheme(find_scheme("tables-" + scheme), std::move(mesh), {.set = std::move(set)});
}

// The pattern has all dyadic points: 4 segments on half an edge are eighths of it.
void expect_limit(std::string const& scheme, std::filesystem::path const& model,
                  std::filesystem::path const& samples)
{
    test::LimitSamples const limit = test::read_limit_samples(samples);
    ASSERT_GT(limit.samples.size(), 0u);
    using Place = std::array<int, 3>; // face, u and v in eighths
    std::map<Place, Vec> wanted;
    for (auto const& s : limit.samples) {
        auto const eighth = [](double x) { return int(std::lround(8 * x)); };
        // Printed with 10 digits.
        EXPECT_NEAR(8 * s.u, eighth(s.u), 1e-9) << "a sample between our rows";
        wanted[{int(s.face), eighth(s.u), eighth(s.v)}] = s.position;
    }
    SchemeOnMesh const m = tables_on(scheme, test::mesh_of_samples(model), {{"mesher", "pattern"}});
    FrameSettings s;
    s.tess_factor = 4;
    double worst = 0;
    std::set<Place> met;
    visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& patch) {
        for (std::size_t i = 0; i < patch.points(); ++i) {
            UnitPoint const at =
                domain_to_unit(patch.place(), patch.domain().u[i], patch.domain().v[i]);
            bool const is_triangle = m.mesh->base().face(patch.place().face).size() == 3;
            float const u = is_triangle ? at.v : at.u, v = is_triangle ? 1 - at.u - at.v : at.v;
            Place const place{int(m.mesh->base().file_face(patch.place().face)), int(8 * u),
                              int(8 * v)};
            auto const found = wanted.find(place);
            if (found == wanted.end()) continue; // of a coarser grid
            met.insert(place);
            worst = std::max(worst, distance(Vec(patch.vertex(i).position), found->second) /
                                        limit.diagonal);
        }
    });
    EXPECT_EQ(met.size(), wanted.size());
    // Weights and positions are floats: M1 and a sum of up to 20 products round some 40 times, each
    // by 2^-24 of at most 0.9 diagonals, 2.1e-6 if all went one way.
    EXPECT_LT(worst, 2e-6);
    testing::Test::RecordProperty("worst_distance_in_diagonals",
                                  std::to_string(worst * 1e9) + "e-9");
}

// Creases that end in a semi-sharp way, boundaries; the other file's darts take a smooth vertex's
// mask (tagged_limit_test.cpp).
TEST(TableForm, PatternsPointsAreLimits)
{
    for (auto const& [scheme, name] : {std::pair{"loop", "loop_cube_creases1.loop"},
                                       {"loop", "loop_saddle_edgeonly.loop"},
                                       {"catmull-clark", "catmark_cube_corner0.dyadic"},
                                       {"catmull-clark", "catmark_cube_creases2.dyadic"},
                                       {"catmull-clark", "catmark_inf_crease0.dyadic"},
                                       {"catmull-clark", "catmark_tent_creases0.dyadic"}}) {
        SCOPED_TRACE(name);
        std::string const model(name, std::strchr(name, '.'));
        expect_limit(scheme, test::golden("limit/" + model + ".obj"),
                     test::golden("limit/" + std::string(name) + ".csv.gz"));
    }
}

class LoopLimitOf : public testing::TestWithParam<char const*> {};

TEST_P(LoopLimitOf, PatternsPointsAreThoseOfAnotherImplementation)
{
    std::string const name = GetParam();
    TESSEMU_NEEDS_SHARED("golden/limit/" + name + ".loop.csv.gz");
    expect_limit("loop", test::shared("models/" + name + ".obj"),
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

// A prism on a pentagon with a closed crease round its lid, and in another an edge and its end.
ControlMesh creased_prism()
{
    ControlMesh m;
    for (float z : {0.0f, 2.0f})
        for (std::array<float, 2> const& p :
             {std::array{1.0f, 0.0f}, {0.3f, 0.95f}, {-0.8f, 0.6f}, {-0.8f, -0.6f}, {0.3f, -0.95f}})
            m.positions.emplace_back(p[0], p[1], z);
    m.add_face(std::array<std::uint32_t, 5>{4, 3, 2, 1, 0});
    m.add_face(std::array<std::uint32_t, 5>{5, 6, 7, 8, 9});
    for (std::uint32_t k = 0; k < 5; ++k) {
        std::uint32_t const next = (k + 1) % 5;
        m.add_face(std::array{k, next, 5 + next, 5 + k});
        m.creases.push_back({5 + k, 5 + next, kInfinitelySharp});
    }
    m.creases.push_back({0, 1, 2.5f});
    m.creases.push_back({1, 2, 1.25f});
    m.creases.push_back({3, 8, kInfinitelySharp});
    m.corners.push_back({4, kInfinitelySharp});
    return m;
}

struct Tagged {
    std::string name, scheme;
    ControlMesh mesh;
};

std::vector<Tagged> tagged_meshes()
{
    std::vector<Tagged> out;
    out.push_back({"creased icosahedron", "loop", creased_icosahedron()});
    ControlMesh chaikin = creased_icosahedron();
    auto const g = chaikin.face(7);
    chaikin.creases.push_back({g[1], g[2], 1.25f});
    chaikin.rules.crease_method = CreaseMethod::Chaikin;
    out.push_back({"Chaikin", "loop", chaikin});
    ControlMesh loop = icosahedron(); // a closed crease: normals of two sides
    Topology const t(loop);
    for (HalfEdge h : t.ring(0)) {
        HalfEdge const across = t.next(h);
        loop.creases.push_back(
            {t.vertex_of(across), t.vertex_of(t.next(across)), kInfinitelySharp});
    }
    out.push_back({"closed crease", "loop", loop});
    out.push_back({"saddle", "loop",
                   load_model(test::golden("limit/loop_saddle_edgeonly.obj").string()).mesh});
    out.push_back({"icosahedron", "butterfly", icosahedron()});
    out.push_back({"saddle", "butterfly", out[3].mesh});
    out.push_back({"creased prism", "catmull-clark", creased_prism()});
    ControlMesh prism = creased_prism();
    prism.rules.crease_method = CreaseMethod::Chaikin;
    out.push_back({"Chaikin's prism", "catmull-clark", prism});
    out.push_back({"open dart", "catmull-clark",
                   load_model(test::golden("limit/catmark_dart_edgeonly.obj").string()).mesh});
    return out;
}

// Ways to normals.
std::vector<ParameterTexts> ways_to_normals(std::string const& scheme)
{
    if (scheme == "butterfly") return {{}};
    return {{}, {{"normals", "tangents"}}, {{"initial", "gradients"}}};
}
std::string in_words(ParameterTexts const& set)
{
    std::string out;
    for (auto const& [name, value] : set) out += name + "=" + value + " ";
    return out;
}

// By base vertices that a step's points and their tangents are summed of: positions are the step's,
// normals the limit's.
template <class Masks>
void expect_gradients(ControlMesh const& mesh, int steps, RefinementStep step)
{
    RefinedMesh const refined(mesh, steps, step);
    Topology const& t = refined.topology();
    std::vector<WeightedSum> const sums = sums_over_base<Masks>(refined);
    auto const applied = [&](WeightedSum const& of) {
        Vec sum(0);
        for (WeightedSum::Term const& term : of.terms())
            sum += term.weight * Vec(mesh.positions[term.point]);
        return sum;
    };
    auto const magnitude = [&](WeightedSum const& of) {
        double sum = 0;
        for (WeightedSum::Term const& term : of.terms())
            sum += std::abs(term.weight) * length(Vec(mesh.positions[term.point]));
        return sum;
    };
    std::vector<Vec> x;
    for (WeightedSum const& sum : sums) x.push_back(applied(sum));
    ASSERT_EQ(x.size(), refined.mesh().positions.size());
    double size = 0;
    for (Vec const& p : x) size = std::max(size, length(p));
    // Each step's masks are convex and round three coordinates to single: sqrt(3) 2^-24 of the size.
    for (std::size_t v = 0; v < x.size(); ++v)
        EXPECT_LT(distance(x[v], Vec(refined.mesh().positions[v])), steps * size * 0x1p-23) << v;
    LimitPoints const limits = limit_points<Masks>(t, x);
    GradientMasks<Masks> masks(t);
    std::size_t sides = 0;
    for (std::uint32_t v = 0; v < x.size(); ++v) {
        auto const ring = t.ring(v);
        std::set<std::uint32_t> points;
        for (HalfEdge h : ring) points.insert(limits.of_corner[h]);
        for (std::size_t j = 0; j < ring.size(); ++j) {
            std::uint32_t const point = limits.of_corner[ring[j]];
            bool const begins =
                limits.of_corner[ring[(j + ring.size() - 1) % ring.size()]] != point;
            if (points.size() > 1 && !begins) continue;
            auto const [a, b] =
                masks.at(v, points.size() > 1 ? std::optional(j) : std::nullopt, sums);
            // A weight has some 200 roundings behind it, of steps and of rings that semi-sharp tags
            // refine; the product's direction is off by those of both tangents, over its length.
            // The limit's normal has as many behind it.
            Vec const n = cross(applied(a), applied(b));
            double const off = 2 * 200 * 0x1p-53 * magnitude(a) * magnitude(b) / length(n);
            EXPECT_LT(distance(normalize(n), limits.normal[point]), 2 * off) << v << ", edge " << j;
            ++sides;
            if (points.size() == 1) break;
        }
    }
    EXPECT_GE(sides, x.size());
}

TEST(GradientRows, AreTheStepsPointsWithTheLimitsNormals)
{
    for (auto const& [name, scheme, mesh] : tagged_meshes())
        for (int steps : {1, 2}) {
            SCOPED_TRACE(name + ", steps: " + std::to_string(steps));
            if (scheme == "loop") expect_gradients<Loop>(mesh, steps, loop_step);
            if (scheme == "catmull-clark")
                expect_gradients<CatmullClark>(mesh, steps, catmull_clark_step);
        }
}

TEST(TableForm, GradientsAreRefusedWhereNothingReadsThem)
{
    for (char const* other : {"normals=tangents", "shading=0"}) {
        std::string const text = other;
        std::size_t const at = text.find('=');
        try {
            tables_on("loop", icosahedron(),
                      {{"initial", "gradients"}, {text.substr(0, at), text.substr(at + 1)}});
            ADD_FAILURE() << other;
        } catch (Error const& e) {
            EXPECT_NE(std::string(e.what()).find(other), std::string::npos) << e.what();
        }
    }
}

TEST(TableForm, SharedEdgesHaveEqualBitsWithBothMeshersAndAllTags)
{
    ThreadPool const threads;
    for (auto const& [name, scheme, mesh] : tagged_meshes())
        for (bool is_pattern : {false, true})
            for (ParameterTexts set : ways_to_normals(scheme)) {
                set.emplace_back("mesher", is_pattern ? "pattern" : "tessellator");
                SCOPED_TRACE(name + ", " + in_words(set));
                SchemeOnMesh const m = tables_on(scheme, mesh, set);
                std::vector<float> const factors =
                    is_pattern ? std::vector{1.0f, 8.0f} : std::vector{1.0f, 4.0f, 7.3f, 17.0f};
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

TEST(TableForm, PassesTheCrackCheckInAllPartitioningsAndWithMixedFactors)
{
    ThreadPool const threads;
    for (auto const& [name, scheme, mesh] : tagged_meshes()) {
        for (ParameterTexts const& set : ways_to_normals(scheme)) {
            for (Partitioning p : {Partitioning::Integer, Partitioning::Pow2,
                                   Partitioning::FractionalOdd, Partitioning::FractionalEven})
                for (bool mixed : {false, true}) {
                    if (test::kSlow && (p != Partitioning::FractionalOdd || !mixed)) continue;
                    SCOPED_TRACE(name + " " + in_words(set) + std::to_string(int(p)));
                    SchemeOnMesh const m = tables_on(scheme, mesh, set);
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
}

TEST(TableForm, CracksWhereTablesAreNotEnforced)
{
    for (Tagged const& of :
         {Tagged{"", "loop", icosahedron()}, Tagged{"", "catmull-clark", creased_prism()}}) {
        SCOPED_TRACE(of.scheme);
        SchemeOnMesh const m = tables_on(of.scheme, of.mesh, {{"tables", "unenforced"}});
        FrameSettings s;
        s.tess_factor = 8;
        test::EdgeComparison const c = test::compare_edges(*m.patches, s, ThreadPool());
        EXPECT_GT(c.differing_positions, 10u);
    }
}

TEST(MeshTables, WeightsSumToOneAndTangentsToZero)
{
    for (auto const& [name, scheme, mesh] : tagged_meshes()) {
        SCOPED_TRACE(name);
        SchemeOnMesh const m = tables_on(scheme, mesh);
        auto const& tables = static_cast<TableForm const&>(*m.patches).tables();
        for (TypeOfTables const& t : tables.types()) {
            auto const samples = std::size_t(t.grid.samples());
            EXPECT_EQ(samples, t.grid.sides == 3 ? 561u : 1089u);
            for (std::size_t s = 0; s < samples; ++s) {
                double sums[3] = {};
                for (std::size_t k = 0; k < std::size_t(t.points); ++k) {
                    sums[0] += double(t.position[k * samples + s]);
                    if (t.tangents[0].empty()) continue; // Butterfly's
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
    SchemeOnMesh const m = tables_on("loop", icosahedron());
    auto const& tables = static_cast<TableForm const&>(*m.patches).tables();
    ASSERT_EQ(tables.types().size(), 2u);
    EXPECT_EQ(std::min(tables.types()[0].points, tables.types()[1].points), 11);
    EXPECT_EQ(std::max(tables.types()[0].points, tables.types()[1].points), 12);
    EXPECT_EQ(tables.vertices().size(), 42u);
    EXPECT_FALSE(tables.has_creases());
}

// Two rings of faces around a regular triangle have 27 vertices that weigh something, of Loop's one
// ring 12; the sheet's count.
TEST(MeshTables, ARegularTriangleOfButterflyHas27Points)
{
    SchemeOnMesh const m = tables_on("butterfly", icosahedron());
    auto const& tables = static_cast<TableForm const&>(*m.patches).tables();
    std::set<int> points;
    for (TypeOfTables const& t : tables.types()) {
        Topology const topology(t.type.mesh());
        bool is_regular = true;
        for (std::uint32_t v = 0; v < t.type.point_of.size(); ++v)
            is_regular = is_regular && (topology.is_boundary(v) || topology.ring(v).size() == 6);
        if (is_regular) points.insert(t.points);
    }
    EXPECT_EQ(points, std::set{27});
}

// Normals of an icosahedron's faces point along its vertices, and what is summed by the same weights
// stays so: carried along from the file's mesh, normals are scaled positions.
TEST(TableForm, ShadingFromTheFilesMeshCarriesNormalsAsPositions)
{
    for (char const* scheme : {"loop", "butterfly"}) {
        ControlMesh mesh = icosahedron();
        for (glm::vec3& p : mesh.positions) p *= 0.5f;
        SchemeOnMesh const m = tables_on(scheme, mesh, {{"shading", "0"}});
        FrameSettings s;
        s.tess_factor = 5;
        double worst = 0;
        std::size_t points = 0;
        visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& patch) {
            for (std::size_t i = 0; i < patch.points(); ++i, ++points) {
                auto const v = patch.vertex(i);
                worst = std::max(worst, double(distance(v.normal, normalize(v.position))));
            }
        });
        EXPECT_GT(points, 1000u);
        // Some 40 sums round by 2^-24 of lengths up to 1 on both sides.
        EXPECT_LT(worst, 80 * 0x1p-24) << scheme;
    }
}

// HOLL10 figure 4: the later, the nearer to the surface's own normals; on cages without symmetry,
// that is: an icosahedron's first normals are right.
TEST(TableForm, ShadingNearsTheSurfaceWithEachStepAndMovesNoPoint)
{
    if (test::kSlow) GTEST_SKIP() << "many points; the test before goes over the same code";
    ThreadPool const threads;
    for (std::string const scheme : {"loop", "catmull-clark"}) {
        ControlMesh const mesh = load_model(scheme == "loop" ? "spindle" : "golem").mesh;
        std::map<std::array<float, 2>, Vec> own, positions; // by file face and place on it
        double error[3] = {};
        auto const visit = [&](ParameterTexts set, float factor, auto const& work) {
            SchemeOnMesh const m = tables_on(scheme, mesh, std::move(set));
            FrameSettings s;
            s.tess_factor = factor;
            visit_surface(*m.patches, s, threads, [&](SurfacePatch const& patch) {
                for (std::size_t i = 0; i < patch.points(); ++i) {
                    UnitPoint const at =
                        domain_to_unit(patch.place(), patch.domain().u[i], patch.domain().v[i]);
                    std::array const place{float(patch.place().face) + at.u / 2, at.v};
                    work(place, patch.vertex(i));
                }
            });
        };
        visit({{"mesher", "pattern"}, {"normals", "tangents"}}, 8,
              [&](auto const& place, auto const& v) {
                  own[place] = v.normal;
                  positions[place] = v.position;
              });
        for (int steps : {0, 1, 2}) {
            std::size_t met = 0, moved = 0;
            visit({{"mesher", "pattern"}, {"shading", std::to_string(steps)}},
                  steps == 2 ? 4.0f : 8.0f, [&](auto const& place, auto const& v) {
                      auto const same = own.find(place);
                      if (same == own.end()) return;
                      ++met;
                      Vec const d = Vec(v.normal) - same->second;
                      error[steps] += dot(d, d);
                      moved += Vec(v.position) != positions[place];
                  });
            EXPECT_GT(met, own.size() - 1);
            error[steps] /= double(met);
            if (steps < 2) { // by a second step positions round otherwise
                EXPECT_EQ(moved, 0u) << scheme << steps;
            }
        }
        double by_gradients = 0;
        visit({{"mesher", "pattern"}, {"initial", "gradients"}}, 8,
              [&](auto const& place, auto const& v) {
                  Vec const d = Vec(v.normal) - own.at(place);
                  by_gradients += dot(d, d) / double(own.size());
                  // Both ways have some hundred roundings of either sign; of a coordinate's, 16 are left.
                  EXPECT_LT(distance(Vec(v.position), positions.at(place)),
                            16 * 0x1p-24 * bounding_box_diagonal(mesh));
              });
        EXPECT_LT(by_gradients, error[0]) << scheme; // on one cage above error[1], on one below
        EXPECT_LT(error[1], error[0]) << scheme;
        EXPECT_LT(error[2], error[1]) << scheme;
    }
}

// Interpolating: the file's vertices lie on the surface, as they are but for the tables' zeros and
// ones, which are exact.
TEST(TableForm, ButterflyInterpolatesTheFilesVertices)
{
    for (char const* mesher : {"tessellator", "pattern"}) {
        ControlMesh const mesh = icosahedron();
        SchemeOnMesh const m = tables_on("butterfly", mesh, {{"mesher", mesher}});
        std::set<std::array<float, 3>> wanted, met;
        for (glm::vec3 const& p : mesh.positions) wanted.insert({p.x, p.y, p.z});
        FrameSettings s;
        s.tess_factor = 2;
        visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& patch) {
            for (std::size_t i = 0; i < patch.points(); ++i) {
                glm::vec3 const p = patch.vertex(i).position;
                if (wanted.count({p.x, p.y, p.z})) met.insert({p.x, p.y, p.z});
            }
        });
        EXPECT_EQ(met, wanted) << mesher;
    }
}

// Stam and Loop's scheme on triangles and quads at once: a file of masks is all that it has.
// The surface does not depend on how many steps are taken before the tables.
TEST(TableForm, DrawsAnySchemeOfOneFileOfMasks)
{
    ControlMesh mesh; // a house: a cube whose lid is a pyramid
    mesh.positions = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1},
                      {1, -1, 1},   {1, 1, 1},   {-1, 1, 1}, {0, 0, 2}};
    mesh.add_face(std::array<std::uint32_t, 4>{3, 2, 1, 0});
    for (std::uint32_t k = 0; k < 4; ++k) {
        std::uint32_t const next = (k + 1) % 4;
        mesh.add_face(std::array{k, next, 4 + next, 4 + k});
        mesh.add_face(std::array{4 + k, 4 + next, 8u});
    }
    Parameters parameters;
    parameters.set("mesher", std::string("pattern"));
    parameters.set("tables", std::string("enforced"));
    parameters.set("shading", std::string("1"));
    using Place = std::array<int, 3>; // face, and where on it in sixteenths
    std::map<Place, Vec> of_one_step;
    for (int steps : {1, 2}) {
        TableForm const form(std::make_shared<RefinedMesh>(mesh, steps, test::loop_stam_step),
                             TableForm::rules<test::LoopStam>(parameters), parameters, {});
        EXPECT_GE(form.patch_counts().size(), 2u); // of triangles and of quads
        FrameSettings s;
        s.tess_factor = float(8 >> steps);
        test::EdgeComparison const c = test::compare_edges(form, s, ThreadPool());
        EXPECT_GT(c.shared_points, 100u);
        EXPECT_EQ(c.lonely_points, 0u);
        EXPECT_EQ(c.differing_positions + c.differing_normals, 0u) << c.first_difference;
        std::size_t compared = 0;
        visit_surface(form, s, ThreadPool(), [&](SurfacePatch const& patch) {
            for (std::size_t i = 0; i < patch.points(); ++i) {
                UnitPoint const at =
                    domain_to_unit(patch.place(), patch.domain().u[i], patch.domain().v[i]);
                Place const place{int(patch.place().face), int(16 * at.u), int(16 * at.v)};
                Vec const p(patch.vertex(i).position);
                if (steps == 1) {
                    of_one_step[place] = p;
                    continue;
                }
                auto const same = of_one_step.find(place);
                if (same == of_one_step.end()) continue;
                ++compared;
                // Some 40 roundings by 2^-24 of coordinates up to 2.
                EXPECT_LT(distance(same->second, p), 40 * 0x1p-23);
            }
        });
        if (steps == 2) {
            EXPECT_GE(compared, of_one_step.size());
        }
    }
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
