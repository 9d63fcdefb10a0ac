// Tables of a mesh's patches times its points: the limit surface, whatever is tagged; and what
// patches share of it, bit for bit.
//
// SPDX-License-Identifier: Apache-2.0
#include "analysis/limit_surface.h"
#include "emu/parallel.h"
#include "pipeline/basis_tables/mesh_basis.h"
#include "pipeline/mesh/biermann.h"
#include "pipeline/mesh/catmull_clark.h"
#include "tests/support/random_mesh.h"
#include "tests/support/shapes.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <random>

namespace tessemu {
namespace {

using Vec = glm::dvec3;

double diagonal_of(ControlMesh const& mesh)
{
    glm::vec3 low = mesh.positions[0], high = low;
    for (auto const& p : mesh.positions) low = min(low, p), high = max(high, p);
    return glm::length(Vec(high) - Vec(low));
}

// Sharp without end or not at all, as Biermann's rules have it.
ControlMesh by_biermann(ControlMesh mesh, std::optional<double> flatness)
{
    for (auto& c : mesh.creases) c.sharpness = c.sharpness > 2 ? kInfinitelySharp : 0;
    for (auto& c : mesh.corners) c.sharpness = c.sharpness > 2 ? kInfinitelySharp : 0;
    mesh.rules.sectors = SectorRules::Biermann;
    mesh.rules.crease_method = CreaseMethod::Normal;
    mesh.rules.flatness = flatness;
    mark_concave_sectors(mesh);
    return mesh;
}

struct Worst {
    std::size_t points = 0, normals = 0;
    double position = 0, normal = 0;
    std::array<std::size_t, kPatchFamilies> patches{};
    std::size_t with_beyond = 0, with_other_points = 0;
};

// In double, at all samples, from the drawn mesh's rounded points.
void compare_with_limit(ControlMesh const& mesh, Worst& worst)
{
    RefinedMesh const refined(mesh, 2, catmull_clark_step);
    BasisTableMemory store;
    MeshBasis const basis(refined, &store, {.enforced = false});
    LimitSurface const limit(refined.topology(), kTableSteps);
    double const diagonal = diagonal_of(refined.mesh());
    auto const& x = refined.mesh().positions;
    for (BasisPatch const& patch : basis.patches()) {
        PatchTypeTables const& type = basis.types()[patch.type];
        BasisTables const tables = *store.find(type.type);
        ++worst.patches[std::size_t(type.type.family())];
        worst.with_beyond += std::any_of(type.type.beyond.begin(), type.type.beyond.end(),
                                         [](auto const& ring) { return ring.has_value(); });
        worst.with_other_points += !type.beyond.empty();
        EXPECT_EQ(patch.rotation, 0);
        for (int j = 0; j < kTableSide; ++j)
            for (int i = 0; i < kTableSide; ++i) {
                Vec p(0), du(0), dv(0);
                for (std::size_t k = 0; k < std::size_t(tables.points); ++k) {
                    Vec const c(x[basis.points()[patch.first_point + type.point_of[k]]]);
                    std::size_t const s = k * kTableSamples + std::size_t(j * kTableSide + i);
                    p += tables.position[s] * c;
                    du += tables.du[s] * c;
                    dv += tables.dv[s] * c;
                }
                std::uint32_t const v = limit.vertex(patch.face, i, j);
                worst.position =
                    std::max(worst.position, glm::length(p - limit.positions()[v]) / diagonal);
                ++worst.points;
                // At the corner of a type: its own test.
                Vec const n = cross(du, dv);
                if ((i == 0 && j == 0) ||
                    !(glm::length(n) > 1e-4 * glm::length(du) * glm::length(dv)))
                    continue;
                worst.normal =
                    std::max(worst.normal, glm::length(n / glm::length(n) - limit.normals()[v]));
                ++worst.normals;
            }
    }
}

// Weights of magnitude up to 1 that differ by roundings; normals of tangents that differ by some
// 1e-15 of their length, at an angle of 1e-4 and more.
TEST(BasisSurface, IsTheLimitSurfaceOfTaggedMeshes)
{
    Worst worst;
    for (std::uint32_t seed = 5; seed <= 8; ++seed)
        compare_with_limit(test::with_random_tags(test::random_mesh(seed), seed), worst);
    EXPECT_LE(worst.position, 1e-12);
    EXPECT_LE(worst.normal, 1e-9);
    EXPECT_GT(worst.normals, worst.points / 2);
    for (PatchFamily f : {PatchFamily::Regular, PatchFamily::Smooth, PatchFamily::Crease,
                          PatchFamily::ConvexCorner, PatchFamily::Dart, PatchFamily::SemiSharp})
        EXPECT_GT(worst.patches[std::size_t(f)], 0u) << in_words(f);
    EXPECT_GT(worst.with_beyond, 0u) << "Chaikin's rule";
}

TEST(BasisSurface, IsTheLimitSurfaceOfBiermannsRules)
{
    Worst worst;
    std::optional<double> const flatness[] = {{}, 0.0, 0.5, 1.0};
    for (std::uint32_t seed = 4; seed <= 9; ++seed)
        compare_with_limit(
            by_biermann(test::with_random_tags(test::random_mesh(seed), seed), flatness[seed % 4]),
            worst);
    EXPECT_LE(worst.position, 1e-12);
    EXPECT_LE(worst.normal, 1e-9);
    EXPECT_GT(worst.patches[std::size_t(PatchFamily::ConcaveCorner)], 0u);
    EXPECT_EQ(worst.patches[std::size_t(PatchFamily::SemiSharp)], 0u);
    EXPECT_GT(worst.with_beyond, 0u);
    EXPECT_GT(worst.with_other_points, 0u);
}

} // namespace
} // namespace tessemu
