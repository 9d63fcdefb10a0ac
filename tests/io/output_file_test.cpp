// SPDX-License-Identifier: Apache-2.0
#include "io/output_file.h"

#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

fs::path scratch()
{
    fs::path const p =
        fs::temp_directory_path() / ("tessemu_output_test_" + std::to_string(getpid()));
    fs::remove_all(p);
    fs::create_directories(p);
    return p;
}

std::size_t files_in(fs::path const& folder)
{
    return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(OutputFile, IsInItsPlaceOnceCommitted)
{
    fs::path const folder = scratch(), path = folder / "a.txt";
    std::string const large(200000, 'x');
    {
        OutputFile out(path);
        EXPECT_EQ(files_in(folder), 0u) << "asking leaves nothing";
        out.write("new ");
        out.write(large);
        out.write("end");
        EXPECT_FALSE(fs::exists(path));
        out.commit();
    }
    EXPECT_EQ(test::read_text(path), "new " + large + "end");
    EXPECT_EQ(files_in(folder), 1u);
    OutputFile(path).commit(); // no bytes are a file too
    EXPECT_EQ(fs::file_size(path), 0u);
}

TEST(OutputFile, KeepsTheOldFileUnlessCommitted)
{
    fs::path const folder = scratch(), path = folder / "a.txt";
    write_file(path, "old");
    try {
        OutputFile out(path);
        out.write("half");
        out.close();
        throw Error("no more");
    } catch (Error const&) {
    }
    EXPECT_EQ(test::read_text(path), "old");
    EXPECT_EQ(files_in(folder), 1u);
}

TEST(OutputFile, TakesANameAsLongAsTheSystemTakes)
{
    fs::path const folder = scratch();
    write_file(folder / std::string(255, 'a'), "x");
    EXPECT_EQ(test::read_text(folder / std::string(255, 'a')), "x");
    EXPECT_THROW(write_file(folder / std::string(256, 'a'), "x"), WriteError);
}

TEST(OutputFile, SaysWhichWriteLostBytes)
{
    OutputFile out("/dev/full");
    EXPECT_TRUE(out.is_stream());
    out.write("waits in memory");
    EXPECT_THROW(out.close(), WriteError);
}

TEST(OutputFile, GoesToTheSamePlaceByAnyName)
{
    fs::path const folder = scratch();
    fs::create_directory_symlink(folder, folder / "again");
    fs::create_symlink("b", folder / "link");
    auto const same = [](fs::path const& a, fs::path const& b) {
        return OutputFile(a).is_same(OutputFile(b));
    };
    EXPECT_TRUE(same(folder / "a", folder / "again" / "." / "a"));
    EXPECT_TRUE(same(folder / "link", folder / "b"));
    EXPECT_FALSE(same(folder / "a", folder / "b"));
    EXPECT_TRUE(same("-", "/dev/stdout"));
    EXPECT_FALSE(same("/dev/null", "/dev/null")) << "it keeps nothing to mix";
    ASSERT_EQ(mkfifo((folder / "p").c_str(), 0666), 0);
    EXPECT_TRUE(same(folder / "p", folder / "again" / "p"));
}

TEST(ExtensionOf, IsWithoutDotAndCase)
{
    EXPECT_EQ(extension_of("a.PNG"), "png");
    EXPECT_EQ(extension_of("b.c/a.Obj"), "obj");
    EXPECT_EQ(extension_of("b.c/a"), "");
    EXPECT_EQ(extension_of(".png"), "");
    EXPECT_EQ(extension_of("a.\xc9xr"), "\xc9xr");
}

} // namespace
} // namespace tessemu
