// Texture coordinates by the masks of positions, and surfaces that are displaced on them.
//
// SPDX-License-Identifier: Apache-2.0
#include "tests/pipeline/displaced.h"

#include "io/model.h"
#include "pipeline/mesh/butterfly.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/loop.h"
#include "pipeline/mesh/triangulate.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/edges.h"
#include "tests/support/machines.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace tessemu {
namespace {

struct Case {
    std::string name;
    RefinementStep step;
    ControlMesh mesh;
};

ControlMesh tagged_golem()
{
    ControlMesh mesh = load_model("golem").mesh;
    auto const face = mesh.face(3);
    mesh.creases.push_back({face[0], face[1], 2.5f});
    mesh.creases.push_back({face[1], face[2], kInfinitelySharp});
    mesh.corners.push_back({mesh.face(9)[0], 1.5f});
    return mesh;
}

std::vector<Case> cases()
{
    ControlMesh const golem = tagged_golem(), jug = load_model("jug").mesh,
                      triangles = triangulate(golem).mesh;
    return {{"Catmull-Clark", catmull_clark_step, golem},
            {"n-gons and a boundary", catmull_clark_step, jug},
            {"Loop", loop_step, triangles},
            {"Butterfly", butterfly_step, triangles}};
}

// One pair of coordinates for each vertex: x and y.
void map_flat(ControlMesh& mesh)
{
    mesh.coordinates.clear();
    for (glm::vec3 const& p : mesh.positions) mesh.coordinates.emplace_back(p.x, p.y);
    mesh.face_coordinates = mesh.face_vertices;
    mesh.rules.smooth_coordinates = true;
}

glm::dvec2 coordinates_at(ControlMesh const& mesh, HalfEdge h)
{
    return mesh.coordinates[mesh.face_coordinates[h]];
}

TEST(SmoothCoordinates, OfAMeshWithoutSeamsAreWhatPositionsWouldBe)
{
    for (auto& [name, step, mesh] : cases()) {
        SCOPED_TRACE(name);
        map_flat(mesh);
        float size = 0;
        for (glm::vec3 const& p : mesh.positions)
            size = std::max({size, std::abs(p.x), std::abs(p.y)});
        for (int steps : {1, 2}) {
            RefinedMesh const refined(mesh, steps, step);
            ControlMesh const& fine = refined.mesh();
            ASSERT_EQ(fine.face_coordinates.size(), fine.face_vertices.size());
            double worst = 0;
            for (HalfEdge h = 0; h < fine.face_vertices.size(); ++h) {
                glm::vec3 const& p = fine.positions[fine.face_vertices[h]];
                worst =
                    std::max(worst, glm::distance(coordinates_at(fine, h), glm::dvec2(p.x, p.y)));
            }
            // Positions round to single once a step, and masks add up to less than twice that.
            EXPECT_LT(worst, steps * 2 * size * 0x1p-24);
        }
    }
}

// A chart is refined as though it were a mesh of its own.
TEST(SmoothCoordinates, OfAChartAreThoseOfItsFacesAlone)
{
    for (auto& [name, step, mesh] : cases()) {
        SCOPED_TRACE(name);
        mesh.creases.clear(); // which the chart alone would have to name anew
        mesh.corners.clear();
        map_flat(mesh);
        // Faces above the middle have coordinates that are shifted.
        std::vector<char> is_above;
        float low = mesh.positions[0].z, high = low;
        for (glm::vec3 const& p : mesh.positions)
            low = std::min(low, p.z), high = std::max(high, p.z);
        std::size_t const vertices = mesh.coordinates.size();
        for (std::size_t v = 0; v < vertices; ++v)
            mesh.coordinates.push_back(mesh.coordinates[v] + glm::dvec2(100, 0));
        ControlMesh chart;
        std::vector<std::uint32_t> number(vertices, ~0u), face_vertices;
        for (std::uint32_t f = 0; f < mesh.faces(); ++f) {
            auto const face = mesh.face(f);
            float z = 0;
            for (std::uint32_t v : face) z += mesh.positions[v].z / float(face.size());
            is_above.push_back(z > (low + high) / 2);
            if (!is_above.back()) continue;
            face_vertices.clear();
            for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h) {
                std::uint32_t const v = mesh.face_vertices[h];
                mesh.face_coordinates[h] = v + std::uint32_t(vertices);
                if (number[v] == ~0u) {
                    number[v] = std::uint32_t(chart.positions.size());
                    glm::dvec2 const c = coordinates_at(mesh, h);
                    chart.positions.emplace_back(c.x, c.y, 0);
                }
                face_vertices.push_back(number[v]);
            }
            chart.add_face(face_vertices);
        }
        ASSERT_GT(chart.faces(), 10u);
        ASSERT_LT(chart.faces(), mesh.faces());
        RefinedMesh const whole(mesh, 2, step), part(chart, 2, step);
        std::uint32_t at = 0; // half-edge of the part
        double worst = 0;
        for (std::uint32_t f = 0; f < whole.mesh().faces(); ++f) {
            if (!is_above[whole.place(f).face]) continue;
            for (HalfEdge h = whole.mesh().face_start[f]; h < whole.mesh().face_start[f + 1]; ++h) {
                glm::vec3 const& p = part.mesh().positions[part.mesh().face_vertices[at++]];
                worst = std::max(
                    worst, glm::distance(coordinates_at(whole.mesh(), h), glm::dvec2(p.x, p.y)));
            }
        }
        EXPECT_EQ(at, part.mesh().face_vertices.size());
        EXPECT_LT(worst, 3 * 2 * 128 * 0x1p-24); // of numbers below 128, as above
    }
}

TEST(SmoothCoordinates, AreLinearUnlessAskedFor)
{
    ControlMesh mesh = tagged_golem();
    map_flat(mesh);
    RefinedMesh const smooth(mesh, 1, catmull_clark_step);
    mesh.rules.smooth_coordinates = false;
    RefinedMesh const linear(mesh, 1, catmull_clark_step);
    double most = 0;
    for (HalfEdge h = 0; h < linear.mesh().face_vertices.size(); ++h)
        most = std::max(most, glm::distance(coordinates_at(linear.mesh(), h),
                                            coordinates_at(smooth.mesh(), h)));
    EXPECT_GT(most, 0.01);
}

TEST(FacesByPlace, FindEachFaceHoweverItIsTurned)
{
    for (auto const& [name, step, mesh] : cases()) {
        SCOPED_TRACE(name);
        RefinedMesh const refined(mesh, 2, step);
        FacesByPlace const faces(refined);
        for (std::uint32_t f = 0; f < refined.mesh().faces(); ++f)
            for (int turns : {0, 1, 2}) {
                FacesByPlace::Found const found = faces(refined.place(f, turns));
                ASSERT_EQ(found.face, f);
                ASSERT_EQ(found.turns, turns);
            }
    }
}

SchemeOnMesh on_smooth_coordinates(std::string const& name, ControlMesh mesh, int subdivide)
{
    Scheme const& scheme = find_scheme(name);
    ParameterTexts set = scheme.info().watertight_with;
    set.emplace_back("coordinates", "smooth");
    return build_scheme(scheme, std::move(mesh), {.subdivide = subdivide, .set = std::move(set)});
}

// What a patch hands to its pixels is what the drawn mesh's corners have.
TEST(SmoothCoordinates, OfAPatchAreThoseOfItsFace)
{
    int const size = 64;
    for (std::string const scheme : {"gregory-stencil", "tables-loop", "tables-catmull-clark"}) {
        SCOPED_TRACE(scheme);
        ControlMesh mesh = load_model("golem").mesh;
        test::add_charts(mesh);
        SchemeOnMesh const m = on_smooth_coordinates(scheme, mesh, 1);
        FacesByPlace const faces(*m.mesh);
        ControlMesh const& fine = m.mesh->mesh();
        FrameSettings s;
        s.tess_factor = 2;
        s.partitioning = Partitioning::Integer;
        s.displacement = std::make_shared<Displacement>(m.mesh, test::noise(size), 0.1f);
        std::size_t corners = 0;
        visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
            auto const [face, turns] = faces(p.place());
            auto const n = std::uint32_t(fine.face(face).size());
            auto const at = p.domain();
            for (std::size_t i = 0; i < p.points(); ++i) {
                float const u = at.u[i], v = at.v[i];
                int corner = -1;
                if (n == 4 && (u == 0 || u == 1) && (v == 0 || v == 1))
                    corner = v == 0 ? int(u) : 3 - int(u);
                if (n == 3 && (u == 1 || v == 1 || u + v == 0))
                    corner = u == 1 ? 0 : v == 1 ? 1 : 2;
                if (corner < 0) continue;
                HalfEdge const h = fine.face_start[face] + std::uint32_t(corner + turns) % n;
                glm::dvec2 const c = coordinates_at(fine, h);
                auto const& shown = p.vertex(i).coordinates;
                // Whole numbers within the period.
                auto const off = [&](double have, double want) {
                    double const d = (have - want) / size;
                    return std::abs(d - std::round(d)) * size;
                };
                EXPECT_LT(off(shown.x, c.x * size - 0.5), 1e-4);
                EXPECT_LT(off(shown.y, (1 - c.y) * size - 0.5), 1e-4);
                ++corners;
            }
        });
        EXPECT_EQ(corners, fine.face_vertices.size());
    }
}

TEST(SmoothCoordinates, DisplaceClosedSurfaces)
{
    ThreadPool const threads;
    for (std::string const scheme : {"gregory-stencil", "tables-loop", "tables-catmull-clark",
                                     "tables-butterfly", "stam", "phong"})
        for (bool has_seams : {false, true}) {
            SCOPED_TRACE(scheme);
            ControlMesh mesh = load_model("golem").mesh;
            if (has_seams) {
                map_flat(mesh); // seams at every other face
                std::size_t const n = mesh.coordinates.size();
                for (std::size_t i = 0; i < n; ++i)
                    mesh.coordinates.push_back(0.7 * mesh.coordinates[i] + glm::dvec2(0.3, 0.1));
                for (std::uint32_t f = 0; f < mesh.faces(); f += 2)
                    for (HalfEdge h = mesh.face_start[f]; h < mesh.face_start[f + 1]; ++h)
                        mesh.face_coordinates[h] += std::uint32_t(n);
            } else {
                map_flat(mesh);
            }
            SchemeOnMesh const m = on_smooth_coordinates(scheme, std::move(mesh), 1);
            FrameSettings s;
            s.tess_factor = 7.3f;
            s.displacement = std::make_shared<Displacement>(m.mesh, test::noise(512), 0.05f);
            for (Machine const& machine : test::contraction_policies(4)) {
                s.machine = machine;
                test::EdgeComparison const c = test::compare_edges(*m.patches, s, threads);
                ASSERT_GT(c.shared_points, 100u);
                ASSERT_EQ(c.differing_positions, 0u) << c.first_difference;
            }
        }
}

TEST(SmoothCoordinates, AreRefusedWhereNothingMakesThem)
{
    auto const refused = [](std::string const& scheme, ControlMesh mesh, std::string const& why) {
        try {
            on_smooth_coordinates(scheme, std::move(mesh), 0);
            ADD_FAILURE() << why;
        } catch (Error const& e) {
            EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
        }
    };
    ControlMesh mesh = load_model("golem").mesh;
    map_flat(mesh);
    refused("gregory-stencil", mesh, "no step of subdivision is taken");
    refused("tables-catmull-clark", load_model("spindle").mesh, "has no texture coordinates");
}

} // namespace
} // namespace tessemu
