// SPDX-License-Identifier: Apache-2.0
#include "io/mesh_writer.h"

#include "io/model.h"
#include "pipeline/schemes/scheme.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <sstream>

#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

fs::path scratch()
{
    fs::path const p =
        fs::temp_directory_path() / ("tessemu_mesh_test_" + std::to_string(getpid()));
    fs::create_directories(p);
    return p;
}

struct Exported {
    std::uint64_t vertices, triangles;
};

Exported export_model(std::string const& model, fs::path const& path, bool weld, float tess)
{
    SchemeOnMesh const m = build_scheme(find_scheme("gregory-stencil"), load_model(model).mesh);
    OutputFile out(path);
    MeshWriter writer(out, weld);
    FrameSettings s;
    s.tess_factor = tess;
    visit_surface(*m.patches, s, ThreadPool(2),
                  [&](SurfacePatch const& patch) { writer.add(patch); });
    writer.finish();
    out.commit();
    return {writer.vertices(), writer.triangles()};
}

// A welded export of a closed mesh is a closed manifold: each edge has two triangles, V - E + F
// = 2.
TEST(MeshWriter, AWeldedClosedMeshHasEulerCharacteristicTwo)
{
    fs::path const path = scratch() / "spindle.obj";
    for (float tess : {1.0f, 3.0f, 6.4f}) {
        Exported const e = export_model("spindle", path, true, tess);
        std::map<std::pair<long, long>, int> edges;
        std::istringstream in(test::read_text(path));
        std::string line;
        std::uint64_t faces = 0;
        while (std::getline(in, line)) {
            if (!line.starts_with("f ")) continue;
            ++faces;
            std::istringstream words(line.substr(2));
            long v[3];
            for (long& x : v) {
                words >> x;
                words.ignore(100, ' ');
            }
            for (int i = 0; i < 3; ++i) ++edges[std::minmax(v[i], v[(i + 1) % 3])];
        }
        ASSERT_EQ(faces, e.triangles);
        for (auto const& [edge, n] : edges)
            ASSERT_EQ(n, 2) << edge.first << "-" << edge.second << " tess " << tess;
        EXPECT_EQ(long(e.vertices) - long(edges.size()) + long(faces), 2);
    }
}

TEST(MeshWriter, PlyAndObjHoldTheSameNumbers)
{
    Exported const ply = export_model("jug", scratch() / "jug.ply", false, 4);
    Exported const obj = export_model("jug", scratch() / "jug.obj", false, 4);
    EXPECT_EQ(ply.vertices, obj.vertices);
    EXPECT_EQ(ply.triangles, obj.triangles);
    std::string const text = test::read_text(scratch() / "jug.ply");
    std::size_t const data = text.find("end_header\n") + 11;
    EXPECT_EQ(text.size() - data, ply.vertices * 36 + ply.triangles * 13);
    std::string const o = test::read_text(scratch() / "jug.obj");
    float first[3];
    std::memcpy(first, text.data() + data, sizeof first);
    float x = 0, y = 0, z = 0;
    ASSERT_EQ(std::sscanf(o.c_str(), "v %f %f %f", &x, &y, &z), 3);
    EXPECT_EQ(x, first[0]);
    EXPECT_EQ(y, first[1]);
    EXPECT_EQ(z, first[2]);
}

TEST(MeshWriter, LeavesNothingBehindUnlessCommitted)
{
    fs::path const path = scratch() / "never.obj";
    fs::remove(path);
    std::size_t const before =
        std::size_t(std::distance(fs::directory_iterator(scratch()), fs::directory_iterator()));
    {
        OutputFile out(path);
        MeshWriter writer(out, false);
        writer.finish();
    }
    EXPECT_EQ(
        std::size_t(std::distance(fs::directory_iterator(scratch()), fs::directory_iterator())),
        before);
    OutputFile other(scratch() / "a.stl");
    EXPECT_THROW(MeshWriter(other, false), WriteError);
}

TEST(DomainToUnit, TurnsCornersBackExactly)
{
    float const corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (std::uint8_t r = 0; r < 4; ++r)
        for (int i = 0; i < 4; ++i) {
            PatchPlace const place{.sides = 4, .rotation = r};
            UnitPoint const p = domain_to_unit(place, corners[i][0], corners[i][1]);
            EXPECT_EQ(p.u, corners[(i + r) % 4][0]);
            EXPECT_EQ(p.v, corners[(i + r) % 4][1]);
        }
    for (std::uint8_t r = 0; r < 3; ++r) {
        // The patch's corner 0.
        UnitPoint const p = domain_to_unit({.sides = 3, .rotation = r}, 1, 0);
        EXPECT_EQ(p.u, r == 0 ? 1 : 0);
        EXPECT_EQ(p.v, r == 1 ? 1 : 0);
    }
}

} // namespace
} // namespace tessemu
