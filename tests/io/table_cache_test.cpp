// Basis-function tables on disk: found again whole, or made again.
//
// SPDX-License-Identifier: Apache-2.0
#include "io/table_cache.h"

#include "io/output_file.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;

struct TableCache : testing::Test {
    fs::path folder = fs::temp_directory_path() / ("tessemu_cache_" + std::to_string(getpid()));
    PatchType type = sector_type(2, 1);

    TableCache()
    {
        fs::remove_all(folder);
        tables(); // before any fork
    }
    ~TableCache() override { fs::remove_all(folder); }
    static BasisTables const& tables()
    {
        static BasisTables const made = make_basis_tables(sector_type(2, 1));
        return made;
    }
    std::size_t files(std::string const& extension) const
    {
        std::size_t n = 0;
        if (fs::exists(folder))
            for (auto const& entry : fs::directory_iterator(folder))
                n += entry.path().extension() == extension;
        return n;
    }
};

TEST_F(TableCache, IsFoundByAnotherProcess)
{
    {
        BasisTableCache cache(folder);
        EXPECT_FALSE(cache.find(type));
        cache.keep(type, tables());
        EXPECT_TRUE(cache.find(type));
    }
    BasisTableCache other(folder);
    EXPECT_EQ(other.find(type), tables());
    EXPECT_FALSE(other.find(sector_type(2, 0)));
    EXPECT_EQ(files(".tables"), 1u);
}

TEST_F(TableCache, FindsAChangeOfAnyByte)
{
    std::string const whole = table_file(type, tables());
    EXPECT_EQ(read_table_file(whole, type), tables());
    EXPECT_FALSE(read_table_file(whole, sector_type(2, 0)));
    EXPECT_FALSE(read_table_file(whole + "x", type));
    std::size_t const head = 512; // then one byte in 997: the checksum is over all
    for (std::size_t n = 0; n < whole.size(); n += n < head ? 1 : 997) {
        std::string changed = whole;
        changed[n] = char(changed[n] ^ 1);
        EXPECT_FALSE(read_table_file(changed, type)) << n;
        EXPECT_FALSE(read_table_file(std::string_view(whole).substr(0, n), type)) << n;
    }
}

TEST_F(TableCache, ReplacesAFileThatIsBroken)
{
    BasisTableCache(folder).keep(type, tables());
    fs::path const file = BasisTableCache(folder).file_of(type);
    for (std::string const& content : {std::string(), std::string("tessemu basis tables 1\n"),
                                       table_file(sector_type(2, 0), tables())}) {
        write_file(file, content);
        BasisTableCache cache(folder);
        EXPECT_FALSE(cache.find(type));
        cache.keep(type, tables());
        EXPECT_EQ(BasisTableCache(folder).find(type), tables());
    }
}

TEST_F(TableCache, DoesNoHarmWhereItCannotBeWritten)
{
    write_file(folder, "a file, not a folder");
    std::vector<std::string> warnings;
    BasisTableCache cache(folder, [&](std::string const& w) { warnings.push_back(w); });
    cache.keep(type, tables());
    cache.keep(sector_type(2, 0), tables());
    EXPECT_EQ(warnings.size(), 1u);
    EXPECT_EQ(cache.find(type), tables()) << "from memory";
    BasisTableCache silent(folder);
    silent.keep(type, tables());
}

// Each of them makes and looks for the same types again and again; what is found is whole.
TEST_F(TableCache, IsSharedByProcesses)
{
    std::vector<pid_t> children;
    for (int c = 0; c < 4; ++c) {
        pid_t const child = fork();
        if (child == 0) {
            bool right = true;
            for (int i = 0; i < 20; ++i) {
                BasisTableCache cache(folder);
                if (auto const found = cache.find(type)) right = right && *found == tables();
                cache.keep(type, tables());
            }
            _exit(right ? 0 : 1);
        }
        children.push_back(child);
    }
    for (pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(files(".tables"), 1u);
    EXPECT_EQ(files(".tmp"), 0u);
}

// At any moment: a temporary may stay, a file that is there is whole.
TEST_F(TableCache, SurvivesAKillInTheMiddle)
{
    std::size_t whole = 0;
    for (int i = 0; i < 20; ++i) {
        pid_t const child = fork();
        if (child == 0)
            for (int n = 0;; ++n) {
                BasisTableCache cache(folder);
                cache.keep(type, tables());
            }
        std::this_thread::sleep_for(std::chrono::microseconds(2000 + 997 * i));
        kill(child, SIGKILL);
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFSIGNALED(status));
        if (!fs::exists(BasisTableCache(folder).file_of(type))) continue;
        EXPECT_EQ(BasisTableCache(folder).find(type), tables());
        ++whole;
    }
    EXPECT_GT(whole, 0u);
}

TEST(BasisTableMemory, ForgetsWhatWasNotAskedForLongest)
{
    BasisTables const t = make_basis_tables(sector_type(1, 0));
    BasisTableMemory memory(2 * t.bytes());
    memory.keep(sector_type(1, 0), t);
    memory.keep(smooth_type(3), t);
    EXPECT_TRUE(memory.find(sector_type(1, 0)));
    memory.keep(smooth_type(5), t);
    EXPECT_FALSE(memory.find(smooth_type(3)));
    EXPECT_TRUE(memory.find(sector_type(1, 0)));
    EXPECT_LE(memory.bytes(), 2 * t.bytes());
    BasisTableMemory small(1);
    small.keep(smooth_type(3), t);
    EXPECT_EQ(small.size(), 0u);
}

} // namespace
} // namespace tessemu
