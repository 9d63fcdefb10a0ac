// Adaptive levels of table-driven patches: grids, and bounds of how far triangles lie from the
// surface, held against the surface itself, triangle by triangle.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/schemes/bolz/adaptive.h"

#include "io/model.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/placement.h"
#include "pipeline/schemes/bolz/deviation.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <random>
#include <set>

namespace tessemu {
namespace {

using Vec = glm::dvec3;

// --- grids ---

std::string in_words(GridLevels const& l)
{
    std::string out = std::to_string(l.inside) + ":";
    for (int e : l.edges) out += " " + std::to_string(e);
    return out;
}

std::vector<GridLevels> all_grids(int most)
{
    std::vector<GridLevels> out;
    for (int inside = 0; inside <= most; ++inside) {
        int const n = inside + 1;
        for (int i = 0; i < n * n * n * n; ++i)
            out.push_back({std::uint8_t(inside),
                           {std::uint8_t(i % n), std::uint8_t(i / n % n),
                            std::uint8_t(i / n / n % n), std::uint8_t(i / n / n / n)}});
    }
    return out;
}

std::vector<GridLevels> some_grids()
{
    std::vector<GridLevels> out = all_grids(3);
    for (std::array<std::uint8_t, 4> const& edges : {std::array<std::uint8_t, 4>{5, 5, 5, 5},
                                                     {0, 0, 0, 0},
                                                     {5, 0, 3, 1},
                                                     {4, 5, 5, 5},
                                                     {2, 4, 0, 5},
                                                     {5, 5, 0, 5}})
        out.push_back({5, edges});
    return out;
}

struct Place {
    int x, y;
    auto operator<=>(Place const&) const = default;
};
// In segments of the inside.
std::vector<Place> places_of(PatchGrid const& grid, int segments)
{
    std::vector<Place> out;
    for (std::size_t i = 0; i < grid.points.u.size(); ++i)
        out.push_back(
            {int(grid.points.u[i] * float(segments)), int(grid.points.v[i] * float(segments))});
    return out;
}

TEST(BolzGrid, TrianglesTileTheSquareOnceCounterClockwise)
{
    for (GridLevels const& levels : some_grids()) {
        int const n = 1 << levels.inside;
        PatchGrid const grid = make_patch_grid(levels);
        std::vector<Place> const at = places_of(grid, n);
        std::vector<std::uint32_t> const& index = grid.points.patch.indices;
        long area = 0; // twice
        // A triangulation without overlap: positive triangles whose areas add up to the square's,
        // every side inside it shared by two that run along it in opposite directions.
        std::map<std::pair<Place, Place>, int> sides;
        for (std::size_t t = 0; t < index.size(); t += 3) {
            Place const a = at[index[t]], b = at[index[t + 1]], c = at[index[t + 2]];
            long const twice = long(b.x - a.x) * (c.y - a.y) - long(b.y - a.y) * (c.x - a.x);
            ASSERT_GT(twice, 0) << in_words(levels);
            area += twice;
            for (auto const& side : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
                ASSERT_EQ(++sides[side], 1) << in_words(levels);
        }
        ASSERT_EQ(area, 2L * n * n) << in_words(levels);
        for (auto const& [side, count] : sides) {
            auto const& [a, b] = side;
            bool const outside =
                (a.x == b.x && (a.x == 0 || a.x == n)) || (a.y == b.y && (a.y == 0 || a.y == n));
            ASSERT_EQ(sides.count({b, a}), outside ? 0u : 1u) << in_words(levels);
        }
    }
}

TEST(BolzGrid, HasExactlyThePointsOfEachEdgesLevelAndOfTheInside)
{
    for (GridLevels const& levels : some_grids()) {
        int const n = 1 << levels.inside;
        std::set<Place> expected;
        for (int y = 1; y < n; ++y)
            for (int x = 1; x < n; ++x) expected.insert({x, y});
        for (int i = 0; i <= n; ++i) {
            auto const has = [&](std::size_t k) {
                return i % (1 << (levels.inside - levels.edges[k])) == 0;
            };
            if (has(0)) expected.insert({i, 0});
            if (has(1)) expected.insert({n, i});
            if (has(2)) expected.insert({i, n});
            if (has(3)) expected.insert({0, i});
        }
        PatchGrid const grid = make_patch_grid(levels);
        std::vector<Place> const at = places_of(grid, n);
        ASSERT_EQ(std::set<Place>(at.begin(), at.end()), expected) << in_words(levels);
        ASSERT_EQ(at.size(), expected.size()) << in_words(levels);
        std::set<std::uint32_t> const used(grid.points.patch.indices.begin(),
                                           grid.points.patch.indices.end());
        ASSERT_EQ(used.size(), at.size()) << in_words(levels);
        ASSERT_EQ(grid.places.empty(), levels.is_regular());
        for (std::size_t i = 0; i < grid.places.size(); ++i)
            ASSERT_EQ(grid.places[i], std::uint32_t(at[i].x + (at[i].y << 8))) << in_words(levels);
    }
}

// --- bounds ---

constexpr int kSegments = 1 << PatchDeviation::kSampleLevel;
constexpr int kSide = kSegments + 1;

double distance_to(Vec p, Vec a, Vec b, Vec c)
{
    Vec const normal = cross(b - a, c - a);
    double const square = dot(normal, normal);
    auto const to_side = [&](Vec s, Vec e) {
        double const l = dot(e - s, e - s);
        double const t = l > 0 ? std::clamp(dot(p - s, e - s) / l, 0.0, 1.0) : 0.0;
        return length(p - s - t * (e - s));
    };
    if (square > 0 && dot(cross(b - a, p - a), normal) >= 0 &&
        dot(cross(c - b, p - b), normal) >= 0 && dot(cross(a - c, p - c), normal) >= 0)
        return std::abs(dot(p - a, normal)) / std::sqrt(square);
    return std::min({to_side(a, b), to_side(b, c), to_side(c, a)});
}

// A patch's samples, twice as fine as its finest grid.
struct Sampled {
    std::vector<Vec> samples;

    Sampled(BasisTables const& tables, std::vector<Vec> const& points)
        : samples(std::size_t(kSide) * kSide, Vec(0))
    {
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t q = 0; q < samples.size(); ++q)
                samples[q] += tables.position[i * samples.size() + q] * points[i];
    }
    Vec at(int x, int y) const { return samples[std::size_t(y * kSide + x)]; }

    // The largest distance of a sample from the grid's triangles, or 0 where all are within
    // `limit`.
    double beyond(GridLevels const& levels, double limit) const
    {
        PatchGrid const grid = make_patch_grid(levels);
        std::vector<Place> const at_place = places_of(grid, kSegments);
        std::vector<std::array<Vec, 3>> triangles;
        std::vector<std::uint32_t> const& index = grid.points.patch.indices;
        for (std::size_t t = 0; t < index.size(); t += 3) {
            auto const corner = [&](std::size_t k) {
                return at(at_place[index[t + k]].x, at_place[index[t + k]].y);
            };
            triangles.push_back({corner(0), corner(1), corner(2)});
        }
        double most = 0;
        std::size_t last = 0; // where the sample before was
        for (Vec const& q : samples) {
            double nearest = HUGE_VAL;
            for (std::size_t i = 0; i < triangles.size() && nearest > limit; ++i) {
                std::size_t const t = (last + i) % triangles.size();
                nearest = std::min(
                    nearest, distance_to(q, triangles[t][0], triangles[t][1], triangles[t][2]));
                if (nearest <= limit) last = t;
            }
            if (nearest > limit) most = std::max(most, nearest);
        }
        return most;
    }
};

std::vector<PatchType> types()
{
    std::vector<PatchType> out;
    for (int n = 2; n <= 9; ++n) out.push_back(smooth_type(n));
    out.push_back(smooth_type(20));
    for (int faces = 1; faces <= 4; ++faces)
        for (int position = 0; position < faces; ++position)
            for (bool is_corner : {false, true})
                out.push_back(sector_type(faces, position, is_corner));
    out.push_back(dart_type(4, 0));
    out.push_back(dart_type(5, 3));
    PatchType semi_sharp = smooth_type(4);
    semi_sharp.corner.edges = {1.5f, 0, 1.5f, 0};
    out.push_back(semi_sharp);
    semi_sharp = smooth_type(3);
    semi_sharp.corner.vertex = 2.25f;
    out.push_back(semi_sharp);
    return out;
}

// The type's chart, bent and shaken.
std::vector<Vec> random_net(PatchType const& type, std::mt19937& random, double shake)
{
    auto const vector = [&] {
        Vec v;
        for (int k = 0; k < 3; ++k) v[k] = double(random()) * 0x1p-31 - 1;
        return v;
    };
    Vec const a = vector(), b = vector(), xx = vector(), xy = vector(), yy = vector();
    std::vector<Vec> out;
    for (glm::dvec2 const& p : chart_of(type))
        out.push_back(a * p.x + b * p.y + 0.3 * (xx * p.x * p.x + xy * p.x * p.y + yy * p.y * p.y) +
                      shake * vector());
    return out;
}

PatchTypeTables of_type(PatchType const& type)
{
    return in_single_precision(type, make_basis_tables(type));
}

// What the bound may lack: roundings of double sums.
constexpr double kSlack = 1e-12;

TEST(BolzDeviation, NoSampleLiesFurtherFromTheTrianglesThanTheBound)
{
    if (test::kSlow) GTEST_SKIP() << "many samples of what other tests go over too";
    std::mt19937 random(7);
    for (PatchType const& type : types()) {
        PatchDeviation const deviation(of_type(type));
        BasisTables const tables = make_basis_tables(type, PatchDeviation::kSampleLevel);
        for (double shake : {0.0, 0.02, 1.0}) {
            std::vector<Vec> const points = random_net(type, random, shake);
            PatchDeviation::Net net = deviation.net_of(points);
            net.rounding = 0;
            Sampled const surface(tables, points);
            for (int n = 0; n <= PatchDeviation::kMostLevel; ++n) {
                auto const l = std::uint8_t(n);
                std::vector<GridLevels> grids{{l, {l, l, l, l}}};
                for (int i = 0; i < 3 && n > 0; ++i) {
                    auto const edge = [&] { return std::uint8_t(random() % (unsigned(n) + 1)); };
                    GridLevels g{l, {}};
                    for (std::uint8_t& e : g.edges) e = edge();
                    grids.push_back(g);
                }
                for (GridLevels const& g : grids) {
                    double const bound = deviation.bound(net, g) + kSlack;
                    EXPECT_EQ(surface.beyond(g, bound), 0)
                        << type.in_words() << ", " << in_words(g) << ", bound " << bound;
                }
            }
        }
    }
}

TEST(BolzDeviation, AStripsBoundHoldsForEachEdgeByItself)
{
    std::mt19937 random(11);
    for (PatchType const& type : {smooth_type(4), smooth_type(5), sector_type(2, 0, false)}) {
        PatchDeviation const deviation(of_type(type));
        std::vector<Vec> const points = random_net(type, random, 0.1);
        PatchDeviation::Net net = deviation.net_of(points);
        net.rounding = 0;
        Sampled const surface(make_basis_tables(type, PatchDeviation::kSampleLevel), points);
        for (std::size_t k = 0; k < 4; ++k)
            for (int e = 0; e < 3; ++e) {
                GridLevels g{3, {3, 3, 3, 3}};
                g.edges[k] = std::uint8_t(e);
                EXPECT_EQ(surface.beyond(g, deviation.bound(net, g) + kSlack), 0) << in_words(g);
                EXPECT_GE(deviation.bound(net, g), deviation.strip_bound(net, 3, int(k), e));
            }
    }
}

TEST(BolzDeviation, IsZeroForAFlatRegularNetInAnyAffineParametrisation)
{
    PatchType const type = smooth_type(4);
    PatchDeviation const deviation(of_type(type));
    std::vector<Vec> points;
    for (glm::dvec2 const& p : chart_of(type))
        points.push_back(Vec(3, -1, 2) + Vec(1, 0.5, 0.25) * p.x + Vec(-0.75, 2, 7) * p.y);
    PatchDeviation::Net net = deviation.net_of(points);
    EXPECT_GT(net.rounding, 0);
    net.rounding = 0;
    for (GridLevels const& g : all_grids(2)) EXPECT_LT(deviation.bound(net, g), 1e-13);
    EXPECT_LT(deviation.bound(net, 5), 1e-13);
}

TEST(BolzDeviation, OfARegularPatchIsAQuarterWithEachLevelAndCloseToTheTruth)
{
    PatchType const type = smooth_type(4);
    PatchDeviation const deviation(of_type(type));
    std::vector<Vec> points;
    for (glm::dvec2 const& p : chart_of(type)) points.emplace_back(p.x, p.y, p.x * p.x / 2);
    PatchDeviation::Net net = deviation.net_of(points);
    net.rounding = 0;
    for (int n = 0; n <= 5; ++n) {
        // z'' = 1: a chord of length h lies up to h^2/8 below.
        double const truth = std::ldexp(1.0, -2 * n - 3);
        EXPECT_GE(deviation.bound(net, n), truth * (1 - 1e-9)) << n;
        EXPECT_LE(deviation.bound(net, n), 4 * truth) << n;
    }
    double const last = deviation.bound(net, 4) / deviation.bound(net, 5);
    EXPECT_GT(last, 3.5);
    EXPECT_LT(last, 4.1);
}

TEST(BolzDeviation, TheChartOfASmoothVertexIsKeptByAStepOfSubdivision)
{
    // The corner's quarter of the patch is the patch, smaller: S(u/2, v/2) = lambda S(u, v).
    for (int n : {3, 4, 5, 8}) {
        PatchType const type = smooth_type(n);
        BasisTables const tables = make_basis_tables(type);
        std::vector<glm::dvec2> const chart = chart_of(type);
        auto const at = [&](int i, int j) {
            glm::dvec2 out(0);
            for (std::size_t k = 0; k < chart.size(); ++k)
                out +=
                    tables.position[k * kTableSamples + std::size_t(j * kTableSide + i)] * chart[k];
            return out;
        };
        double const lambda = at(16, 0).x / at(32, 0).x;
        for (int j = 0; j <= 32; j += 2)
            for (int i = 0; i <= 32; i += 2)
                EXPECT_LT(length(at(i / 2, j / 2) - lambda * at(i, j)), 1e-12) << n;
    }
}

// --- levels ---

struct Model {
    std::string name;
    std::shared_ptr<RefinedMesh const> mesh;
};

Model refined(std::string const& name, ControlMesh mesh, int steps)
{
    return {name, std::make_shared<RefinedMesh const>(std::move(mesh), steps, catmull_clark_step)};
}

std::vector<Model> models()
{
    std::vector<Model> out;
    out.push_back(refined("golem", load_model("golem").mesh, 2));
    out.push_back(refined("jug", load_model("jug").mesh, 2));
    out.push_back(refined("torus", test::torus(8, 5).mesh, 1));
    out.push_back(refined("tagged cube", test::tagged_cube(), 2));
    return out;
}

// Whose patches have control points beyond those of others, or one vertex twice.
std::vector<Model> models_of_other_rules()
{
    std::vector<Model> out;
    ControlMesh chaikin = test::tagged_cube(), biermann = test::tagged_cube();
    chaikin.rules.crease_method = CreaseMethod::Chaikin;
    out.push_back(refined("by Chaikin's rule", std::move(chaikin), 2));
    biermann.creases.pop_back(); // no finite sharpness
    biermann.rules.sectors = SectorRules::Biermann;
    biermann.rules.flatness = 0.25;
    out.push_back(refined("by Biermann's rules", std::move(biermann), 2));
    out.push_back(refined("torus of few faces", test::torus(3, 3).mesh, 1));
    return out;
}

std::vector<DrawnPatch> drawn_patches(RefinedMesh const& mesh, MeshBasis const& basis)
{
    Topology const& topology = mesh.topology();
    std::vector<DrawnPatch> out;
    for (BasisPatch const& p : basis.patches()) {
        DrawnPatch d{p.face, {}};
        for (std::uint32_t k = 0; k < 4; ++k) {
            HalfEdge const twin =
                topology.twin(mesh.mesh().face_start[p.face] + (std::uint32_t(p.rotation) + k) % 4);
            d.neighbours[k] = twin == Topology::kNone ? DrawnPatch::kNone : topology.face_of(twin);
        }
        out.push_back(d);
    }
    return out;
}

std::vector<Vec> points_of(RefinedMesh const& mesh, MeshBasis const& basis, BasisPatch const& p)
{
    std::vector<Vec> out;
    for (int k = 0; k < basis.types()[p.type].points; ++k)
        out.emplace_back(mesh.mesh().positions[basis.points()[p.first_point + std::uint32_t(k)]]);
    return out;
}

// Points that are one vertex each, in the order of tables that do not know which are.
std::vector<Vec> of_finer_tables(BasisTables const& finer, PatchTypeTables const& tables,
                                 std::vector<Vec> const& points)
{
    std::vector<Vec> out;
    auto const own = std::size_t(tables.type.points());
    for (std::size_t k = 0; k < own; ++k) out.push_back(points[tables.point_of[k]]);
    EXPECT_EQ(finer.beyond, tables.beyond);
    for (std::size_t k = own; k < std::size_t(finer.points); ++k)
        out.push_back(points[tables.point_of[k]]);
    return out;
}

void expect_samples_within(Model const& model, double share)
{
    auto const& [name, mesh] = model;
    MeshBasis const basis(*mesh);
    std::vector<DrawnPatch> const drawn = drawn_patches(*mesh, basis);
    std::vector<BasisTables> tables(basis.types().size());
    double const distance = share * bounding_box_diagonal(mesh->base());
    AdaptiveLevels const levels = adaptive_levels(drawn, basis, mesh->mesh(), distance);
    std::size_t looked_at = 0;
    for (std::size_t p = 0; p < drawn.size(); ++p) {
        GridLevels const& g = levels.patches[p];
        if (g.inside == PatchDeviation::kMostLevel) continue; // may be beyond it
        if (g.is_regular() && p % 7 != 0) continue;           // time
        BasisPatch const& patch = basis.patches()[drawn[p].patch];
        BasisTables& t = tables[patch.type];
        if (t.points == 0)
            t = make_basis_tables(basis.types()[patch.type].type, PatchDeviation::kSampleLevel);
        std::vector<Vec> const points =
            of_finer_tables(t, basis.types()[patch.type], points_of(*mesh, basis, patch));
        EXPECT_EQ(Sampled(t, points).beyond(g, distance), 0)
            << name << ", face " << patch.face << ", " << in_words(g);
        ++looked_at;
    }
    EXPECT_GT(looked_at, 0u) << name;
}

TEST(BolzLevels, KeepAllSamplesWithinTheDistanceOfTheTrianglesThatAreDrawn)
{
    if (test::kSlow) GTEST_SKIP() << "many samples of what other tests go over too";
    for (Model const& model : models())
        for (double share : {3e-3, 3e-4}) expect_samples_within(model, share);
    for (Model const& model : models_of_other_rules()) expect_samples_within(model, 1e-3);
}

TEST(BolzLevels, EdgesHaveTheLesserOfBothAndFinerDistancesFinerPatches)
{
    for (auto const& [name, mesh] : models()) {
        MeshBasis const basis(*mesh);
        std::vector<DrawnPatch> const drawn = drawn_patches(*mesh, basis);
        double const diagonal = bounding_box_diagonal(mesh->base());
        std::vector<GridLevels> before(drawn.size());
        std::set<int> used;
        for (double share : {1.0, 1e-2, 1e-3, 1e-4}) {
            AdaptiveLevels const levels =
                adaptive_levels(drawn, basis, mesh->mesh(), share * diagonal);
            ASSERT_EQ(levels.patches.size(), drawn.size());
            for (std::size_t p = 0; p < drawn.size(); ++p) {
                GridLevels const& g = levels.patches[p];
                used.insert(g.inside);
                for (std::size_t k = 0; k < 4; ++k) {
                    std::uint32_t const other = drawn[p].neighbours[k];
                    EXPECT_EQ(g.edges[k], other == DrawnPatch::kNone
                                              ? g.inside
                                              : std::min(g.inside, levels.patches[other].inside));
                }
                EXPECT_GE(g.inside, before[p].inside) << name;
                if (share == 1) {
                    EXPECT_EQ(g.inside, 0) << name;
                }
            }
            before = levels.patches;
            // What is said of those beyond is so.
            EXPECT_EQ(levels.beyond > 0, levels.largest > share * diagonal) << name;
        }
        EXPECT_GE(used.size(), 3u) << name;
    }
}

TEST(BolzLevels, AreTheSmallestButBesideStrips)
{
    for (auto const& [name, mesh] : models()) {
        MeshBasis const basis(*mesh);
        std::vector<DrawnPatch> const drawn = drawn_patches(*mesh, basis);
        double const distance = 1e-3 * bounding_box_diagonal(mesh->base());
        AdaptiveLevels const levels = adaptive_levels(drawn, basis, mesh->mesh(), distance);
        std::map<std::uint32_t, std::unique_ptr<PatchDeviation>> of_type;
        std::size_t raised = 0;
        for (std::size_t p = 0; p < drawn.size(); ++p) {
            BasisPatch const& patch = basis.patches()[drawn[p].patch];
            auto& deviation = of_type[patch.type];
            if (!deviation) deviation = std::make_unique<PatchDeviation>(basis.types()[patch.type]);
            auto const net = deviation->net_of(points_of(*mesh, basis, patch));
            GridLevels const& g = levels.patches[p];
            if (g.inside < PatchDeviation::kMostLevel) {
                EXPECT_LE(deviation->bound(net, g), distance) << name;
            }
            raised += g.inside > 0 && deviation->bound(net, g.inside - 1) <= distance;
        }
        EXPECT_LT(20 * raised, drawn.size()) << name; // few
    }
}

} // namespace
} // namespace tessemu
