// What is written is read back as the same mesh.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/control_mesh_writer.h"

#include "io/model.h"
#include "pipeline/mesh/manifold.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"
#include "tests/support/random_mesh.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <random>
#include <set>

#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

fs::path scratch(std::string const& name)
{
    return fs::temp_directory_path() /
           ("tessemu_control_mesh_" + std::to_string(getpid()) + "_" + name);
}

std::string written(ControlMesh const& mesh, std::string const& name,
                    Placement const& placement = {})
{
    fs::path const path = scratch(name);
    OutputFile out(path);
    write_control_mesh(mesh, out, placement);
    out.commit();
    std::string const text = test::read_text(path);
    fs::remove(path);
    return text;
}

// Without a warning.
ObjFile read_back(std::string const& text)
{
    ObjFile out = read_obj(text, "written.obj");
    EXPECT_TRUE(out.warnings.empty()) << out.warnings[0];
    return out;
}

std::vector<std::uint32_t> bits_of(std::vector<glm::vec3> const& points)
{
    std::vector<std::uint32_t> out(3 * points.size());
    std::memcpy(out.data(), points.data(), 4 * out.size());
    return out;
}

void expect_same(ControlMesh const& a, ControlMesh const& b)
{
    EXPECT_EQ(bits_of(a.positions), bits_of(b.positions));
    EXPECT_EQ(a.face_start, b.face_start);
    EXPECT_EQ(a.face_vertices, b.face_vertices);
    EXPECT_EQ(a.coordinates, b.coordinates);
    EXPECT_EQ(a.face_coordinates, b.face_coordinates);
    // A mesh's creases and corners are sets.
    std::set<std::tuple<std::uint32_t, std::uint32_t, float>> creases[2];
    std::set<std::pair<std::uint32_t, float>> corners[2];
    for (int i : {0, 1}) {
        ControlMesh const& m = i ? b : a;
        for (auto const& c : m.creases) creases[i].insert({c.a, c.b, c.sharpness});
        for (auto const& c : m.corners) corners[i].insert({c.vertex, c.sharpness});
    }
    EXPECT_EQ(creases[0], creases[1]);
    EXPECT_EQ(corners[0], corners[1]);
    EXPECT_EQ(a.holes, b.holes);
    EXPECT_EQ(a.rules, b.rules);
}

// Coordinates of any binade, texture coordinates, every tag, unused vertices.
ControlMesh random_tagged(std::uint32_t seed)
{
    std::mt19937 random(seed);
    auto const number = [&](double scale) { return scale * (double(random()) / 0x1p31 - 1); };
    ControlMesh m = test::join_faces(test::random_mesh(seed), seed);
    for (glm::vec3& p : m.positions)
        for (int k = 0; k < 3; ++k)
            if (random() % 4 == 0) p[k] *= std::ldexp(1.0f, -int(random() % 60));
    m.positions[0].x = -0.0f;
    m.positions[1].y = std::bit_cast<float>(3u); // denormal
    m.positions.emplace_back(1, 2, 3);           // of no face
    for (std::size_t h = 0; h < m.face_vertices.size(); ++h) {
        if (random() % 3 || m.coordinates.empty()) m.coordinates.emplace_back(number(1), number(7));
        m.face_coordinates.push_back(std::uint32_t(random() % m.coordinates.size()));
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::set<std::uint32_t> vertices, holes;
    for (std::uint32_t f = 0; f < m.faces(); f += 3) {
        std::uint32_t const a = m.face(f)[0], b = m.face(f)[1];
        float const sharpness[] = {0.3f, float(1.0 / 3 + double(random() % 8)), 10, 11.5f};
        if (edges.insert(ordered_edge(a, b)).second)
            m.creases.push_back({a, b, sharpness[random() % 4]});
        if (f % 2 && vertices.insert(a).second) m.corners.push_back({a, sharpness[random() % 4]});
        if (f % 5 == 0) holes.insert(f);
    }
    m.holes.assign(holes.begin(), holes.end());
    m.rules.boundary = BoundaryRule(random() % 3);
    m.rules.crease_method = random() % 2 ? CreaseMethod::Chaikin : CreaseMethod::Normal;
    m.rules.smooth_triangles = random() % 2;
    return m;
}

TEST(ControlMeshWriter, AnObjIsReadBackBitForBitWithItsTags)
{
    for (std::uint32_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE(seed);
        ControlMesh const mesh = random_tagged(seed);
        ObjFile const back = read_back(written(mesh, "a.obj"));
        ASSERT_TRUE(back.placement.is_identity());
        expect_same(mesh, back.mesh);
        if (HasFailure()) return;
    }
}

TEST(ControlMeshWriter, ReadBackStepsAreTheSameMesh)
{
    for (char const* model : {"golem", "jug", "saddle_star", "spindle"})
        for (int steps : {1, 2}) {
            ControlMesh mesh = load_model(model).mesh;
            mesh.creases.push_back({mesh.face(0)[0], mesh.face(0)[1], 2.5f});
            mesh.corners.push_back({mesh.face(1)[0], 10});
            mesh.holes = {2};
            RefinedMesh const refined(std::move(mesh), steps, catmull_clark_step);
            DrawnMesh const drawn = drawn_mesh(refined, {}, ThreadPool(2));
            expect_same(drawn.mesh, read_back(written(drawn.mesh, "b.obj")).mesh);
        }
}

TEST(ControlMeshWriter, AMeshThatWasScaledOrMovedStandsWhereItStood)
{
    for (double scale : {1e-30, 1.0, 1e30})
        for (double off : {0.0, 1e6}) {
            std::string text;
            for (int v = 0; v < 8; ++v)
                text += "v " + std::to_string(v & 1) + " " + std::to_string(v >> 1 & 1) + " " +
                        std::to_string(v >> 2) + "\n";
            text += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
            ControlMesh const unit = read_obj(text, "unit").mesh;
            std::vector<glm::dvec3> file;
            for (glm::vec3 const& p : unit.positions)
                file.push_back(scale * (glm::dvec3(p) + glm::dvec3(off, 0, 0)));
            Placement const placement{std::span(file)};
            ASSERT_EQ(placement.is_identity(), scale == 1.0 && off == 0);
            ControlMesh mesh = unit;
            for (std::size_t v = 0; v < 8; ++v) mesh.positions[v] = placement.from_file(file[v]);
            ObjFile const back = read_obj(written(mesh, "c.obj", placement), "c.obj");
            for (std::size_t v = 0; v < 8; ++v) // the same frame: the same points
                EXPECT_EQ(back.mesh.positions[v], mesh.positions[v]) << scale << " " << off;
            for (std::size_t v = 0; v < 8; ++v)
                EXPECT_EQ(back.placement.to_file(back.mesh.positions[v]),
                          placement.to_file(mesh.positions[v]));
        }
}

TEST(ControlMeshWriter, ASlitIsReadBackAsACrease)
{
    ControlMesh m;
    for (int v = 0; v < 8; ++v) m.positions.emplace_back(v & 1, v >> 1 & 1, v >> 2);
    constexpr std::uint32_t kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                            {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    for (auto const& f : kFaces) m.add_face(f);
    m.positions.emplace_back(2, 2, 0);
    m.positions.emplace_back(2, 2, 1);
    m.add_face(std::array{3u, 7u, 9u, 8u});
    m = make_manifold(std::move(m)).mesh;
    ASSERT_EQ(m.slits.size(), 1u);
    ControlMesh const back = read_back(written(m, "d.obj")).mesh;
    EXPECT_EQ(std::count_if(back.creases.begin(), back.creases.end(),
                            [&](ControlMesh::Crease const& c) {
                                return ordered_edge(c.a, c.b) == m.slits[0] &&
                                       c.sharpness >= kInfinitelySharp;
                            }),
              1);
}

TEST(ControlMeshWriter, APlyHoldsPositionsAndFaces)
{
    for (bool large : {false, true}) { // faces of more sides than a byte counts
        ControlMesh const m = large ? test::prism(300) : random_tagged(3);
        std::string const text = written(m, "e.ply");
        EXPECT_NE(text.find(large ? "list uint int vertex_indices" : "list uchar int vertex_ind"),
                  text.npos);
        std::size_t data = text.find("end_header\n") + 11;
        std::size_t const count = large ? 4 : 1; // bytes
        ASSERT_EQ(text.size(),
                  data + 12 * m.positions.size() + count * m.faces() + 4 * m.face_vertices.size());
        EXPECT_EQ(std::memcmp(text.data() + data, m.positions.data(), 12 * m.positions.size()), 0);
        data += 12 * m.positions.size();
        for (std::size_t f = 0; f < m.faces(); ++f) {
            std::uint32_t sides = 0;
            std::memcpy(&sides, text.data() + data, count);
            ASSERT_EQ(sides, m.face(f).size());
            data += count;
            ASSERT_EQ(std::memcmp(text.data() + data, m.face(f).data(), 4 * sides), 0);
            data += 4 * sides;
        }
        EXPECT_NE(text.find("element face " + std::to_string(m.faces()) + "\n"), text.npos);
    }
}

TEST(ControlMeshWriter, SaysWhatAPlyLacks)
{
    EXPECT_EQ(left_out_of_ply(test::prism(4)), "");
    ControlMesh m = test::prism(4);
    m.creases = {{0, 1, 2}};
    EXPECT_EQ(left_out_of_ply(m), "1 crease");
    m.holes = {0, 1};
    EXPECT_EQ(left_out_of_ply(m), "1 crease and 2 holes");
    m.rules.boundary = BoundaryRule::EdgeOnly;
    EXPECT_EQ(left_out_of_ply(m), "1 crease, 2 holes and interpolateboundary");
}

TEST(ControlMeshWriter, AnotherExtensionIsRefused)
{
    OutputFile out(scratch("f.stl"));
    EXPECT_THROW(write_control_mesh(test::prism(3), out), WriteError);
}

} // namespace
} // namespace tessemu
