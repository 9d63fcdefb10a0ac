// Names of points and lines against the refined mesh's own vertices and edges.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/patch_place.h"

#include "io/model.h"
#include "pipeline/mesh/catmull_clark.h"
#include "pipeline/mesh/refinement.h"
#include "tests/support/random_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace tessemu {
namespace {

constexpr std::uint32_t kOne = MeshPoint::kOne, kDomainOne = 65536;

struct NamedMesh {
    std::string name;
    ControlMesh mesh;
};

std::vector<NamedMesh> meshes()
{
    std::vector<NamedMesh> out;
    for (char const* model : {"golem", "jug", "spindle", "saddle_star"})
        out.push_back({model, load_model(model).mesh});
    for (int n : {3, 5, 6}) out.push_back({"prism " + std::to_string(n), test::prism(n)});
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        out.push_back({"random " + std::to_string(seed), test::random_mesh(seed)});
        out.push_back(
            {"joined " + std::to_string(seed), test::join_faces(test::random_mesh(seed), seed)});
    }
    return out;
}

bool has_polygons(ControlMesh const& mesh)
{
    for (std::size_t f = 0; f < mesh.faces(); ++f)
        if (mesh.face(f).size() > 4) return true;
    return false;
}

// work(name, refined mesh) for 0 to 3 steps; faces of more than four sides need one.
template <class Work> void for_each_refined(Work&& work)
{
    for (NamedMesh const& m : meshes())
        for (int steps = has_polygons(m.mesh) ? 1 : 0; steps <= 3; ++steps) {
            RefinedMesh const refined(m.mesh, steps, catmull_clark_step);
            SCOPED_TRACE(m.name + ", " + std::to_string(steps) + " steps");
            work(refined);
            if (testing::Test::HasFatalFailure()) return;
        }
}

struct Domain {
    std::uint32_t u, v;
};
// At t, in 1/65536, from corner k to corner k+1.
Domain on_edge(int sides, int k, std::uint32_t t)
{
    std::uint32_t const s = kDomainOne - t;
    if (sides == 4)
        return std::array<Domain, 4>{
            {{t, 0}, {kDomainOne, t}, {s, kDomainOne}, {0, s}}}[std::size_t(k)];
    return std::array<Domain, 3>{{{s, t}, {0, s}, {t, 0}}}[std::size_t(k)];
}

// A patch turned as some scheme might turn it.
struct Patch {
    std::uint32_t face;
    int rotation, sides;
    PatchPlace place;

    Patch(RefinedMesh const& m, std::uint32_t f) : face(f), sides(int(m.mesh().face(f).size()))
    {
        rotation = int((f * 2654435761u) >> 8) % sides;
        place = m.place(f, rotation);
    }
    std::uint32_t vertex(RefinedMesh const& m, int k) const
    {
        return m.mesh().face(face)[std::size_t((k + rotation) % sides)];
    }
};

// What a point is on the refined mesh itself: a vertex, a point of an edge, a point of a face.
using Truth = std::array<std::uint32_t, 4>;

TEST(MeshPoint, NamesAreEqualExactlyWhereThePointsAre)
{
    for_each_refined([](RefinedMesh const& m) {
        std::map<MeshPoint, Truth> truth_of;
        std::map<Truth, MeshPoint> name_of;
        auto const check = [&](PatchPlace const& place, Domain at, Truth const& truth) {
            MeshPoint const name = mesh_point(m.base(), place, at.u, at.v);
            auto const [known, fresh] = truth_of.try_emplace(name, truth);
            ASSERT_EQ(known->second, truth) << in_words(name) << " names two points";
            auto const [other, first] = name_of.try_emplace(truth, name);
            ASSERT_EQ(other->second, name)
                << in_words(name) << " and " << in_words(other->second) << " are one point";
        };
        for (std::uint32_t f = 0; f < m.mesh().faces(); ++f) {
            Patch const p(m, f);
            for (int k = 0; k < p.sides; ++k) {
                std::uint32_t const a = p.vertex(m, k), b = p.vertex(m, k + 1);
                check(p.place, on_edge(p.sides, k, 0), {0, a, 0, 0});
                for (std::uint32_t t : {1u, 16384u, 32768u, 65535u})
                    check(p.place, on_edge(p.sides, k, t),
                          {1, std::min(a, b), std::max(a, b), a < b ? t : kDomainOne - t});
            }
            check(p.place, {20000, 30000}, {2, f, 0, 0});
        }
        EXPECT_EQ(truth_of.size(), name_of.size());
    });
}

// A point of a line by its coordinate there.
MeshPoint point_on(ControlMesh const& mesh, MeshLine const& line, std::uint32_t at)
{
    if (line.kind == MeshLine::Kind::Edge) {
        if (at == 0) return {MeshPoint::Kind::Vertex, line.a, 0, 0, 0};
        if (at == kOne) return {MeshPoint::Kind::Vertex, line.b, 0, 0, 0};
        return {MeshPoint::Kind::Edge, line.a, line.b, 0, at};
    }
    bool const x = line.kind == MeshLine::Kind::ConstantX;
    if (at != 0 && at != kOne)
        return {MeshPoint::Kind::Face, line.a, line.b, x ? line.at : at, x ? at : line.at};
    PatchPlace unit;
    unit.face = line.a;
    unit.corner = std::uint16_t(line.b);
    return mesh_point(mesh, unit, (x ? line.at : at) >> 9, (x ? at : line.at) >> 9);
}

TEST(MeshInterval, RunsThroughThePointsOfItsEdge)
{
    for_each_refined([](RefinedMesh const& m) {
        for (std::uint32_t f = 0; f < m.mesh().faces(); ++f) {
            Patch const p(m, f);
            for (int k = 0; k < p.sides; ++k) {
                MeshInterval const i = mesh_interval(m.base(), p.place, k);
                ASSERT_EQ(i.at(0), i.from);
                ASSERT_EQ(i.at(kDomainOne), i.to);
                for (std::uint32_t t : {0u, 1u, 16384u, 40961u, 65535u, kDomainOne}) {
                    Domain const d = on_edge(p.sides, k, t);
                    MeshPoint const there = mesh_point(m.base(), p.place, d.u, d.v);
                    ASSERT_EQ(point_on(m.base(), i.line, i.at(t)), there)
                        << in_words(there) << ", edge " << k << " at " << t;
                }
            }
        }
    });
}

TEST(MeshInterval, LinesAreCoveredFromBothSidesWithoutGaps)
{
    for_each_refined([](RefinedMesh const& m) {
        std::map<MeshLine, std::vector<MeshInterval>> lines;
        for (std::uint32_t f = 0; f < m.mesh().faces(); ++f) {
            Patch const p(m, f);
            for (int k = 0; k < p.sides; ++k) {
                MeshInterval const i = mesh_interval(m.base(), p.place, k);
                lines[i.line].push_back(i);
            }
        }
        std::size_t edges = 0;
        for (auto const& [line, intervals] : lines) {
            bool boundary = false;
            if (line.kind == MeshLine::Kind::Edge) {
                ++edges;
                HalfEdge const h = m.base_topology().find_edge(line.a, line.b);
                ASSERT_NE(h, Topology::kNone);
                boundary = m.base_topology().twin(h) == Topology::kNone;
            }
            // Forwards and backwards, each whole: the patches on both sides run along it so.
            int covered = 0;
            for (bool forwards : {true, false}) {
                std::vector<std::pair<std::uint32_t, std::uint32_t>> run;
                for (MeshInterval const& i : intervals)
                    if ((i.from < i.to) == forwards) run.push_back(std::minmax(i.from, i.to));
                if (run.empty()) continue;
                ++covered;
                std::sort(run.begin(), run.end());
                ASSERT_EQ(run.front().first, 0u);
                ASSERT_EQ(run.back().second, kOne);
                for (std::size_t k = 0; k + 1 < run.size(); ++k)
                    ASSERT_EQ(run[k].second, run[k + 1].first);
            }
            ASSERT_EQ(covered, boundary ? 1 : 2);
        }
        EXPECT_EQ(edges, summarize(m.base_topology()).edges);
    });
}

// Cells of every level, with 16-bit fractions, in a float.
TEST(UnitPoint, IsExactAtEveryLevel)
{
    ControlMesh mesh = test::prism(5); // face 0 has five sides, face 2 four
    mesh.add_face(std::array<std::uint32_t, 3>{0, 1, 2});
    std::mt19937 random(5);
    auto const below = [&](std::uint32_t n) { return std::uint32_t(random() % n); };
    for (int round = 0; round < 20000; ++round) {
        PatchPlace p;
        p.rotation = std::uint8_t(below(4));
        p.level = std::uint8_t(below(PatchPlace::kMaxLevel + 1));
        p.i = std::uint16_t(below(1u << p.level));
        p.j = std::uint16_t(below(1u << p.level));
        p.face = 2;
        if (round % 3 == 1) p.face = 0, p.corner = std::uint16_t(below(5));
        // Odd, so that it lies inside.
        std::uint32_t u = 2 * below(32768) + 1, v = 2 * below(32768) + 1;
        if (round % 3 == 2) {
            p = {};
            p.sides = 3;
            p.face = std::uint32_t(mesh.faces() - 1);
            p.rotation = std::uint8_t(below(3));
            if (u + v >= kDomainOne) u = kDomainOne - u, v = kDomainOne - v;
            if (u + v == kDomainOne) continue;
        }
        MeshPoint const name = mesh_point(mesh, p, u, v);
        UnitPoint const at = domain_to_unit(p, float(u) * 0x1p-16f, float(v) * 0x1p-16f);
        ASSERT_EQ(name.kind, MeshPoint::Kind::Face);
        ASSERT_EQ(name.a, p.face);
        ASSERT_EQ(name.b, std::uint32_t(p.corner));
        ASSERT_EQ(double(at.u) * kOne, double(name.s));
        ASSERT_EQ(double(at.v) * kOne, double(name.t));
    }
}

// A square's refinement is the grid that its cells are named by.
TEST(UnitPoint, IsWhereTheRefinementPutsTheVerticesOfASquare)
{
    ControlMesh square;
    square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    square.add_face(std::array<std::uint32_t, 4>{0, 1, 2, 3});
    for (int steps = 0; steps <= 5; ++steps) {
        RefinedMesh const m(square, steps, catmull_clark_step);
        for (std::uint32_t f = 0; f < m.mesh().faces(); ++f) {
            Patch const p(m, f);
            EXPECT_EQ(p.place.level, steps);
            for (int k = 0; k < 4; ++k) {
                Domain const d = on_edge(4, k, 0);
                UnitPoint const at = domain_to_unit(p.place, float(d.u >> 16), float(d.v >> 16));
                ASSERT_EQ(m.mesh().positions[p.vertex(m, k)], glm::vec3(at.u, at.v, 0));
            }
        }
    }
}

TEST(MeshPoint, InWordsCountsFromOne)
{
    using Kind = MeshPoint::Kind;
    EXPECT_EQ(in_words(MeshPoint{Kind::Vertex, 2, 0, 0, 0}), "corner at vertex 3");
    EXPECT_EQ(in_words(MeshPoint{Kind::Edge, 2, 6, 0, kOne / 2}), "edge 3-7, t = 32768/65536");
    EXPECT_EQ(in_words(MeshPoint{Kind::Edge, 2, 6, 0, 3}), "edge 3-7, t = 3/33554432");
    EXPECT_EQ(in_words(MeshPoint{Kind::Face, 4, PatchPlace::kWhole, kOne / 4, kOne / 2}),
              "inside face 5, (u, v) = (16384/65536, 32768/65536)");
    EXPECT_EQ(in_words(MeshPoint{Kind::Face, 4, 1, kOne / 4, kOne / 2}),
              "inside face 5, at its corner 2, (u, v) = (16384/65536, 32768/65536)");
}

} // namespace
} // namespace tessemu
