// The program as its users run it: options, results, exit statuses and the docs' commands.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/machine.h"
#include "pipeline/mesh/builtin_models.h"
#include "tests/cli/program.h"
#include "tests/io/picture_hash.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

using test::draw_json;
using test::Result;
using test::run;
using test::scratch;

// Options that must change no result.
std::string const kFewest = " -j 1 --lanes " + std::to_string(*std::begin(kBuiltLanes)) + " ",
                  kMost = " -j 3 --lanes " + std::to_string(*std::rbegin(kBuiltLanes)) + " ";

// The picture_hash of a picture below is that of version 0.1.0, made by the command above it.

TEST(Program, HelpAndVersionExitZeroOnEachVerb)
{
    EXPECT_EQ(run("--help").status, 0);
    EXPECT_EQ(run("--version").status, 0);
    for (char const* verb :
         {"draw", "export", "tessellate", "compare", "check", "cost", "reproduce", "diff", "info",
          "schemes", "models", "subdivide", "tables"}) {
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
                             "reproduce", "diff", "info", "subdivide", "tables"}) {
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
             {"draw jug --pattern uniform",
              "--pattern is of instanced patterns, which --direct3d 10"},
             {"draw jug --direct3d 10 --pattern grid", "tessellator or uniform"},
             {"draw jug --direct3d 10 --pattern uniform --partitioning integer",
              "all points at i/n"},
             {"draw jug --scheme acc", "triangles"},
             {"draw jug --scheme pm", "closed meshes only"},
             {"compare jug --level 7", "--level is 7, it must be 1 to 6"},
             {"reproduce table9", "loop09-table3"},
             {"reproduce loop09-figure2", "loop09-figure12"},
             {"reproduce loop09-table2 --models nowhere", "nowhere/monsterfrog.obj"},
             {"reproduce loop09-table1 -o a.png", "of pictures; loop09-table1 is a table"},
             {"reproduce loop09-figure3 --json -", "picture"},
             {"reproduce loop10-figure5 --models nowhere --json -", "nowhere/two_hole.obj"},
             {"reproduce loop10-figure5 -o a.bmp", "a.bmp"},
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
             {"draw jug --curvature-max auto", "--curvature-max needs --view curvature"},
             {"draw jug --view zebra --curvature-max 1", "needs --view curvature"},
             {"draw jug --scheme stam --view curvature --curvature-max 0", "auto or above 0"},
             {"draw jug --scheme stam --view curvature --curvature-max inf", "--curvature-max"},
             {"draw golem --scheme stam --view curvature --curvature-max 1e40", "for this model"},
             {"draw jug --scheme stam --view curvature --displace studs", "--displace"},
             {"draw jug --view curvature", "jump"},
             {"draw golem --scheme acc --view curvature", "schemes that have it: stam"},
             {"draw golem --scheme pm --view curvature", "quartic"},
             {"draw spindle --scheme phong --view curvature", "blended"},
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

TEST(Program, LevelsOfAdaptivePatchesAreToldAndTheTessFactorIsNotUsed)
{
    fs::path const json = scratch() / "adaptive.json";
    std::string const command = "draw golem --scheme bolz --set adapt=0.01 --size 16x16 ";
    Result const r = run(command + "--json " + json.string());
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(r.err.empty()) << r.err;
    Json const j = Json::parse(test::read_text(json));
    EXPECT_EQ(j["config"]["adapt"], 0.01);
    EXPECT_FALSE(j["config"].contains("tess"));
    std::string line = "patches by their segments: ";
    bool first = true;
    ASSERT_EQ(j["levels"].size(), 6u);
    for (std::size_t level = 0; level < 6; ++level) {
        auto const patches = j["levels"][level].get<std::uint64_t>();
        if (patches == 0) continue;
        line += (first ? "" : ", ") + std::to_string(patches) + " of " +
                std::to_string(1 << level) + (level == 0 ? " segment" : " segments");
        first = false;
    }
    EXPECT_EQ(r.out.find(line + "\n"), 0u) << r.out;

    Result const with_tess = run(command + "--tess 4");
    EXPECT_EQ(with_tess.status, 0);
    EXPECT_EQ(with_tess.err, "warning: --tess is not used: each patch has its own segments\n");
    Json const uniform = draw_json("golem --scheme bolz --size 16x16");
    EXPECT_EQ(uniform["config"]["tess"], 8.0);
    EXPECT_FALSE(uniform["config"].contains("adapt"));
    EXPECT_FALSE(uniform.contains("levels"));
    EXPECT_NE(run("schemes").out.find("--set adapt=NUMBER  1e-09 to 1, by default not set: "),
              std::string::npos);
    EXPECT_NE(run(command + "--set adapt=0").err.find("more than once"), std::string::npos);
    EXPECT_NE(run("draw golem --scheme bolz --set adapt=0").err.find("from 1e-09 to 1"),
              std::string::npos);
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

// What was asked for by its number in the file, where faces before it were left out.
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
    EXPECT_EQ(test::picture_hash(picture), "822a93b489d7a273");
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

TEST(Program, ExportWeldsAndNamesWhatItCannotHonour)
{
    fs::path const cage = scratch() / "creased.obj";
    // Edge 1-2 lies on the boundary, which is sharp by nature; edge 2-3 does not.
    std::ofstream(cage) << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\n"
                           "f 2 5 6 3\nt crease 2/1/0 0 1 3\nt crease 2/1/0 1 2 3\n";
    Result const r =
        run("export " + cage.string() + " --tess 2 --weld -o " + (scratch() / "c.obj").string());
    EXPECT_EQ(r.status, 0);
    EXPECT_NE(r.err.find("warning: 1 crease edge is drawn smooth"), std::string::npos) << r.err;
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

} // namespace
} // namespace tessemu
