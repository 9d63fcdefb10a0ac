// The program as its users run it: exit statuses, messages, files, JSON.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/machine.h"
#include "pipeline/mesh/builtin_models.h"
#include "tests/cli/program.h"
#include "tests/io/picture_hash.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

using test::Result;
using test::run;
using test::scratch;

Json draw_json(std::string const& arguments)
{
    Result const r = run("draw " + arguments + " --json -");
    EXPECT_EQ(r.status, 0) << r.err;
    return Json::parse(r.out);
}

// Options that must change no result.
std::string const kFewest = " -j 1 --lanes " + std::to_string(*std::begin(kBuiltLanes)) + " ",
                  kMost = " -j 3 --lanes " + std::to_string(*std::rbegin(kBuiltLanes)) + " ";

// The picture_hash of a picture below is that of version 0.1.0, made by the command above it.

TEST(Program, HelpAndVersionExitZeroOnEachVerb)
{
    EXPECT_EQ(run("--help").status, 0);
    EXPECT_EQ(run("--version").status, 0);
    for (char const* verb : {"draw", "export", "tessellate", "compare", "check", "cost",
                             "reproduce", "diff", "info", "schemes", "models"}) {
        Result const help = run(std::string(verb) + " --help");
        EXPECT_EQ(help.status, 0) << verb;
        EXPECT_NE(help.out.find("Examples:"), std::string::npos) << verb;
        Result const version = run(std::string(verb) + " --version");
        EXPECT_EQ(version.status, 0) << verb;
        EXPECT_EQ(version.out.find("tessemu "), 0u) << verb;
    }
}

TEST(Program, AVerbWithoutItsArgumentPrintsHelpAndExitsTwo)
{
    for (char const* verb : {"", "draw", "export", "tessellate", "compare", "check", "cost",
                             "reproduce", "diff", "info"}) {
        Result const r = run(verb);
        EXPECT_EQ(r.status, 2) << verb;
        EXPECT_TRUE(r.out.empty()) << verb;
        std::string const usage = std::string("Usage: tessemu ") + verb;
        EXPECT_NE(r.err.find(usage), std::string::npos) << r.err;
    }
}

TEST(Program, BadUsageExitsTwoWithOneLineThatNamesTheValue)
{
    for (auto const& [arguments, word] : std::vector<std::pair<std::string, std::string>>{
             {"draw nowhere.obj", "nowhere.obj"},
             {"draw jug --tess 65", "65"},
             {"draw jug --tess 0", "--tess"},
             {"draw jug --tess nan", "--tess"},
             {"draw jug --scheme bezier", "gregory-stencil"},
             {"draw jug --size 0x4", "--size"},
             {"draw jug --size 99999x4", "16384"},
             {"draw jug --view wires", "wire"},
             {"draw jug --lanes 5", "--lanes is 5, it must be 4, 8 or 16"},
             {"draw jug --lanes many", "--lanes: 'many' is not a whole number"},
             {"draw jug --camera eye=1,2", "--camera"},
             {"draw jug --contraction mixed:x", "mixed"},
             {"draw jug --vertex-cache fifo:0", "fifo:0"},
             {"draw jug --set sigma=2", "sigma"},
             {"draw jug --set lambda", "NAME=VALUE"},
             {"draw jug --set lambda=17", "from 0 to 16"},
             {"draw jug --set lambda=long", "a number"},
             {"info jug --set sigma=2", "sigma"},
             {"draw jug --set lambda=1 --set r=1 --set lambda=2", "'lambda' is set more than once"},
             {"draw jug --subdivide 7", "--subdivide is 7, it must be 0 to 6"},
             {"info jug --subdivide -1", "0 to 6"},
             {"draw jug --tess-edge pixel=3", "pixels=P"},
             {"draw jug --tess-edge pixels=0", "above 0"},
             {"draw jug --displace nowhere.png", "nowhere.png"},
             {"draw jug --displace-scale 1", "--displace"},
             {"draw jug --animate walk", "sway"},
             {"draw jug --frames 3", "--animate"},
             {"draw jug --animate sway --frames 0", "--frames"},
             {"draw jug --direct3d 9", "--direct3d is '9', it must be 10 or 11"},
             {"draw jug --samples 3", "1, 2, 4 or 8"},
             {"draw jug --cull left", "none, back or front"},
             {"draw jug --direct3d 10 --tess-edge pixels=8", "adaptive"},
             {"draw jug --scheme acc", "triangles"},
             {"draw jug --scheme pm", "closed meshes only"},
             {"compare jug --level 7", "--level is 7, it must be 1 to 6"},
             {"reproduce table9", "loop09-table3"},
             {"reproduce loop09-figure2", "loop09-figure12"},
             {"reproduce loop09-table2 --models nowhere", "nowhere/monsterfrog.obj"},
             {"reproduce loop09-table1 -o a.png", "figures"},
             {"reproduce loop09-figure3 --json -", "picture"},
             {"reproduce loop09-table1 --level 2", "no level"},
             {"cost jug --gpu nowhere", "gtx260"},
             {"check golem --rays -1", "0 to 1000000000"},
             {"check golem --break glass", "topleft"},
             {"check golem --break fold --break-face 71", "--break-face is 71, it must be 1 to 70"},
             {"check golem --break fold --break-face 0", "--break-face is 0, it must be 1 to 70"},
             {"check golem --break fold --break-face -3", "--break-face is -3, it must be 1 to 70"},
             {"check golem --break-face 3", "--break-face needs --break"},
             {"check jug --join -1", "--join is -1, it must be 0 or more"},
             {"draw jug --join nan", "--join: 'nan' is not a number"},
             {"info jug --join -inf", "--join: '-inf' is not a number"},
             {"info jug --join 1e6", "the shortest edge is "},
             {"check golem --break fold --direct3d 10", "tessellator"},
             {"check golem --break weights --scheme pm", "stencil form"},
             {"check golem --break-face 3", "--break-face needs --break"},
             {"draw jug --level 3", "--level needs --view error"},
             {"draw jug --view cage --level 3", "--level needs --view error"},
             {"draw jug --error-max auto", "--error-max needs --view error"},
             {"draw jug --view error --error-max 1", "POSITION,ANGLE"},
             {"draw jug --view error --error-max 0,1", "above 0"},
             {"draw spindle --view error", "needs quads"},
             {"draw jug --view error --displace studs", "--displace"},
             {"reproduce loop09-table3 --models nowhere", "nowhere/monsterfrog.obj"},
             {"diff nowhere.json nowhere.json", "nowhere.json"},
             {"draw jug -o picture.bmp", ".bmp"},
             {"draw jug -o missing/folder/a.png", "missing/folder"},
             {"draw jug -j -1", "-1"},
             {"draw jug --no-such-option", "--no-such-option"},
             {"draw jug -inf", "expected: -inf"},
             {"frobnicate", "frobnicate"},
             {"export jug -o mesh.stl", ".stl"},
             {"tessellate --factors 1 2 3", "6 are needed"},
             {"tessellate --batch cases.txt --domain tri", "--domain"},
             {"tessellate --domain cube --factors 1 2 3", "cube"}}) {
        Result const r = run(arguments);
        EXPECT_EQ(r.status, 2) << arguments;
        EXPECT_NE(r.err.find(word), std::string::npos) << arguments << ": " << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << arguments << ": " << r.err;
        EXPECT_TRUE(r.out.empty()) << arguments;
    }
}

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
    auto const err = [&](std::string const& digits) {
        std::ofstream(cage) << "v 4000000" + digits + " 0 0\nv 4000001" + digits +
                                   " 0 0\nv 4000001" + digits + " 1 0\nv 4000000" + digits +
                                   " 1 0\nf 1 2 3 4\n";
        return run("info " + cage.string()).err;
    };
    EXPECT_NE(
        err(".00").find("digits.obj:1: so far from the origin the file's coordinates are good "
                        "to 0.005, 0.5 % of the edge between vertices 1 and 2"),
        std::string::npos)
        << err(".00");
    EXPECT_EQ(err(".000"), "");
    EXPECT_EQ(err(".000000000"), "");
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

TEST(Program, CamerasShowSomethingOrAreRefused)
{
    for (std::string const camera :
         {"eye=0,1,9:target=0,1,0:up=0,0,1", "eye=0,9,0:target=0,1,0:up=0,-1,0",
          "eye=9,1,0:target=0,1,0:up=1,0,0", "from=1e-300,0,1e-300", "from=0,1e30,0",
          "eye=0,1,9:target=0,1,0:up=1e-300,1e-300,0"})
        EXPECT_GT(draw_json("golem --size 64x64 --camera " + camera)["counters"]["PSInvocations"],
                  99)
            << camera;
    for (auto const& [camera, word] : std::vector<std::pair<std::string, std::string>>{
             {"up=0,0,0", "up=0,0,0 is no direction"},
             {"from=0,0,0", "from=0,0,0 is no direction"},
             {"eye=1,1,1:target=1,1,1", "the same point"},
             {"eye=1e39,0,0", "too far off"},
             {"target=0,1e300,0", "too far off"},
             {"focal=1e-50", "focal"},
             {"focal=1e300", "focal"},
             {"focal=1e-9", "no pixel is covered"},
             {"eye=0,0,99:target=0,0,100", "no pixel is covered"}}) {
        fs::path const picture = scratch() / "unseen.png";
        Result const r =
            run("draw golem --size 64x64 --camera " + camera + " -o " + picture.string());
        EXPECT_EQ(r.status, 2) << camera;
        EXPECT_NE(r.err.find("--camera"), std::string::npos) << camera << r.err;
        EXPECT_NE(r.err.find(word), std::string::npos) << camera << r.err;
        EXPECT_FALSE(fs::exists(picture));
    }
}

TEST(Program, AutomaticFramingIsTheSameForBothSignsOfADisplacement)
{
    auto const eye = [](std::string const& scale) {
        return draw_json("golem --size 32x32 --displace studs --displace-scale " +
                         scale)["config"]["camera_eye"];
    };
    EXPECT_EQ(eye("-2"), eye("2"));
    EXPECT_NE(eye("-2"), eye("0"));
}

TEST(Program, LanesThatTheBuildLacksNameItsOption)
{
    for (int lanes : {4, 8, 16}) {
        Result const r = run("draw jug --size 16x16 --lanes " + std::to_string(lanes));
        if (std::find(std::begin(kBuiltLanes), std::end(kBuiltLanes), lanes) !=
            std::end(kBuiltLanes)) {
            EXPECT_EQ(r.status, 0) << r.err;
        } else {
            EXPECT_EQ(r.status, 2);
            EXPECT_NE(r.err.find("TESSEMU_ALL_LANES"), std::string::npos) << r.err;
        }
    }
}

TEST(Program, DrawWritesPictureTableAndJson)
{
    fs::path const picture = scratch() / "jug.png", json = scratch() / "jug.json";
    Result const r =
        run("draw jug --size 64x48 -o " + picture.string() + " --json " + json.string());
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(r.err.empty()) << r.err;
    EXPECT_NE(r.out.find("domain_shader"), std::string::npos);
    EXPECT_EQ(test::picture_hash(picture), "33c1ed2ba374e94d");
    Json const j = Json::parse(test::read_text(json));
    EXPECT_EQ(j["schema"], "tessemu.draw/1");
    EXPECT_EQ(j["hash"].get<std::string>().size(), 64u);
    EXPECT_EQ(j["inputs"][0]["name"], "jug");
    auto const& c = j["counters"];
    EXPECT_EQ(c["HSInvocations"], c["IAPrimitives"]);
    EXPECT_EQ(c["HSControlPointInvocations"].get<int>() > 15 * c["HSInvocations"].get<int>(), true);
    EXPECT_EQ(j["stages"]["domain_shader"]["invocations"], c["DSInvocations"]);
    EXPECT_EQ(j.dump().find(scratch().string()), std::string::npos) << "a path in the result";
}

TEST(Program, DisplacesByAnImageOnTextureCoordinates)
{
    fs::path const cage = scratch() / "square.obj", map = scratch() / "map.exr";
    std::ofstream(cage) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                           "f 1/1 2/2 3/3 4/4\n";
    ASSERT_EQ(run("draw jug --size 64x64 -o " + map.string()).status, 0);
    Json const flat = draw_json(cage.string() + " --size 64x64");
    Json const bumpy = draw_json(cage.string() + " --size 64x64 --displace " + map.string() +
                                 " --displace-scale .2");
    EXPECT_NE(flat["hash"], bumpy["hash"]);
    EXPECT_EQ(bumpy["config"]["displace"], "map.exr");
    EXPECT_EQ(bumpy["config"]["displace_scale"], 0.2f);
    EXPECT_EQ(bumpy["inputs"][1]["name"], "map.exr");
    Result const r = run("draw spindle --displace " + map.string());
    EXPECT_EQ(r.status, 2);
    EXPECT_NE(r.err.find("texture coordinates"), std::string::npos) << r.err;
}

// "none" and "studs" are words, whatever files there are.
TEST(Program, ADisplacementIsAnInputOnlyWhereItIsAnImage)
{
    fs::path const empty = scratch() / "no_files", folder = scratch() / "files";
    fs::create_directories(empty);
    fs::create_directories(folder);
    for (char const* name : {"none", "studs"}) std::ofstream(folder / name) << "no image";
    auto const draw_in = [](fs::path const& where, std::string const& options) {
        fs::path const json = scratch() / "in.json";
        std::string const command = "cd " + where.string() + " && " + TESSEMU_PROGRAM +
                                    " draw jug --size 16x16 " + options + " --json " +
                                    json.string() + " >/dev/null";
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
        return Json::parse(test::read_text(json));
    };
    for (char const* options : {"", "--displace none", "--displace studs"}) {
        Json const a = draw_in(empty, options), b = draw_in(folder, options);
        EXPECT_EQ(a["inputs"].size(), 1u) << options;
        EXPECT_EQ(b["inputs"], a["inputs"]) << options;
        EXPECT_EQ(b["hash"], a["hash"]) << options;
    }
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
          "fin.obj:19: face 8 has fewer than three corners at different vertices: left out\n",
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

TEST(Program, ParametersOfASchemeAreResolvedInTheResult)
{
    Json const a = draw_json("jug --size 16x16"),
               b = draw_json("jug --size 16x16 --set lambda=1.5");
    EXPECT_EQ(a["config"]["lambda"], 1.0);
    EXPECT_EQ(b["config"]["lambda"], 1.5);
    EXPECT_EQ(b["config"]["r"], 1.0);
    // An option takes one value: what follows is the model.
    EXPECT_EQ(draw_json("--set lambda=1.5 jug --size 16x16")["hash"], b["hash"]);
    EXPECT_EQ(draw_json("--size 16x16 --set r=2 --set lambda=1.5 jug")["config"]["r"], 2.0);
    EXPECT_NE(a["hash"], b["hash"]);
}

TEST(Program, CommandsAddUpToTheStages)
{
    std::string const mesh = (scratch() / "m.ply").string();
    for (std::string const& arguments :
         {std::string("draw jug --size 32x32"), std::string("draw jug --size 32x32 --view wire"),
          std::string("draw jug --size 32x32 --view cage"),
          std::string("draw jug --size 32x32 --direct3d 10"),
          std::string("draw jug --size 32x32 --scheme gregory-two-stage --animate sway"),
          "export jug --scheme gregory-two-stage --animate sway -o " + mesh}) {
        Result const r = run(arguments + " --json -");
        ASSERT_EQ(r.status, 0) << r.err;
        Json const j = Json::parse(r.out);
        std::map<std::string, std::uint64_t> sum;
        int dispatches = 0, draws = 0;
        for (Json const& c : j["commands"]) {
            EXPECT_FALSE(c["name"].get<std::string>().empty()) << arguments;
            (c["kind"] == "dispatch" ? dispatches : draws) += c["number"].get<int>();
            for (auto const& [stage, s] : c["stages"].items())
                sum[stage] += s["invocations"].get<std::uint64_t>();
        }
        EXPECT_EQ(sum.size(), j["stages"].size()) << arguments;
        for (auto const& [stage, s] : j["stages"].items())
            EXPECT_EQ(sum[stage], s["invocations"]) << arguments << " " << stage;
        EXPECT_GT(draws, 0) << arguments;
        EXPECT_EQ(dispatches > 0, arguments.find("two-stage") != std::string::npos) << arguments;
    }
}

TEST(Program, ASequenceHasAPictureAndCountersForEachFrame)
{
    fs::path const picture = scratch() / "sway.png";
    for (char const* scheme : {"gregory-stencil", "gregory-two-stage"}) {
        std::string const options =
            std::string("draw jug --size 64x48 --animate sway --frames 3 ") + "--scheme " + scheme;
        Result const r = run(options + " -o " + picture.string() + " --json -");
        ASSERT_EQ(r.status, 0) << r.err;
        Json const j = Json::parse(r.out);
        ASSERT_EQ(j["frames"].size(), 3u);
        EXPECT_NE(j["frames"][0]["target_sha256"], j["frames"][1]["target_sha256"]);
        EXPECT_EQ(j["frames"][0]["upload_bytes"], 6 * 48);
        EXPECT_EQ(j["frames"][0]["counters"]["DSInvocations"],
                  j["frames"][2]["counters"]["DSInvocations"]);
        EXPECT_EQ(j["frames"][0]["counters"]["CSInvocations"].get<int>() > 0,
                  std::string_view(scheme) == "gregory-two-stage");
        for (auto const& [name, hash] : {std::pair("sway_0000.png", "3fb53dd4deb2106c"),
                                         {"sway_0001.png", "5e1c4d77320c1b81"},
                                         {"sway_0002.png", "e2c8cb6b24849c56"}}) {
            EXPECT_EQ(test::picture_hash(scratch() / name), hash) << name;
            fs::remove(scratch() / name);
        }
        EXPECT_EQ(Json::parse(run(options + kFewest + "--json -").out)["hash"], j["hash"]);
    }
}

TEST(Program, CheckExitsOneWhereAVerdictFails)
{
    Result const good = run("check golem --size 128x128 --rays 2000 --json -");
    ASSERT_EQ(good.status, 0) << good.err;
    Json const a = Json::parse(good.out);
    for (char const* name : {"topology", "position", "normal", "coverage", "raycast"})
        EXPECT_EQ(a["verdicts"][name]["verdict"], "pass") << name;
    EXPECT_EQ(a["verdicts"]["displaced"]["verdict"], "skipped");
    EXPECT_FALSE(a["verdicts"]["displaced"]["reason"].get<std::string>().empty());
    EXPECT_GT(a["witness"]["raycast"]["checked"], 4000) << "rays, and pixels of the picture";
    EXPECT_EQ(
        Json::parse(run("check golem --size 128x128 --rays 2000 --json -" + kFewest).out)["hash"],
        a["hash"]);

    fs::path const picture = scratch() / "cracks.png";
    Result const bad = run("check golem --size 128x128 --rays 0 --break order -o " +
                           picture.string() + " --json -");
    EXPECT_EQ(bad.status, 1) << bad.err;
    EXPECT_EQ(test::picture_hash(picture), "da6f527381b7d465");
    Json const b = Json::parse(bad.out);
    EXPECT_EQ(b["verdicts"]["position"]["verdict"], "fail");
    EXPECT_EQ(b["verdicts"]["position"]["sites"].size(), b["verdicts"]["position"]["failures"]);
    Json const& site = b["verdicts"]["position"]["sites"][0];
    EXPECT_EQ(site["bits"][0].get<std::string>().substr(0, 2), "0x");
    EXPECT_GE(site["ulp"].get<int>(), 1);
    EXPECT_EQ(site["faces"].size(), 2u);
    EXPECT_EQ(b["verdicts"]["raycast"]["verdict"], "skipped");
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

// What was asked for by its number in the file, where faces before it were left out.
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

TEST(Program, CostGivesSecondsByStageAndARoofline)
{
    fs::path const picture = scratch() / "roof.png";
    Result const r = run("cost jug --size 64x48 -o " + picture.string() + " --json -");
    ASSERT_EQ(r.status, 0) << r.err;
    Json const j = Json::parse(r.out);
    EXPECT_EQ(j["schema"], "tessemu.cost/1");
    EXPECT_EQ(j["gpu"], "GeForce GTX 260");
    EXPECT_EQ(j["config"]["gpu"], "gtx260");
    double shaders = 0;
    for (Json const& s : j["stages"])
        if (s["stage"].get<std::string>().ends_with("_shader"))
            shaders += s["seconds"].get<double>();
    EXPECT_NEAR(shaders, j["shader_seconds"].get<double>(), 1e-12);
    EXPECT_GT(j["sources"].size(), 5u);
    EXPECT_EQ(test::picture_hash(picture), "c69eaeefd2b76e4f");
    // The prediction is a result as any other: the same on any host.
    EXPECT_EQ(Json::parse(run("cost jug --size 64x48 --json -" + kFewest).out)["hash"], j["hash"]);
}

TEST(Program, ViewsOfErrorsAndControlMeshesArePictures)
{
    fs::path const picture = scratch() / "view.png";
    for (auto const& [view, hash] :
         {std::pair<std::string, char const*>("error --level 2", "dc5a8908f785cc60"),
          {"cage", "c9dcebae45f08cd0"}}) {
        Result const r = run("draw golem --size 64x48 --view " + view + " -o " + picture.string());
        EXPECT_EQ(r.status, 0) << r.err;
        EXPECT_EQ(test::picture_hash(picture), hash) << view;
        fs::remove(picture);
    }
    Result const r = run("reproduce loop09-figure3 -o " + picture.string());
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(test::picture_hash(picture), "eed23bc499ea343e");
    EXPECT_EQ(run("reproduce loop09-table1 --json -").status, 0);
}

TEST(Program, Direct3D10DrawsTheSamePicture)
{
    fs::path const eleven = scratch() / "eleven.png", ten = scratch() / "ten.png";
    ASSERT_EQ(run("draw jug --size 64x48 -o " + eleven.string()).status, 0);
    ASSERT_EQ(run("draw jug --size 64x48 --direct3d 10 -o " + ten.string()).status, 0);
    EXPECT_EQ(test::read_text(eleven), test::read_text(ten));
}

TEST(Program, DiffExitsOneWhereResultsDiffer)
{
    std::string const a = (scratch() / "a.json").string(), b = (scratch() / "b.json").string();
    ASSERT_EQ(run("draw jug --size 64x48 --json " + a).status, 0);
    ASSERT_EQ(run("draw jug --size 64x48 --json " + b + kFewest).status, 0);
    EXPECT_EQ(run("diff " + a + " " + b).status, 0);
    ASSERT_EQ(run("draw jug --size 64x48 --tess 12 --json " + b).status, 0);
    Result const r = run("diff " + a + " " + b);
    EXPECT_EQ(r.status, 1);
    EXPECT_NE(r.out.find("counters.DSInvocations"), std::string::npos);
    EXPECT_EQ(run("diff " + a + " " + b + " --tolerance 1").status, 0) << "numbers alone differ";
}

TEST(Program, CompareGivesTheSameResultForAnyThreadsAndLanes)
{
    Result const a = run("compare saddle_star --level 3 --json -" + kFewest),
                 b = run("compare saddle_star --level 3 --json -" + kMost);
    ASSERT_EQ(a.status, 0) << a.err;
    Json const x = Json::parse(a.out), y = Json::parse(b.out);
    EXPECT_EQ(x["errors"].size(), 6u);
    EXPECT_EQ(x["hash"], y["hash"]);
}

TEST(Program, TheHashDoesNotDependOnThreadsLanesOrWhereTheModelLies)
{
    fs::path const copy = scratch() / "sub";
    fs::create_directories(copy);
    std::ofstream(copy / "star.obj")
        << "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\nt oddity 0/0/0\n";
    fs::copy_file(copy / "star.obj", scratch() / "star.obj", fs::copy_options::overwrite_existing);
    Json const a = draw_json((copy / "star.obj").string() + " --size 80x60 --tess 3.7" + kFewest);
    Json const b =
        draw_json((scratch() / "star.obj").string() + " --size 80x60 --tess 3.7" + kMost);
    EXPECT_EQ(a["hash"], b["hash"]);
    EXPECT_EQ(a["warnings"], b["warnings"]);
    EXPECT_EQ(a["warnings"].size(), 1u);
    Json const c = draw_json((copy / "star.obj").string() + " --size 80x60 --tess 3.8");
    EXPECT_NE(a["hash"], c["hash"]);
}

TEST(Program, TheVertexCacheChangesCountsOnly)
{
    Json const none = draw_json("jug --size 64x64 --vertex-cache none");
    Json const all = draw_json("jug --size 64x64 --vertex-cache infinite");
    EXPECT_EQ(none["counters"]["VSInvocations"], none["counters"]["IAVertices"]);
    EXPECT_LT(all["counters"]["VSInvocations"], none["counters"]["VSInvocations"]);
    EXPECT_EQ(none["counters"]["PSInvocations"], all["counters"]["PSInvocations"]);
}

TEST(Program, TessellateBatchAnswersTheGoldenCases)
{
    fs::path const golden = TESSEMU_GOLDEN_BATCH;
    Result const r = run("tessellate --batch " + (golden / "cases.txt").string());
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(r.out, test::read_text(golden / "expected.txt"));
}

TEST(Program, AMalformedBatchLineIsNamed)
{
    fs::path const batch = scratch() / "batch.txt";
    for (char const* bad :
         {"quad integer", "quad integer triangle_cw 3f800000", "cube integer point 0",
          "tri integer point 3f800000 3f800000 3f800000 zzzzzzzz", "", "\r"}) {
        std::ofstream(batch) << "isoline integer line 3f800000 3f800000\n"
                             << bad << "\nisoline integer line 3f800000 3f800000\n";
        Result const r = run("tessellate --batch " + batch.string());
        EXPECT_EQ(r.status, 2) << bad;
        EXPECT_NE(r.err.find("batch.txt:2:"), std::string::npos) << r.err;
        EXPECT_TRUE(r.out.empty()) << bad;
    }
}

TEST(Program, EmptyLinesBehindABatchAndTheEndingsOfLinesChangeNothing)
{
    fs::path const batch = scratch() / "batch.txt";
    std::string const a = "isoline integer line 3f800000 3f800000",
                      b = "tri integer triangle_cw 40000000 40000000 40000000 40000000";
    std::ofstream(batch) << a + "\n" + b + "\n";
    Result const plain = run("tessellate --batch " + batch.string());
    ASSERT_EQ(plain.status, 0) << plain.err;
    EXPECT_TRUE(plain.err.empty());
    EXPECT_EQ(std::count(plain.out.begin(), plain.out.end(), '\n'), 2);
    for (std::string const& text : {a + "\r\n" + b + "\r\n", a + "\n" + b, a + "\n" + b + "\n\n",
                                    a + "\n" + b + "\n \n\r\n\n"}) {
        std::ofstream(batch) << text;
        Result const r = run("tessellate --batch " + batch.string());
        EXPECT_EQ(r.status, 0) << r.err;
        EXPECT_EQ(r.out, plain.out);
    }
    // The golden cases have outputs that Direct3D 11 forbids.
    std::ofstream(batch) << a + "\nquad integer line 3f800000 3f800000 3f800000 3f800000 "
                                "3f800000 3f800000\n";
    Result const illegal = run("tessellate --batch " + batch.string());
    EXPECT_EQ(illegal.status, 0);
    EXPECT_NE(illegal.err.find("batch.txt:2: Direct3D 11 has no such output"), std::string::npos)
        << illegal.err;
    EXPECT_NE(illegal.err.find("R75"), std::string::npos);
}

TEST(Program, TessellateTakesAnyFloatAndKeepsWhatWasAsked)
{
    auto const patch = [](std::string const& arguments) {
        Result const r = run("tessellate " + arguments);
        EXPECT_EQ(r.status, 0) << arguments << ": " << r.err;
        return r.status == 0 ? Json::parse(r.out) : Json();
    };
    Json const inside = patch("--domain tri --partitioning integer --factors 2 2 2 -inf");
    EXPECT_EQ(inside["config"]["factors"], Json::parse(R"([2.0, 2.0, 2.0, "-inf"])"));
    EXPECT_EQ(inside["case"], "tri integer triangle_cw 40000000 40000000 40000000 ff800000");
    // To the smallest, which is the same for NaN.
    Json const one = patch("--domain tri --partitioning integer --factors 2 2 2 1"),
               nan = patch("--domain tri --partitioning integer --factors 2 2 2 nan"),
               negative = patch("--domain tri --partitioning integer --factors 2 2 2 -.5");
    EXPECT_GT(one["points"], 0);
    for (Json const& same : {inside, nan, negative}) EXPECT_EQ(same["indices"], one["indices"]);
    EXPECT_EQ(nan["config"]["factors"][3], "nan");
    // At an edge: culled.
    for (std::string const factor : {"-inf", "nan", "-1", "0", "-nan", "-1e-40"})
        EXPECT_EQ(patch("--domain tri --factors 2 " + factor + " 2 2")["points"], 0) << factor;
    Json const most = patch("--domain tri --factors inf 2 2 2");
    EXPECT_EQ(most["u"], patch("--domain tri --factors 63 2 2 2")["u"]);
    EXPECT_EQ(most["config"]["factors"][0], "inf");
    // R59: pow2 is the hull shader's part.
    EXPECT_EQ(patch("--partitioning pow2 --factors 5 5 5 5 5 5")["u"],
              patch("--partitioning integer --factors 5 5 5 5 5 5")["u"]);
    EXPECT_NE(run("tessellate --help").out.find("R59"), std::string::npos);
}

TEST(Program, TessellateRefusesOutputsThatDirect3D11Forbids)
{
    for (char const* bad : {"--domain quad --output line --factors 1 1 1 1 1 1",
                            "--domain tri --output line --factors 1 1 1 1",
                            "--domain isoline --output triangle_cw --factors 1 1",
                            "--domain isoline --output triangle_ccw --factors 1 1"}) {
        Result const r = run(std::string("tessellate ") + bad);
        EXPECT_EQ(r.status, 2) << bad;
        EXPECT_NE(r.err.find("R75"), std::string::npos) << r.err;
        EXPECT_TRUE(r.out.empty());
    }
    for (char const* good : {"--domain quad --output point --factors 1 1 1 1 1 1",
                             "--domain tri --output triangle_ccw --factors 1 1 1 1",
                             "--domain isoline --output point --factors 1 1"})
        EXPECT_EQ(run(std::string("tessellate ") + good).status, 0) << good;
    EXPECT_EQ(Json::parse(run("tessellate --domain isoline --factors 2 3").out)["config"]["output"],
              "line");
}

TEST(Program, TessellateGivesOnePatchAsJson)
{
    Result const r = run("tessellate --domain quad --partitioning integer --factors 1 1 1 1 1 1");
    ASSERT_EQ(r.status, 0) << r.err;
    Json const j = Json::parse(r.out);
    EXPECT_EQ(j["u"], (std::vector<int>{0, 65536, 65536, 0}));
    EXPECT_EQ(j["indices"], (std::vector<int>{0, 1, 3, 1, 2, 3}));
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

TEST(Program, ExportWeldsAndNamesWhatItCannotHonour)
{
    fs::path const cage = scratch() / "creased.obj";
    // Edge 1-2 lies on the boundary, which is sharp by nature; edge 2-3 does not.
    std::ofstream(cage) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\n"
                           "f 2 5 6 3\nt crease 2/1/0 0 1 3\nt crease 2/1/0 1 2 3\n";
    Result const r =
        run("export " + cage.string() + " --tess 2 --weld -o " + (scratch() / "c.obj").string());
    EXPECT_EQ(r.status, 0);
    EXPECT_NE(r.err.find("warning: 1 crease edges are drawn smooth"), std::string::npos) << r.err;
}

TEST(Program, AMeshHasOneHashInBothFormats)
{
    std::string hashes[2];
    for (int i = 0; i < 2; ++i) {
        std::string const file = (scratch() / (i ? "m.obj" : "m.ply")).string();
        Result const r = run("export jug --tess 2.5 --json - -o " + file);
        ASSERT_EQ(r.status, 0) << r.err;
        hashes[i] = Json::parse(r.out)["hash"];
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// Every command of the program that README and docs print runs as printed, in the page's order. The
// commands that build it made the one that runs here.
TEST(Program, CommandsOfReadmeAndDocsWork)
{
    std::vector<std::string> pages{"README.md"};
    for (auto const& entry : fs::recursive_directory_iterator(test::source("docs")))
        if (entry.path().extension() == ".md")
            pages.push_back(fs::relative(entry.path(), test::source("")).string());
    std::sort(pages.begin(), pages.end());
    std::map<std::string, int> commands;
    for (std::string const& page : pages) {
        std::istringstream in(test::read_text(test::source(page)));
        std::string line;
        while (std::getline(in, line)) {
            std::string arguments;
            for (std::string const prefix : {"    build/release/tessemu ", "    tessemu "})
                if (line.starts_with(prefix)) arguments = line.substr(prefix.size());
            if (arguments.empty()) continue;
            std::string const command = "cd " + scratch().string() + " && " + TESSEMU_PROGRAM +
                                        " " + arguments + " >out.txt 2>err.txt";
            EXPECT_EQ(std::system(command.c_str()), 0) << page << ": " << line << "\n"
                                                       << test::read_text(scratch() / "err.txt");
            ++commands[page];
        }
    }
    for (char const* page : {"README.md", "docs/new_scheme.md", "docs/watertight.md"})
        EXPECT_GT(commands[page], 0) << page;
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
