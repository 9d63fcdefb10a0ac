// Surfaces over subdivided meshes are closed as those over the file's own are.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/pipeline/displaced.h"
#include "tests/support/edges.h"
#include "tests/support/random_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace tessemu {
namespace {

struct Case {
    std::string name;
    ControlMesh mesh;
};

std::vector<Case> cases()
{
    std::vector<Case> out;
    for (char const* model : {"golem", "jug", "saddle_star", "spindle"})
        out.push_back({model, load_model(model).mesh});
    out.push_back({"prism", test::prism(5)});
    out.push_back({"joined jug", test::join_faces(load_model("jug").mesh, 1)});
    out.push_back({"joined random", test::join_faces(test::random_mesh(7), 7)});
    return out;
}

void expect_equal_bits(SchemeOnMesh const& m, FrameSettings s, std::size_t inner_edges)
{
    for (Machine const& machine : test::contraction_policies(5)) {
        s.machine = machine;
        SCOPED_TRACE("contraction " + std::to_string(int(machine.contraction)) + ", seed " +
                     std::to_string(machine.seed));
        test::EdgeComparison const c = test::compare_edges(*m.patches, s, ThreadPool());
        ASSERT_GE(c.shared_points, 4 * inner_edges); // at a tess factor above 4
        ASSERT_EQ(c.lonely_points, 0u);
        ASSERT_EQ(c.differing_positions, 0u) << c.first_difference;
        ASSERT_EQ(c.differing_normals, 0u) << c.first_difference;
    }
}

// work(what, scheme on mesh) for every scheme that draws the mesh after 1 and 2 steps.
template <class Work> void for_each_refined(Work&& work)
{
    for (Case const& c : cases())
        for (int steps : {1, 2})
            for (char const* scheme : {"gregory-stencil", "gregory-two-stage", "acc"}) {
                ControlMesh mesh = c.mesh;
                test::add_charts(mesh);
                SchemeOnMesh const m =
                    build_scheme(find_scheme(scheme), std::move(mesh), {.subdivide = steps});
                SCOPED_TRACE(c.name + ", " + scheme + ", subdivided " + std::to_string(steps));
                MeshSummary const summary = summarize(m.mesh->topology());
                work(m, summary.edges - summary.boundary_edges);
                if (testing::Test::HasFatalFailure()) return;
            }
}

TEST(RefinedSurface, SharedEdgesHaveEqualBitsUnderEveryContraction)
{
    for_each_refined([](SchemeOnMesh const& m, std::size_t inner_edges) {
        FrameSettings s;
        s.tess_factor = 4.3f;
        expect_equal_bits(m, s, inner_edges);
    });
}

// Every edge of the file's mesh is a seam; those that the steps make are not.
TEST(RefinedSurface, StaysClosedDisplacedByAnImage)
{
    HeightImage const image = test::noise(1024);
    for_each_refined([&](SchemeOnMesh const& m, std::size_t inner_edges) {
        FrameSettings s;
        s.tess_factor = 4.3f;
        s.displacement = std::make_shared<Displacement>(m.mesh, image, 0.05f);
        expect_equal_bits(m, s, inner_edges);
    });
}

// Own coordinates are continuous inside a face: a patch's child lies where its face's chart has it.
TEST(RefinedSurface, CoordinatesAreTheFacesOwnWhateverItsPatches)
{
    for (char const* model : {"golem", "jug"}) {
        ControlMesh mesh = load_model(model).mesh;
        test::add_charts(mesh);
        for (int steps : {0, 1, 3}) {
            SchemeOnMesh const m =
                build_scheme(find_scheme("gregory-stencil"), mesh, {.subdivide = steps});
            FrameSettings s;
            s.tess_factor = 2;
            s.partitioning = Partitioning::Integer;
            s.displacement = std::make_shared<Displacement>(m.mesh, test::noise(16), 0.05f);
            std::size_t points = 0;
            visit_surface(*m.patches, s, ThreadPool(1), [&](SurfacePatch const& p) {
                PatchPlace const& place = p.place();
                HalfEdge const first = mesh.face_start[place.face];
                std::size_t const n = mesh.face(place.face).size();
                if (n != 4) return;
                auto const corner = [&](HalfEdge k) {
                    glm::dvec2 const c = mesh.coordinates[mesh.face_coordinates[first + k]];
                    return glm::dvec2(16 * c.x - 0.5, 16 * (1 - c.y) - 0.5); // in texels
                };
                for (std::size_t i = 0; i < p.points(); ++i) {
                    UnitPoint const at = domain_to_unit(place, p.domain().u[i], p.domain().v[i]);
                    double const u = double(at.u), v = double(at.v);
                    glm::dvec2 const expected = (1 - v) * ((1 - u) * corner(0) + u * corner(1)) +
                                                v * ((1 - u) * corner(3) + u * corner(2));
                    glm::dvec2 const is(p.vertex(i).coordinates);
                    // Of places a period apart either will do. Parts are below 64; corners, six
                    // products and four sums round, each by half an ulp of 32 to 64.
                    for (int k = 0; k < 2; ++k)
                        ASSERT_NEAR(std::remainder(is[k] - expected[k], 16), 0, 11 * 0x1p-19);
                    ++points;
                }
            });
            EXPECT_GT(points, 500u);
        }
    }
}

// A step of Catmull-Clark keeps the limit surface, so patches of a finer mesh lie closer to that of
// the coarse one: the deviation from the finest falls from step to step.
TEST(RefinedSurface, ApproachesALimitAsTheMeshIsSubdivided)
{
    ControlMesh const mesh = load_model("golem").mesh;
    using Surface = std::map<MeshPoint, glm::vec3>;
    auto const surface = [&](int steps) {
        SchemeOnMesh const m =
            build_scheme(find_scheme("gregory-stencil"), mesh, {.subdivide = steps});
        FrameSettings s;
        s.partitioning = Partitioning::Integer;
        s.tess_factor = float(16 >> steps);
        Surface out;
        visit_surface(*m.patches, s, ThreadPool(), [&](SurfacePatch const& p) {
            TessellatedPatch const& t = p.domain().patch;
            for (std::size_t i = 0; i < p.points(); ++i)
                out[mesh_point(mesh, p.place(), t.u[i], t.v[i])] = p.vertex(i).position;
        });
        return out;
    };
    Surface const finest = surface(4);
    double before = 1;
    for (int steps : {0, 1, 2, 3}) {
        Surface const now = surface(steps);
        ASSERT_EQ(now.size(), finest.size());
        double sum = 0;
        for (auto const& [name, p] : now) {
            auto const other = finest.find(name);
            ASSERT_NE(other, finest.end()) << in_words(name);
            glm::vec3 const d = p - other->second;
            sum += double(d.x * d.x + d.y * d.y + d.z * d.z);
        }
        double const rms = std::sqrt(sum / double(now.size()));
        EXPECT_LT(rms, before / 2) << steps;
        before = rms;
    }
}

} // namespace
} // namespace tessemu
