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
#include "tests/support/sanitized.h"
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
// 1e-15 of their length, at an angle of 1e-4 and more. What is left out of the normals is a sample
// in 1,089 at the corner, and tangents in one line, which only a patch at a concave or folded place
// has; half is that something was compared. Each kind of patch and of points must have occurred.
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
    if (test::kSlow) GTEST_SKIP() << "goes over the code that Bolz.IsTheLimitSurface... does";
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

// Tables of arbitrary origin: each weight off by up to an ulp of a float.
class NoisyStore : public BasisTableStore {
public:
    std::optional<BasisTables> find(PatchType const& type) override
    {
        BasisTables out = make_basis_tables(type);
        for (auto* table : {&out.position, &out.du, &out.dv})
            for (double& w : *table) w *= 1 + 0x1p-23 * (double(random_() % 3) - 1);
        return out;
    }
    void keep(PatchType const&, BasisTables const&) override {}

private:
    std::mt19937 random_{1};
};

struct Shared {
    std::size_t positions = 0, tangents = 0, positions_differ = 0, tangents_differ = 0;
};

// Sums in single precision, of products and sums apart; `by_vertex`: in the order of the vertices,
// else of the tables.
Shared shared_sides(RefinedMesh const& refined, MeshBasis const& basis, bool by_vertex)
{
    Topology const& t = refined.topology();
    Sharpness const sharpness(t);
    auto const& x = refined.mesh().positions;
    auto const at = [&](std::uint32_t face, int i, int j) {
        BasisPatch const& patch = basis.patches()[face];
        PatchTypeTables const& type = basis.types()[patch.type];
        std::vector<std::pair<std::uint32_t, std::size_t>> order;
        for (std::size_t k = 0; k < std::size_t(type.points); ++k)
            order.emplace_back(basis.points()[patch.first_point + k], k);
        if (by_vertex) std::sort(order.begin(), order.end());
        std::array<glm::vec3, 3> sum{glm::vec3(0), glm::vec3(0), glm::vec3(0)};
        for (auto const& [vertex, k] : order) {
            std::size_t const s = k * kTableSamples + std::size_t(j * kTableSide + i);
            sum[0] += type.position[s] * x[vertex];
            sum[1] += type.du[s] * x[vertex];
            sum[2] += type.dv[s] * x[vertex];
        }
        return sum;
    };
    Shared out;
    for (HalfEdge h = 0; h < refined.mesh().face_vertices.size(); ++h) {
        HalfEdge const other = t.twin(h);
        if (other == Topology::kNone || h % 4 > 1) continue;
        bool const lower = h % 4 == 0;
        for (int s = 0; s < kTableSide; ++s) {
            auto const a = lower ? at(t.face_of(h), s, 0) : at(t.face_of(h), 32, s);
            auto const b = lower ? at(t.face_of(other), 0, s) : at(t.face_of(other), s, 32);
            ++out.positions;
            out.positions_differ += a[0] != b[0];
            if (lower && (s == 0 || sharpness.edge(h) >= kInfinitelySharp)) continue;
            // Turned by a right angle: du is the other's dv, dv its -du; across Right the same.
            ++out.tangents;
            out.tangents_differ += a[1] != (lower ? b[2] : -b[2]) || a[2] != (lower ? -b[1] : b[1]);
        }
    }
    return out;
}

// The share of points that differ without enforcement or order is most of
// them.
TEST(BasisSurface, HasEqualBitsWherePatchesMeetWithEnforcedTablesInOneOrder)
{
    std::optional<double> const flatness[] = {{}, 0.0, 0.5};
    Shared all, unenforced, unordered;
    auto const add = [](Shared& sum, Shared const& s) {
        sum.positions += s.positions, sum.tangents += s.tangents;
        sum.positions_differ += s.positions_differ, sum.tangents_differ += s.tangents_differ;
    };
    for (std::uint32_t seed : test::kSlow ? std::vector{5u} : std::vector{5u, 7u, 20u})
        for (int rules = 0; rules < 4; ++rules) {
            ControlMesh mesh = test::with_random_tags(test::random_mesh(seed), seed);
            if (rules > 0) mesh = by_biermann(std::move(mesh), flatness[rules - 1]);
            RefinedMesh const refined(std::move(mesh), 2, catmull_clark_step);
            NoisyStore store;
            MeshBasis const basis(refined, &store);
            Shared const s = shared_sides(refined, basis, true);
            MeshSummary const mesh_has = summarize(refined.topology());
            EXPECT_EQ(s.positions, (mesh_has.edges - mesh_has.boundary_edges) * kTableSide);
            EXPECT_EQ(s.positions_differ, 0u) << seed << " " << rules;
            EXPECT_EQ(s.tangents_differ, 0u) << seed << " " << rules;
            add(all, s);
            if (rules > 1) continue;
            NoisyStore again;
            add(unenforced,
                shared_sides(refined, MeshBasis(refined, &again, {.enforced = false}), true));
            add(unordered, shared_sides(refined, basis, false));
        }
    EXPECT_GT(all.tangents, all.positions / 2); // all but those at infinitely sharp edges
    for (Shared const& s : {unenforced, unordered}) {
        EXPECT_GT(s.positions_differ, s.positions / 2);
        EXPECT_GT(s.tangents_differ, s.tangents / 2);
    }
}

} // namespace
} // namespace tessemu
