// subdivide: what it counts, writes and refuses, and that what it writes is the surface's mesh.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/machine.h"
#include "io/model.h"
#include "pipeline/commands/patch_mesh.h"
#include "pipeline/schemes/scheme.h"
#include "tests/cli/program.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::Result;
using test::run;
using test::scratch;

Json subdivide(std::string const& arguments)
{
    Result const r = run("subdivide " + arguments + " --json -");
    EXPECT_EQ(r.status, 0) << r.err;
    return r.status == 0 ? Json::parse(r.out) : Json();
}

TEST(Subdivide, BitsAndCountsDependOnNeitherThreadsNorLanes)
{
    std::set<std::string> hashes;
    for (int levels = 1; levels <= 4; ++levels) {
        std::string const which = "jug --levels " + std::to_string(levels);
        std::string first, mesh;
        for (int threads : {1, 2})
            for (int lanes : kBuiltLanes) {
                fs::path const path = scratch() / "refined.obj";
                Json j = subdivide(which + " -j " + std::to_string(threads) + " --lanes " +
                                   std::to_string(lanes) + " -o " + path.string());
                j.erase("run");
                if (first.empty()) {
                    first = j.dump();
                    mesh = test::read_text(path);
                    hashes.insert(j["hash"]);
                }
                EXPECT_EQ(j.dump(), first) << levels << " -j " << threads << " --lanes " << lanes;
                EXPECT_TRUE(test::read_text(path) == mesh);
            }
    }
    EXPECT_EQ(hashes.size(), 4u);
}

TEST(Subdivide, AStepHasTheKernelsOfItsFacesEdgesAndVertices)
{
    Json const j = subdivide("jug --levels 2");
    EXPECT_EQ(j["schema"], "tessemu.subdivide/1");
    EXPECT_EQ(j["config"].dump(), R"({"levels":2,"sort":"none","contraction":"none"})");
    ASSERT_EQ(j["steps"].size(), 2u);
    Json const &a = j["steps"][0], &b = j["steps"][1];
    std::int64_t const F = a["faces"], E = a["edges"], V = a["vertices"];
    EXPECT_EQ(b["vertices"], F + E + V);
    EXPECT_EQ(j["mesh"]["vertices"],
              std::int64_t(b["faces"]) + std::int64_t(b["edges"]) + F + E + V);
    EXPECT_EQ(j["mesh"]["faces"], 4 * std::int64_t(b["faces"]));
    char const* const kNames[] = {"face points", "edge points", "vertex points"};
    std::int64_t const threads[] = {F, E, V};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(a["kernels"][k]["kernel"], kNames[k]);
        EXPECT_EQ(a["kernels"][k]["threads"], threads[k]);
        EXPECT_EQ(a["kernels"][k]["loops"].size(), k == 1 ? 0u : 2u);
    }
    EXPECT_EQ(a["kernels"][1]["index_fetches"], 4 * E);
    ASSERT_EQ(j["commands"].size(), 6u);
    EXPECT_EQ(j["commands"][5]["name"], "vertex points, step 2");
    Json const sorted = subdivide("jug --levels 2 --set sort=valence");
    EXPECT_EQ(sorted["config"]["sort"], "valence");
    EXPECT_LE(sorted["steps"][0]["kernels"][2]["loops"][0]["turns_run"],
              a["kernels"][2]["loops"][0]["turns_run"]);
    EXPECT_NE(sorted["hash"], j["hash"]);
    EXPECT_NE(run("subdivide jug").out.find("vertex points"), std::string::npos);
}

TEST(Subdivide, LevelZeroIsTheMeshInItsOwnNumbers)
{
    fs::path const path = scratch() / "same.obj";
    Json const j = subdivide("jug --levels 0 -o " + path.string());
    EXPECT_EQ(j["config"].dump(), R"({"levels":0,"contraction":"none"})");
    EXPECT_EQ(j["steps"].size(), 0u);
    ControlMesh const jug = load_model("jug").mesh, back = load_model(path.string()).mesh;
    EXPECT_EQ(back.positions, jug.positions);
    EXPECT_EQ(back.face_vertices, jug.face_vertices);
    EXPECT_EQ(back.face_start, jug.face_start);
}

// A mesh with all that a step carries along.
std::string tagged_cube(int boundary)
{
    std::string out = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                      "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                      "f 1/1 3/2 4/3 2/4\nf 5/1 6/2 8/3 7/4\nf 1/1 2/2 6/3 5/4\n"
                      "f 3/1 7/2 8/3 4/4\nf 1/1 5/2 7/3 3/4\n" // open at x = 1
                      "t crease 2/1/0 0 2 2.3\nt crease 2/1/0 4 6 10\nt corner 1/1/0 2 1.6\n"
                      "t hole 1/0/0 2\nt creasemethod 0/0/1 chaikin\n";
    return out + "t interpolateboundary 1/0/0 " + std::to_string(boundary) + "\n";
}

// Faces that are drawn, each by its corners' positions.
std::vector<std::vector<glm::vec3>> drawn_faces(RefinedMesh const& m)
{
    ControlMesh const drawn = drawn_mesh(m, {}, ThreadPool(2)).mesh;
    std::vector<std::string> warnings;
    std::vector<char> const hidden = hidden_faces(m, warnings);
    std::vector<std::vector<glm::vec3>> out;
    for (std::uint32_t f = 0; f < drawn.faces(); ++f) {
        if (hidden[f]) continue;
        auto& face = out.emplace_back();
        for (std::uint32_t v : drawn.face(f)) face.push_back(drawn.positions[v]);
    }
    return out;
}

TEST(Subdivide, WhatItWritesIsTheMeshThatSubdivideInFrontOfASchemeHas)
{
    std::vector<std::string> models{"jug", "golem", "saddle_star", "spindle"};
    for (int boundary : {0, 1, 2}) {
        fs::path const path = scratch() / ("tagged" + std::to_string(boundary) + ".obj");
        std::ofstream(path) << tagged_cube(boundary);
        models.push_back(path.string());
    }
    std::size_t faces = 0;
    for (std::string const& model : models)
        for (int levels : {1, 2}) {
            SCOPED_TRACE(model + ", " + std::to_string(levels));
            fs::path const path = scratch() / "step.obj";
            Result const r = run("subdivide " + model + " --levels " + std::to_string(levels) +
                                 " -o " + path.string());
            ASSERT_EQ(r.status, 0) << r.err;
            for (int more : {0, 1}) { // the same, and as sharp, for whoever goes on
                RefinedMesh const whole(load_model(model).mesh, levels + more, catmull_clark_step),
                    rest(load_model(path.string()).mesh, more, catmull_clark_step);
                auto const a = drawn_faces(whole), b = drawn_faces(rest);
                EXPECT_EQ(a, b);
                faces += a.size();
                EXPECT_EQ(whole.mesh().creases.size(), rest.mesh().creases.size());
                EXPECT_EQ(whole.mesh().corners.size(), rest.mesh().corners.size());
                if (more) continue;
                EXPECT_EQ(whole.mesh().coordinates, rest.mesh().coordinates);
            }
        }
    EXPECT_GT(faces, 1000u);
}

TEST(Subdivide, APlyTellsWhatItLacks)
{
    fs::path const model = scratch() / "tagged.obj", path = scratch() / "step.ply";
    std::ofstream(model) << tagged_cube(1);
    Result const r = run("subdivide " + model.string() + " -o " + path.string());
    EXPECT_EQ(r.status, 0);
    EXPECT_NE(r.err.find("PLY has no tags"), std::string::npos) << r.err;
    EXPECT_EQ(test::read_text(path).substr(0, 4), "ply\n");
}

TEST(Subdivide, RefusalsNameTheOptionTheValueAndTheLimit)
{
    for (auto const& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
             {"jug --levels 7", "--levels is 7, it must be 0 to 6"},
             {"jug --levels -1", "--levels is -1, it must be 0 to 6"},
             {"jug --levels 0 --set sort=valence", "no step of subdivision is taken"},
             {"jug --set sort=faces", "sort is 'faces', it must be none or valence"},
             {"jug --set alpha=1", "no parameter 'alpha'; there is sort"},
             {"jug -o refined.stl", ".stl"},
             {"nowhere.obj", "nowhere.obj"}}) {
        Result const r = run("subdivide " + arguments);
        EXPECT_EQ(r.status, 2) << arguments;
        EXPECT_NE(r.err.find(words), std::string::npos) << arguments << ": " << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    }
    // Nor does a run without steps take it, or show it.
    EXPECT_EQ(run("draw jug --set sort=valence --size 16x16").status, 2);
    EXPECT_FALSE(test::draw_json("jug --size 16x16")["config"].contains("sort"));
    EXPECT_EQ(test::draw_json("jug --size 16x16 --subdivide 1")["config"]["sort"], "none");
}

TEST(Subdivide, SchemesMentionTheSortOnce)
{
    std::string const out = run("schemes").out;
    std::size_t const at = out.find("--set sort=none");
    EXPECT_NE(at, std::string::npos);
    EXPECT_EQ(out.find("--set sort", at + 1), std::string::npos);
}

} // namespace
} // namespace tessemu
