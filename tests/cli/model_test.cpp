// The program and the files of its users: which are read, refused, warned about, cut, joined or
// moved.
//
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/mesh/builtin_models.h"
#include "tests/cli/program.h"
#include "tests/io/picture_hash.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

using test::draw_json;
using test::Result;
using test::run;
using test::scratch;

// Warnings that say why stand above the error.
TEST(Program, WarningsArePrintedBeforeTheErrorThatFollows)
{
    fs::path const cage = scratch() / "odd.obj";
    std::string const square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 2 2\nl 1 5\n";
    std::ofstream(cage) << square << "f 1 2 3\nf 1 2 4\n";
    Result r = run("draw " + cage.string() + " --scheme acc");
    EXPECT_EQ(r.status, 2);
    std::size_t const line = r.err.find("odd.obj:6: 'l'"), unused = r.err.find("vertex 5"),
                      error = r.err.find("acc draws quads only");
    EXPECT_LT(line, unused) << r.err;
    EXPECT_LT(unused, error) << r.err;
    EXPECT_NE(error, std::string::npos) << r.err;
    std::ofstream(cage) << square << "f 1 2 3 9\n";
    r = run("info " + cage.string());
    EXPECT_EQ(r.status, 2);
    EXPECT_LT(r.err.find("odd.obj:6: 'l'"), r.err.find("odd.obj:7: vertex index is 9")) << r.err;
    std::ofstream(cage) << square << "f 1 2 3 4\n";
    r = run("draw " + cage.string() + " --displace nowhere.png");
    EXPECT_LT(r.err.find("odd.obj:6: 'l'"), r.err.find("nowhere.png")) << r.err;
    EXPECT_EQ(r.err.find("odd.obj:6: 'l'"), r.err.rfind("odd.obj:6: 'l'")) << "twice: " << r.err;
}

TEST(Program, ReadsAModelFromStandardInput)
{
    fs::path const cage = scratch() / "square.obj", out = scratch() / "in.ply";
    std::ofstream(cage) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\np 1\nf 1 2 3 4\n"
                           "v 2 0 0\nv 2 1 0\nf 2 5 6 3\n"; // with an edge to check
    for (std::string const& verb :
         {std::string("draw - --size 16x16"), std::string("info -"),
          std::string("check - --tess 2"), std::string("compare -"),
          std::string("cost - --gpu gtx260"), "export - -o " + out.string()}) {
        Result const file = run(verb.substr(0, verb.find('-')) + cage.string() +
                                verb.substr(verb.find('-') + 1) + " --json -");
        Result const in = run(verb + " --json -", cage);
        ASSERT_EQ(in.status, file.status) << verb << ": " << in.err;
        EXPECT_EQ(in.err, "warning: standard input:5: 'p': points are left out, only faces make a "
                          "surface\n");
        Json a = Json::parse(file.out), b = Json::parse(in.out);
        EXPECT_EQ(b["inputs"][0]["name"], "-");
        EXPECT_EQ(a["inputs"][0]["sha256"], b["inputs"][0]["sha256"]);
        EXPECT_EQ(a["counters"], b["counters"]);
    }
    Result const bad = run("draw - --scheme pm", cage);
    EXPECT_EQ(bad.status, 2);
    EXPECT_NE(bad.err.find("standard input:6: "), std::string::npos) << bad.err;
    Result const empty = run("draw -");
    EXPECT_EQ(empty.status, 2);
    EXPECT_NE(empty.err.find("standard input: is empty"), std::string::npos) << empty.err;
}

// A built-in cage times 2^k, then moved.
fs::path cage_elsewhere(std::string const& name, int k, double by = 0)
{
    fs::path const path = scratch() / (name + ".obj");
    std::ofstream out(path);
    for (BuiltinModel const& m : builtin_models()) {
        if (m.name != name) continue;
        std::istringstream in{std::string(m.obj)};
        std::string line;
        while (std::getline(in, line)) {
            double x = 0, y = 0, z = 0;
            if (std::sscanf(line.c_str(), "v %lf %lf %lf", &x, &y, &z) == 3) {
                char text[120];
                std::snprintf(text, sizeof text, "v %.17g %.17g %.17g", std::ldexp(x, k) + by,
                              std::ldexp(y, k) - by, std::ldexp(z, k) + by / 2);
                line = text;
            }
            out << line << "\n";
        }
    }
    return path;
}

TEST(Program, ACageTimes2To40GivesTheSamePictureAndVerdicts)
{
    fs::path const picture = scratch() / "scaled.png";
    for (std::string const name : {"jug", "golem"}) {
        std::string expected_picture, expected_verdicts;
        for (int k : {0, -40, 40}) {
            std::string const cage = cage_elsewhere(name, k).string();
            std::string const draw = "draw " + cage +
                                     " --size 96x64 --displace studs --tess-edge pixels=8 "
                                     "--animate sway -o " +
                                     picture.string();
            ASSERT_EQ(run(draw).status, 0) << draw;
            std::string const drawn = test::read_text(picture);
            Result const check = run("check " + cage + " --size 96x64 --rays 2000 --json -");
            ASSERT_EQ(check.status, 0) << check.err;
            std::string const verdicts = Json::parse(check.out)["verdicts"].dump();
            if (k == 0) expected_picture = drawn, expected_verdicts = verdicts;
            EXPECT_EQ(drawn, expected_picture) << name << " times 2^" << k;
            EXPECT_EQ(verdicts, expected_verdicts) << name << " times 2^" << k;
        }
    }
}

TEST(Program, ACageFarFromTheOriginGivesTheSameVerdicts)
{
    auto const verdicts = [](std::string const& model) {
        Json const j =
            Json::parse(run("check " + model + " --size 96x64 --rays 2000 --json -").out);
        std::string out;
        for (auto const& [name, v] : j["verdicts"].items())
            out += name + " " + v["verdict"].get<std::string>() + " " +
                   std::to_string(v.value("checked", 0)) + ", ";
        EXPECT_EQ(j["warnings"].size(), 0u) << j["warnings"];
        // The samples that a picture covers turn with its rounding.
        return out.substr(0, out.find("coverage")) + out.substr(out.find("raycast"));
    };
    for (std::string const name : {"jug", "golem"})
        for (double by : {1e5, 1e7, 1e12})
            EXPECT_EQ(verdicts(cage_elsewhere(name, 0, by).string()), verdicts(name)) << by;
}

TEST(Program, PositionsOfAMovedCageAreTheFiles)
{
    fs::path const cage = scratch() / "utm.obj", out = scratch() / "utm_out.obj",
                   ply = scratch() / "utm_out.ply";
    std::ofstream(cage) << "v 486997.88 4684678.68 507.99\nv 487007.88 4684678.68 507.99\n"
                           "v 487007.88 4684688.68 517.99\nv 486997.88 4684688.68 507.99\n"
                           "f 1 2 3 4\n";
    ASSERT_EQ(run("export " + cage.string() + " --tess 1 -o " + out.string()).err, "");
    std::istringstream lines(test::read_text(out));
    std::vector<double> x;
    for (std::string word; lines >> word;)
        if (word == "v")
            for (int k = 0; k < 3; ++k) lines >> x.emplace_back();
    ASSERT_EQ(x.size(), 12u);
    // Single precision keeps 10 m to 2^-20 m, doubles so far off to 2^-30.
    double const expected[2][3] = {{486997.88, 4684678.68, 507.99},
                                   {487007.88, 4684688.68, 517.99}};
    for (auto const& p : expected) {
        double nearest = 1;
        for (std::size_t v = 0; v < 4; ++v) {
            double d = 0;
            for (std::size_t k = 0; k < 3; ++k) d = std::max(d, std::abs(x[3 * v + k] - p[k]));
            nearest = std::min(nearest, d);
        }
        EXPECT_LT(nearest, 2e-6);
    }
    ASSERT_EQ(run("export " + cage.string() + " --tess 1 -o " + ply.string()).status, 0);
    std::string const bytes = test::read_text(ply);
    EXPECT_NE(bytes.find("property double x\nproperty double y\nproperty double z\n"
                         "property float nx"),
              std::string::npos);
    std::size_t const header = bytes.find("end_header\n") + 11;
    EXPECT_EQ(bytes.size(), header + 4 * (3 * 8 + 6 * 4) + 2 * 13);

    // A camera is read and told in the file's frame, as are other lengths.
    Json const j =
        draw_json(cage.string() + " --size 32x32 --camera "
                                  "eye=487002.5,4684683.5,540:target=487002.5,4684683.25,508");
    EXPECT_EQ(j["config"]["camera_eye"], Json({487002.5, 4684683.5, 540.0}));
    EXPECT_EQ(j["config"]["camera_target"], Json({487002.5, 4684683.25, 508.0}));
    EXPECT_GT(j["counters"]["PSInvocations"], 100);
}

TEST(Program, LengthsOfAScaledCageAreTheFiles)
{
    std::string const cage = cage_elsewhere("golem", -40).string();
    std::string const eye = "--camera eye=1,2,9:target=0,1,0 --size 48x48 ";
    auto const times = [](double x) {
        char text[40];
        std::snprintf(text, sizeof text, "%.17g", std::ldexp(x, -40));
        return std::string(text);
    };
    Json const home = draw_json("golem " + eye +
                                "--tess-edge distance=2 --displace studs "
                                "--displace-scale 0.125");
    Json const away = draw_json(cage + " --camera eye=" + times(1) + "," + times(2) + "," +
                                times(9) + ":target=0," + times(1) + ",0 --size 48x48 " +
                                "--tess-edge distance=" + times(2) +
                                " --displace studs --displace-scale " + times(0.125));
    EXPECT_EQ(home["counters"], away["counters"]);
    EXPECT_EQ(away["config"]["displace_scale"], std::ldexp(0.125, -40));
    EXPECT_EQ(away["config"]["camera_eye"][2], std::ldexp(9.0, -40));
    auto const errors = [](std::string const& model) {
        return Json::parse(run("compare " + model + " --level 2 --json -").out);
    };
    Json const a = errors("golem"), b = errors(cage);
    EXPECT_EQ(a["errors"], b["errors"]);
    EXPECT_EQ(b["diagonal"], std::ldexp(a["diagonal"].get<double>(), -40));
}

TEST(Program, WarnsWhereTheFilesOwnDigitsLoseAnEdge)
{
    fs::path const cage = scratch() / "digits.obj";
    auto const err = [&](std::string const& left, std::string const& right) {
        std::ofstream(cage) << "v " + left + " 0 0\nv " + right + " 0 0\nv " + right + " 1 0\nv " +
                                   left + " 1 0\nf 1 2 3 4\n";
        return run("info " + cage.string()).err;
    };
    std::string const lost = err("4e+06", "4.00001e+06");
    EXPECT_NE(lost.find("digits.obj:2: so far from the origin the file's coordinates are good to "
                        "5, 500 % of the edge between vertices 2 and 3"),
              std::string::npos)
        << lost;
    EXPECT_EQ(err("4000000", "4000001"), "");
    EXPECT_EQ(err("4000000.00", "4000001.00"), "");
    std::ofstream(cage) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n"; // exact where it stands
    EXPECT_EQ(run("info " + cage.string()).err, "");
}

TEST(Program, ACageWithoutExtentIsRefused)
{
    fs::path const cage = scratch() / "point.obj";
    std::ofstream(cage) << "v 1 2 3\nv 1 2 3\nv 1 2 3\nv 0 0 0\nf 1 2 3\n";
    Result const r = run("draw " + cage.string());
    EXPECT_EQ(r.status, 2);
    EXPECT_NE(r.err.find("point.obj: all vertices of all faces are at one point"),
              std::string::npos)
        << r.err;
}

TEST(Program, SubdividesTheMeshBeforeAnyScheme)
{
    std::string const mesh = (scratch() / "m.ply").string();
    for (std::string const& verb :
         {std::string("draw golem --size 16x16"), "export golem --tess 1 -o " + mesh,
          std::string("check golem --size 16x16 --tess 2 --rays 0"),
          std::string("compare golem --level 1"), std::string("cost golem --size 16x16"),
          std::string("info golem")}) {
        Result const plain = run(verb + " --json -"), finer = run(verb + " --subdivide 1 --json -");
        ASSERT_EQ(plain.status, 0) << plain.err;
        ASSERT_EQ(finer.status, 0) << finer.err;
        Json const a = Json::parse(plain.out), b = Json::parse(finer.out);
        EXPECT_EQ(a["config"]["subdivide"], 0) << verb;
        EXPECT_EQ(b["config"]["subdivide"], 1) << verb;
        EXPECT_NE(a["hash"], b["hash"]) << verb;
        if (a.contains("counters")) {
            int const patches = a["counters"]["HSInvocations"];
            EXPECT_EQ(patches, 70) << verb;
            EXPECT_EQ(b["counters"]["HSInvocations"], 4 * patches) << verb;
        }
    }
    // The file's figures, and the patches of what is drawn.
    Json const info = Json::parse(run("info golem --subdivide 2 --json -").out);
    EXPECT_EQ(info["mesh"]["faces"], 70);
    int patches = 0;
    for (Json const& p : info["patches"]) patches += p["patches"].get<int>();
    EXPECT_EQ(patches, 16 * 70);
    // The automatic camera is that of the file's mesh.
    Json const a = draw_json("golem --size 16x16"),
               b = draw_json("golem --size 16x16 --subdivide 1");
    for (char const* name : {"camera_eye", "camera_target", "camera_focal"})
        EXPECT_EQ(a["config"][name], b["config"][name]) << name;
}

TEST(Program, InfoCountsTypesOfCornerValencesWhereTablesAreByType)
{
    Json const info = Json::parse(run("info golem --subdivide 1 --json -").out);
    for (Json const& kind : info["patches"]) {
        int patches = 0;
        for (Json const& type : kind["valence_types"]) {
            patches += type["patches"].get<int>();
            int regular = 0;
            for (int n : type["valences"]) regular += n == 4;
            EXPECT_GE(regular, 3) << type;
        }
        EXPECT_EQ(patches, kind["patches"]) << kind["kind"]; // closed quads: all have a type
    }
    std::string const text = run("info golem --subdivide 1").out;
    EXPECT_NE(text.find("of LOOP10's 449, "), std::string::npos) << text;
    Json const other = Json::parse(run("info golem --scheme pm --json -").out);
    EXPECT_FALSE(other["patches"][0].contains("valence_types"));
}

TEST(Program, TheValenceViewPrintsTheColorsThatOccur)
{
    Result const r = run("draw golem --subdivide 1 --view valence --size 32x32");
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(r.out.find("regular     grey          128 patches\n"
                         "valence 3   green          72 patches\n"
                         "valence 5   red            80 patches\n\n"),
              0u)
        << r.out;
    Result const refused = run("draw golem --view valence --direct3d 10 --size 32x32");
    EXPECT_EQ(refused.status, 2);
    EXPECT_NE(refused.err.find("valence"), std::string::npos) << refused.err;
}

// Of an animation one range serves all frames.
TEST(Program, TheCurvatureViewPrintsItsRangeInTheFilesUnits)
{
    std::string const options = " --scheme stam --size 32x32 --view curvature";
    Json const home = draw_json("golem" + options);
    double const range = home["config"]["curvature_max"];
    for (int k : {-40, 40}) {
        std::string const cage = cage_elsewhere("golem", k).string();
        Json const away = draw_json(cage + options);
        EXPECT_EQ(away["config"]["curvature_max"], std::ldexp(range, -k)) << k;
        char given[60];
        std::snprintf(given, sizeof given, " --curvature-max %.17g", std::ldexp(2, -k));
        EXPECT_EQ(draw_json(cage + options + given)["config"]["curvature_max"], std::ldexp(2, -k));
    }
    Result const closed = run("draw golem" + options + " --curvature-max 2.5");
    EXPECT_EQ(closed.out.find("mean curvature, 1/unit of length: blue -2.5 and below, white 0, red "
                              "2.5 and above\n\n"),
              0u)
        << closed.out;
    Result const open = run("draw jug" + options);
    EXPECT_NE(open.out.find("\n64 patches without second derivatives: grey\n\n"), std::string::npos)
        << open.out;
    double const moving =
        draw_json("golem" + options + " --animate sway --frames 4")["config"]["curvature_max"];
    for (char const* phase : {"0", "0.25", "0.5", "0.75"})
        EXPECT_GE(moving, draw_json("golem" + options + " --animate sway --phase " +
                                    phase)["config"]["curvature_max"]);
}

TEST(Program, MatricesMadeAheadChangeNothingThatIsDrawnOrCounted)
{
    Json const a = draw_json("golem --subdivide 1 --size 64x64 --tess 3"),
               b = draw_json("golem --subdivide 1 --size 64x64 --tess 3 --set matrices=ahead");
    EXPECT_EQ(a["config"]["matrices"], "demand");
    EXPECT_EQ(b["config"]["matrices"], "ahead");
    EXPECT_EQ(a["counters"], b["counters"]);
    EXPECT_EQ(a["stages"], b["stages"]);
    EXPECT_EQ(a["commands"], b["commands"]);
}

TEST(Program, MeshErrorsNameTheLineOfTheFilesFace)
{
    fs::path const cage = scratch() / "open.obj"; // face 2 is inside, the others touch the boundary
    std::ofstream(cage) << "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n"
                           "f 1 2 5 4\nf 2 3 6 5\n";
    for (char const* steps : {"0", "1", "3"}) {
        Result const r = run("draw " + cage.string() + " --scheme pm --subdivide " + steps);
        EXPECT_EQ(r.status, 2);
        EXPECT_NE(r.err.find("open.obj:7: pm draws closed meshes only"), std::string::npos)
            << r.err;
    }
}

// A cube with a fin on edge 1-2, a face that repeats a vertex, one of two vertices, a loose vertex.
TEST(Program, FacesOfAnyKindAreDrawnWithWarningsThatCountThem)
{
    fs::path const cage = scratch() / "fin.obj";
    std::ofstream(cage)
        << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
           "v 0 -1 0\nv 1 -1 0\nv 5 5 5\n"
           "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 7 3\nf 2 4 8 6\n"
           "f 1 2 10 9\nf 9 10\n";
    fs::path const out = scratch() / "fin.ply";
    Result const r = run("export " + cage.string() + " -o " + out.string());
    EXPECT_EQ(r.status, 0);
    EXPECT_TRUE(fs::exists(out));
    for (char const* warning :
         {"fin.obj:16: face 5 names a vertex twice in a row and loses the repetition\n",
          "fin.obj:19: face 8 has fewer than three different vertices, or names one twice, not in "
          "a "
          "row: left out\n",
          "fin.obj:11: vertex 11 is in no face: left out\n",
          "fin.obj:1: an edge at vertex 1 has more than two faces",
          "fin.obj:1: 2 vertices have several fans of faces: each gets a copy of them; the first "
          "is "
          "vertex 1\n"})
        EXPECT_NE(r.err.find(warning), std::string::npos) << warning << r.err;
    Json const check = Json::parse(run("check " + cage.string() + " --json -").out);
    Json const& verdicts = check["verdicts"];
    for (char const* name : {"topology", "position", "normal"}) {
        EXPECT_EQ(verdicts[name]["verdict"], "pass") << name;
        auto const reason = verdicts[name]["reason"].get<std::string>();
        EXPECT_EQ(reason.find("1 cut edge is not compared"), 0u) << name << ": " << reason;
    }
    EXPECT_EQ(verdicts["coverage"]["verdict"], "skipped");
    Result const strict = run("export " + cage.string() + " --strict -o " + out.string());
    EXPECT_EQ(strict.status, 2);
    EXPECT_NE(strict.err.find("fin.obj:19: face 8 has 2 vertices, at least 3 are needed"),
              std::string::npos)
        << strict.err;
}

// What no scheme draws can still be looked at.
TEST(Program, TheCageViewNeedsNoPatches)
{
    fs::path const fan = scratch() / "fan.obj", open = scratch() / "fan.png"; // 40 triangles
    std::string text = "v 0 0 1\n", faces;
    for (int i = 0; i < 40; ++i) {
        double const t = i * 0.157;
        text += "v " + std::to_string(std::cos(t)) + " " + std::to_string(std::sin(t)) + " 0\n";
        faces += "f 1 " + std::to_string(2 + i) + " " + std::to_string(2 + (i + 1) % 40) + "\n";
    }
    std::ofstream(fan) << text << faces;
    std::string const draw =
        "draw " + fan.string() + " --scheme pm --size 64x64 -o " + open.string();
    EXPECT_EQ(run(draw).status, 2); // an open mesh, and beyond the limits of others
    fs::remove(open);
    Result const cage = run(draw + " --view cage");
    EXPECT_EQ(cage.status, 0) << cage.err;
    EXPECT_TRUE(fs::exists(open));
    // What a scheme takes is shown as it is refined for it.
    EXPECT_EQ(draw_json("jug --view cage --size 64x64")["counters"],
              draw_json("jug --view cage --size 64x64 --scheme pm")["counters"]);
}

// A cube whose faces have their own vertices, as modelling programs write hard edges.
std::string cube_of_24_vertices()
{
    static constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    std::string text;
    for (auto const& f : kFaces)
        for (int v : f)
            text += "v " + std::to_string(v & 1) + " " + std::to_string(v >> 1 & 1) + " " +
                    std::to_string(v >> 2) + "\n";
    return text + "f 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\nf 13 14 15 16\nf 17 18 19 20\n"
                  "f 21 22 23 24\n";
}

TEST(Program, CheckSaysThatNothingWasCheckedAndJoinsVertices)
{
    fs::path const cube = scratch() / "cube24.obj";
    std::ofstream(cube) << cube_of_24_vertices();
    std::string const check = "check " + cube.string() + " --size 64x64 --rays 500 ";
    Result const open = run(check + "--json -");
    EXPECT_EQ(open.status, 2);
    EXPECT_NE(open.err.find("cube24.obj: nothing was checked: 24 open edges lie on others with "
                            "other vertices: --join DISTANCE"),
              std::string::npos)
        << open.err;
    Json const j = Json::parse(open.out);
    for (auto const& [name, verdict] : j["verdicts"].items())
        EXPECT_EQ(verdict["verdict"], "skipped") << name;
    EXPECT_FALSE(j["config"].contains("join"));
    EXPECT_NE(j["warnings"].dump().find("--join 0"), std::string::npos);

    for (char const* distance : {"0", "1e-6"}) {
        Result const joined = run(check + "--json - --join " + distance);
        EXPECT_EQ(joined.status, 0) << joined.err;
        EXPECT_NE(joined.err.find("16 vertices are joined"), std::string::npos) << joined.err;
        Json const closed = Json::parse(joined.out);
        EXPECT_EQ(closed["verdicts"]["coverage"]["verdict"], "pass");
        EXPECT_EQ(closed["config"]["join"], std::stod(distance));
    }
    // For all verbs.
    for (std::string const verb : {"info ", "draw --size 32x32 ", "cost ", "compare --level 1 "}) {
        Result const r = run(verb + cube.string() + " --join 0 --json -");
        EXPECT_EQ(r.status, 0) << verb << r.err;
        EXPECT_EQ(Json::parse(r.out)["config"]["join"], 0) << verb;
        EXPECT_NE(r.err.find("16 vertices are joined"), std::string::npos) << verb << r.err;
    }
    Json const info = Json::parse(run("info " + cube.string() + " --join 0 --json -").out)["mesh"];
    EXPECT_EQ(info["vertices"], 8);
    EXPECT_EQ(info["boundary_edges"], 0);
}

// Joined, and cut along an edge of three faces: done and told once.
TEST(Program, InfoJoinsAndCutsAsCheckDoes)
{
    fs::path const path = scratch() / "cube_with_a_fin.obj";
    std::ofstream(path) << "v 5 5 5\n" + cube_of_24_vertices() + "v 0 0 9\nf -25 -24 -1\n";
    std::string const rest = path.string() + " --join 0 --json - ";
    Result const info = run("info " + rest), check = run("check --size 32x32 --rays 0 " + rest);
    Json const i = Json::parse(info.out), c = Json::parse(check.out);
    EXPECT_EQ(i["warnings"], c["warnings"]) << i["warnings"] << c["warnings"];
    EXPECT_GE(i["warnings"].size(), 3u) << i["warnings"];
    EXPECT_EQ(i["mesh"]["faces"], 7);
    EXPECT_EQ(i["mesh"]["unused_vertices"], 1);
    EXPECT_EQ(info.err, check.err.substr(0, info.err.size()));
}

TEST(Program, BreakFaceCountsTheFilesFaces)
{
    fs::path const cube = scratch() / "with_a_line.obj";
    std::string text = cube_of_24_vertices();
    text.insert(text.find("f 1 2 3 4"), "f 1 2 1\n");
    std::ofstream(cube) << text;
    std::string const check =
        "check " + cube.string() + " --size 64x64 --rays 500 --join 0 --break fold --break-face ";
    Result const r = run(check + "7 --json -");
    EXPECT_EQ(r.status, 1) << r.err;
    EXPECT_EQ(Json::parse(r.out)["config"]["break_face"], 7);
    EXPECT_EQ(run(check + "1").status, 2);
}

TEST(Program, CheckExitsTwoWhereAPlantedMistakeIsNotFound)
{
    for (auto const& [arguments, why] : std::vector<std::pair<std::string, std::string>>{
             {"jug --break fold", "coverage and raycast are skipped, the surface is open"},
             {"jug --break topleft", "coverage is skipped, the surface is open"},
             {"golem --tess 1 --break order", "the same bits"}}) {
        Result const r = run("check " + arguments + " --rays 500 --size 64x64");
        EXPECT_EQ(r.status, 2) << arguments;
        EXPECT_NE(r.err.find(why), std::string::npos) << r.err;
        EXPECT_NE(r.out.find("position"), std::string::npos) << "verdicts are given";
    }
}

TEST(Program, InfoSchemesAndModelsList)
{
    Result const info = run("info jug");
    EXPECT_EQ(info.status, 0);
    EXPECT_NE(info.out.find("Gregory triangle"), std::string::npos);
    Result const schemes = run("schemes");
    EXPECT_EQ(schemes.status, 0);
    for (char const* words :
         {"gregory-stencil\n", "LOOP09 section 3, 4.3",
          "takes quads and triangles, larger faces after 1 step of subdivision, closed meshes only",
          "--set lambda=1  0 to 16: "})
        EXPECT_NE(schemes.out.find(words), std::string::npos) << words;
    EXPECT_NE(run("models").out.find("jug"), std::string::npos);
    EXPECT_EQ(Json::parse(run("info spindle --json -").out)["mesh"]["boundary_edges"], 0);
}

// expected.tsv: file, outcome, class, check, ...
TEST(Program, BadFilesBehaveAsTheTableSays)
{
    TESSEMU_NEEDS_SHARED("models/bad/expected.tsv");
    std::istringstream table(test::read_text(test::shared("models/bad/expected.tsv")));
    std::string line;
    std::size_t files = 0;
    while (std::getline(table, line)) {
        if (line.starts_with("#") || line.starts_with("file\t")) continue;
        std::istringstream row(line);
        std::string file, outcome, group, check;
        std::getline(row, file, '\t'), std::getline(row, outcome, '\t'),
            std::getline(row, group, '\t');
        std::getline(row, check, '\t');
        std::string const path = test::shared("models/bad/" + file).string();
        fs::path const mesh = scratch() / "bad.obj";
        fs::remove(mesh);
        Result const r = run("export " + path + " --tess 3 -o " + mesh.string());
        ++files;
        ASSERT_TRUE(r.status == 0 || r.status == 2) << file << " " << r.status;
        bool const rejected = r.status == 2;
        if (outcome == "accept") {
            EXPECT_FALSE(rejected) << file << ": " << r.err;
        } else if (outcome == "reject") {
            EXPECT_TRUE(rejected) << file;
        } else if (outcome == "not-silent") {
            EXPECT_TRUE(rejected || r.err.find("warning:") != std::string::npos) << file;
        }
        if (rejected) {
            EXPECT_FALSE(fs::exists(mesh)) << file;
            EXPECT_NE(r.err.find(file), std::string::npos) << file << ": " << r.err;
        } else {
            std::string const text = test::read_text(mesh);
            EXPECT_EQ(text.find("nan"), std::string::npos) << file;
            EXPECT_EQ(text.find("inf"), std::string::npos) << file;
            if (check.starts_with("V=")) {
                int v = 0, f = 0;
                std::sscanf(check.c_str(), "V=%d F=%d", &v, &f);
                Json const info = Json::parse(run("info " + path + " --json -").out)["mesh"];
                EXPECT_EQ(info["vertices"], v) << file;
                EXPECT_EQ(info["faces"], f) << file;
            }
        }
    }
    EXPECT_EQ(files, 30u);
}

} // namespace
} // namespace tessemu
