// Sorted meshes are the same meshes, and draw the same surfaces.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/sort_by_valence.h"

#include "io/model.h"
#include "pipeline/frame.h"
#include "pipeline/mesh/animation.h"
#include "pipeline/mesh/manifold.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/random_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace tessemu {
namespace {

struct Cage {
    std::string name;
    ControlMesh mesh;
};

// A cube with a fin: make_manifold cuts it, and leaves a slit.
ControlMesh finned_cube()
{
    ControlMesh m;
    for (int v = 0; v < 8; ++v) m.positions.emplace_back(v & 1, v >> 1 & 1, v >> 2);
    constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (auto const& f : kFaces) m.add_face(f);
    m.positions.emplace_back(2, 2, 0);
    m.positions.emplace_back(2, 2, 1);
    m.add_face(std::array{3u, 7u, 9u, 8u});
    return make_manifold(std::move(m)).mesh;
}

// Faces of several sizes, boundaries, and every kind of tag.
std::vector<Cage> cages()
{
    std::vector<Cage> out;
    for (char const* model : {"golem", "jug", "saddle_star", "spindle"})
        out.push_back({model, load_model(model).mesh});
    out.push_back({"prism", test::prism(5)});
    out.push_back({"joined random", test::join_faces(test::random_mesh(7), 7)});
    out.push_back({"fin", finned_cube()});
    ControlMesh tagged = load_model("jug").mesh; // quads and triangles
    for (std::uint32_t f = 0; f < 20; ++f)
        tagged.creases.push_back(
            {tagged.face(f)[0], tagged.face(f)[1], f % 3 ? 0.4f + 0.3f * float(f) : 10});
    for (std::uint32_t v = 0; v < 30; v += 7)
        tagged.corners.push_back({v, v % 2 ? 0.6f * float(v) : 12});
    tagged.holes = {3, 17, 40};
    out.push_back({"tagged jug", tagged});
    return out;
}

ControlMesh sorted(ControlMesh const& mesh)
{
    return sort_by_valence(mesh, catmull_clark_step(Topology(mesh)).tables);
}

// Faces, tags and coordinates by the file's numbers.
struct Named {
    std::map<std::uint32_t, std::pair<std::vector<std::uint32_t>, std::vector<glm::dvec2>>> faces;
    std::map<std::uint32_t, std::vector<glm::vec3>> positions; // of a vertex that was cut several
    std::multiset<std::tuple<std::uint32_t, std::uint32_t, float>> creases;
    std::multiset<std::pair<std::uint32_t, float>> corners;
    std::set<std::uint32_t> holes;
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> slits;

    friend bool operator==(Named const&, Named const&) = default;
};
Named by_names(ControlMesh const& m)
{
    Named out;
    for (std::uint32_t f = 0; f < m.faces(); ++f) {
        auto& [vertices, coordinates] = out.faces[m.file_face(f)];
        for (std::uint32_t h = m.face_start[f]; h < m.face_start[f + 1]; ++h) {
            vertices.push_back(m.file_vertex(m.face_vertices[h]));
            if (!m.face_coordinates.empty())
                coordinates.push_back(m.coordinates[m.face_coordinates[h]]);
        }
    }
    for (std::uint32_t v = 0; v < m.positions.size(); ++v)
        out.positions[m.file_vertex(v)].push_back(m.positions[v]);
    for (auto const& c : m.creases)
        out.creases.insert({m.file_vertex(c.a), m.file_vertex(c.b), c.sharpness});
    for (auto const& c : m.corners) out.corners.insert({m.file_vertex(c.vertex), c.sharpness});
    for (std::uint32_t f : m.holes) out.holes.insert(m.file_face(f));
    for (auto const& [a, b] : m.slits)
        out.slits.insert(ordered_edge(m.file_vertex(a), m.file_vertex(b)));
    return out;
}

TEST(SortByValence, KeepsTheMeshUnderTheFilesNumbers)
{
    bool slits = false, tags = false, coordinates = false;
    for (Cage const& cage : cages()) {
        SCOPED_TRACE(cage.name);
        ControlMesh const now = sorted(cage.mesh);
        EXPECT_EQ(by_names(now), by_names(cage.mesh));
        EXPECT_TRUE(std::is_sorted(now.holes.begin(), now.holes.end()));
        EXPECT_TRUE(std::is_sorted(now.slits.begin(), now.slits.end()));
        EXPECT_EQ(now.cut_edges, cage.mesh.cut_edges);
        slits = slits || !now.slits.empty();
        tags = tags || (!now.creases.empty() && !now.corners.empty() && !now.holes.empty());
        coordinates = coordinates || !now.face_coordinates.empty();
    }
    EXPECT_TRUE(slits && tags && coordinates) << "not all was compared";
}

TEST(SortByValence, OrdersByTheTurnsOfTheKernelsAndKeepsTheOrderOfEqualOnes)
{
    for (Cage const& cage : cages()) {
        SCOPED_TRACE(cage.name);
        ControlMesh const now = sorted(cage.mesh);
        SubdivisionTables const t = catmull_clark_step(Topology(now)).tables,
                                was = catmull_clark_step(Topology(cage.mesh)).tables;
        std::map<std::uint32_t, std::uint32_t> turns, before; // how many rows have so many
        for (std::uint32_t f = 1; f < now.faces(); ++f) {
            auto const a = std::pair(now.face(f - 1).size(), now.file_face(f - 1)),
                       b = std::pair(now.face(f).size(), now.file_face(f));
            EXPECT_LT(a, b);
        }
        auto const valence = [](SubdivisionTables const& tables, std::uint32_t v) {
            return tables.vertex_offset_valence[2 * v + 1];
        };
        for (std::uint32_t v = 0; v < now.positions.size(); ++v) {
            ++turns[valence(t, v)];
            ++before[valence(was, v)];
            if (v == 0) continue;
            EXPECT_LE(valence(t, v - 1), valence(t, v));
        }
        EXPECT_EQ(turns, before);
    }
}

// The largest coordinate, and the most sides of a face or edges at a vertex.
struct Extent {
    double coordinate = 0, sides = 3;
};
Extent extent_of(RefinedMesh const& m)
{
    Extent out;
    for (glm::vec3 const& p : m.base().positions)
        for (int k = 0; k < 3; ++k)
            out.coordinate = std::max(out.coordinate, double(std::abs(p[k])));
    for (std::uint32_t f = 0; f < m.base().faces(); ++f)
        out.sides = std::max(out.sides, double(m.base().face(f).size()));
    for (std::uint32_t v = 0; v < m.base().positions.size(); ++v)
        out.sides = std::max(out.sides, double(m.base_topology().valence(v)));
    return out;
}

// How far a refined point may lie from the exact one. All masks are means with weights that are not
// negative, so errors of a step are not enlarged by the next. Rounding, in units of 2^-24 of the
// largest coordinate: a face's point m - 1 sums, the weight and a product; a vertex's 2n - 1 sums,
// two weights, two products and a sum; a blended one's 2n + 1 terms with a rounded weight, a
// product and a sum each, in a row: 2n + 3. A step has a face's and one of the others.
double rounding(Extent const& e, int steps)
{
    return steps * (e.sides + 1 + 2 * e.sides + 4) * 0x1p-24 * e.coordinate;
}

// The refined mesh's vertices by name; of a name that a cut has given to several, all.
using Points = std::map<MeshPoint, std::vector<glm::vec3>>;
Points points_of(RefinedMesh const& m, DrawnMesh const& drawn)
{
    std::map<MeshPoint, std::set<std::uint32_t>> numbers;
    constexpr std::uint32_t kCorner[4][2] = {{0, 0}, {65536, 0}, {65536, 65536}, {0, 65536}};
    for (std::uint32_t f = 0; f < m.mesh().faces(); ++f)
        for (std::size_t k = 0; k < 4; ++k)
            numbers[as_in_file(m.base(),
                               mesh_point(m.base(), m.place(f), kCorner[k][0], kCorner[k][1]))]
                .insert(m.mesh().face(f)[k]);
    Points out;
    for (auto const& [name, of] : numbers)
        for (std::uint32_t v : of) out[name].push_back(drawn.mesh.positions[v]);
    return out;
}

bool is_near(glm::vec3 a, glm::vec3 b, double distance)
{
    for (int k = 0; k < 3; ++k)
        if (!(std::abs(double(a[k]) - double(b[k])) <= distance)) return false;
    return true;
}

std::size_t compare(Points const& a, Points const& b, double distance)
{
    std::size_t compared = 0;
    EXPECT_EQ(a.size(), b.size());
    for (auto const& [name, points] : a) {
        auto const other = b.find(name);
        if (other == b.end() || other->second.size() != points.size()) {
            ADD_FAILURE() << in_words(name) << " is not in both";
            continue;
        }
        for (glm::vec3 const& p : points) {
            ++compared;
            EXPECT_TRUE(std::any_of(other->second.begin(), other->second.end(),
                                    [&](glm::vec3 const& q) { return is_near(p, q, distance); }))
                << in_words(name);
        }
    }
    return compared;
}

BuildOptions options(int steps, char const* sort)
{
    BuildOptions out;
    out.subdivide = steps;
    if (sort) out.set = {{"sort", sort}};
    return out;
}

TEST(SortByValence, ThePointsOfTheKernelsMoveByRoundingAlone)
{
    for (Cage const& cage : cages())
        for (int steps : {1, 2, 3})
            for (bool moved : {false, true}) {
                SCOPED_TRACE(cage.name + ", " + std::to_string(steps) + " steps" +
                             (moved ? ", in a pose" : ""));
                SchemeOnMesh const a = refine_for_no_scheme(catmull_clark_step, cage.mesh,
                                                            options(steps, nullptr)),
                                   b = refine_for_no_scheme(catmull_clark_step, cage.mesh,
                                                            options(steps, "valence"));
                EXPECT_EQ(a.parameters.word("sort"), "none");
                EXPECT_EQ(b.parameters.word("sort"), "valence");
                auto const& rows = b.mesh->tables()[0].vertex_offset_valence;
                for (std::size_t i = 3; i < rows.size(); i += 2) EXPECT_LE(rows[i - 2], rows[i]);
                SurfaceSettings s, t;
                Extent e = extent_of(*a.mesh);
                if (moved) {
                    s.pose = std::make_shared<Pose>(SpineRig(a.mesh->base()).sway(0.3));
                    t.pose = std::make_shared<Pose>(SpineRig(b.mesh->base()).sway(0.3));
                    for (std::size_t v = 0; v < cage.mesh.positions.size(); ++v)
                        for (int k = 0; k < 3; ++k) // the same bits in both: a thread has a vertex
                            e.coordinate = std::max(
                                e.coordinate,
                                1.001 * std::abs(s.pose->posed(v, a.mesh->base().positions[v])[k]));
                }
                ThreadPool const threads(2);
                std::size_t const compared = compare(
                    points_of(*a.mesh, drawn_mesh(*a.mesh, s, threads)),
                    points_of(*b.mesh, drawn_mesh(*b.mesh, t, threads)), 2 * rounding(e, steps));
                EXPECT_EQ(compared, a.mesh->mesh().positions.size());
                if (HasFailure()) return;
            }
}

// Of patches with one segment an edge: their corners, which are on the limit surface.
Points corners_of(SchemeOnMesh const& m)
{
    FrameSettings s;
    s.tess_factor = 1;
    std::map<MeshPoint, std::vector<glm::vec3>> out;
    visit_surface(*m.patches, s, ThreadPool(2), [&](SurfacePatch const& patch) {
        TessellatedPatch const& t = patch.domain().patch;
        for (std::size_t i = 0; i < patch.points(); ++i) {
            auto& points = out[as_in_file(
                m.mesh->base(), mesh_point(m.mesh->base(), patch.place(), t.u[i], t.v[i]))];
            glm::vec3 const p = patch.vertex(i).position;
            if (std::find(points.begin(), points.end(), p) == points.end()) points.push_back(p);
        }
    });
    return out;
}

TEST(SortByValence, ExportedPointsOfTheSameNameMoveByRoundingAlone)
{
    for (Cage const& cage : cages())
        for (char const* scheme : {"gregory-stencil", "gregory-two-stage", "acc"}) {
            SCOPED_TRACE(cage.name + ", " + scheme);
            SchemeOnMesh const a = build_scheme(find_scheme(scheme), cage.mesh,
                                                options(1, nullptr)),
                               b = build_scheme(find_scheme(scheme), cage.mesh,
                                                options(1, "valence"));
            int inputs = 0;
            for (PatchCount const& c : a.patches->patch_counts())
                inputs = std::max(inputs, c.max_inputs);
            Extent const e = extent_of(*a.mesh);
            // A corner of a patch is a mean of its inputs, by weights that are rounded as products
            // and sums are.
            double const limit = (inputs + 2) * 0x1p-24 * e.coordinate;
            EXPECT_GT(
                compare(corners_of(a), corners_of(b), 2 * (rounding(e, a.mesh->steps()) + limit)),
                20u);
            EXPECT_EQ(by_names(a.mesh->base()), by_names(b.mesh->base()));
        }
}

TEST(SortByValence, IsRefusedWhereNoStepIsTaken)
{
    Scheme const& scheme = find_scheme("gregory-stencil");
    ControlMesh const jug = load_model("jug").mesh;
    try {
        build_scheme(scheme, jug, options(0, "valence"));
        ADD_FAILURE();
    } catch (Error const& e) {
        EXPECT_NE(std::string(e.what()).find("sort is 'valence', and no step of subdivision"),
                  std::string::npos)
            << e.what();
    }
    build_scheme(scheme, jug, options(0, "none")); // asks for nothing
    EXPECT_EQ(build_scheme(scheme, jug).parameters.values().count("sort"), 0u);
    EXPECT_EQ(build_scheme(scheme, jug, options(1, nullptr)).parameters.word("sort"), "none");
    // A step of the scheme's own.
    EXPECT_EQ(build_scheme(scheme, test::prism(5), options(0, "valence")).parameters.word("sort"),
              "valence");
    EXPECT_THROW(build_scheme(scheme, jug, options(1, "faces")), Error);
}

// What is wrong is named as in the file, whatever the order.
TEST(SortByValence, RefusalsNameTheFilesFaces)
{
    ControlMesh const mesh = load_model("jug").mesh;
    std::string what[2];
    for (int i : {0, 1}) try {
            build_scheme(find_scheme("pm"), mesh, options(1, i ? "valence" : nullptr));
            ADD_FAILURE();
        } catch (MeshError const& e) {
            what[i] = e.what();
        }
    EXPECT_EQ(what[0], what[1]);
    EXPECT_NE(what[0].find("face "), std::string::npos);
}

} // namespace
} // namespace tessemu
