// Biermann's rules: steps against golden data, the eigenvectors that they are made for, limits,
// flatness, the kernels' tables, and which sectors are concave.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/biermann.h"

#include "pipeline/commands/subdivision.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/limit.h"
#include "pipeline/mesh/sort_by_valence.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/gzip.h"
#include "tests/support/point_sets.h"
#include "tests/support/random_mesh.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <glm/geometric.hpp>

#include <random>

namespace tessemu {
namespace {

using Vec = glm::dvec3;
using Words = std::vector<std::uint32_t>;

nlohmann::json const& golden()
{
    static nlohmann::json const data =
        nlohmann::json::parse(test::read_gzip(test::golden("subdivision/blz_refine.json.gz")));
    return data.at("cases");
}

// The angle of a corner is that of its convex or concave sector; the flag is set by hand.
ControlMesh mesh_of(nlohmann::json const& g)
{
    ControlMesh m;
    for (auto const& p : g["verts"]) m.positions.emplace_back(p[0], p[1], p[2]);
    for (auto const& f : g["faces"]) m.add_face(f.get<Words>());
    for (auto const& c : g["creases"]) m.creases.push_back({c[0], c[1], kInfinitelySharp});
    m.rules.sectors = SectorRules::Biermann;
    m.rules.flatness = 0;
    Topology const topology(m);
    for (auto const& [vertex, angle] : g["corner"].items()) {
        auto const v = std::uint32_t(std::stoul(vertex));
        m.corners.push_back({v, kInfinitelySharp});
        if (angle.get<double>() > 3) m.concave.push_back(topology.ring(v)[0]);
    }
    return m;
}

// Data of magnitude about 1, means of up to 25 points: the golden data's own 1e-12.
TEST(BiermannRules, StepsAgreeWithGoldenDataInDouble)
{
    for (auto const& g : golden()) {
        SCOPED_TRACE(g["name"].get<std::string>());
        ControlMesh mesh = mesh_of(g);
        std::vector<Vec> x;
        for (auto const& p : g["verts"]) x.emplace_back(p[0], p[1], p[2]);
        for (char const* level : {"level1_verts", "level2_verts"}) {
            Topology const topology(mesh);
            Sharpness const sharpness(topology);
            x = refined_points<CatmullClark, Vec>(topology, sharpness, x);
            EXPECT_LE(test::worst_distance(x, g[level]), 1e-12) << level;
            ControlMesh fine = split_mesh(topology, sharpness, x, false);
            EXPECT_EQ(fine.concave.size(), mesh.concave.size());
            mesh = std::move(fine);
        }
    }
    EXPECT_EQ(golden().size(), 11u);
}

// A ring with something sharp in it, by name.
struct Case {
    std::string name;
    RingSharpness sharp;
    std::size_t faces;
};

std::vector<Case> cases()
{
    std::vector<Case> out;
    auto const ring = [](std::size_t n, bool open) {
        RingSharpness r;
        r.biermann = true;
        r.open = open;
        r.edge.assign(open ? n + 1 : n, 0);
        if (open) r.edge.front() = r.edge.back() = kInfinitelySharp;
        return r;
    };
    auto const add = [&](std::string const& kind, std::size_t n, RingSharpness const& r) {
        out.push_back({kind + " of " + std::to_string(n), r, n});
    };
    for (std::size_t n = 1; n <= 12; ++n) {
        RingSharpness r = ring(n, true);
        add("boundary", n, r);
        r.vertex = kInfinitelySharp;
        add("convex corner", n, r);
        r.concave = {0};
        if (n > 1) add("concave corner", n, r);
        if (n < 3) continue;
        r = ring(n, false);
        r.vertex = kInfinitelySharp;
        add("tip", n, r);
        r.edge[n / 2] = kInfinitelySharp;
        add("tip of a crease", n, r);
        r.vertex = 0;
        add("dart", n, r);
        r.edge[0] = kInfinitelySharp;
        add("crease", n, r);
    }
    return out;
}

template <class X> Ring<X> ring_of(Case const& c, X const& zero)
{
    return {zero, std::vector<X>(c.sharp.edge.size(), zero), std::vector<X>(c.faces, zero)};
}

// What the rules are for: cos(j theta) and sin(j theta) on edges, 2 cos(theta/2) times those of
// (j + 1/2) theta on faces, are halved by a step. Five sums of values below 2: 8 units of 2^-52.
TEST(BiermannRules, AnyTaggedSectorHasOneHalfTwice)
{
    std::size_t sectors = 0;
    for (Case const& c : cases()) {
        SCOPED_TRACE(c.name);
        for (RingSector const& s : c.sharp.sectors()) {
            bool const is_curve = !s.closed && c.sharp.rule() == VertexRule::Crease;
            for (int quarter : {0, 1}) {
                Ring<double> ring = ring_of(c, 0.0);
                auto const sine = [&](std::size_t halves) {
                    return sin_pi(int(halves) * s.turn + quarter * s.of, 2 * s.of);
                };
                double const on_face = 2 * cos_pi(s.turn, 2 * s.of);
                std::size_t const e = ring.edge.size();
                for (std::size_t k = 0; k <= s.faces; ++k)
                    if (!s.closed || k < s.faces) ring.edge[(s.first + k) % e] = sine(2 * k);
                for (std::size_t k = 0; k < s.faces; ++k)
                    ring.face[(s.first + k) % c.faces] = on_face * sine(2 * k + 1);
                Ring<double> const after = refined_ring<CatmullClark>(ring, c.sharp);
                if (is_curve || c.sharp.rule() == VertexRule::Dart) {
                    EXPECT_NEAR(after.vertex, 0, 8 * 0x1p-52);
                }
                for (std::size_t k = 0; k <= s.faces; ++k) {
                    std::size_t const j = (s.first + k) % e;
                    EXPECT_NEAR(after.edge[j], ring.edge[j] / 2, 8 * 0x1p-52)
                        << quarter << " " << k;
                }
                for (std::size_t k = 0; k < s.faces; ++k) {
                    std::size_t const j = (s.first + k) % c.faces;
                    EXPECT_NEAR(after.face[j], ring.face[j] / 2, 8 * 0x1p-52)
                        << quarter << " " << k;
                }
            }
            ++sectors;
        }
    }
    EXPECT_EQ(sectors, 85u);
}

Vec random_point(std::mt19937& random)
{
    auto const c = [&] { return double(random() % 1024) / 512 - 1; };
    double const x = c(), y = c();
    return {x, y, c()};
}

Ring<Vec> random_ring(Case const& c, std::mt19937& random)
{
    Ring<Vec> ring = ring_of(c, Vec(0));
    for (std::size_t i = 0; i < 1 + ring.edge.size() + ring.face.size(); ++i)
        ring.point(i) = random_point(random);
    return ring;
}

// Masks do not see steps, but that each halves the tangents; nor do they see flatness. Weights of a
// mask add up to some 40 in absolute value, and a mask of a dart is found by iteration, to 2^-48.
// A sector of one face on a crease has no second tangent of its own.
TEST(BiermannRules, MasksAreLeftEigenvectorsFlattenedOrNot)
{
    std::mt19937 random(3);
    std::size_t tangents = 0;
    for (Case c : cases())
        for (std::optional<double> flatness : {std::optional<double>(), std::optional(0.0),
                                               std::optional(0.375), std::optional(1.0)}) {
            SCOPED_TRACE(c.name + " with flatness " + std::to_string(flatness.value_or(-1)));
            c.sharp.flatness = flatness;
            Ring<Vec> const ring = random_ring(c, random);
            Limits<CatmullClark> limits;
            auto const before = limits.of(ring, c.sharp),
                       after = limits.of(refined_ring<CatmullClark>(ring, c.sharp), c.sharp);
            EXPECT_LE(glm::length(after.position - before.position), 1e-12);
            ASSERT_EQ(after.sides.size(), before.sides.size());
            for (std::size_t i = 0; i < after.sides.size(); ++i)
                for (int t : {0, 1}) {
                    if (before.sides[i].faces == 1 && c.sharp.rule() == VertexRule::Crease)
                        continue;
                    Vec const half = before.sides[i].tangents[t] / 2.0;
                    EXPECT_LE(glm::length(after.sides[i].tangents[t] - half), 1e-11) << i << t;
                    ++tangents;
                }
        }
    EXPECT_GT(tangents, 400u);
}

// A ring that is flattened all the way is flat: its points are those that its masks give.
TEST(BiermannRules, AFlatnessOfOneFlattensInOneStep)
{
    std::mt19937 random(5);
    std::size_t flat = 0;
    for (Case c : cases()) {
        SCOPED_TRACE(c.name);
        c.sharp.flatness = 1;
        if (!is_flattened(c.sharp, c.faces)) continue;
        Ring<Vec> const ring = refined_ring<CatmullClark>(random_ring(c, random), c.sharp);
        auto const limit = Limits<CatmullClark>().of(ring, c.sharp);
        for (std::size_t i = 0; i < limit.sides.size(); ++i) {
            auto const& side = limit.sides[i];
            if (side.faces == 1 && c.sharp.rule() == VertexRule::Crease) continue;
            Vec const n = glm::normalize(cross(side.tangents[0], side.tangents[1]));
            for (std::size_t k = 0; k < side.faces; ++k) {
                std::size_t const j = side.first_face + k;
                EXPECT_LE(std::abs(dot(n, ring.edge[j % ring.edge.size()] - limit.position)), 1e-9);
                EXPECT_LE(std::abs(dot(n, ring.face[j % c.faces] - limit.position)), 1e-9);
                ++flat;
            }
        }
    }
    EXPECT_GT(flat, 300u);
}

// Explicit steps against the masks. Of up to 3 faces the second eigenvalue is at most 0.4521 (of a
// convex corner's sine mode, [[gamma + c/8, h/8], [h/2, 1/4]] with c = cos(pi/3)): ten steps leave
// 4e-4 of a ring of size 2 for the position, thirty (0.4521/0.5)^30 = 0.05 for the plane. A tip is
// a cone: its ring has no plane to tend to.
TEST(BiermannRules, StepsTendToTheLimitOfTheMasks)
{
    std::mt19937 random(11);
    for (Case const& c : cases()) {
        if (c.faces > 3 || (c.faces == 1 && c.sharp.rule() == VertexRule::Crease)) continue;
        SCOPED_TRACE(c.name);
        Ring<Vec> ring = random_ring(c, random);
        auto const limit = Limits<CatmullClark>().of(ring, c.sharp);
        for (std::size_t i = 0; i < 1 + ring.edge.size() + c.faces; ++i)
            ring.point(i) -= limit.position; // to keep digits
        for (int step = 0; step < 10; ++step) ring = refined_ring<CatmullClark>(ring, c.sharp);
        EXPECT_LE(glm::length(ring.vertex), 2e-3);
        for (int step = 10; step < 30; ++step) ring = refined_ring<CatmullClark>(ring, c.sharp);
        bool const is_cone = limit.rule == VertexRule::Corner && c.sharp.sectors().front().closed;
        for (auto const& side : limit.sides) {
            if (is_cone || (side.faces == 1 && limit.rule == VertexRule::Crease)) continue;
            Vec const n = glm::normalize(cross(side.tangents[0], side.tangents[1]));
            for (std::size_t k = 0; k < side.faces; ++k) {
                Vec const d = ring.face[(side.first_face + k) % c.faces] - ring.vertex;
                EXPECT_LE(std::abs(dot(n, glm::normalize(d))), 0.05) << k;
            }
        }
    }
}

// With the default flatness a concave sector's ring tends to the plane of its sharp edges, by
// (1/4)/(1/2) a step; without, the sine mode wins, whose eigenvalue is above 1/2, and the ring
// leaves that plane.
TEST(BiermannRules, AConcaveSectorIsFlatOnlyWithFlatness)
{
    std::mt19937 random(13);
    for (Case c : cases()) {
        if (c.sharp.concave.empty()) continue;
        SCOPED_TRACE(c.name);
        Ring<Vec> const start = random_ring(c, random);
        for (bool is_flat : {true, false}) {
            c.sharp.flatness = is_flat ? std::optional<double>() : std::optional(0.0);
            Ring<Vec> ring = start;
            for (std::size_t i = 0; i < 1 + ring.edge.size() + c.faces; ++i)
                ring.point(i) -= start.vertex;
            for (int step = 0; step < 40; ++step) ring = refined_ring<CatmullClark>(ring, c.sharp);
            Vec const n = glm::normalize(cross(ring.edge.front(), ring.edge.back()));
            double const off = std::abs(dot(n, glm::normalize(ring.face[c.faces / 2])));
            // With up to 4 faces (0.547/0.5)^40 = 36: nearly a direction at random. With more it is
            // on its way.
            if (is_flat) {
                EXPECT_LE(off, 1e-9);
            } else {
                EXPECT_GE(off, c.faces <= 4 ? 0.1 : 1e-3);
            }
        }
    }
}

TEST(BiermannRules, TheLargestEigenvaluesOfConcaveSectorsAreTheKnownOnes)
{
    EXPECT_NEAR(CatmullClark::concave_eigenvalue(2), 0.633, 5e-4);
    EXPECT_NEAR(CatmullClark::concave_eigenvalue(3), 0.580, 5e-4);
    EXPECT_NEAR(CatmullClark::concave_eigenvalue(4), 0.547, 5e-4);
}

// Tags that Biermann's rules know, concave sectors by the cage's angles.
ControlMesh tagged(ControlMesh mesh, std::uint32_t seed, std::optional<double> flatness)
{
    mesh = test::with_random_tags(std::move(mesh), seed);
    auto const harden = [](float& s) { s = s > 2 ? kInfinitelySharp : 0; };
    for (auto& c : mesh.creases) harden(c.sharpness);
    for (auto& c : mesh.corners) harden(c.sharpness);
    mesh.rules.sectors = SectorRules::Biermann;
    mesh.rules.flatness = flatness;
    check_sharpness_for_biermann(mesh);
    mark_concave_sectors(mesh);
    return mesh;
}

std::vector<std::pair<std::string, ControlMesh>> cages()
{
    std::vector<std::pair<std::string, ControlMesh>> out;
    for (std::uint32_t seed = 0; seed < 12; ++seed) {
        std::optional<double> const flatness[] = {{}, 0.0, 0.5, 1.0};
        ControlMesh m = test::random_mesh(seed);
        if (seed % 2) m = test::join_faces(m, seed);
        out.emplace_back("cage " + std::to_string(seed), tagged(m, seed, flatness[seed % 4]));
    }
    return out;
}

// A ring's step is what a mesh's step does to it, where no neighbour is flattened.
TEST(BiermannRules, ARingIsRefinedAsItsMeshIs)
{
    std::size_t compared = 0, flattened = 0;
    for (auto const& [name, cage] : cages()) {
        SCOPED_TRACE(name);
        // The second step: of quads, old vertices apart.
        Topology const first(cage);
        std::vector<Vec> x(cage.positions.begin(), cage.positions.end());
        x = refined_points<CatmullClark, Vec>(first, Sharpness(first), x);
        ControlMesh const mesh = split_mesh(first, Sharpness(first), x, false);
        Topology const topology(mesh);
        Sharpness const sharpness(topology);
        std::vector<Vec> const next = refined_points<CatmullClark, Vec>(topology, sharpness, x);
        EdgeNumbers const edges(topology);
        std::size_t const first_vertex = mesh.faces() + edges.size();
        RingSharpness sharp;
        auto const is_flat = [&](std::uint32_t v) {
            sharpness.around(v, sharp);
            return is_flattened(sharp, topology.ring(v).size());
        };
        for (std::uint32_t v = 0; v < x.size(); ++v) {
            auto const faces = topology.ring(v);
            bool is_near = false;
            for (HalfEdge h : faces)
                for (std::uint32_t w : mesh.face(topology.face_of(h)))
                    is_near = is_near || (w != v && is_flat(w));
            if (faces.empty() || is_near) continue;
            flattened += is_flat(v);
            sharpness.around(v, sharp);
            Ring<Vec> ring{x[v], {}, {}};
            for (HalfEdge h : faces) {
                ring.edge.push_back(x[topology.vertex_of(topology.next(h))]);
                ring.face.push_back(x[topology.vertex_of(topology.next(topology.next(h)))]);
            }
            if (topology.is_boundary(v))
                ring.edge.push_back(x[topology.vertex_of(topology.previous(faces.back()))]);
            Ring<Vec> const fine = refined_ring<CatmullClark>(ring, sharp);
            double reach = glm::length(x[v]);
            for (Vec const& p : ring.edge) reach = std::max(reach, glm::length(p));
            for (Vec const& p : ring.face) reach = std::max(reach, glm::length(p));
            double const bound = 1e-13 * reach; // sums of up to 25 points, masks of up to 1e-15
            EXPECT_LE(glm::length(fine.vertex - next[first_vertex + v]), bound) << v;
            for (std::size_t j = 0; j < faces.size(); ++j) {
                EXPECT_LE(glm::length(fine.edge[j] - next[mesh.faces() + edges[faces[j]]]), bound)
                    << v << " " << j;
                EXPECT_LE(glm::length(fine.face[j] - next[topology.face_of(faces[j])]), bound)
                    << v << " " << j;
            }
            ++compared;
        }
    }
    EXPECT_GT(compared, 1000u);
    EXPECT_GT(flattened, 50u);
}

// A blended row of m terms whose weights sum to W in absolute value rounds each weight, product and
// sum: 3 m u W M with u = 2^-24 and M the largest coordinate that it reads, and multiplies the
// errors that it reads by W. Other points: (2 n + 4) u M (subdivision_test.cpp).
TEST(BiermannRules, KernelsAgreeWithTheMasksWithinRounding)
{
    std::size_t blended_faces = 0;
    for (auto const& [name, mesh] : cages()) {
        SCOPED_TRACE(name);
        std::vector<Vec> x(mesh.positions.begin(), mesh.positions.end());
        ControlMesh coarse = mesh;
        double bound = 0;
        for (int steps = 1; steps <= 3; ++steps) {
            double most = 0, n = 4;
            for (Vec const& p : x)
                for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(p[k]));
            for (std::size_t f = 0; f < coarse.faces(); ++f)
                n = std::max(n, double(coarse.face(f).size()));
            Topology const topology(coarse);
            for (std::uint32_t v = 0; v < coarse.positions.size(); ++v)
                n = std::max(n, double(topology.valence(v)));
            Sharpness const sharpness(topology);
            x = refined_points<CatmullClark, Vec>(topology, sharpness, x);
            ControlMesh next = split_mesh(topology, sharpness, x, false);
            RefinedMesh const m(mesh, steps, catmull_clark_step);
            SubdivisionTables const& t = m.tables().back();
            std::vector<char> is_target(t.buffer_size());
            for (std::uint32_t p : t.blended.target) is_target[p] = 1;
            double const of_kernels = bound + (2 * n + 4) * 0x1p-24 * most;
            double worst_row = of_kernels;
            for (std::size_t r = 0; r < t.blended.target.size(); ++r) {
                blended_faces += t.blended.target[r] < t.first_edge_point();
                double absolute = 0, sum = 0;
                for (std::size_t i = t.blended.first[r]; i < t.blended.first[r + 1]; ++i) {
                    absolute += std::abs(double(t.blended.weights[i]));
                    sum += double(t.blended.weights[i]);
                    EXPECT_FALSE(is_target[t.blended.points[i]]) << "read and written";
                    EXPECT_LT(t.blended.points[i], t.first_edge_point());
                }
                double const terms = t.blended.first[r + 1] - t.blended.first[r];
                EXPECT_NEAR(sum, 1, terms * absolute * 0x1p-24);
                worst_row = std::max(worst_row,
                                     absolute * of_kernels + 3 * terms * absolute * 0x1p-24 * most);
            }
            bound = worst_row;
            std::vector<glm::vec3> const drawn = drawn_mesh(m, {}, ThreadPool(1)).mesh.positions;
            ASSERT_EQ(drawn.size(), x.size());
            double worst = 0;
            for (std::size_t v = 0; v < x.size(); ++v)
                for (int k = 0; k < 3; ++k)
                    worst = std::max(worst, std::abs(double(drawn[v][k]) - x[v][k]));
            EXPECT_LE(worst, bound) << steps;
            EXPECT_LE(bound, 2e-2 * most) << "or the bound says nothing";
            coarse = std::move(next);
        }
    }
    EXPECT_GT(blended_faces, 100u);
}

// A square of four faces without one, turned by an angle: its inner corner has three.
ControlMesh notched(double angle, bool is_sharp = true)
{
    ControlMesh m;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
            m.positions.emplace_back(float(std::cos(angle) * x - std::sin(angle) * y),
                                     float(std::sin(angle) * x + std::cos(angle) * y), 0.25f);
    for (Words const& f : {Words{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}}) m.add_face(f);
    if (is_sharp) m.corners.push_back({4, kInfinitelySharp});
    m.rules.sectors = SectorRules::Biermann;
    return m;
}

TEST(ConcaveSectors, AreThoseWhoseAnglesSumToMoreThanPi)
{
    for (double angle : {0.0, 0.1, 0.7, 1.3, 2.9}) {
        ControlMesh m = notched(angle);
        Topology const topology(m);
        ConcaveSectors const found = mark_concave_sectors(m);
        EXPECT_EQ(found.several_faces, 1u);
        EXPECT_EQ(found.one_face, 0u);
        EXPECT_EQ(m.concave, Words{topology.ring(4)[0]});
        m = notched(angle, false); // a crease, not a corner
        mark_concave_sectors(m);
        EXPECT_TRUE(m.concave.empty());
        // Half a circle is convex, whatever roundings say: vertices 1 and 3 have two square faces.
        m = notched(angle);
        m.corners = {{1, kInfinitelySharp}, {3, kInfinitelySharp}};
        mark_concave_sectors(m);
        EXPECT_TRUE(m.concave.empty());
    }
}

// Sectors of one vertex apart: a full ring cut by two creases, three faces on one side.
TEST(ConcaveSectors, AreFoundOnOneSideOfACrease)
{
    ControlMesh m = notched(0.3);
    m.add_face(Words{4, 5, 8, 7});
    m.creases = {{4, 5, kInfinitelySharp}, {4, 7, kInfinitelySharp}};
    Topology const topology(m);
    mark_concave_sectors(m);
    ASSERT_EQ(m.concave.size(), 1u);
    EXPECT_EQ(topology.vertex_of(m.concave[0]), 4u);
    EXPECT_EQ(topology.vertex_of(topology.next(m.concave[0])), 7u)
        << "counter-clockwise from this edge";
}

TEST(ConcaveSectors, OfOneFaceAreTakenAsConvexAndTold)
{
    ControlMesh arrow;
    arrow.positions = {{0, 0, 0}, {2, -1, 0}, {0, 2, 0}, {-2, -1, 0}};
    arrow.add_face(Words{0, 1, 2, 3});
    arrow.rules.sectors = SectorRules::Biermann;
    arrow.file_vertices = {6, 7, 8, 9};
    ConcaveSectors const found = mark_concave_sectors(arrow);
    EXPECT_EQ(found.one_face, 1u);
    EXPECT_TRUE(arrow.concave.empty());
    auto const words = in_words(found, arrow);
    ASSERT_EQ(words.size(), 1u);
    EXPECT_NE(words[0].find("vertex 7 of face 1"), std::string::npos) << words[0];
    EXPECT_NE(words[0].find("convex"), std::string::npos) << words[0];
    EXPECT_TRUE(in_words(ConcaveSectors{}, arrow).empty());
}

// The corner after a step is of the same vertex and sector; a sort renames it.
TEST(ConcaveSectors, AreCarriedThroughStepsAndSorts)
{
    ControlMesh m = notched(0.3);
    mark_concave_sectors(m);
    RefinedStep const step = catmull_clark_step(Topology(m));
    RefinedStep const second = catmull_clark_step(Topology(step.mesh));
    for (ControlMesh const* fine : {&step.mesh, &second.mesh}) {
        Topology const topology(*fine);
        ASSERT_EQ(fine->concave.size(), 1u);
        std::uint32_t const v = topology.vertex_of(fine->concave[0]);
        EXPECT_EQ(fine->positions[v], m.positions[4]);
        EXPECT_EQ(topology.ring_index(fine->concave[0]), 0u) << "begins at the boundary";
        ControlMesh marked = *fine;
        mark_concave_sectors(marked);
        EXPECT_EQ(marked.concave, fine->concave);
    }
    for (auto const& [name, cage] : cages()) {
        ControlMesh const sorted = sort_by_valence(cage, catmull_clark_step(Topology(cage)).tables);
        ControlMesh marked = sorted;
        mark_concave_sectors(marked);
        EXPECT_EQ(sorted.concave, marked.concave) << name;
    }
}

TEST(BiermannRules, KnowNoFiniteSharpnessAndSayWhere)
{
    auto const error_of = [](ControlMesh const& m) -> std::string {
        try {
            check_sharpness_for_biermann(m);
        } catch (MeshError const& e) {
            EXPECT_LT(e.face, m.faces());
            return e.what();
        }
        return {};
    };
    ControlMesh m = test::prism(4);
    m.creases = {{0, 1, kInfinitelySharp}};
    EXPECT_EQ(error_of(m), "");
    m.creases.push_back({1, 2, 2.5f});
    std::string error = error_of(m);
    for (char const* part : {"edge 2-3", "2.5", "rules=opensubdiv", "face "})
        EXPECT_NE(error.find(part), std::string::npos) << error;
    m.creases.pop_back();
    m.corners = {{5, 0.5f}};
    error = error_of(m);
    for (char const* part : {"vertex 6", "0.5", "rules=opensubdiv"})
        EXPECT_NE(error.find(part), std::string::npos) << error;
    m = notched(0); // sharp as any boundary
    m.creases = {{0, 1, 1.5f}};
    EXPECT_EQ(error_of(m), "");
}

class RuledScheme : public Scheme {
public:
    SchemeInfo info() const override
    {
        SchemeInfo out;
        out.name = "ruled";
        out.takes.steps = 1;
        out.parameters = {{"flatness", "", 0.25, 0, 1}};
        return out;
    }
    void set_rules(ControlMesh& mesh, Parameters const& parameters,
                   WarningSink const& warn) const override
    {
        check_sharpness_for_biermann(mesh);
        mesh.rules.sectors = SectorRules::Biermann;
        mesh.rules.flatness = parameters.number("flatness");
        mark_concave_sectors(mesh);
        warn("a warning");
    }
    std::unique_ptr<PatchMesh> build(std::shared_ptr<RefinedMesh const>, Parameters const&,
                                     BuildServices const&) const override
    {
        return nullptr;
    }
};

TEST(Schemes, MaySetTheRulesOfSubdivision)
{
    ControlMesh m = notched(0.3);
    m.positions.pop_back(); // of no face
    m.rules = {};
    std::vector<std::string> heard;
    BuildOptions options;
    options.warn = [&](std::string const& w) { heard.push_back(w); };
    SchemeOnMesh const on = refine_for_scheme(RuledScheme(), m, options);
    EXPECT_EQ(heard, std::vector<std::string>{"a warning"});
    EXPECT_EQ(on.warnings, heard);
    EXPECT_EQ(on.mesh->base().rules.flatness, 0.25);
    EXPECT_EQ(on.mesh->mesh().rules, on.mesh->base().rules);
    EXPECT_EQ(on.mesh->base().concave.size(), 1u);
    EXPECT_EQ(on.mesh->mesh().concave.size(), 1u);
    EXPECT_FALSE(on.mesh->tables()[0].blended.target.empty());
    m.corners[0].sharpness = 3;
    EXPECT_THROW(refine_for_scheme(RuledScheme(), m, options), MeshError);
}

} // namespace
} // namespace tessemu
