// SPDX-License-Identifier: Apache-2.0
#include "io/obj_reader.h"

#include "emu/error.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

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
    ObjFile const f = read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nvn 0 0 1\nf 1 2 3 4\n"
                               "f 2//1 5//-1 -3\n",
                               "a");
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
    EXPECT_EQ(f.mesh.rules.boundary, BoundaryRule::EdgeOnly);
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
    EXPECT_EQ(message_of("v 1 2 1e101\n" + kCube),
              "file.obj:1: coordinate is 1e101, the limit is 1e+100");
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
          "t crease 2/1/0 0\n", "t corner 1/1/0 x 2\n", "t hole 1/0/0 6\n", "t hole 0/0/0\n",
          "t crease 4/3/0 0 1 1 2 2\n", "t crease 6/2/0 0 1 1 2 2 3 5 6\n", "t corner 0/1/0 3\n",
          "t interpolateboundary 0/0/0\n", "t interpolateboundary 1/0/0 3\n"}) {
        ObjFile const f = read_obj(kCube + tag, "a.obj");
        ASSERT_EQ(f.warnings.size(), 1u) << tag;
        EXPECT_TRUE(f.warnings[0].starts_with("a.obj:15: ")) << f.warnings[0];
        EXPECT_TRUE(f.mesh.creases.empty());
    }
}

TEST(ObjReader, CountsLikeWarningsOfTags)
{
    for (auto const& [tag, other] : std::vector<std::pair<std::string, std::string>>{
             {"t corner 1/1/0 99 2\n", "t corner 1/1/0 98 2\n"},
             {"t crease 2/1/0 0 6 2\n", "t crease 2/1/0 1 7 2\n"},
             {"t crease 2/1/0 0 1 x\n", "t corner 1/1/0 0 y\n"},
             {"t one 0/0/0\n", "t two 0/0/0\n"},
             {"t\n", "t crease\n"},
             {"t corner 1/1/0 1 -1\n", "t corner 1/1/0 2 -2\n"},
             {"t hole 0/0/0\n", "t hole 0/0/0\n"}}) {
        std::string text = kCube + tag;
        for (int i = 0; i < 199; ++i) text += other;
        auto const warnings = read_obj(text, "a").warnings;
        ASSERT_EQ(warnings.size(), 1u) << tag;
        EXPECT_TRUE(warnings[0].starts_with("a:15: ")) << warnings[0];
        EXPECT_TRUE(warnings[0].ends_with(" (and 199 more)")) << warnings[0];
    }
}

// Digits that an exponent does not make up for are no zero.
TEST(ObjReader, ANumberOfManyDigitsIsNotZero)
{
    std::string const huge = std::string(61, '9') + "e-1";
    ObjFile const f = read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt " + huge +
                                   " 0\nf 1/1 2/1 3/1\nt crease 2/1/0 0 1 " + huge + "\n",
                               "a");
    EXPECT_EQ(f.warnings.size(), 2u);
    EXPECT_TRUE(f.mesh.coordinates.empty());
    EXPECT_TRUE(f.mesh.creases.empty());
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

// A unit quad so far off that the mesh is moved.
std::string const kFarQuad =
    "v 1000000 0 0\nv 1000001 0 0\nv 1000001 1 0\nv 1000000 1 0\nf -4 -3 -2 -1\n";

TEST(ObjReader, AMovedMeshMayHaveAnyLinesBesideItsVertices)
{
    EXPECT_EQ(read_obj("p \\\nv\n" + kFarQuad, "a").mesh.faces(), 1u);
    EXPECT_EQ(read_obj(kFarQuad + "l 1 2 \\\nv", "a").mesh.faces(), 1u);
    EXPECT_EQ(read_obj("v 0.0e-2147483648 0.5E-99999999999999999999 0e2147483647\n" + kFarQuad, "a")
                  .mesh.faces(),
              1u);
}

RC_GTEST_PROP(ObjReader, AnyWordsBesideAMovedMeshReadOrThrowAFormatError, ())
{
    auto const words = *rc::gen::container<std::vector<std::string>>(rc::gen::element<std::string>(
        "p", "l", "call", "curv", "t", "vt", "g", "#", "\\\n", "\\\nv", "\n", "\n", "1", "0.5",
        "1/1/0", "corner", "v 1 2 3\n", "v 0.0e-2147483648 1.00001e+06 1\n"));
    std::string text;
    for (auto const& w : words) text += w + (w.ends_with('\n') ? "" : " ");
    for (std::string const& all : {text + "\n\n" + kFarQuad, kFarQuad + text}) {
        try {
            ObjFile const f = read_obj(all, "a");
            for (std::uint32_t v : f.mesh.face_vertices) RC_ASSERT(v < f.mesh.positions.size());
        } catch (FormatError const&) {
        }
    }
}

// Whole numbers, halves and decimals in a fixed number may be exact; %g cuts what it does not hold.
TEST(ObjReader, WarnsOfLostDigitsOnlyWhereTheFormatHasCutThem)
{
    auto const warnings = [](std::string const& far, std::string const& next,
                             std::string const& rest = "") {
        return read_obj("v " + far + " 0 0\nv " + next + " 0 0\nv " + next + " 1 0\nv " + far +
                            " 1 0\nf 1 2 3 4\n" + rest,
                        "a")
            .warnings;
    };
    for (auto const& [far, next] :
         std::vector<std::pair<std::string, std::string>>{{"100", "101"},
                                                          {"100000", "100001"},
                                                          {"1e6", "1000001"},
                                                          {"123456789", "123456790"},
                                                          {"100", "100.5"},
                                                          {"4000000.00", "4000001.00"},
                                                          {"4000000.12", "4000001.12"}})
        EXPECT_EQ(warnings(far, next), std::vector<std::string>{}) << far;
    EXPECT_EQ(warnings("100000", "100001", "v 1 2 1234.56\n"), std::vector<std::string>{});

    std::vector<std::string> const lost = warnings("4.00001e+06", "4.00002e+06");
    ASSERT_EQ(lost.size(), 1u);
    EXPECT_TRUE(lost[0].starts_with("a:2: so far from the origin the file's coordinates are good "
                                    "to 5, 500 % of the edge between vertices"))
        << lost[0];
    // Of three places the first two are those of a body as %g writes it.
    EXPECT_EQ(warnings("100003", "100004",
                       "v 100002 1.23457 0.333333\nv 1 2.34568 0.666667\nv 1 3.45679 -0.111111\n")
                  .size(),
              1u);
    // Beyond what a double tells apart.
    EXPECT_EQ(warnings("1000000000000000", "1000000000000001").size(), 1u);
}

TEST(ObjReader, NumbersRoundAsTheNearestFloat)
{
    // The middle between 1 and the next float, and a little above it: a double does not see that.
    std::string const middle = "1.000000059604644775390625";
    ObjFile const f = read_obj("v 0.1 1.17549435e-38 " + middle + "\nv 0.3 -2.5 1e-3\nv " + middle +
                                   "0000000000001 7 8\nf 1 2 3\n",
                               "a");
    EXPECT_EQ(f.mesh.positions[0].x, 0.1f);
    EXPECT_EQ(f.mesh.positions[0].y, 1.17549435e-38f);
    EXPECT_EQ(f.mesh.positions[0].z, 1.0f);
    EXPECT_EQ(f.mesh.positions[1].x, 0.3f);
    EXPECT_EQ(f.mesh.positions[1].z, 1e-3f);
    EXPECT_EQ(f.mesh.positions[2].x, std::nextafter(1.0f, 2.0f));
}

TEST(ObjReader, PlacesAMeshByTheVerticesOfItsFaces)
{
    ObjFile const f = read_obj("v 1000001 0 0\nv 1000002.25 0 0\nv 1000001 1 0\nv 0 1e90 0\n"
                               "f 1 2 3\n",
                               "a");
    EXPECT_TRUE(f.placement.is_moved());
    auto const& p = f.mesh.positions;
    EXPECT_EQ(p[1].x - p[0].x, 1.25f);
    EXPECT_EQ(f.placement.to_file(p[0]), glm::dvec3(1000001, 0, 0));
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(p[3][k]));
}

TEST(ObjReader, ReadsTextureCoordinatesOfFaceCorners)
{
    ObjFile const obj = read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                 "vt 0 0.25\nvt 1 0.5 7\nvt 0.75 -1e1\n"
                                 "vn 0 0 1\nf 1/1 2/2/1 3/-1 4/1\n",
                                 "a.obj");
    EXPECT_TRUE(obj.warnings.empty());
    ASSERT_EQ(obj.mesh.coordinates.size(), 3u);
    EXPECT_EQ(obj.mesh.coordinates[0], glm::dvec2(0, 0.25));
    EXPECT_EQ(obj.mesh.coordinates[2], glm::dvec2(0.75, -10));
    EXPECT_EQ(obj.mesh.face_coordinates, (std::vector<std::uint32_t>{0, 1, 2, 0}));
}

// The surface does not depend on them: faults leave the mesh without, and say so.
TEST(ObjReader, BadTextureCoordinatesAreDroppedWithALine)
{
    std::string const vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    for (auto const& [rest, line] :
         {std::pair<std::string, std::string>{"vt 0 0\nf 1/1 2/1 3/2\n", "a.obj:5: "},
          {"vt 0 0\nf 1/1 2/1 3\n", "a.obj:5: "},
          {"f 1/1 2/1 3/1\n", "a.obj:4: "},
          {"vt\nf 1/1 2/1 3/1\n", "a.obj:4: "},
          {"vt 0 0,5\nf 1/1 2/1 3/1\n", "a.obj:4: "},
          {"vt nan 0\nvt inf 1\nf 1/1 2/1 3/1\n", "a.obj:4: "},
          {"vt 0 1e30\nf 1/1 2/1 3/1\n", "a.obj:4: "},
          {"vt 0 0\nf 1/-2 2/1 3/1\n", "a.obj:5: "},
          {"vt 0 0\nf 1/0 2/1 3/1\n", "a.obj:5: "}}) {
        ObjFile const obj = read_obj(vertices + rest, "a.obj");
        EXPECT_EQ(obj.mesh.faces(), 1u);
        EXPECT_TRUE(obj.mesh.face_coordinates.empty()) << rest;
        ASSERT_EQ(obj.warnings.size(), 1u) << rest;
        EXPECT_TRUE(obj.warnings[0].starts_with(line)) << obj.warnings[0];
    }
    ObjFile const obj = read_obj(vertices + "vt 0 0\nf 1 2 3\n", "a.obj");
    EXPECT_EQ(obj.warnings, std::vector<std::string>{"a.obj:4: no face uses the file's 1 texture "
                                                     "coordinates: the mesh gets none"});
    EXPECT_TRUE(obj.mesh.face_coordinates.empty());
}

TEST(ObjReader, ATextureCoordinateOfOneNumberHasVZero)
{
    ObjFile const obj =
        read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.5\nvt 1 0.25\nf 1/1 2/2 3/1\n", "a");
    EXPECT_TRUE(obj.warnings.empty());
    ASSERT_EQ(obj.mesh.coordinates.size(), 2u);
    EXPECT_EQ(obj.mesh.coordinates[0], glm::dvec2(0.5, 0));
    EXPECT_EQ(obj.mesh.coordinates[1], glm::dvec2(1, 0.25));
}

// Without the line after it, the mesh would lack a vertex or a face.
TEST(ObjReader, ACommentOrNameThatEndsInABackslashDoesNotContinue)
{
    for (char const* line : {"# made by C:\\models\\", "g left\\", "o a \\", "usemtl b\\",
                             "mtllib C:\\", "nothing \\"}) {
        std::string text = kCube;
        text.insert(0, std::string(line) + "\n");
        text.insert(text.find("f 1 4"), std::string(line) + "\n");
        ObjFile const f = read_obj(text, "a");
        EXPECT_EQ(f.mesh.positions.size(), 8u) << line;
        EXPECT_EQ(f.mesh.faces(), 6u) << line;
    }
    // Nor does a comment behind a statement that is read.
    EXPECT_EQ(read_obj("v 0 0 0 # a \\\n" + kCube, "a").mesh.positions.size(), 9u);
}

TEST(ObjReader, StatementsThatAreReadContinueAfterABackslash)
{
    ObjFile const f = read_obj("v 0 \\\n 0 \\ \r\n0\nv 1 0 0\nv 1 1 0\nl 1 \\\n2\nf 1 2 \\\n3\n"
                               "t crease 2/1/0 \\\n0 1 2\n",
                               "a");
    EXPECT_EQ(f.mesh.positions.size(), 3u);
    EXPECT_EQ(f.mesh.creases.size(), 1u);
    EXPECT_EQ(f.lines.faces, std::vector<int>{8});
    EXPECT_EQ(f.warnings,
              std::vector<std::string>{"a:6: 'l': lines are left out, only faces make a surface"});
}

TEST(ObjReader, LinesEndWithLineFeedCarriageReturnOrBoth)
{
    for (std::string const end : {"\n", "\r\n", "\r"}) {
        std::string text = "# a\n\n" + kCube + "f 1 2 nine"; // without a last line end
        for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += end.size())
            text.replace(i, 1, end);
        EXPECT_EQ(message_of(text), "file.obj:17: 'nine' is not a vertex index");
        text.resize(text.rfind(end));
        EXPECT_EQ(read_obj(text, "a").mesh.faces(), 6u);
    }
}

TEST(ObjReader, RefusesWhatIsNoText)
{
    EXPECT_EQ(message_of(""), "file.obj: is empty");
    EXPECT_EQ(message_of(std::string("\xff\xfev\0", 4)),
              "file.obj: is UTF-16 text; save it as UTF-8");
    EXPECT_NE(message_of(kCube + std::string("\0", 1)).find("file.obj:15: byte 136 is zero"),
              std::string::npos)
        << message_of(kCube + std::string("\0", 1));
}

TEST(ObjReader, NumbersAreWholeDecimalWords)
{
    auto const at = [](std::string const& number) {
        return read_obj("v " + number + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a")
            .mesh.positions[0]
            .x;
    };
    EXPECT_EQ(at("+1.5"), 1.5f);
    EXPECT_EQ(at("-.5"), -0.5f);
    EXPECT_EQ(at("1."), 1.0f);
    EXPECT_EQ(at("+1E+2"), 100.0f);
    EXPECT_EQ(at("1e-999"), 0.0f);
    EXPECT_EQ(at("0." + std::string(400, '0') + "1"), 0.0f);
    EXPECT_EQ(at("0." + std::string(400, '0') + "1e-5"), 0.0f);
    EXPECT_EQ(at("0." + std::string(400, '0') + "1e+402"), 10.0f);
    for (char const* word : {"1.0abc", "1,5", "1e", "--1", "+-1", "0x10", "1_000", "inf", "NaN",
                             "1.2.3", "1d5", "\xc2\xa0", "."})
        EXPECT_NE(message_of("v " + std::string(word) + " 0 0\n" + kCube).find("file.obj:1: "),
                  std::string::npos)
            << word;
    EXPECT_EQ(message_of("v 1,5 0 0\n" + kCube),
              "file.obj:1: coordinate '1,5' is not a finite number; decimals follow a point");
    EXPECT_NE(message_of("v 0 1e999 0\n" + kCube).find("file.obj:1: coordinate is 1e999"),
              std::string::npos);
}

TEST(ObjReader, RefusesALineOfNumbersAlone)
{
    std::string const what = "file.obj:10: '3' begins the line, which is no statement";
    EXPECT_EQ(message_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n\n\nf 1 2 \\\n\n\n3 4\n")
                  .substr(0, what.size()),
              what);
}

TEST(ObjReader, WarnsOfEachKindOfLineThatIsLost)
{
    for (auto const& [lines, warning] : std::vector<std::pair<std::string, std::string>>{
             {"l 1 2\nl 2 3\n", "'l': lines are left out, only faces make a surface (and 1 more)"},
             {"p 1\n", "'p': points are left out, only faces make a surface"},
             {"vp 1\ncstype bezier\ndeg 3\ncurv 0 1 1 2\nend\n",
              "'vp': free-form curves and surfaces are left out, only faces make a surface (and 4 "
              "more)"},
             {"call a.obj\n", "'call': other files and commands are left out, only faces make a "
                              "surface"},
             {"face 1 2 3\nV 1 2 3\n",
              "'face' begins no statement of an OBJ file: left out (and 1 more)"},
             {"vn 0 0\n", "normal is not three finite numbers; normals are not used"},
             {"vn 0 0 1\nf 1//2 2//2 3//2\n",
              "normal index is 2, the file has 1: normals are not used"},
             {"f 1//-1 2 3\n",
              "normal index is -1, the file has 0 before this line: normals are not used"},
             {"v 1 2 3 0.5\n",
              "vertex has the weight 0.5: left out, only free-form surfaces have weights"},
             {"v 1 2 3 1 0 0\nv 1 2 3 0 1 0\n",
              "vertex has 6 numbers: those after the first 3, as of a colour, are left out (and 1 "
              "more)"},
             {"t hole 1/0/0 1 2\n",
              "tag 'hole' announces 1/0/0 values and has 2: the rest is left out"},
             {"t interpolateboundary 1/0/0 3\n",
              "tag 'interpolateboundary' is 3, known are 0 (none), 1 (edge and corner) and 2 (edge "
              "only): skipped"},
             {"t creasemethod 0/0/1 chalkin\n",
              "tag 'creasemethod' is 'chalkin', known are 'normal' and 'chaikin': skipped"},
             {"t smoothtriangles 1/0/0 2\n",
              "tag 'smoothtriangles' has no word, 'catmark' or 'smooth': skipped"},
             {"t facevaryinginterpolateboundary 1/0/0 1\n",
              "tag 'facevaryinginterpolateboundary' is not honoured: texture coordinates are "
              "linear "
              "in faces, as by rule 5"},
         }) {
        std::vector<std::string> told;
        ObjFile const f =
            read_obj(kCube + lines, "a.obj", [&](std::string const& w) { told.push_back(w); });
        ASSERT_EQ(f.warnings.size(), 1u) << lines;
        int const line = f.warnings[0].starts_with("a.obj:16: ") ? 16 : 15;
        EXPECT_EQ(f.warnings[0], "a.obj:" + std::to_string(line) + ": " + warning);
        EXPECT_EQ(told, f.warnings);
    }
    EXPECT_TRUE(read_obj(kCube + "g a\no b\ns off\nusemtl c\nmtllib d\nvn 0 0 1\nv 1 2 3 1\n", "a")
                    .warnings.empty());
}

TEST(ObjReader, WarningsStandBeforeTheErrorThatFollows)
{
    std::vector<std::string> told;
    EXPECT_THROW(read_obj("l 1 2\n" + kCube + "f 1 2 9\n", "a.obj",
                          [&](std::string const& w) { told.push_back(w); }),
                 FormatError);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_TRUE(told[0].starts_with("a.obj:1: "));
}

TEST(ObjReader, CreaseMethodAndSmoothTrianglesAreWords)
{
    ControlMesh const plain = read_obj(kCube, "a").mesh;
    EXPECT_EQ(plain.rules.crease_method, CreaseMethod::Normal);
    EXPECT_FALSE(plain.rules.smooth_triangles);
    ObjFile const tagged =
        read_obj(kCube + "t creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n", "a");
    EXPECT_EQ(tagged.mesh.rules.crease_method, CreaseMethod::Chaikin);
    EXPECT_TRUE(tagged.mesh.rules.smooth_triangles);
    EXPECT_TRUE(tagged.warnings.empty());
    ObjFile const last =
        read_obj(kCube + "t creasemethod 0/0/1 chaikin\nt creasemethod 0/0/1 normal\n"
                         "t smoothtriangles 0/0/1 smooth\nt smoothtriangles 0/0/1 catmark\n",
                 "a");
    EXPECT_EQ(last.mesh.rules.crease_method, CreaseMethod::Normal);
    EXPECT_FALSE(last.mesh.rules.smooth_triangles);
}

// As regression/common/far_utils.h has it.
TEST(ObjReader, TagsOfSeveralItemsHaveOneSharpnessOrOneForEach)
{
    auto const creases = [](std::string const& tag) {
        std::vector<float> sharpness;
        for (auto const& c : read_obj(kCube + tag, "a").mesh.creases)
            sharpness.insert(sharpness.end(), {float(c.a), float(c.b), c.sharpness});
        return sharpness;
    };
    EXPECT_EQ(creases("t crease 4/1/0 0 1 2 3 2.5\n"),
              (std::vector<float>{0, 1, 2.5f, 2, 3, 2.5f}));
    EXPECT_EQ(creases("t crease 4/2/0 0 1 2 3 2 3\n"), (std::vector<float>{0, 1, 2, 2, 3, 3}));
    EXPECT_EQ(creases("t crease 4/4/0 0 1 2 3 2 7 3 7\n"), (std::vector<float>{0, 1, 2, 2, 3, 3}));
    EXPECT_EQ(creases("t crease 4/3/0 0 1 2 3 2 7 3\n"), (std::vector<float>{0, 1, 2, 2, 3, 3}));
    // The last one holds; what is not sharp is none.
    EXPECT_EQ(creases("t crease 2/1/0 0 1 2\nt crease 2/1/0 1 0 3\n"),
              (std::vector<float>{1, 0, 3}));
    EXPECT_EQ(creases("t crease 2/1/0 0 1 2\nt crease 2/1/0 0 1 -1\n"), std::vector<float>{});
    EXPECT_EQ(creases("t crease 2/1/0 0 1 inf\n"), (std::vector<float>{0, 1, 10}));

    auto const corners =
        read_obj(kCube + "t corner 2/2/0 3 4 1 2\nt corner 2/1/0 5 6 4\n", "a").mesh.corners;
    ASSERT_EQ(corners.size(), 4u);
    EXPECT_EQ(corners[1].sharpness, 2);
    EXPECT_EQ(corners[3].sharpness, 4);
}

} // namespace
} // namespace tessemu
