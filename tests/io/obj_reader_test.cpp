// SPDX-License-Identifier: Apache-2.0
#include "io/obj_reader.h"

#include "emu/error.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace tessemu {
namespace {

std::string const kCube =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string message_of(std::string const& text)
{
    try {
        read_obj(text, "file.obj");
    } catch (FormatError const& e) {
        return e.what();
    }
    return "";
}

TEST(ObjReader, ReadsFacesAsTheyAre)
{
    ObjFile const f =
        read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2/1/1 5//2 3/7\n", "a");
    ASSERT_EQ(f.mesh.faces(), 2u);
    EXPECT_EQ(f.mesh.face(0).size(), 4u);
    EXPECT_EQ(f.mesh.face(1).size(), 3u);
    EXPECT_EQ(f.mesh.face(1)[1], 4u);
    EXPECT_TRUE(f.warnings.empty());
}

TEST(ObjReader, ReadsOpenSubdivTags)
{
    ObjFile const f =
        read_obj(kCube + "t crease 2/1/0 0 1 2.5\nt corner 1/1/0 3 10\nt hole 1/0/0 2\n"
                         "t interpolateboundary 1/0/0 2\n",
                 "a");
    ASSERT_EQ(f.mesh.creases.size(), 1u);
    EXPECT_EQ(f.mesh.creases[0].sharpness, 2.5f);
    ASSERT_EQ(f.mesh.corners.size(), 1u);
    EXPECT_EQ(f.mesh.holes, std::vector<std::uint32_t>{2});
    EXPECT_EQ(f.mesh.boundary, BoundaryRule::EdgeOnly);
}

TEST(ObjReader, AcceptsByteOrderMarkCarriageReturnsAndContinuations)
{
    std::string crlf = "\xef\xbb\xbf" + kCube;
    for (std::size_t i = 0; (i = crlf.find('\n', i)) != std::string::npos; i += 2)
        crlf.insert(i, "\r");
    EXPECT_EQ(read_obj(crlf, "a").mesh.positions.size(), 8u);
    std::string joined = kCube;
    joined.replace(joined.find("f 1 4 3 2"), 9, "f 1 4 \\\n 3 2");
    EXPECT_EQ(read_obj(joined, "a").mesh.face(0).size(), 4u);
}

TEST(ObjReader, ErrorsNameFileLineValueAndLimit)
{
    EXPECT_EQ(message_of(kCube + "f 1 2 9\n"),
              "file.obj:15: vertex index is 9, the file has 8 vertices");
    EXPECT_EQ(message_of(kCube + "f 0 1 2\n"),
              "file.obj:15: vertex index is 0, indices start at 1");
    EXPECT_EQ(message_of("v 1 2\n" + kCube), "file.obj:1: vertex has 2 coordinates, 3 are needed");
    EXPECT_EQ(message_of("v 1 2 nan\n" + kCube),
              "file.obj:1: coordinate 'nan' is not a finite number");
    EXPECT_EQ(message_of("v 1 2 0x1\n" + kCube),
              "file.obj:1: coordinate '0x1' is not a finite number");
    EXPECT_EQ(message_of(kCube + "f\n"), "file.obj:15: face has no vertices");
    EXPECT_EQ(message_of("v 1 2 3\n"), "file.obj: holds no face (1 vertices)");
    EXPECT_NE(message_of("v 1 2 1e30\n" + kCube).find("limit is 1000000000"), std::string::npos);
}

// What is to be done with such faces is make_manifold's.
TEST(ObjReader, TakesFacesOfAnyVertices)
{
    ControlMesh const m = read_obj(kCube + "f 1 2\nf 1 2 1\nf 3/1\n", "a.obj").mesh;
    ASSERT_EQ(m.faces(), 9u);
    EXPECT_EQ(m.face(6).size(), 2u);
    EXPECT_EQ(m.face(7)[2], 0u);
    EXPECT_EQ(m.face(8).size(), 1u);
}

TEST(ObjReader, WarnsAboutTagsThatItSkips)
{
    for (char const* tag :
         {"t crease 2/1/0 0 8 2\n", "t crease 2/1/0 0 6 2\n", "t unknown 0/0/0\n", "t crease\n",
          "t crease 2/1/0 0\n", "t corner 1/1/0 x 2\n", "t hole 1/0/0 6\n"}) {
        ObjFile const f = read_obj(kCube + tag, "a.obj");
        EXPECT_EQ(f.warnings.size(), 1u) << tag;
        EXPECT_TRUE(f.mesh.creases.empty());
    }
}

RC_GTEST_PROP(ObjReader, AnyTextEitherReadsOrThrowsAFormatError, ())
{
    auto const lines = *rc::gen::container<std::vector<std::string>>(rc::gen::oneOf(
        rc::gen::element<std::string>("v 0 0 0", "v 1 0 0", "v 0 1 1e5", "f 1 2 3", "f -1 -2 -3",
                                      "f 1/2/3 2 3", "t crease 2/1/0 0 1 2", "t", "f", "v",
                                      "f 1 2 3 \\", "\\"),
        rc::gen::string<std::string>()));
    std::string text;
    for (auto const& l : lines) text += l + "\n";
    try {
        ObjFile const f = read_obj(text, "a");
        RC_ASSERT(f.mesh.faces() > 0u);
        for (std::uint32_t v : f.mesh.face_vertices) RC_ASSERT(v < f.mesh.positions.size());
    } catch (FormatError const&) {
    }
}

TEST(ObjReader, NumbersRoundAsTheNearestFloat)
{
    // tinyobjloader parses in double before it rounds; these would differ if it parsed in float.
    ObjFile const f =
        read_obj("v 0.1 1.17549435e-38 16777217\nv 0.3 -2.5 1e-3\nv 3.4028 7 8\nf 1 2 3\n", "a");
    EXPECT_EQ(f.mesh.positions[0].x, 0.1f);
    EXPECT_EQ(f.mesh.positions[0].z, 16777216.0f);
    EXPECT_EQ(f.mesh.positions[1].x, 0.3f);
    EXPECT_EQ(f.mesh.positions[1].z, 1e-3f);
}

TEST(ObjReader, ReadsTextureCoordinatesOfFaceCorners)
{
    ObjFile const obj = read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                 "vt 0 0.25\nvt 1 0.5 7\nvt 0.75 -1e1\n"
                                 "f 1/1 2/2/9 3/-1 4/1\n",
                                 "a.obj");
    EXPECT_TRUE(obj.warnings.empty());
    ASSERT_EQ(obj.mesh.coordinates.size(), 3u);
    EXPECT_EQ(obj.mesh.coordinates[0], glm::vec2(0, 0.25f));
    EXPECT_EQ(obj.mesh.coordinates[2], glm::vec2(0.75f, -10));
    EXPECT_EQ(obj.mesh.face_coordinates, (std::vector<std::uint32_t>{0, 1, 2, 0}));
}

// The surface does not depend on them: faults leave the mesh without, and say so.
TEST(ObjReader, BadTextureCoordinatesAreDroppedWithALine)
{
    std::string const vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    for (auto const& [rest, line] :
         {std::pair<std::string, std::string>{"vt 0 0\nf 1/1 2/1 3/2\n", "a.obj:5: "},
          {"vt 0 0\nf 1/1 2/1 3\n", "a.obj:5: "},
          {"vt 0\nf 1/1 2/1 3/1\n", "a.obj:4: "},
          {"vt nan 0\nvt inf 1\nf 1/1 2/1 3/1\n", "a.obj:4: "},
          {"vt 0 1e30\nf 1/1 2/1 3/1\n", "a.obj:5: "},
          {"vt 0 0\nf 1/-2 2/1 3/1\n", "a.obj:5: "},
          {"vt 0 0\nf 1/0 2/1 3/1\n", "a.obj:5: "}}) {
        ObjFile const obj = read_obj(vertices + rest, "a.obj");
        EXPECT_EQ(obj.mesh.faces(), 1u);
        EXPECT_TRUE(obj.mesh.face_coordinates.empty()) << rest;
        ASSERT_EQ(obj.warnings.size(), 1u) << rest;
        EXPECT_TRUE(obj.warnings[0].starts_with(line)) << obj.warnings[0];
    }
    // Coordinates that no face uses are nobody's concern.
    ObjFile const obj = read_obj(vertices + "vt 0 0\nf 1 2 3\n", "a.obj");
    EXPECT_TRUE(obj.warnings.empty());
    EXPECT_TRUE(obj.mesh.face_coordinates.empty());
}

} // namespace
} // namespace tessemu
