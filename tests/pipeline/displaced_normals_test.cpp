// Normals of displaced surfaces: what they are where a formula says it, and that patches agree.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/displaced_normals.h"

#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/pipeline/displaced.h"
#include "tests/support/cages.h"
#include "tests/support/edges.h"
#include "tests/support/sanitized.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <map>

namespace tessemu {
namespace {

SchemeOnMesh on_charts(std::string const& model, Scheme const& scheme)
{
    ControlMesh mesh = load_model(model).mesh;
    test::add_charts(mesh);
    return test::build_watertight(scheme, std::move(mesh));
}

FrameSettings displaced_by(std::shared_ptr<Displacement const> map)
{
    FrameSettings s;
    s.tess_factor = 4.3f;
    s.displacement = std::move(map);
    return s;
}

// Without a slope nothing turns. (Far enough out a surface folds, that of Butterfly soon; so the map
// is not that high.)
TEST(DisplacedNormals, OfALevelMapAreTheSmoothSurfacesBitForBit)
{
    for (Scheme const* scheme : test::tessellated_schemes())
        for (std::string const& model : test::models_of(*scheme))
            for (float height : {0.0f, 0.75f}) {
                SchemeOnMesh const m = on_charts(model, *scheme);
                HeightImage const level{std::vector<float>(12, height), 4, 3};
                FrameSettings s =
                    displaced_by(std::make_shared<Displacement>(m.mesh, level, 1e-6f));
                s.true_normals = true;
                std::vector<glm::vec3> smooth;
                ListStatistics const plain =
                    visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
                        for (std::size_t i = 0; i < p.points(); ++i)
                            smooth.push_back(p.vertex(i).normal);
                    });
                std::size_t at = 0, differing = 0;
                ListStatistics const displaced = visit_displaced_surface(
                    *m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
                        for (std::size_t i = 0; i < p.points(); ++i)
                            differing += p.vertex(i).normal != smooth.at(at++);
                    });
                EXPECT_EQ(at, smooth.size());
                EXPECT_EQ(differing, 0u) << model << " " << scheme->info().name;
                EXPECT_EQ(displaced.total.stages, plain.total.stages);
            }
}

TEST(DisplacedNormals, PatchesAgreeBitForBitUnderEveryContraction)
{
    if (test::kSlow) GTEST_SKIP() << "with sanitizers Determinism draws every scheme so";
    HeightImage const image = test::noise(64);
    for (Scheme const* scheme : test::tessellated_schemes())
        for (std::string const& model : test::models_of(*scheme)) {
            SchemeOnMesh const m = on_charts(model, *scheme);
            std::shared_ptr<Displacement const> const maps[] = {
                std::make_shared<Displacement>(Displacement::studs(0.1f, 0.05f)),
                std::make_shared<Displacement>(m.mesh, image, 0.05f)};
            for (std::size_t map = 0; map < std::size(maps); ++map)
                for (Contraction contraction : {Contraction::None, Contraction::Mixed}) {
                    FrameSettings s = displaced_by(maps[map]);
                    s.machine.contraction = contraction;
                    s.machine.seed = 7;
                    if (test::kSlow && !test::meets_case(s.machine, map, std::size(maps))) continue;
                    std::map<MeshPoint, glm::vec3> seen;
                    std::size_t shared = 0;
                    visit_displaced_surface(
                        *m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
                            DomainPoints const& at = p.domain();
                            for (std::size_t i = 0; i < p.points(); ++i) {
                                glm::vec3 const n = p.vertex(i).normal;
                                MeshPoint const name = mesh_point(m.mesh->base(), p.place(),
                                                                  at.patch.u[i], at.patch.v[i]);
                                auto const [first, fresh] = seen.try_emplace(name, n);
                                shared += !fresh;
                                ASSERT_EQ(n, first->second) << in_words(name);
                                ASSERT_NEAR(glm::length(n), 1, 1e-6f);
                            }
                        });
                    EXPECT_GT(shared, 100u) << model << " " << scheme->info().name;
                }
        }
}

// Control points on z = c (x^2 + y^2) give the bicubic B-spline z = c (x^2 + y^2) + 2c/3, whose
// constant no normal sees, and a ramp is linear between its texels' centres: p = S + h N in closed
// form.
TEST(DisplacedNormals, OfABowlUnderARampAreTheCrossProductOfItsDifferences)
{
    constexpr std::uint32_t kFaces = 8;
    double const c = 1.0 / 16, scale = 0.5;
    ControlMesh mesh;
    for (std::uint32_t j = 0; j <= kFaces; ++j)
        for (std::uint32_t i = 0; i <= kFaces; ++i) {
            double const x = double(i) - 4, y = double(j) - 4;
            mesh.positions.emplace_back(float(x), float(y), float(c * (x * x + y * y)));
            mesh.coordinates.emplace_back(double(i) / kFaces, double(j) / kFaces);
        }
    for (std::uint32_t j = 0; j < kFaces; ++j)
        for (std::uint32_t i = 0; i < kFaces; ++i) {
            std::uint32_t const v = j * (kFaces + 1) + i;
            mesh.add_face(std::array<std::uint32_t, 4>{v, v + 1, v + kFaces + 2, v + kFaces + 1});
        }
    mesh.face_coordinates = mesh.face_vertices;
    HeightImage ramp{{}, 16, 16};
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) ramp.heights.push_back(float(x - 2 * y) / 16);
    auto const point = [&](double x, double y) { // S = (x, y, c (x^2 + y^2) + 2c/3)
        glm::dvec3 const n = glm::normalize(glm::dvec3(-2 * c * x, -2 * c * y, 1));
        double const column = (x + 4) / 8 * 16 - 0.5, row = (1 - (y + 4) / 8) * 16 - 0.5;
        return glm::dvec3(x, y, c * (x * x + y * y)) + scale * ((column - 2 * row) / 16) * n;
    };
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), mesh);
    FrameSettings const s =
        displaced_by(std::make_shared<Displacement>(m.mesh, ramp, float(scale), HeightWrap::Clamp));
    std::size_t checked = 0;
    visit_displaced_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
        std::uint32_t const i = p.place().face % kFaces, j = p.place().face / kFaces;
        if (i < 2 || j < 2 || i > 5 || j > 5) return; // not near the boundary
        for (std::size_t k = 0; k < p.points(); ++k) {
            SurfaceVertex const v = p.vertex(k);
            double const x = double(v.smooth.x), y = double(v.smooth.y), e = 0x1p-12;
            glm::dvec3 const expected = glm::normalize(
                glm::cross(point(x + e, y) - point(x - e, y), point(x, y + e) - point(x, y - e)));
            // Points are below 4 and patches 1 wide. A fit is off by 2^-21 4 at its nodes, and the
            // weights of a derivative at an end of the patch (degree 4: 43, for normals too, of
            // heights up to 2) take that to 43 2^-19 + 43 2 2^-21 of a tangent, twice over for two.
            double const bound = 2 * (43 * 0x1p-19 + 86 * 0x1p-21);
            ASSERT_LT(glm::distance(glm::dvec3(v.normal), expected), bound) << x << " " << y;
            ++checked;
        }
    });
    EXPECT_GT(checked, 400u);
}

// A dome whose uppermost row of vertices lies on one point: along it no tangent tells how the map
// changes.
TEST(DisplacedNormals, AtAPoleAreTheSmoothSurfaces)
{
    ControlMesh mesh;
    constexpr std::uint32_t kAround = 8, kUp = 3;
    for (std::uint32_t j = 0; j <= kUp; ++j)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            static float const c[] = {1, 0.7f, 0, -0.7f, -1, -0.7f, 0, 0.7f};
            float const r = 1 - float(j) / kUp;
            mesh.positions.emplace_back(r * c[i], r * c[(i + 6) % kAround], 1 - r * r);
        }
    for (std::uint32_t j = 0; j < kUp; ++j)
        for (std::uint32_t i = 0; i < kAround; ++i) {
            std::uint32_t const v = j * kAround, k = (i + 1) % kAround;
            mesh.add_face(
                std::array<std::uint32_t, 4>{v + i, v + k, v + kAround + k, v + kAround + i});
        }
    test::add_charts(mesh);
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), mesh);
    FrameSettings s = displaced_by(std::make_shared<Displacement>(m.mesh, test::noise(16), 0.1f));
    s.true_normals = true;
    std::vector<glm::vec3> smooth;
    visit_surface(*m.patches, s, ThreadPool(1), [&](SurfacePatch const& p) {
        for (std::size_t i = 0; i < p.points(); ++i) smooth.push_back(p.vertex(i).normal);
    });
    std::size_t at = 0, poles = 0, others = 0;
    visit_displaced_surface(*m.patches, s, ThreadPool(1), [&](SurfacePatch const& p) {
        for (std::size_t i = 0; i < p.points(); ++i, ++at) {
            SurfaceVertex const v = p.vertex(i);
            ASSERT_NEAR(glm::length(v.normal), 1, 1e-6f);
            if (v.smooth == glm::vec3(0, 0, 1)) {
                ++poles;
                ASSERT_EQ(v.normal, smooth.at(at));
            } else {
                others += v.normal != smooth.at(at);
            }
        }
    });
    EXPECT_GT(poles, kAround * 2);
    EXPECT_GT(others, 100u);
}

TEST(DisplacedNormals, NeedADisplacement)
{
    SchemeOnMesh const m = build_scheme(find_scheme("acc"), load_model("golem").mesh);
    EXPECT_THROW(visit_displaced_surface(*m.patches, FrameSettings(), ThreadPool(1), {}), Error);
}

} // namespace
} // namespace tessemu
