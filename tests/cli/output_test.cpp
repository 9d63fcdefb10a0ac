// Where results go: full disks, devices, pipes, links, names of any bytes; and what is left behind.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/report.h"
#include "tests/cli/program.h"
#include "tests/io/picture_hash.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

#include <sys/stat.h>
#include <sys/sysmacros.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using test::Result;

// What each verb answers with, quickly.
std::vector<std::string> const kVerbs{"draw jug --size 16x16",
                                      "check golem --tess 1 --size 16x16 --rays 0",
                                      "compare spindle --level 1",
                                      "cost jug --size 16x16",
                                      "reproduce loop09-table1",
                                      "diff a.json b.json",
                                      "info jug",
                                      "subdivide jug",
                                      "tessellate --factors 1 1 1 1 1 1"};
// Verbs that write a file by -o.
std::vector<std::string> const kPictures{"draw jug --size 64x64",
                                         "draw golem --size 64x64 --view error --level 1",
                                         "check golem --tess 1 --size 64x64 --rays 0",
                                         "cost jug --size 16x16", "reproduce loop09-figure3"};

/// Runs shell commands in a folder of the test's own; $T is the program.
class Output : public testing::Test {
protected:
    Output()
    {
        fs::remove_all(here);
        fs::create_directories(here);
    }
    ~Output() override { fs::remove_all(here); }

    Result shell(std::string const& script) const
    {
        std::ofstream(test::scratch() / "script") << script << "\n";
        return test::run_command("cd " + here.string() + " && T=" + TESSEMU_PROGRAM + " bash " +
                                 (test::scratch() / "script").string());
    }
    std::string read(std::string const& name) const { return test::read_text(here / name); }
    void make_results() const
    {
        for (char const* name : {"a.json", "b.json"})
            ASSERT_EQ(shell(std::string("$T info jug --json ") + name).status, 0);
    }
    /// Names in the folder, hidden ones too.
    std::vector<std::string> names() const
    {
        std::vector<std::string> out;
        for (auto const& entry : fs::directory_iterator(here))
            out.push_back(entry.path().filename().string());
        std::sort(out.begin(), out.end());
        return out;
    }
    void expect_one_line(Result const& r, std::string const& words, std::string const& what) const
    {
        EXPECT_EQ(r.status, 2) << what << ": " << r.err;
        EXPECT_NE(r.err.find(words), std::string::npos) << what << ": " << r.err;
        EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << what << ": " << r.err;
    }

    /// A device without room: a copy, since root could replace the system's.
    std::string full_device() const
    {
        fs::path const path = here.parent_path() / "full";
        if (geteuid() != 0) return "/dev/full";
        fs::remove(path);
        mknod(path.c_str(), S_IFCHR | 0666, makedev(1, 7));
        return path.string();
    }

    fs::path const here = test::scratch() / "here";
};

using Strings = std::vector<std::string>;

TEST_F(Output, LostStandardOutputExitsTwoWithAReasonOnEveryVerb)
{
    make_results();
    Strings commands{"--help",
                     "--version",
                     "draw --help",
                     "schemes",
                     "models",
                     "export jug -o m.ply",
                     "tessellate --batch cases.txt"};
    std::ofstream(here / "cases.txt") << "isoline integer line 3f800000 3f800000\n";
    for (std::string const& verb : kVerbs) {
        commands.push_back(verb);
        commands.push_back(verb + " --json -");
    }
    for (std::string const& command : commands) {
        Result const full = shell("$T " + command + " >/dev/full");
        expect_one_line(full, "standard output: cannot be written: No space left", command);
        if (command.find("--json") != std::string::npos) continue;
        Result const closed = shell("$T " + command + " >&-");
        expect_one_line(closed, "standard output: is not open for writing", command);
        // The reader is gone before the program writes.
        Result const gone = shell("set -o pipefail; mkfifo p 2>/dev/null; cat p >/dev/null & "
                                  "exec 3>p; kill $!; wait $! 2>/dev/null; $T " +
                                  command + " >&3");
        expect_one_line(gone, "its reader is gone", command);
    }
    EXPECT_FALSE(fs::exists(here / "m.ply")) << "a run that fails writes no file";
}

TEST_F(Output, StandardOutputThatIsClosedIsNoFilesDescriptor)
{
    Result const r = shell("$T draw jug --size 16x16 -o a.png --json a.json >&- 2>&-");
    EXPECT_EQ(r.status, 2);
    EXPECT_TRUE(names().empty());
}

TEST_F(Output, MessagesThatAreLostChangeNothing)
{
    // Two warnings and an error.
    std::ofstream(here / "fin.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\nf 1 2 3 4\n";
    for (char const* to : {"2>/dev/full", "2>&-"}) {
        EXPECT_EQ(shell(std::string("$T info fin.obj ") + to).status, 0) << to;
        EXPECT_EQ(shell(std::string("$T info nowhere.obj ") + to).status, 2) << to;
    }
}

// A file system of 16 KiB where the machine lets us mount one. Four old files fill it, one leaves
// room for a part of what is written, or for the picture and not for the JSON.
TEST_F(Output, AFullDiskLeavesTheOldFilesAndNothingElse)
{
    if (shell("unshare -m true").status != 0)
        GTEST_SKIP() << "no right to mount; other tests have a full device";
    fs::create_directories(here / "disk");
    auto const expect_refused = [&](std::string const& command, std::string const& old) {
        Result const r = shell("unshare -m bash -c '"
                               "mount -t tmpfs -o size=16k none disk || exit 99\n"
                               "for f in " +
                               old + "; do echo old > disk/$f; done\n$T " + command +
                               " > out; status=$?\n"
                               "echo $(ls -A disk) > left; cat disk/* > held\nexit $status'");
        expect_one_line(r, "No space left", command);
        EXPECT_EQ(read("left"), old + "\n") << command;
        EXPECT_EQ(read("held").size(), 4 * std::size_t(std::count(old.begin(), old.end(), '.')))
            << command;
    };
    Strings commands{"export jug --tess 8 -o disk/a.obj", "export jug --tess 8 -o disk/a.ply",
                     "draw jug --size 16x16 --json disk/a.json",
                     "draw jug --animate sway --frames 9 --size 64x64 -o disk/a.png",
                     "tessellate --factors 64 64 64 64 64 64 -o disk/a.json"};
    for (std::string const& verb : kPictures)
        for (char const* name : {"a.png", "a.exr"}) commands.push_back(verb + " -o disk/" + name);
    for (std::string const& command : commands) expect_refused(command, "a.exr a.json a.ply a.png");
    for (char const* command :
         {"draw jug --size 512x512 -o disk/a.exr",
          "draw jug --size 8x8 -o disk/a.png --json disk/j", "export jug --tess 8 -o disk/a.ply",
          "draw jug --animate sway --frames 30 --size 16x16 -o disk/a.png"})
        expect_refused(command, "a.png");
}

TEST_F(Output, AFileBeyondALimitLeavesTheOldFileAndNothingElse)
{
    std::ofstream(here / "a.exr") << "old";
    std::ofstream(here / "a.ply") << "old";
    for (char const* command : {"draw jug --size 64x64 -o a.exr", "export jug --tess 8 -o a.ply"}) {
        Result const r = shell(std::string("ulimit -f 4; $T ") + command);
        expect_one_line(r, "File too large", command);
    }
    EXPECT_EQ(names(), (Strings{"a.exr", "a.ply"}));
    EXPECT_EQ(read("a.exr"), "old");
    EXPECT_EQ(read("a.ply"), "old");
}

TEST_F(Output, DevicesAreWrittenToAndStay)
{
    // Copies of /dev/null and /dev/full.
    if (mknod((here / "null").c_str(), S_IFCHR | 0666, makedev(1, 3)) != 0 ||
        mknod((here / "full.png").c_str(), S_IFCHR | 0666, makedev(1, 7)) != 0 ||
        !std::ofstream(here / "null").is_open())
        GTEST_SKIP() << "no right to make devices, or to use them";
    make_results();
    for (std::string const& verb : kVerbs) {
        EXPECT_EQ(shell("$T " + verb + " --json null").status, 0) << verb;
        expect_one_line(shell("$T " + verb + " --json full.png"), "No space left", verb);
    }
    for (std::string const& verb : kPictures) {
        EXPECT_EQ(shell("$T " + verb + " -o null").status, 0) << verb;
        expect_one_line(shell("$T " + verb + " -o full.png"), "No space left", verb);
    }
    EXPECT_EQ(shell("$T export jug --tess 2 -o null --json null").status, 0);
    for (char const* name : {"null", "full.png"}) {
        struct stat s = {};
        ASSERT_EQ(lstat((here / name).c_str(), &s), 0);
        EXPECT_TRUE(S_ISCHR(s.st_mode)) << name;
    }
    EXPECT_EQ(names(), (Strings{"a.json", "b.json", "full.png", "null"}));
}

TEST_F(Output, PipesAndDescriptorsGetTheBytesOfAFile)
{
    ASSERT_EQ(shell("$T draw jug --size 32x32 -o a.png --json a.json").status, 0);
    ASSERT_EQ(shell("$T draw jug --size 32x32 -o a.exr").status, 0);
    ASSERT_EQ(shell("$T export jug --tess 2 -o a.obj && $T export jug --tess 2 -o a.ply").status,
              0);
    std::string const draw = "$T draw jug --size 32x32 -o ", mesh = "$T export jug --tess 2 -o ";
    // As /dev/stdout is a link, which a mistake would replace.
    fs::create_symlink("/proc/self/fd/1", here / "stdout");
    for (std::string const& script :
         {draw + ">(cat > b.png)", draw + "- > b.png", draw + "stdout > b.png",
          draw + "stdout | cat > b.png", draw + "/dev/fd/3 3> b.png",
          draw + "/proc/self/fd/3 3> b.png >/dev/null",
          "mkfifo f.PNG; cat f.PNG > b.png & " + draw + "f.PNG; wait"}) {
        // The substituted process ends on its own time.
        Result const r = shell(script + "; status=$?; sleep .2; exit $status");
        EXPECT_EQ(r.status, 0) << script << r.err;
        EXPECT_TRUE(read("b.png") == read("a.png")) << script;
        fs::remove(here / "b.png");
    }
    EXPECT_EQ(fs::status(here / "f.PNG").type(), fs::file_type::fifo);
    for (std::string const format : {"obj", "ply"}) {
        std::string const script = "rm -f p." + format + "; mkfifo p." + format + "; cat p." +
                                   format + " > b & " + mesh + "p." + format + "; wait";
        EXPECT_EQ(shell(script).status, 0);
        EXPECT_TRUE(read("b") == read("a." + format)) << format;
    }
    EXPECT_EQ(shell(mesh + "- > b").status, 0);
    EXPECT_TRUE(read("b") == read("a.obj"));
    EXPECT_EQ(shell("mkfifo p.exr; cat p.exr > b & " + draw + "p.exr; wait").status, 0);
    EXPECT_TRUE(read("b") == read("a.exr"));
    // What is there already stays: the shell's >>.
    EXPECT_EQ(shell("echo first > b; " + draw + "stdout >> b").status, 0);
    EXPECT_EQ(read("b"), "first\n" + read("a.png"));
    // One reader, one pipe after the other.
    EXPECT_EQ(
        shell("mkfifo one two; (cat one > 1; cat two > 2) & " + draw + "one --json two && wait")
            .status,
        0);
    EXPECT_TRUE(read("1") == read("a.png"));
    EXPECT_EQ(Json::parse(read("2"))["hash"], Json::parse(read("a.json"))["hash"]);
}

TEST_F(Output, NothingElseIsPrintedWhereAResultIs)
{
    fs::create_symlink("/proc/self/fd/1", here / "stdout");
    Json const json = Json::parse(shell("$T draw jug --size 16x16 --json stdout").out);
    EXPECT_EQ(json["schema"], "tessemu.draw/1");
    EXPECT_EQ(shell("$T export jug --tess 1 -o stdout").out.substr(0, 2), "v ");
    EXPECT_EQ(Json::parse(shell("$T export jug --tess 1 -o a.ply --json -").out)["schema"],
              "tessemu.export/1");
}

TEST_F(Output, LinksAreFollowed)
{
    fs::create_directories(here / "sub");
    fs::create_directories(here / "at");
    std::ofstream(here / "at/old.png") << "old";
    fs::create_symlink("../at/old.png", here / "sub/a.png");
    fs::create_symlink("a.png", here / "sub/b.png"); // a link to a link
    fs::create_symlink("../at/new.json", here / "sub/a.json");
    fs::create_symlink("b.png", here / "sub/loop.png");
    fs::create_symlink("at", here / "folder");
    Result const r = shell("$T draw jug --size 16x16 -o sub/b.png --json sub/a.json");
    ASSERT_EQ(r.status, 0) << r.err;
    for (char const* link : {"sub/a.png", "sub/b.png", "sub/a.json"})
        EXPECT_TRUE(fs::is_symlink(here / link)) << link;
    EXPECT_EQ(read("at/old.png").substr(1, 3), "PNG");
    EXPECT_EQ(Json::parse(read("at/new.json"))["schema"], "tessemu.draw/1");
    EXPECT_EQ(shell("$T draw jug --size 16x16 -o folder/c.png").status, 0);
    EXPECT_TRUE(fs::is_regular_file(here / "at/c.png"));
    fs::remove(here / "sub/a.png");
    fs::create_symlink("b.png", here / "sub/a.png");
    expect_one_line(shell("$T draw jug -o sub/a.png"), "symbolic links", "a loop");
}

TEST_F(Output, ReplacedFilesKeepTheirPermissions)
{
    for (mode_t mode : {0600, 0640, 0755}) {
        std::ofstream(here / "a.png") << "old";
        chmod((here / "a.png").c_str(), mode);
        ASSERT_EQ(shell("umask 077; $T draw jug --size 16x16 -o a.png").status, 0);
        struct stat s = {};
        stat((here / "a.png").c_str(), &s);
        EXPECT_EQ(s.st_mode & 0777, mode);
        EXPECT_EQ(read("a.png").substr(1, 3), "PNG");
    }
    ASSERT_EQ(shell("umask 027; $T draw jug --size 16x16 -o b.png").status, 0);
    EXPECT_EQ(fs::status(here / "b.png").permissions(), fs::perms(0640)) << "a new file's";
}

TEST_F(Output, ExtensionsAreOfAnyCase)
{
    ASSERT_EQ(shell("$T draw jug --size 16x16 -o a.png && $T draw jug --size 16x16 -o A.PNG && "
                    "$T draw jug --size 16x16 -o a.exr && $T draw jug --size 16x16 -o A.Exr && "
                    "$T export jug --tess 1 -o a.obj && $T export jug --tess 1 -o A.Obj && "
                    "$T export jug --tess 1 -o a.ply && $T export jug --tess 1 -o A.PLY && "
                    "$T cost jug --size 16x16 -o c.png && $T cost jug --size 16x16 -o C.Png && "
                    "$T draw jug --size 16x16 --animate sway --frames 2 -o s.PNG")
                  .status,
              0);
    EXPECT_TRUE(read("A.PNG") == read("a.png"));
    EXPECT_EQ(test::picture_hash(here / "A.Exr"), test::picture_hash(here / "a.exr"));
    EXPECT_TRUE(read("A.Obj") == read("a.obj"));
    EXPECT_TRUE(read("A.PLY") == read("a.ply"));
    EXPECT_TRUE(read("C.Png") == read("c.png"));
    EXPECT_TRUE(fs::exists(here / "s_0001.PNG"));
    // An .exr is drawn into floats, whatever the case.
    Json const j = Json::parse(shell("$T draw jug --size 16x16 -o B.EXR --json -").out);
    EXPECT_EQ(j["config"]["color_format"], "R32G32B32A32_FLOAT");
}

TEST_F(Output, NoResultReplacesAnInput)
{
    std::string const square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                               "vt 0 1\nf 1/1 2/2 3/3 4/4\n";
    std::ofstream(here / "in.obj") << square;
    fs::create_symlink("in.obj", here / "link.obj");
    ASSERT_EQ(shell("$T draw in.obj --size 16x16 -o h.png").status, 0);
    std::string const heights = read("h.png");
    std::ofstream(here / "batch.txt") << "quad integer triangle_cw 1 1 1 1 1 1\n";
    std::string const batch = read("batch.txt");
    for (char const* command :
         {"export in.obj -o in.obj", "export in.obj -o link.obj", "export link.obj -o ./in.obj",
          "draw in.obj --size 16x16 -o a.png --json in.obj", "info in.obj --json in.obj",
          "compare in.obj --json in.obj", "check in.obj --json in.obj", "cost in.obj --json in.obj",
          "draw in.obj --size 16x16 --displace h.png -o h.png",
          "tessellate --batch batch.txt -o batch.txt"}) {
        Result const r = shell("$T " + std::string(command));
        EXPECT_EQ(r.status, 2) << command;
        EXPECT_NE(r.err.find("which the run reads"), std::string::npos) << command << r.err;
    }
    EXPECT_EQ(read("in.obj"), square);
    EXPECT_TRUE(read("h.png") == heights);
    EXPECT_EQ(read("batch.txt"), batch);
}

TEST_F(Output, NamesAreBytes)
{
    std::string const name = "caf\xe9 \\ \xc3\xa9\xff.obj", shown = "caf\\xE9 \\x5C \xc3\xa9\\xFF";
    fs::create_directories(here / "f\xfc");
    std::ofstream(here / "f\xfc" / name)
        << "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n"
           "t odd\xffity 0/0/0\n";
    std::string const model = "f\xfc/'" + name + "'";
    for (std::string const& verb :
         {std::string("draw --size 16x16"), std::string("check --size 16x16 --tess 1 --rays 0"),
          std::string("export --tess 1 -o m\xff.ply"), std::string("compare --level 1"),
          std::string("cost --size 16x16 -o 'r\xff.png'"), std::string("info")}) {
        Result const r = shell("$T " + verb + " " + model + " --json -");
        ASSERT_EQ(r.status, 0) << verb << r.err;
        Json const j = Json::parse(r.out);
        EXPECT_EQ(j["inputs"][0]["name"], shown + ".obj") << verb;
        EXPECT_EQ(j["warnings"].size(), 1u) << verb;
    }
    EXPECT_TRUE(fs::exists(here / "m\xff.ply"));
    ASSERT_EQ(shell("$T draw jug --size 16x16 -o $'h\\xfe.png'").status, 0);
    std::ofstream(here / "square.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\n"
                                          "vt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n";
    Result const r = shell("$T draw square.obj --size 16x16 --displace $'h\\xfe.png' --json -");
    ASSERT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(Json::parse(r.out)["config"]["displace"], "h\\xFE.png");
    ASSERT_EQ(shell("$T info jug --json $'j\\xff.json'").status, 0);
    Result const diff = shell("$T diff $'j\\xff.json' $'j\\xff.json' --json -");
    EXPECT_EQ(Json::parse(diff.out)["inputs"][1]["name"], "j\\xFF.json");
    expect_one_line(shell("$T draw $'no\\xff.obj'"), "no\xff.obj", "a file that is not there");
}

TEST(AsUtf8, KeepsUtf8AndEscapesOtherBytesSoThatTheyCanBeHadBack)
{
    for (char const* text : {"", "jug", "\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x8d\xba",
                             "\xed\x9f\xbf", "\xee\x80\x80", "\xf4\x8f\xbf\xbf"})
        EXPECT_EQ(as_utf8(text), text);
    for (auto const& [bytes, text] : {std::pair<std::string, std::string>("\xe9", "\\xE9"),
                                      {"a\xc3", "a\\xC3"},
                                      {"\xc3(", "\\xC3("},
                                      {"\xc0\xaf", "\\xC0\\xAF"},          // overlong
                                      {"\xe0\x9f\xbf", "\\xE0\\x9F\\xBF"}, // overlong
                                      {"\xed\xa0\x80", "\\xED\\xA0\\x80"}, // half of a pair
                                      {"\xf4\x90\x80\x80", "\\xF4\\x90\\x80\\x80"}, // too large
                                      {"\xe2\x82", "\\xE2\\x82"},
                                      {"\\xE9", "\\x5CxE9"}})
        EXPECT_EQ(as_utf8(bytes), text);
}

TEST_F(Output, WhatCanFailFailsBeforeTheWork)
{
    fs::create_directories(here / "d.png");
    std::ofstream(here / "locked.png") << "old";
    fs::permissions(here / "locked.png", fs::perms(0444));
    fs::create_symlink("/proc/self/fd/1", here / "stdout");
    fs::create_symlink("missing/deep/a.png", here / "astray.png");
    ASSERT_EQ(mkfifo((here / "p").c_str(), 0666), 0);
    // Hours of work if they came to it.
    std::string const work = "timeout 20 $T draw jug --tess 64 --subdivide 6 --size 8192x8192 ";
    for (auto const& [options, words] : std::vector<std::pair<std::string, std::string>>{
             {"-o a.bmp", "extension is '.bmp'"},
             {"-o a", "extension is ''"},
             {"-o ''", "-o is '', it must be"},
             {"--json ''", "--json is '', it must be"},
             {"-o missing/a.png", "missing does not exist"},
             {"-o d.png", "d.png: is a folder"},
             {"-o d.png/", "is a folder"},
             {"-o locked.png", "locked.png: is read-only"},
             {"-o locked.png/a.png", "locked.png does not exist"},
             {"-o astray.png", "missing/deep does not exist"},
             {"-o /proc/a.png", "/proc/a.png: its folder /proc takes no new file"},
             {"-o " + std::string(300, 'a') + ".png", "File name too long"},
             {"-o a.png --json missing/a.json", "missing does not exist"},
             {"-o a.png --json a.png", "where --json goes"},
             {"-o a.png --json ./../here/a.png", "where --json goes"},
             {"-o - --json -", "where --json goes"},
             {"-o stdout --json -", "where --json goes"},
             {"-o p --json p", "where --json goes"},
             {"-o a.png > a.png", "where standard output goes"},
             {"--json a.json > a.json", "where standard output goes"},
             {"-o - --animate sway --frames 2", "--frames makes 2"},
             {"-o p --animate sway --frames 2", "--frames makes 2"},
             {"-o s.png --json s_0001.png --animate sway --frames 2", "where --json goes"},
             {"-o /dev/fd/9", "/dev/fd/9: is not open for writing"},
             {"-o /dev/fd/0 < locked.png", "is not open for writing"}}) {
        Result const r = shell(work + options);
        expect_one_line(r, words, options);
        EXPECT_TRUE(r.out.empty()) << options;
    }
    EXPECT_EQ(read("locked.png"), "old");
    expect_one_line(shell("timeout 20 $T export jug --subdivide 6 --tess 64 -o a.stl"), ".stl", "");
    expect_one_line(shell("timeout 20 $T export jug --subdivide 6 --tess 64 -o missing/a.ply"),
                    "missing", "");
}

TEST_F(Output, AFolderWithoutPermissionIsFoundBeforeTheWork)
{
    // Root may write anywhere: the program runs as nobody.
    std::string const user = geteuid() == 0 ? "setpriv --reuid=65534 --clear-groups " : "";
    fs::permissions(here, fs::perms(0755));
    if (shell(user + "$T --version").status != 0) GTEST_SKIP() << "nobody cannot run the program";
    fs::create_directories(here / "locked");
    std::ofstream(here / "locked/a.png") << "old";
    fs::permissions(here / "locked/a.png", fs::perms(0666));
    fs::permissions(here / "locked", fs::perms(0555));
    fs::create_directories(here / "hidden");
    fs::permissions(here / "hidden", fs::perms(0600));
    for (auto const& [output, words] : std::vector<std::pair<std::string, std::string>>{
             {"-o locked/b.png", "takes no new file: Permission denied"},
             {"-o locked/a.png", "takes no new file: Permission denied"},
             {"--json locked/b.json", "takes no new file: Permission denied"},
             {"-o hidden/sub/a.png", "hidden/sub: Permission denied"}})
        expect_one_line(
            shell("timeout 20 " + user + "$T draw jug --tess 64 --subdivide 6 " + output), words,
            output);
    EXPECT_EQ(read("locked/a.png"), "old");
    fs::permissions(here / "locked", fs::perms(0755)); // so that it can be removed
    fs::permissions(here / "hidden", fs::perms(0755));
}

TEST_F(Output, AnInterruptedRunLeavesTheOldFileAndNothingElse)
{
    std::ofstream(here / "a_0000.png") << "old";
    for (auto const& [signal, status] :
         {std::pair<std::string, int>("INT", 130), {"TERM", 143}, {"HUP", 129}}) {
        // Frames wait in temporaries until the last one is there. `set -m`: with job control a
        // shell's & does not ignore SIGINT.
        Result const r = shell(
            "set -m; $T draw jug --size 512x512 --animate sway --frames 9999 -o a.png >/dev/null & "
            "for i in $(seq 200); do [ $(ls -A | wc -l) -gt 3 ] && break; sleep .05; done; "
            "ls -A | wc -l; kill -" +
            signal + " $!; wait $!");
        EXPECT_EQ(r.status, status) << r.err;
        EXPECT_GT(std::atoi(r.out.c_str()), 3) << "there were temporaries";
        EXPECT_EQ(names(), Strings{"a_0000.png"}) << signal;
    }
    EXPECT_EQ(read("a_0000.png"), "old");
    // nohup's choice is kept.
    Result const r = shell("(trap '' HUP; exec $T draw jug --size 16x16 --animate sway --frames 40 "
                           "-o b.png >/dev/null) & sleep .05; kill -HUP $!; wait $!");
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(fs::exists(here / "b_0039.png"));
}

TEST_F(Output, SeveralFilesAreReplacedTogetherOrNotAtAll)
{
    std::string const full = full_device();
    if (!fs::is_character_file(full)) GTEST_SKIP() << "no right to make devices";
    std::ofstream(here / "a.png") << "old";
    std::ofstream(here / "s_0000.png") << "old";
    expect_one_line(shell("$T draw jug --size 16x16 -o a.png --json " + full), "No space left",
                    "json");
    EXPECT_EQ(read("a.png"), "old");
    expect_one_line(shell("$T draw jug --size 16x16 -o a.png --json a.json > /dev/full"),
                    "standard output", "table");
    EXPECT_EQ(read("a.png"), "old");
    expect_one_line(
        shell("$T draw jug --size 16x16 --animate sway --frames 3 -o s.png --json " + full),
        "No space left", "frames");
    EXPECT_EQ(read("s_0000.png"), "old");
    EXPECT_EQ(names(), (Strings{"a.png", "s_0000.png"}));
}

// A view that has no use for an option says so.
TEST_F(Output, OptionsThatAViewDoesNotUseAreNamed)
{
    Result const r = shell("$T draw golem --view error --level 1 --samples 4 --size 16x16");
    EXPECT_EQ(r.status, 0);
    EXPECT_EQ(r.err, "warning: --view error does not use --samples\n");
    EXPECT_EQ(shell("$T draw golem --view cage --tess 4 --size 16x16").err,
              "warning: --view cage does not use --tess\n");
}

TEST_F(Output, FramesAskOnlyForTheNamesThatTheyWrite)
{
    Result const r = shell("touch s.png; chmod 444 s.png; "
                           "$T draw jug --size 16x16 --animate sway --frames 2 -o s.png");
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(fs::exists(here / "s_0001.png"));
    EXPECT_EQ(read("s.png"), "");
}

TEST_F(Output, ATemporaryFolderThatIsMissingIsNamed)
{
    Result const r = shell("TMPDIR=/nowhere $T export jug --tess 1 -o -");
    EXPECT_EQ(r.status, 2);
    EXPECT_NE(r.err.find("standard output: needs a folder for temporary files, TMPDIR is "
                         "'/nowhere': "),
              std::string::npos)
        << r.err;
}

TEST_F(Output, WhatAGroupMayDoGoesToNoOtherGroup)
{
    if (geteuid() != 0) GTEST_SKIP() << "only root can make a file of a foreign group";
    Result const r = shell("chmod 777 .; touch a.json; chgrp 1234 a.json; chmod 672 a.json; "
                           "setpriv --reuid=65534 --regid=65534 --clear-groups "
                           "$T info jug --json a.json && stat -c '%a %u %g' a.json");
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_TRUE(r.out.ends_with("\n622 65534 65534\n")) << r.out;
}

} // namespace
} // namespace tessemu
