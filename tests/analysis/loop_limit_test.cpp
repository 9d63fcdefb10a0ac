// The limit surface of Loop subdivision against samples made by OpenSubdiv and against itself at
// other levels; comparisons of triangle schemes with it.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/compare.h"
#include "io/model.h"
#include "pipeline/mesh/loop.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/limit_samples.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tessemu {
namespace {

using Vec = glm::dvec3;

struct Agreement {
    std::size_t compared = 0, normals = 0;
    double position = 0; ///< worst distance in diagonals
    double normal = 0;   ///< worst |n - n'|
};

// Rows weigh vertices 1 and 2 of a face by u and v, the grid corners 0 and 1.
Agreement compare_with_samples(std::filesystem::path const& obj, std::filesystem::path const& csv)
{
    ControlMesh const mesh = test::mesh_of_samples(obj);
    std::vector<Vec> const positions = test::exact_positions(obj);
    EXPECT_EQ(positions.size(), mesh.positions.size());
    Topology const topology(mesh);
    LimitSurface const limit(topology, 3, positions, loop_step); // samples at 1/8 or 1/4
    test::LimitSamples const golden = test::read_limit_samples(csv);
    Agreement out;
    for (auto const& s : golden.samples) {
        double const x = limit.grid() * (1 - s.u - s.v), y = limit.grid() * s.u;
        EXPECT_NEAR(x, std::round(x), 1e-8) << "a sample beside the grid";
        std::uint32_t const v = limit.vertex(s.face, int(std::round(x)), int(std::round(y)));
        out.position = std::max(out.position,
                                glm::length(limit.positions()[v] - s.position) / golden.diagonal);
        ++out.compared;
        if (s.normal == Vec(0)) continue;
        out.normal = std::max(out.normal, glm::length(limit.normals()[v] - s.normal));
        ++out.normals;
    }
    return out;
}

// Samples are printed with 10 digits, in coordinates of up to a diagonal: 2e-10. Normals have 8
// decimals; in slim triangles the digits of positions turn them further.
void expect_samples(std::filesystem::path const& obj, std::filesystem::path const& csv)
{
    Agreement const a = compare_with_samples(obj, csv);
    EXPECT_GT(a.compared, 100u);
    EXPECT_GT(2 * a.normals, a.compared);
    EXPECT_LE(a.position, 2e-10);
    EXPECT_LE(a.normal, 1e-6);
    testing::Test::RecordProperty("samples", std::to_string(a.compared));
    testing::Test::RecordProperty("worst_of_the_diagonal",
                                  std::to_string(a.position * 1e12) + "e-12");
    testing::Test::RecordProperty("worst_normal", std::to_string(a.normal * 1e9) + "e-9");
}

class LoopCage : public testing::TestWithParam<std::string> {};

TEST_P(LoopCage, LiesOnOpenSubdivsLimitSurface)
{
    expect_samples(test::golden("limit/" + GetParam() + ".obj"),
                   test::golden("limit/" + GetParam() + ".loop.csv.gz"));
}
INSTANTIATE_TEST_SUITE_P(Small, LoopCage,
                         testing::Values("loop_cube_creases1", "loop_saddle_edgeonly"));

class SharedLoopCage : public testing::TestWithParam<std::string> {};

TEST_P(SharedLoopCage, LiesOnOpenSubdivsLimitSurface)
{
    std::string const model = "models/" + GetParam() + ".obj",
                      golden = "golden/limit/" + GetParam() + ".loop.csv.gz";
    TESSEMU_NEEDS_SHARED(model);
    TESSEMU_NEEDS_SHARED(golden);
    expect_samples(test::shared(model), test::shared(golden));
}
INSTANTIATE_TEST_SUITE_P(Shared, SharedLoopCage,
                         testing::Values("loop_cube", "loop_icosahedron", "loop_xord_interior",
                                         "knight_tri_1k"));

// An octahedron with an infinitely sharp closed crease, a semi-sharp edge and a corner.
ControlMesh tagged_octahedron()
{
    ControlMesh m;
    m.positions = {{3, 0, 0}, {0, 2, 0}, {-3, 0, 1}, {0, -2, 0}, {0, 0, 2}, {0, 0, -2}};
    for (std::uint32_t k = 0; k < 4; ++k) {
        std::uint32_t const next = (k + 1) % 4;
        m.add_face(std::vector{k, next, 4u});
        m.add_face(std::vector{next, k, 5u});
        m.creases.push_back({k, next, kInfinitelySharp});
    }
    m.creases.push_back({0, 4, 2.5f});
    m.corners.push_back({5, kInfinitelySharp});
    return m;
}

// Refinement and limits are exact but for rounding: a point is the same at every level, and its
// normal where no convention gives it: not where the mesh is sharp itself.
TEST(LoopLimit, DoesNotDependOnTheLevel)
{
    ControlMesh const mesh = tagged_octahedron();
    Topology const topology(mesh);
    LimitSurface const coarse(topology, 2, {}, loop_step), fine(topology, 5, {}, loop_step);
    EXPECT_EQ(coarse.sides(), 3);
    EXPECT_EQ(coarse.faces(), mesh.faces() * 16);
    std::size_t normals = 0;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f)
        for (int i = 0; i <= 4; ++i)
            for (int j = 0; i + j <= 4; ++j) {
                std::uint32_t const a = coarse.vertex(f, i, j), b = fine.vertex(f, 8 * i, 8 * j);
                // Means of 7 values at most, of up to 3, seven times, and three steps more.
                EXPECT_LE(glm::length(coarse.positions()[a] - fine.positions()[b]),
                          10 * 15 * 0x1p-53 * 3)
                    << f << " " << i << " " << j;
                if (i == 4 || j == 4 || i + j == 0) continue;
                EXPECT_LE(glm::length(coarse.normals()[a] - fine.normals()[b]), 1e-10)
                    << f << " " << i << " " << j;
                ++normals;
            }
    EXPECT_EQ(normals, mesh.faces() * 12);
}

// In a regular flat net points are where their weights say.
TEST(LoopLimit, AGridsPointsLieByTheirWeights)
{
    ControlMesh mesh;
    for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i) mesh.positions.emplace_back(float(i), float(j), 0.0f);
    for (std::uint32_t j = 0; j < 4; ++j)
        for (std::uint32_t i = 0; i < 4; ++i) {
            std::uint32_t const a = 5 * j + i;
            mesh.add_face(std::vector{a, a + 1, a + 5});
            mesh.add_face(std::vector{a + 6, a + 5, a + 1});
        }
    Topology const topology(mesh);
    LimitSurface const limit(topology, 3, {}, loop_step);
    std::size_t inside = 0;
    for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
        auto const v = mesh.face(f);
        Vec const x[3] = {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
        bool is_inside = true; // its ring has no vertex at the boundary
        for (Vec const& p : x) is_inside = is_inside && std::max(abs(p.x - 2), abs(p.y - 2)) < 2;
        if (!is_inside) continue;
        ++inside;
        for (int i = 0; i <= 8; ++i)
            for (int j = 0; i + j <= 8; ++j) {
                std::uint32_t const at = limit.vertex(f, i, j);
                Vec const wanted =
                    (double(i) * x[0] + double(j) * x[1] + (8.0 - i - j) * x[2]) / 8.0;
                EXPECT_LE(glm::length(limit.positions()[at] - wanted), 1e-14);
                EXPECT_EQ(limit.normals()[at], Vec(0, 0, 1));
            }
    }
    EXPECT_EQ(inside, 8u);
}

TEST(LoopLimit, RefusesAFaceThatIsNoTriangle)
{
    ControlMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.add_face(std::vector<std::uint32_t>{0, 1, 2, 3});
    Topology const topology(mesh);
    EXPECT_THROW(LimitSurface(topology, 2, {}, loop_step), MeshError);
}

SchemeOnMesh pattern(ControlMesh mesh, int steps = 0)
{
    return build_scheme(find_scheme("tables-loop"), std::move(mesh),
                        {.subdivide = steps, .set = {{"mesher", "pattern"}}});
}

// Tables in float, and sums of 12 to 20 products: tables-loop is the limit surface at all points of
// the pattern, those inside triangles included. Weights and sums round, by 2^-24 of coordinates of
// half a diagonal each time: 40 times would be 1.2e-6. What is promised is 2e-7, for roundings do
// not all go one way.
//
// By closest point too where normals agree roughly; those of subdivision shading (HOLL10 3) differ
// by more than a right angle at worst on few large faces with sharp edges, and then a sample takes
// the surface for another sheet's.
void expect_no_error(ControlMesh const& mesh, bool normals_agree = true)
{
    SchemeOnMesh const on = pattern(mesh);
    for (int level : {1, 3, 5}) {
        SurfaceComparison const c = compare_with_limit(*on.patches, {}, level, ThreadPool(2));
        std::size_t const side = (std::size_t(1) << level) + 1;
        EXPECT_EQ(c.equal_position.samples, 4 * mesh.faces() * (side * (side + 1) / 2)) << level;
        EXPECT_LE(c.equal_position.max, 2e-7) << level;
        if (normals_agree) {
            EXPECT_LE(c.to_limit.max, 2e-7) << level; // samples coincide with vertices
            EXPECT_LE(c.from_limit.max, 2e-7) << level;
        }
        testing::Test::RecordProperty("worst_of_the_diagonal",
                                      std::to_string(c.equal_position.max * 1e9) + "e-9");
    }
}

TEST(CompareWithLoop, TablesHaveNoErrorWithSemiSharpCreases)
{
    expect_no_error(load_model(test::golden("limit/loop_cube_creases1.obj").string()).mesh);
}
TEST(CompareWithLoop, TablesHaveNoErrorAtABoundary)
{
    expect_no_error(load_model(test::golden("limit/loop_saddle_edgeonly.obj").string()).mesh);
}
TEST(CompareWithLoop, TablesHaveNoErrorWithInfinitelySharpTags)
{
    expect_no_error(tagged_octahedron(), false);
}
TEST(CompareWithLoop, TablesHaveNoErrorOnAThousandTriangles)
{
    TESSEMU_NEEDS_SHARED("models/knight_tri_1k.obj");
    SchemeOnMesh const on =
        pattern(load_model(test::shared("models/knight_tri_1k.obj").string()).mesh);
    SurfaceComparison const c = compare_with_limit(*on.patches, {}, 3, ThreadPool(2));
    EXPECT_EQ(c.equal_position.samples, 4u * 1000 * 45);
    EXPECT_LE(c.equal_position.max, 3e-7); // coordinates of up to 0.9 diagonals, 10 edges a vertex
    EXPECT_LE(c.from_limit.max, 3e-7);
}

// Triangles of several levels, on a drawn mesh with faces turned and upside down: each patch is
// compared with its own part of its face.
class MixedTriangles final : public PatchMesh {
public:
    MixedTriangles(ControlMesh const& mesh, int steps)
        : PatchMesh(std::make_shared<RefinedMesh const>(mesh, steps, loop_step))
    {
        ControlMesh half[2] = {mesh, mesh};
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) half[f % 2].holes.push_back(f);
        coarse_ = pattern(half[0], 1);
        fine_ = pattern(half[1], 2);
    }

    CommandList commands(SurfaceSettings const& settings) const override
    {
        SurfaceSettings coarse = settings;
        coarse.tess_factor *= 2;
        CommandList list = coarse_.patches->commands(coarse);
        CommandList more = fine_.patches->commands(settings);
        for (Command& c : more.commands) list.commands.push_back(std::move(c));
        for (auto& m : more.memory) list.memory.push_back(std::move(m));
        return list;
    }
    std::vector<PatchCount> patch_counts() const override
    {
        return coarse_.patches->patch_counts();
    }

private:
    SchemeOnMesh coarse_, fine_;
};

TEST(CompareWithLoop, FindsEachPatchOnItsFace)
{
    ControlMesh const mesh = load_model(test::golden("limit/loop_cube_creases1.obj").string()).mesh;
    for (int steps : {0, 1, 2}) {
        int const level = 4 - steps; // sixteenths of the mesh's edges
        EqualParameterErrors const e =
            equal_parameter_errors(MixedTriangles(mesh, steps), {}, level, ThreadPool(2));
        ErrorStatistics const position = e.position_statistics();
        EXPECT_EQ(position.samples, mesh.faces() / 2 * (16 * 15 + 64 * 6)) << steps;
        EXPECT_LE(position.max, 2e-7) << steps;
    }
}

// An octahedron's vertices move towards its middle by 4 chi, chi = 1 / (3 / (8 beta) + 4), for
// their neighbours' sum is 0, and are the closest of the surface to the cage's, which all
// substitutes keep: nothing of theirs is further off.
TEST(CompareWithLoop, CornersOfSubstitutesAreOffByWhatTheMaskMovesThem)
{
    ControlMesh mesh;
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t k = 0; k < 4; ++k) {
        std::uint32_t const next = (k + 1) % 4;
        mesh.add_face(std::vector{k, next, 4u});
        mesh.add_face(std::vector{next, k, 5u});
    }
    double const beta = (0.625 - 0.375 * 0.375) / 4, moved = 4 / (3 / (8 * beta) + 4);
    for (char const* scheme : {"flat", "phong", "pn-triangles"}) {
        SchemeOnMesh const on = build_scheme(find_scheme(scheme), mesh);
        SurfaceComparison const c = compare_with_limit(*on.patches, {}, 3, ThreadPool(2));
        // Corners are products with 1 and 0 but for a rounding or two.
        EXPECT_NEAR(c.to_limit.max, moved / std::sqrt(12.0), 0x1p-23) << scheme;
        EXPECT_GT(c.to_limit.samples, 8u * 45) << scheme;
    }
}

} // namespace
} // namespace tessemu
