// The limit surface of tagged cages: against samples made by OpenSubdiv, against itself at other
// levels, and against surfaces known in closed form.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/limit_surface.h"
#include "io/model.h"
#include "pipeline/mesh/biermann.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/limit.h"
#include "tests/support/files.h"
#include "tests/support/limit_samples.h"
#include "tests/support/random_mesh.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <sstream>

namespace tessemu {
namespace {

using Vec = glm::dvec3;

// The points of a base face's sub-quads, by (sub, i, j) on a grid of `cells` a side. A quad's four
// children make one sub-quad.
std::map<std::array<int, 3>, std::uint32_t>
points_of_face(LimitSurface const& limit, ControlMesh const& base, std::uint32_t face, int& cells)
{
    using Corners = std::array<std::array<int, 2>, 4>;
    int const sides = int(base.face(face).size());
    int const digits = sides == 4 ? limit.level() : limit.level() - 1;
    cells = 1 << digits;
    std::map<std::array<int, 3>, std::uint32_t> out;
    std::size_t const of_sub = std::size_t(1) << (2 * digits);
    for (std::size_t q = limit.first_face(face); q < limit.first_face(face + 1); ++q) {
        std::size_t const number = q - limit.first_face(face);
        Corners c{{{0, 0}, {cells, 0}, {cells, cells}, {0, cells}}};
        for (int d = digits - 1; d >= 0; --d) {
            std::size_t const i = number >> (2 * d) & 3;
            auto const middle = [&](std::size_t a, std::size_t b) {
                return std::array{(c[a % 4][0] + c[b % 4][0]) / 2, (c[a % 4][1] + c[b % 4][1]) / 2};
            };
            c = {c[i], middle(i, i + 1), middle(i, i + 2), middle(i, i + 3)};
        }
        for (std::size_t k = 0; k < 4; ++k)
            out[{int(number / of_sub), c[k][0], c[k][1]}] = limit.face(q)[k];
    }
    return out;
}

struct Agreement {
    std::size_t compared = 0;
    double position = 0;  ///< worst distance in diagonals
    double near_dart = 0; ///< the same within a face of an infinitely sharp dart
    double normal = 0;    ///< worst |n - n'|
};

Agreement compare_with_samples(std::filesystem::path const& obj, std::filesystem::path const& csv)
{
    ControlMesh const mesh = test::mesh_of_samples(obj);
    std::vector<Vec> const positions = test::exact_positions(obj);
    EXPECT_EQ(positions.size(), mesh.positions.size());
    Topology const topology(mesh);
    bool quads = true;
    for (std::size_t f = 0; f < mesh.faces(); ++f) quads = quads && mesh.face(f).size() == 4;
    LimitSurface const limit(topology, quads ? 3 : 4, positions); // samples at 1/8
    test::LimitSamples const golden = test::read_limit_samples(csv);
    Sharpness const sharpness(topology);
    std::vector<char> at_dart(mesh.faces(), 0);
    RingSharpness around;
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
        if (topology.ring(v).empty()) continue;
        sharpness.around(v, around);
        bool const is_dart = around.rule() == VertexRule::Dart && !around.is_semi_sharp();
        for (HalfEdge h : topology.ring(v)) at_dart[topology.face_of(h)] |= is_dart;
    }
    Agreement out;
    std::uint32_t face = Topology::kNone;
    std::map<std::array<int, 3>, std::uint32_t> points;
    int cells = 0;
    for (test::LimitSamples::Sample const& s : golden.samples) {
        if (s.face != face) points = points_of_face(limit, mesh, face = s.face, cells);
        auto const at =
            points.find({s.sub, int(std::round(s.u * cells)), int(std::round(s.v * cells))});
        if (at == points.end()) {
            ADD_FAILURE() << "no point for " << s.line;
            return out;
        }
        double& worst = at_dart[s.face] ? out.near_dart : out.position;
        worst = std::max(worst,
                         glm::length(limit.positions()[at->second] - s.position) / golden.diagonal);
        if (s.normal != Vec(0))
            out.normal = std::max(out.normal, glm::length(limit.normals()[at->second] - s.normal));
        ++out.compared;
    }
    EXPECT_EQ(out.compared, golden.samples.size());
    return out;
}

// Samples are printed with 10 digits, in models of up to 10 diagonals from their origin: 5e-9. The
// file with infinitely sharp darts is off by 1e-5 itself in the faces there, for OpenSubdiv takes a
// smooth vertex's mask. Normals have 8 decimals, and at extraordinary vertices those of
// OpenSubdiv's patches are off by up to 6e-6 (see limit_surface_test.cpp).
void expect_agreement(std::string const& name, Agreement const& a)
{
    EXPECT_GT(a.compared, 100u);
    EXPECT_LE(a.position, 5e-9) << name;
    EXPECT_LE(a.near_dart, 1e-5) << name;
    EXPECT_LE(a.normal, 6e-6) << name;
    testing::Test::RecordProperty("samples", std::to_string(a.compared));
    testing::Test::RecordProperty("worst_of_the_diagonal",
                                  std::to_string(a.position * 1e9) + "e-9");
    testing::Test::RecordProperty("worst_normal", std::to_string(a.normal * 1e9) + "e-9");
}

class TaggedCage : public testing::TestWithParam<std::string> {};

TEST_P(TaggedCage, LiesOnOpenSubdivsLimitSurface)
{
    expect_agreement(GetParam(),
                     compare_with_samples(test::golden("limit/" + GetParam() + ".obj"),
                                          test::golden("limit/" + GetParam() + ".dyadic.csv.gz")));
}
INSTANTIATE_TEST_SUITE_P(Small, TaggedCage,
                         testing::Values("catmark_cube_corner0", "catmark_cube_creases2",
                                         "catmark_dart_edgeonly", "catmark_inf_crease0",
                                         "catmark_pyramid_creases0", "catmark_tent_creases0"));

class SharedTaggedCage : public testing::TestWithParam<std::string> {};

TEST_P(SharedTaggedCage, LiesOnOpenSubdivsLimitSurface)
{
    std::string const model = "models/" + GetParam() + ".obj",
                      golden = "golden/limit/" + GetParam() + ".dyadic.csv.gz";
    TESSEMU_NEEDS_SHARED(model);
    TESSEMU_NEEDS_SHARED(golden);
    expect_agreement(GetParam(), compare_with_samples(test::shared(model), test::shared(golden)));
}
INSTANTIATE_TEST_SUITE_P(Shared, SharedTaggedCage,
                         testing::Values("catmark_cube_corner4", "catmark_edgecorner",
                                         "catmark_edgeonly", "catmark_hole_test1", "catmark_pawn",
                                         "catmark_rook", "catmark_smoothtris0",
                                         "catmark_torus_creases0", "spot_control", "two_hole"));

// Every point of a refined mesh against OpenSubdiv's, as sets: the orders differ. Both sum in
// double means of a few points of up to 8, so they agree to some units of 2^-50; but for Chaikin's
// sharpnesses, which are floats whose sums round in the order of a ring: 2^-24 of 2 units.
class RefinedCage : public testing::TestWithParam<std::pair<std::string, int>> {};

TEST_P(RefinedCage, HasOpenSubdivsPoints)
{
    auto const& [name, steps] = GetParam();
    ControlMesh mesh = load_model(test::golden("limit/" + name + ".obj").string()).mesh;
    bool const chaikin = mesh.rules.crease_method == CreaseMethod::Chaikin;
    EXPECT_TRUE(chaikin || mesh.rules.smooth_triangles);
    std::vector<Vec> x(mesh.positions.begin(), mesh.positions.end());
    for (int step = 0; step < steps; ++step) {
        Topology const topology(mesh);
        Sharpness const sharpness(topology);
        x = refined_points<CatmullClark, Vec>(topology, sharpness, x);
        ControlMesh fine = split_mesh(topology, sharpness, x, false);
        mesh = std::move(fine);
    }
    std::istringstream in(test::read_text(test::golden("limit/" + name + ".refined.txt")));
    std::vector<char> taken(x.size(), 0);
    std::size_t points = 0;
    for (Vec p; in >> p.x >> p.y >> p.z; ++points) {
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < x.size(); ++i)
            if (glm::length(x[i] - p) < glm::length(x[nearest] - p)) nearest = i;
        EXPECT_LE(glm::length(x[nearest] - p), chaikin ? 0x1p-23 : 0x1p-48) << points;
        taken[nearest] = 1;
    }
    EXPECT_EQ(points, x.size());
    EXPECT_EQ(std::count(taken.begin(), taken.end(), 1), std::ptrdiff_t(x.size()));
}
INSTANTIATE_TEST_SUITE_P(OpenSubdiv, RefinedCage,
                         testing::Values(std::pair("chaikin_sheet", 3),
                                         std::pair("smooth_triangles", 2)),
                         [](auto const& of) { return of.param.first; });

double reach_of(ControlMesh const& mesh)
{
    double out = 0;
    for (glm::vec3 const& p : mesh.positions) out = std::max(out, glm::length(Vec(p)));
    return out;
}

// A point of the limit surface is the same however far the mesh was refined before the masks: what
// is still sharp goes on in the vertex's own ring. A refined point is a mean of at most 2 n + 1
// others, n up to 40 here, so a step adds at most as many roundings; at most 10 steps follow.
//
// So are normals, but at the mesh's own sharp vertices, where there is none and a convention holds,
// and on boundaries and creases of five faces a side and more. A tangent is a difference of such
// points, shorter by (1/4)^10 at worst; where both tangents are nearly parallel they turn further,
// which 1e-6 leaves room for: a wrong mask turns normals by degrees.
TEST(TaggedLimit, DoesNotDependOnTheLevel)
{
    std::size_t points = 0, normals = 0;
    for (std::uint32_t seed = 1; seed <= 24; ++seed) {
        ControlMesh const mesh = test::with_random_tags(test::random_mesh(seed), seed);
        Topology const topology(mesh);
        Sharpness const sharpness(topology);
        LimitSurface const coarse(topology, 2), fine(topology, 4);
        double const reach = reach_of(mesh);
        RingSharpness around;
        auto const has_normal = [&](std::uint32_t v) {
            sharpness.around(v, around);
            return around.rule() != VertexRule::Corner &&
                   (sharpness.is_plain(v) || topology.ring(v).size() < 5);
        };
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
            if (!coarse.has_grid(f)) continue;
            for (int i = 0; i <= 4; ++i)
                for (int j = 0; j <= 4; ++j) {
                    std::uint32_t const a = coarse.vertex(f, i, j),
                                        b = fine.vertex(f, 4 * i, 4 * j);
                    double const apart = glm::length(coarse.positions()[a] - fine.positions()[b]);
                    EXPECT_LE(apart, 14 * 81 * 0x1p-53 * reach) << seed << " " << f;
                    ++points;
                    if (i % 4 == 0 && j % 4 == 0 &&
                        !has_normal(mesh.face(f)[std::size_t(j == 0 ? i / 4 : 3 - i / 4)]))
                        continue;
                    EXPECT_LE(glm::length(coarse.normals()[a] - fine.normals()[b]), 1e-6)
                        << seed << " " << f << " " << i << " " << j;
                    ++normals;
                }
        }
    }
    EXPECT_GT(points, 10000u);
    EXPECT_GT(normals, 10000u);
}

// By Biermann's rules too, with every flatness, and at vertices with 5 faces and more as well,
// whose tangents are halved whatever the tags; but not on a crease beside one face, which has no
// second tangent. Where a step flattens, weights add up to 5 in absolute value, and rounding with
// them.
TEST(TaggedLimit, OfBiermannsRulesDoesNotDependOnTheLevelEither)
{
    std::size_t points = 0, normals = 0, concave = 0;
    std::optional<double> const flatness[] = {{}, 0.0, 0.5, 1.0};
    for (std::uint32_t seed = 1; seed <= 24; ++seed) {
        ControlMesh mesh = test::random_mesh(seed);
        if (seed % 3 == 0) mesh = test::join_faces(mesh, seed);
        mesh = test::with_random_tags(mesh, seed);
        for (auto& c : mesh.creases) c.sharpness = c.sharpness > 2 ? kInfinitelySharp : 0;
        for (auto& c : mesh.corners) c.sharpness = c.sharpness > 2 ? kInfinitelySharp : 0;
        mesh.rules.sectors = SectorRules::Biermann;
        mesh.rules.flatness = flatness[seed % 4];
        mark_concave_sectors(mesh);
        concave += mesh.concave.size();
        Topology const topology(mesh);
        Sharpness const sharpness(topology);
        LimitSurface const coarse(topology, 1), fine(topology, 3);
        double const reach = reach_of(mesh);
        RingSharpness around;
        auto const has_normal = [&](std::uint32_t v) {
            sharpness.around(v, around);
            auto const sides = around.sectors();
            return around.rule() != VertexRule::Crease ||
                   std::all_of(sides.begin(), sides.end(),
                               [](RingSector const& s) { return s.faces > 1; });
        };
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
            if (!coarse.has_grid(f)) continue;
            for (int i = 0; i <= 2; ++i)
                for (int j = 0; j <= 2; ++j) {
                    std::uint32_t const a = coarse.vertex(f, i, j),
                                        b = fine.vertex(f, 4 * i, 4 * j);
                    double const apart = glm::length(coarse.positions()[a] - fine.positions()[b]);
                    EXPECT_LE(apart, 5 * 14 * 81 * 0x1p-53 * reach) << seed << " " << f;
                    ++points;
                    if (i % 2 == 0 && j % 2 == 0 &&
                        !has_normal(mesh.face(f)[std::size_t(j == 0 ? i / 2 : 3 - i / 2)]))
                        continue;
                    EXPECT_LE(glm::length(coarse.normals()[a] - fine.normals()[b]), 1e-6)
                        << seed << " " << f << " " << i << " " << j;
                    ++normals;
                }
        }
    }
    EXPECT_GT(points, 4000u);
    EXPECT_GT(normals, 4000u);
    EXPECT_GT(concave, 10u);
}

// A cube all of whose edges are sharp is itself. Its corners lie a quarter of the diagonal from
// those of the smooth limit: (1 - 1/2) of the way to the centre, half a diagonal off, where
// (n^2 v + 4 sum d + sum x)/(n(n+5)) of n = 3 is (9 + 4 + (-1))/24 = 1/2 of v. A tangent across an
// edge sums 6 terms that weigh 16 in all, and has the length 6 cells of 1/2: normals have 32 units.
TEST(TaggedLimit, ASharpCubeIsACubeAndTheSmoothOneAQuarterOfTheDiagonalOff)
{
    ControlMesh cube = test::cube().mesh;
    Topology const topology(cube);
    LimitSurface const smooth(topology, 2);
    for (HalfEdge h = 0; h < cube.face_vertices.size(); ++h)
        cube.creases.push_back(
            {topology.vertex_of(h), topology.vertex_of(topology.next(h)), kInfinitelySharp});
    LimitSurface const sharp(topology, 2);
    double diagonal = 2 * reach_of(cube);
    for (std::uint32_t f = 0; f < cube.faces(); ++f) {
        auto const v = cube.face(f);
        Vec const a(cube.positions[v[0]]), b(cube.positions[v[1]]), d(cube.positions[v[3]]);
        Vec const n = glm::normalize(cross(b - a, d - a));
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; j <= 4; ++j) {
                std::uint32_t const p = sharp.vertex(f, i, j);
                EXPECT_EQ(sharp.positions()[p], a + (b - a) * (i / 4.0) + (d - a) * (j / 4.0));
                EXPECT_LE(glm::length(sharp.normals()[p] - n), 32 * 0x1p-53);
            }
        EXPECT_EQ(glm::length(sharp.positions()[sharp.vertex(f, 0, 0)] -
                              smooth.positions()[smooth.vertex(f, 0, 0)]) /
                      diagonal,
                  0.25);
    }
}

// A flat sheet bent by nothing but tags stays flat, and its normals with it, round a sharp corner
// of three faces too.
TEST(TaggedLimit, AFlatSheetHasOneNormalWhateverIsSharp)
{
    ControlMesh sheet;
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) sheet.positions.emplace_back(float(x), float(y), 0.0f);
    for (std::uint32_t y = 0; y < 4; ++y)
        for (std::uint32_t x = 0; x < 4; ++x) {
            if (x > 1 && y > 1) continue; // an L: its inner corner, 12, has three faces
            std::uint32_t const a = 5 * y + x;
            sheet.add_face(std::vector{a, a + 1, a + 6, a + 5});
        }
    sheet.corners.push_back({12, kInfinitelySharp});
    std::size_t compared = 0;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        ControlMesh const mesh = seed ? test::with_random_tags(sheet, seed) : sheet;
        Topology const topology(mesh);
        LimitSurface const limit(topology, 3);
        for (std::size_t p = 0; p < limit.positions().size(); ++p, ++compared) {
            EXPECT_EQ(limit.positions()[p].z, 0);
            EXPECT_EQ(limit.normals()[p], Vec(0, 0, 1))
                << seed << " at " << limit.positions()[p].x << " " << limit.positions()[p].y;
        }
    }
    EXPECT_GT(compared, 5000u);
}

// By Biermann's rules its inner corner is concave, and flat by its flatness: its normals point
// outwards still. Nothing is folded, and the L is covered: 1024 quads of coordinates of up to 4.
TEST(TaggedLimit, AConcaveCornerOfAFlatSheetStaysInItAndFacesOutwards)
{
    for (std::optional<double> flatness : {std::optional<double>(), std::optional(0.0)}) {
        ControlMesh sheet;
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 5; ++x) sheet.positions.emplace_back(float(x), float(y), 0.0f);
        for (std::uint32_t y = 0; y < 4; ++y)
            for (std::uint32_t x = 0; x < 4; ++x) {
                if (x > 1 && y > 1) continue;
                std::uint32_t const a = 5 * y + x;
                sheet.add_face(std::vector{a, a + 1, a + 6, a + 5});
            }
        sheet.corners.push_back({12, kInfinitelySharp});
        sheet.rules.sectors = SectorRules::Biermann;
        sheet.rules.flatness = flatness;
        EXPECT_EQ(mark_concave_sectors(sheet).several_faces, 1u);
        Topology const topology(sheet);
        LimitSurface const limit(topology, 4);
        double area = 0;
        for (std::size_t f = 0; f < limit.faces(); ++f) {
            auto const q = limit.face(f);
            auto const at = [&](int k) { return limit.positions()[q[std::size_t(k)]]; };
            double const twice = cross(at(2) - at(0), at(3) - at(1)).z;
            EXPECT_GT(twice, 0) << "folded";
            area += twice / 2;
        }
        EXPECT_NEAR(area, 12, 1e-12); // each of its other corners has one face and stays
        for (std::size_t p = 0; p < limit.positions().size(); ++p) {
            EXPECT_EQ(limit.positions()[p].z, 0);
            EXPECT_EQ(limit.normals()[p], Vec(0, 0, 1)) << p;
        }
    }
}

// Iterated refinement of a dart's ring against its masks: the limit is what the ring tends to, and
// the normal that of the plane which its differences tend to. The second mode of each parity is at
// most 0.87 of the first for n up to 8 (the smooth vertex's: 0.611 and 0.5), so 30 steps leave
// 0.87^30 = 0.015 of it: normals within 0.1, where two unlike vectors are 1 apart. The masks do not
// see steps: a refined ring has the same limit and the same plane, to rounding.
TEST(TaggedLimit, MasksAreWhatTheRingOfADartTendsTo)
{
    std::mt19937 random(7);
    auto const point = [&] {
        auto const c = [&] { return double(random() % 1024) / 1024; };
        double const x = c(), y = c();
        return Vec(x, y, c());
    };
    auto const normal_of = [](VertexLimit<Vec> const& limit) {
        return glm::normalize(cross(limit.sides[0].tangents[0], limit.sides[0].tangents[1]));
    };
    for (std::size_t n = 2; n <= 12; ++n) {
        Ring<Vec> ring{point(), {}, {}};
        for (std::size_t j = 0; j < n; ++j) {
            // Round the vertex, so that the ring has a side that is outside.
            double const c = cos_pi(int(2 * j), int(n)), s = sin_pi(int(2 * j), int(n));
            ring.edge.push_back(ring.vertex + Vec(c, s, 0) + 0.25 * point());
            ring.face.push_back(ring.vertex + Vec(c - s, s + c, 0) + 0.25 * point());
        }
        RingSharpness dart;
        dart.edge.assign(n, 0);
        dart.edge[1] = kInfinitelySharp;
        Limits<CatmullClark> limits;
        VertexLimit<Vec> const limit = limits.of(ring, dart);
        ASSERT_EQ(limit.sides.size(), 1u);
        EXPECT_EQ(limit.rule, VertexRule::Dart);
        Ring<Vec> fine = ring;
        for (int step = 0; step < 30; ++step) fine = refined_ring<CatmullClark>(fine, dart);
        EXPECT_LE(glm::length(fine.vertex - limit.position), 1e-5) << n; // 0.64^30 = 1.5e-6
        if (n >= 3 && n <= 8) {
            Vec area(0);
            for (std::size_t j = 0; j < n; ++j)
                area += cross(fine.edge[j] - fine.vertex, fine.edge_after(j) - fine.vertex);
            EXPECT_LE(glm::length(glm::normalize(area) - normal_of(limit)), 0.1) << n;
        }
        VertexLimit<Vec> const again = limits.of(refined_ring<CatmullClark>(ring, dart), dart);
        EXPECT_LE(glm::length(again.position - limit.position), 1e-13) << n;
        if (n >= 3) {
            EXPECT_LE(glm::length(normal_of(again) - normal_of(limit)), 1e-11) << n;
        }
    }
}

// Along a crease of two faces a side the surface is a bicubic on each, so its cross tangent is that
// of a B-spline: (-1 -4 -1, 4 of the row inside, 1 beside it)/6; k = 2 in the general mask, where a
// weight is a quotient of sums of three products of up to 4: eight roundings of 2^-52 each.
TEST(TaggedLimit, ARegularCreaseHasTheBSplinesTangent)
{
    for (int at = 0; at < 6; ++at) {
        double weights[6] = {}; // e_0 e_1 e_2 f_0 f_1 V
        weights[at] = 1;
        auto const edge = [&](std::size_t j) -> double const& { return weights[j]; };
        auto const face = [&](std::size_t j) -> double const& { return weights[3 + j]; };
        double const expected[6] = {-1, 4, -1, 1, 1, -4};
        EXPECT_NEAR(CatmullClark::crease_across(2, weights[5], edge, face), expected[at],
                    8 * 0x1p-52);
    }
}

// With k faces the mask is a left eigenvector of the sector's refinement: a step multiplies it by
// lambda = (5 + c + sqrt((c + 9)(c + 1)))/16, c = cos(pi/k).
TEST(TaggedLimit, TheTangentAcrossAnyCreaseIsAnEigenvectorOfTheStep)
{
    for (int k = 2; k <= 12; ++k) {
        std::size_t const n = std::size_t(k);
        RingSharpness open;
        open.open = true;
        open.edge.assign(n + 1, 0);
        open.edge.front() = open.edge.back() = kInfinitelySharp;
        double const c = cos_pi(1, k), lambda = (5 + c + std::sqrt((c + 9) * (c + 1))) / 16;
        auto const across = [&](Ring<double> const& r) {
            auto const edge = [&](std::size_t j) -> double const& { return r.edge[j]; };
            auto const face = [&](std::size_t j) -> double const& { return r.face[j]; };
            return CatmullClark::crease_across(k, r.vertex, edge, face);
        };
        for (std::size_t at = 0; at < 2 * n + 2; ++at) {
            Ring<double> ring{at == 0 ? 1.0 : 0.0, std::vector<double>(n + 1, 0),
                              std::vector<double>(n, 0)};
            if (at > n + 1)
                ring.face[at - n - 2] = 1;
            else if (at > 0)
                ring.edge[at - 1] = 1;
            double const before = across(ring),
                         after = across(refined_ring<CatmullClark>(ring, open));
            EXPECT_NEAR(after, lambda * before, 1e-13) << k << " " << at; // weights up to 40
        }
    }
}

} // namespace
} // namespace tessemu
