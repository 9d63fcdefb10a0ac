// sweep: one table whoever ran its cases, as often as they are killed; what is refused, and where
// paths lead.
//
// SPDX-License-Identifier: Apache-2.0
#include "emu/machine.h"
#include "tests/cli/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <thread>

#include <fcntl.h>
#include <signal.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::Result;
using test::run;

// A fresh folder for a test's sweeps.
fs::path fresh()
{
    fs::path const p = test::scratch() / "sweeps";
    fs::remove_all(p);
    fs::create_directories(p);
    return p;
}

void write(fs::path const& path, std::string const& text)
{
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
}

Result plan(std::string const& text, fs::path const& folder)
{
    fs::path const file = folder.parent_path() / "sweep.json";
    write(file, text);
    return run("sweep plan " + file.string() + " -o " + folder.string());
}

// A sweep that is planned without a word of complaint.
fs::path planned(std::string const& text, fs::path const& folder)
{
    Result const r = plan(text, folder);
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(r.err, "");
    return folder;
}

void run_all(fs::path const& folder, std::string const& arguments = "")
{
    Result const r = run("sweep run " + folder.string() + " " + arguments);
    EXPECT_EQ(r.status, 0) << r.out << r.err;
}

// A table of a sweep whose cases have all run.
std::string merged(fs::path const& folder, std::string const& extension = "csv")
{
    fs::path const path = folder.parent_path() / ("table." + extension);
    Result const r = run("sweep merge " + folder.string() + " -o " + path.string());
    EXPECT_EQ(r.status, 0) << r.err;
    return test::read_text(path);
}

// Results by the case's number in the manifest, from 1.
std::vector<Json> results(fs::path const& folder)
{
    std::map<std::string, std::size_t> number;
    std::ifstream manifest(folder / "manifest.jsonl");
    std::string line;
    for (std::getline(manifest, line); std::getline(manifest, line);)
        number.emplace(Json::parse(line)["case"], number.size() + 1);
    std::vector<Json> out(number.size() + 1);
    for (auto const& e : fs::directory_iterator(folder / "results")) {
        std::ifstream in(e.path());
        while (std::getline(in, line)) {
            Json const j = Json::parse(line);
            out[number.at(j["case"])] = j.contains("result") ? j["result"] : j["message"];
        }
    }
    return out;
}

bool has(std::string const& text, std::string const& words)
{
    return text.find(words) != std::string::npos;
}

// 32 cases of different sizes, on two meshes.
constexpr char const* kDraws = R"({"verb": "draw", "models": ["jug", "golem"],
    "schemes": ["gregory-stencil", "phong"], "tess": [1, 2.5, 4, 7], "samples": [1, 4],
    "size": "24x24"})";

TEST(Sweep, ItsTableIsTheSameWhoeverRanWhatAndWhenAndAsOftenAsTheyAreKilled)
{
    fs::path const at = fresh();
    run_all(planned(kDraws, at / "one"), "-j 1");
    std::string const csv = merged(at / "one");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 33);
    EXPECT_FALSE(has(csv, "missing"));

    planned(kDraws, at / "shards");
    for (char const* shard : {"3/3", "1/3", "2/3"})
        run_all(at / "shards", std::string("--shard ") + shard);
    EXPECT_EQ(merged(at / "shards"), csv);

    for (int lanes : kBuiltLanes) {
        fs::path const folder = at / ("lanes" + std::to_string(lanes));
        run_all(planned(kDraws, folder), "-j 2 --lanes " + std::to_string(lanes));
        EXPECT_EQ(merged(folder), csv) << lanes;
    }

    std::string const killed = (planned(kDraws, at / "killed")).string();
    std::mt19937 random(5);
    for (int round = 0; round < 6; ++round) {
        std::vector<pid_t> processes;
        for (int i = 0; i < 3; ++i) {
            pid_t const pid = fork();
            if (pid == 0) {
                int const null = open("/dev/null", O_RDWR);
                for (int fd : {0, 1, 2}) dup2(null, fd);
                execl(TESSEMU_PROGRAM, "tessemu", "sweep", "run", killed.c_str(), "-j", "1",
                      nullptr);
                _exit(127);
            }
            processes.push_back(pid);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20 + random() % 30));
        for (pid_t p : processes) kill(p, SIGKILL);
        for (pid_t p : processes) {
            int status = 0;
            waitpid(p, &status, 0);
            EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
        }
    }
    run_all(killed);
    EXPECT_EQ(merged(killed), csv);
    EXPECT_EQ(merged(killed, "json"), merged(at / "one", "json"));
    EXPECT_EQ(merged(killed, "sqlite"), merged(at / "one", "sqlite"));
}

TEST(Sweep, AResultIsTheVerbsOwn)
{
    struct Verb {
        char const *sweep, *command_line;
    };
    for (
        Verb const& v : {
            Verb{R"({"verb": "draw", "models": "jug", "schemes": "phong", "tess": 2.5,
                      "samples": 4, "set": [["alpha=0.5"]], "size": "24x24"})",
                 "draw jug --scheme phong --tess 2.5 --samples 4 --set alpha=0.5 --size 24x24"},
            Verb{
                R"({"verb": "draw", "cases": [{"model": "golem", "size": "24x24", "view": "wire"}]})",
                "draw golem --size 24x24 --view wire"},
            Verb{R"({"verb": "cost", "models": "golem", "schemes": "pm", "tess": 3,
                      "geometry-only": true})",
                 "cost golem --scheme pm --tess 3 --geometry-only"},
            Verb{R"({"verb": "cost", "models": "golem", "size": "24x24",
                      "geometry-only": false})",
                 "cost golem --size 24x24"},
            Verb{R"({"verb": "compare", "models": "golem", "schemes": "pm", "level": 1})",
                 "compare golem --scheme pm --level 1"},
            Verb{R"({"verb": "check", "models": "golem", "schemes": "acc", "tess": 2,
                      "size": "24x24", "rays": 5})",
                 "check golem --scheme acc --tess 2 --size 24x24 --rays 5"},
        }) {
        fs::path const folder = fresh() / "sweep";
        run_all(planned(v.sweep, folder), "-j 1");
        Json alone = Json::parse(run(std::string(v.command_line) + " --json -").out);
        EXPECT_EQ(alone.erase("run"), 1u);
        Json const result = results(folder).at(1);
        EXPECT_EQ(result.dump(), alone.dump()) << v.command_line;
        EXPECT_TRUE(has(merged(folder), result["hash"]));
    }
}

TEST(Sweep, AVerdictOfFailIsAResult)
{
    fs::path const folder =
        planned(R"({"verb": "check", "models": "golem", "schemes": "acc", "tess": 2,
                    "size": "24x24", "rays": 0, "break": ["none", "order"]})",
                fresh() / "sweep");
    Result const r = run("sweep run " + folder.string());
    EXPECT_EQ(r.status, 0) << r.err;
    std::string const csv = merged(folder);
    EXPECT_TRUE(has(csv, ",pass,"));
    EXPECT_TRUE(has(csv, ",fail,"));
}

TEST(Sweep, ACaseThatFailsIsToldAndTheRestGoesOn)
{
    fs::path const folder = planned(R"({"verb": "draw", "models": ["jug", "golem"],
        "schemes": ["acc", "phong"], "size": "16x16"})",
                                    fresh() / "sweep");
    std::string const why = "jug:100: acc draws quads only: 32 of 106 faces are triangles";
    EXPECT_EQ(run("sweep status " + folder.string()).out,
              folder.string() + ": 4 cases of draw: 0 done, 0 failed, 4 not yet\n");
    Result r = run("sweep run " + folder.string());
    EXPECT_EQ(r.status, 1);
    EXPECT_EQ(r.out, "3 of 4 cases done, 1 failed; 4 have run now\n");
    r = run("sweep status " + folder.string());
    EXPECT_EQ(r.status, 0);
    EXPECT_TRUE(has(r.out, ": 4 cases of draw: 3 done, 1 failed, 0 not yet\n")) << r.out;
    EXPECT_TRUE(has(r.out, "case 1: draw jug --scheme acc --size 16x16: " + why)) << r.out;

    fs::path const csv = folder.parent_path() / "t.csv";
    r = run("sweep merge " + folder.string() + " -o " + csv.string());
    EXPECT_EQ(r.status, 0);
    EXPECT_TRUE(has(r.err, "warning: 1 of 4 cases failed; case 1: " + why)) << r.err;
    EXPECT_TRUE(has(test::read_text(csv), ",failed,\"" + why));
    EXPECT_EQ(run("sweep run " + folder.string()).out,
              "3 of 4 cases done, 1 failed; 0 have run now\n");
    r = run("sweep run " + folder.string() + " --retry");
    EXPECT_EQ(r.status, 1);
    EXPECT_EQ(r.out, "3 of 4 cases done, 1 failed; 1 have run now\n");
}

TEST(Sweep, AMessageDoesNotSayWhereTheFolderLies)
{
    std::string tables[2];
    for (int i : {0, 1}) {
        fs::path const at = fresh() / (i ? "a" : "another");
        write(at / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        planned(R"({"verb": "draw", "models": "t.obj", "schemes": "acc", "size": "16x16"})",
                at / "sweep");
        EXPECT_EQ(run("sweep run " + (at / "sweep").string()).status, 1);
        tables[i] = merged(at / "sweep");
    }
    EXPECT_EQ(tables[0], tables[1]);
}

TEST(Sweep, MergeOfWhatIsNotDoneSaysHowManyAreMissing)
{
    fs::path const folder = planned(R"({"verb": "draw", "models": "golem", "size": "16x16",
        "tess": [1, 2, 3, 4, 5]})",
                                    fresh() / "sweep"),
                   csv = folder.parent_path() / "t.csv";
    run_all(folder, "--shard 1/2");
    Result r = run("sweep merge " + folder.string() + " -o " + csv.string());
    EXPECT_EQ(r.status, 1);
    EXPECT_TRUE(has(r.err, "2 of 5 cases have not run yet")) << r.err;
    EXPECT_TRUE(has(r.err, "tessemu sweep run " + folder.string())) << r.err;
    std::string const text = test::read_text(csv);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6);
    EXPECT_TRUE(has(text, ",missing,"));
    run_all(folder);
    EXPECT_FALSE(has(merged(folder), "missing"));
}

TEST(Sweep, MergeWritesTheDictionaryBeside)
{
    fs::path const folder =
        planned(R"({"verb": "draw", "models": "golem", "size": "16x16", "tess": [1, 2]})",
                fresh() / "sweep");
    run_all(folder);
    fs::path const csv = folder.parent_path() / "t.csv", columns = folder.parent_path() / "c.csv";
    std::string const to = "sweep merge " + folder.string() + " -o " + csv.string();
    EXPECT_EQ(run(to + " --dictionary " + columns.string()).status, 0);
    std::string const head = test::read_text(csv).substr(0, test::read_text(csv).find('\r'));
    std::string const dictionary = test::read_text(columns);
    EXPECT_EQ(std::count(dictionary.begin(), dictionary.end(), '\n'),
              std::count(head.begin(), head.end(), ',') + 2);
    EXPECT_TRUE(has(dictionary, "\r\ndomain_shader_fetched_bytes,bytes,"));
    EXPECT_EQ(run(to + " --dictionary " + csv.string()).status, 2);
    for (char const* wrong : {"t.txt", "-"}) {
        Result const r = run("sweep merge " + folder.string() + " -o " + wrong);
        EXPECT_EQ(r.status, 2);
        EXPECT_TRUE(has(r.err, "its name must end in .csv, .json or .sqlite")) << r.err;
    }
}

// What a user has beside a sweep: a model, heights, a GPU.
void write_files(fs::path const& at)
{
    write(at / "cages" / "a.obj", test::read_text(test::source("models/golem.obj")));
    std::string heights = "P5 2 2 255\n";
    heights += "\x10\xf0\x80\x40";
    write(at / "heights.pgm", heights);
    write(at / "gpu.json", test::read_text(test::source("gpus/gtx480.json")));
}

TEST(Sweep, PathsAreRelativeToTheSweepFileAndTheFolderCanBeMoved)
{
    fs::path const at = fresh();
    write_files(at);
    planned(R"({"verb": "draw", "models": ["cages/a.obj", "golem"], "schemes": "phong",
                "size": "16x16", "displace": ["none", "heights.pgm"]})",
            at / "sweep");
    run_all(at / "sweep");
    std::string const csv = merged(at / "sweep");
    std::vector<Json> const own = results(at / "sweep");
    EXPECT_EQ(own.size(), 5u);
    std::string const alone =
        run("draw " + (at / "cages/a.obj").string() + " --scheme phong --size 16x16 --displace " +
            (at / "heights.pgm").string() + " --json -")
            .out;
    Json expected = Json::parse(alone);
    expected.erase("run");
    EXPECT_EQ(own[2].dump(), expected.dump());
    EXPECT_NE(own[1].dump(), own[2].dump());

    // Planned, moved, and all it came from gone.
    write_files(at / "x");
    planned(R"({"verb": "draw", "models": ["cages/a.obj", "golem"], "schemes": "phong",
                "size": "16x16", "displace": ["none", "heights.pgm"]})",
            at / "x" / "sweep");
    fs::rename(at / "x" / "sweep", at / "moved");
    fs::remove_all(at / "x");
    run_all(at / "moved");
    EXPECT_EQ(merged(at / "moved"), csv);
    // The same by a path relative to where the run is.
    fs::remove_all(at / "moved" / "results");
    fs::create_directory(at / "moved" / "results");
    Result const r =
        test::run_command("cd " + at.string() + " && " + TESSEMU_PROGRAM + " sweep run moved && " +
                          TESSEMU_PROGRAM + " sweep merge moved -o moved.csv");
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(test::read_text(at / "moved.csv"), csv);
}

TEST(Sweep, AGpuMayBeAFileToo)
{
    fs::path const at = fresh();
    write_files(at);
    planned(R"({"verb": "cost", "models": "golem", "geometry-only": true, "tess": 2,
                "gpu": ["gpu.json", "gtx480"]})",
            at / "sweep");
    fs::remove(at / "gpu.json");
    run_all(at / "sweep");
    std::vector<Json> const own = results(at / "sweep");
    ASSERT_EQ(own.size(), 3u);
    EXPECT_EQ(own[1]["seconds"], own[2]["seconds"]);
    EXPECT_TRUE(has(merged(at / "sweep"), ",gpu.json,"));
}

TEST(Sweep, AModelIsNotLookedForWhereThePlanIsMade)
{
    fs::path const at = fresh();
    write_files(at / "here");
    write(at / "there" / "sweep.json",
          R"({"verb": "draw", "models": "cages/a.obj", "size": "16x16"})");
    Result const r = test::run_command("cd " + (at / "here").string() + " && " + TESSEMU_PROGRAM +
                                       " sweep plan ../there/sweep.json -o ../sweep");
    EXPECT_EQ(r.status, 2) << r.out;
    EXPECT_FALSE(fs::exists(at / "sweep"));
}

TEST(Sweep, StandardInputIsNoModel)
{
    fs::path const folder = fresh() / "sweep", file = folder.parent_path() / "sweep.json";
    write(file, R"({"verb": "draw", "models": "-", "size": "16x16"})");
    Result const r = run("sweep plan " + file.string() + " -o " + folder.string(),
                         test::source("models/golem.obj"));
    EXPECT_EQ(r.status, 2) << r.out;
    EXPECT_FALSE(fs::exists(folder));
}

TEST(Sweep, AnInputThatChangedIsRefused)
{
    fs::path const at = fresh();
    write_files(at);
    fs::path const folder =
        planned(R"({"verb": "draw", "models": "cages/a.obj", "size": "16x16"})", at / "sweep");
    std::ofstream(at / "cages" / "a.obj", std::ios::app) << "# new\n";
    run_all(folder); // it has its own
    Result r = plan(R"({"verb": "draw", "models": "cages/a.obj", "size": "16x16"})", folder);
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(has(r.err, folder.string() + ": another sweep is planned there")) << r.err;
    for (auto const& e : fs::recursive_directory_iterator(folder / "inputs")) {
        if (!e.is_regular_file()) continue;
        std::ofstream(e.path(), std::ios::app) << "# new\n";
        r = run("sweep run " + folder.string());
        EXPECT_EQ(r.status, 2);
        EXPECT_TRUE(has(r.err, e.path().string() + ": it is not what was planned with")) << r.err;
    }
}

TEST(Sweep, AnotherVersionsPlanIsNotRun)
{
    fs::path const folder =
        planned(R"({"verb": "draw", "models": "golem", "size": "16x16"})", fresh() / "sweep");
    std::string text = test::read_text(folder / "manifest.jsonl");
    std::size_t const at = text.find("\"version\":\"") + 11;
    text.insert(at, "9");
    write(folder / "manifest.jsonl", text);
    Result const r = run("sweep run " + folder.string());
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(has(r.err, "planned by version 9")) << r.err;
    EXPECT_TRUE(fs::is_empty(folder / "results"));
}

TEST(Sweep, RefusalsNameTheFileTheKeyAndTheLimitAndLeaveNothing)
{
    fs::path const at = fresh();
    for (auto const& [text, words] : std::vector<std::pair<std::string, std::string>>{
             {R"({"verb": "draw", "models": "jug", "tess": [1, 65]})", R"("tess" is 65)"},
             {R"({"verb": "draw", "models": "jug", "samples": 3})",
              R"("samples" is '3', it must be 1, 2, 4 or 8)"},
             {R"({"verb": "draw", "models": "jug", "schemes": ["acc", "nurbs"]})",
              R"("schemes": scheme 'nurbs' is not known)"},
             {R"({"verb": "draw", "models": ["jug", "teapot"]})", "teapot"},
             {R"({"verb": "draw", "models": "none/a.obj"})", "none/a.obj"},
             {R"({"verb": "draw", "models": "jug", "displace": "none.png"})", "none.png"},
             {R"({"verb": "cost", "models": "jug", "gpu": "voodoo"})", "voodoo"},
             {R"({"verb": "draw", "models": "jug", "tes": 1})",
              R"("tes" is no option of draw that a sweep can set; there are )"},
             {R"({"verb": "draw", "models": "jug", "set": ["lambda=1", "lambda=x"]})",
              R"("set": )"},
             {R"({"verb": "draw", "models": "jug", "lanes": 4})", R"("lanes" is no option)"},
             {R"({"verb": "draw", "models": "jug", "json": "a"})", R"("json" is no option)"},
             {R"({"verb": "draw", "models": "jug", "o": "a.png"})", R"("o" is no option)"},
             {R"({"verb": "export", "models": "jug"})",
              R"("verb" is "export", it must be draw, cost, compare or check)"},
             {R"({"verb": "draw", "models": "jug", "except": [{"model": "jug"}]})",
              R"("except" leaves out every case)"},
             {"{\n\"verb\" \"draw\"}", "this is not JSON"}}) {
        Result const r = plan(text, at / "sweep");
        EXPECT_EQ(r.status, 2) << text;
        EXPECT_TRUE(r.err.starts_with("tessemu: " + (at / "sweep.json").string() + ":")) << r.err;
        EXPECT_TRUE(has(r.err, words)) << text << ": " << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
        EXPECT_FALSE(fs::exists(at / "sweep")) << text;
    }
    planned(R"({"verb": "draw", "models": "golem", "size": "16x16"})", at / "sweep");
    for (auto const& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
             {"--shard 0/3", "--shard is 0"},
             {"--shard 4/3", "--shard is 4, it must be 1 to 3"},
             {"--shard 3", "I/N, such as 1/4"},
             {"--shard 1/2/3", "I/N, such as 1/4"},
             {"--lease 0.5", "--lease is 0.5, it must be 1 to 86400"},
             {"--lanes 3", "--lanes is"},
             {"-j -1", "-j is -1"}}) {
        Result const r = run("sweep run " + (at / "sweep").string() + " " + arguments);
        EXPECT_EQ(r.status, 2) << arguments;
        EXPECT_TRUE(has(r.err, words)) << arguments << ": " << r.err;
        EXPECT_TRUE(fs::is_empty(at / "sweep" / "results")) << arguments;
    }
    for (char const* verb : {"run", "status", "merge -o t.csv"}) {
        Result const r = run("sweep " + std::string(verb) + " " + at.string());
        EXPECT_EQ(r.status, 2) << verb;
        EXPECT_TRUE(has(r.err, "there is no manifest.jsonl")) << r.err;
    }
    EXPECT_FALSE(fs::exists("t.csv"));
}

TEST(Sweep, NothingIsMixedIntoAFolderOfSomethingElse)
{
    fs::path const at = fresh();
    write(at / "work" / "notes.txt", "mine");
    Result const r = plan(R"({"verb": "draw", "models": "jug"})", at / "work");
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(has(r.err, "there is something that is no sweep")) << r.err;
    EXPECT_EQ(std::distance(fs::directory_iterator(at / "work"), fs::directory_iterator()), 1);
}

TEST(Sweep, PlannedAgainItGoesOn)
{
    char const* const text =
        R"({"verb": "draw", "models": "golem", "size": "16x16", "tess": [1, 2, 3]})";
    fs::path const folder = planned(text, fresh() / "sweep");
    run_all(folder, "--shard 1/3");
    Result const r = plan(text, folder);
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(has(r.out, "3 cases of draw")) << r.out;
    EXPECT_TRUE(has(run("sweep status " + folder.string()).out, "1 done, 0 failed, 2 not yet"));
    EXPECT_TRUE(has(plan(R"({"verb": "draw", "models": "golem", "tess": [1, 1.0, "1"]})",
                         folder.parent_path() / "again")
                        .out,
                    "1 cases of draw (2 that are there twice are left out)"));
}

TEST(Sweep, WithoutArgumentsItShowsItsHelp)
{
    for (auto const& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
             {"sweep", "tessemu sweep "},
             {"sweep plan", "tessemu sweep plan "},
             {"sweep run", "tessemu sweep run "},
             {"sweep status", "tessemu sweep status "},
             {"sweep merge", "tessemu sweep merge "}}) {
        Result const r = run(arguments);
        EXPECT_EQ(r.status, 2) << arguments;
        EXPECT_EQ(r.out, "") << arguments;
        EXPECT_TRUE(has(r.err, "Usage: " + words)) << r.err;
        Result const help = run(arguments + " --help");
        EXPECT_EQ(help.status, 0) << arguments;
        EXPECT_EQ(help.out, r.err) << arguments;
    }
    Result const r = run("sweep fly away");
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(r.err.starts_with("tessemu: 'fly' is not a verb of sweep; there are plan run "))
        << r.err;
    EXPECT_TRUE(run("swoop").err.starts_with("tessemu: 'swoop' is not a verb; there are draw "));
    EXPECT_TRUE(has(run("--help").out, "sweep"));
}

} // namespace
} // namespace tessemu
