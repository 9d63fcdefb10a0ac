// SPDX-License-Identifier: Apache-2.0
#include "sweep/claims.h"

#include "io/output_file.h"
#include "tests/sweep/toy_sweep.h"

#include <gtest/gtest.h>

#include <chrono>
#include <random>
#include <thread>

#include <signal.h>

namespace tessemu {
namespace {

namespace fs = std::filesystem;
using std::chrono::hours, std::chrono::seconds, std::chrono::milliseconds;
using test::scratch, test::spawn, test::wait_for;

constexpr double kLong = 86400;

void set_age(fs::path const& path, seconds age)
{
    fs::last_write_time(path, fs::file_time_type::clock::now() - age);
}

// A claim of a process that this host knows nothing of.
fs::path claim_elsewhere(fs::path const& folder, std::string const& name, seconds age)
{
    fs::path const path = folder / name;
    write_file(path, R"({"host":"elsewhere","system":"another","process":17,"start":"1"})"
                     "\n");
    set_age(path, age);
    return path;
}

// A process that took the block and was killed.
void die_with(fs::path const& folder, std::size_t block)
{
    pid_t const pid = spawn([&] {
        Claims claims(folder, kLong);
        if (claims.take(block)) raise(SIGKILL);
    });
    EXPECT_EQ(wait_for(pid), -1) << "it did not get its block";
}

TEST(Claims, ABlockHasOneTakerUntilItIsGivenBack)
{
    fs::path const folder = scratch();
    {
        Claims a(folder, kLong), b(folder, kLong);
        EXPECT_TRUE(a.take(3));
        EXPECT_FALSE(b.take(3));
        EXPECT_FALSE(a.take(3)) << "another thread's";
        EXPECT_TRUE(b.take(4));
        EXPECT_TRUE(b.take(1234567)); // longer than the names' digits
        EXPECT_FALSE(a.take(1234567));
        EXPECT_TRUE(a.holder(4).ends_with(", process " + std::to_string(getpid())));
        a.give_back({3, 4, 5});
        EXPECT_TRUE(b.take(3));
        EXPECT_FALSE(a.take(4)) << "only its own can be given back";
    }
    EXPECT_EQ(test::files_in(folder), 0u) << "what is left is given back";
}

TEST(Claims, ADeadProcessLosesItsClaimAtOnce)
{
    fs::path const folder = scratch();
    die_with(folder, 5);
    EXPECT_EQ(test::claims_in(folder), 1u);
    Claims claims(folder, kLong), other(folder, kLong);
    EXPECT_TRUE(claims.take(5));
    EXPECT_FALSE(other.take(5)) << "the dead one's claim is no way past the living one's";
    claims.give_back({5});
    EXPECT_EQ(test::files_in(folder), 0u) << "the dead one's claim goes too";
    EXPECT_TRUE(other.take(5));
}

TEST(Claims, ManyMayDieOfTheSameBlock)
{
    fs::path const folder = scratch();
    for (int i = 0; i < 12; ++i) die_with(folder, 5);
    Claims claims(folder, kLong);
    EXPECT_TRUE(claims.take(5));
    EXPECT_FALSE(Claims(folder, kLong).take(5));
    claims.give_back({5});
    EXPECT_EQ(test::files_in(folder), 0u);
}

TEST(Claims, ADeadProcessThatNobodyWaitedForIsDead)
{
    fs::path const folder = scratch();
    pid_t const pid = spawn([&] {
        Claims claims(folder, kLong);
        if (claims.take(5)) raise(SIGKILL);
    });
    siginfo_t info = {};
    ASSERT_EQ(waitid(P_PID, id_t(pid), &info, WEXITED | WNOWAIT), 0);
    EXPECT_TRUE(Claims(folder, kLong).take(5));
    EXPECT_EQ(wait_for(pid), -1);
}

TEST(Claims, AnotherProcessOfTheSameNumberIsNotTheOneThatClaimed)
{
    fs::path const folder = scratch();
    std::string text;
    {
        Claims claims(folder, kLong);
        claims.take(0);
        text = test::read_text(folder / "000000.0");
    }
    std::size_t const start = text.find("\"start\":\"") + 9;
    ASSERT_NE(text[start], '"');
    text.insert(start, "1");
    write_file(folder / "000000.0", text);
    EXPECT_TRUE(Claims(folder, kLong).take(0));
}

TEST(Claims, AnotherHostHoldsForItsLeaseAndNoLonger)
{
    fs::path const folder = scratch();
    fs::path const path = claim_elsewhere(folder, "000002.0", seconds(0));
    Claims claims(folder, 1000);
    EXPECT_FALSE(claims.take(2));
    EXPECT_EQ(claims.holder(2), "elsewhere, process 17");
    set_age(path, seconds(500));
    EXPECT_FALSE(claims.take(2));
    set_age(path, seconds(1001));
    EXPECT_TRUE(claims.take(2));
    claims.give_back({2});
    EXPECT_EQ(test::files_in(folder), 0u);
}

TEST(Claims, TheHighestGenerationHolds)
{
    fs::path const folder = scratch();
    claim_elsewhere(folder, "000002.0", seconds(5000));
    claim_elsewhere(folder, "000002.9", seconds(3000));
    fs::path const last = claim_elsewhere(folder, "000002.10", seconds(0));
    Claims claims(folder, 1000);
    EXPECT_FALSE(claims.take(2));
    set_age(last, seconds(2000));
    EXPECT_TRUE(claims.take(2));
    EXPECT_TRUE(fs::exists(folder / "000002.11"));
}

TEST(Claims, AClaimThatDoesNotSayWhoseItIsHoldsForALease)
{
    fs::path const folder = scratch();
    write_file(folder / "000002.0", "");
    Claims claims(folder, 1000);
    EXPECT_FALSE(claims.take(2));
    EXPECT_EQ(claims.holder(2), "somebody");
    set_age(folder / "000002.0", seconds(1001));
    EXPECT_TRUE(claims.take(2));
}

TEST(Claims, WhoLivesTouchesItsClaims)
{
    fs::path const folder = scratch();
    Claims claims(folder, 0.04);
    claims.take(1);
    claims.take(2);
    for (char const* name : {"000001.0", "000002.0"}) set_age(folder / name, hours(2));
    auto const is_old = [&](char const* name) {
        return fs::last_write_time(folder / name) < fs::file_time_type::clock::now() - hours(1);
    };
    while (is_old("000001.0") || is_old("000002.0")) std::this_thread::sleep_for(milliseconds(1));
}

TEST(Claims, WhoIsBackAfterItsLeaseOpensNoWayPastWhoTookOver)
{
    fs::path const folder = scratch();
    Claims late(folder, kLong), next(folder, kLong), third(folder, kLong);
    ASSERT_TRUE(late.take(7));
    claim_elsewhere(folder, "000007.0", hours(48)); // as `next` sees it
    ASSERT_TRUE(next.take(7));
    late.give_back({7});
    EXPECT_FALSE(third.take(7));
    next.give_back({7});
    EXPECT_TRUE(third.take(7));
}

TEST(Claims, WhoIsBackAfterItsLeaseGivesBackNobodyElsesClaim)
{
    fs::path const folder = scratch();
    Claims late(folder, kLong), next(folder, kLong);
    ASSERT_TRUE(late.take(7));
    claim_elsewhere(folder, "000007.0", seconds(0)); // taken over, given back and taken by another
    late.give_back({7});
    EXPECT_FALSE(next.take(7));
}

TEST(Claims, AGapBelowWhoHoldsIsNoWayPastIt)
{
    fs::path const folder = scratch();
    claim_elsewhere(folder, "000007.2", seconds(0));
    Claims claims(folder, 1000);
    EXPECT_FALSE(claims.take(7));
    set_age(folder / "000007.2", seconds(1001));
    EXPECT_TRUE(claims.take(7));
    EXPECT_FALSE(Claims(folder, 1000).take(7));
}

TEST(Claims, AProcessThatDiesWhileItClaimsBarsNothing)
{
    fs::path const folder = scratch();
    std::mt19937 random(11);
    for (int i = 0; i < 100; ++i) {
        pid_t const pid = spawn([&] {
            Claims claims(folder, kLong);
            for (std::size_t b = 0;; b = (b + 1) % 7)
                if (claims.take(b)) claims.give_back({b});
        });
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 4000));
        kill(pid, SIGKILL);
        EXPECT_EQ(wait_for(pid), -1);
        Claims claims(folder, kLong);
        for (std::size_t b = 0; b < 7; ++b) ASSERT_TRUE(claims.take(b)) << i;
    }
}

TEST(Claims, LapsedOnesOfBlocksThatAreDoneAreCleared)
{
    fs::path const folder = scratch();
    die_with(folder, 1);
    die_with(folder, 2);
    die_with(folder, 2);
    claim_elsewhere(folder, "000003.0", seconds(0));
    claim_elsewhere(folder, "000004.0", seconds(5000));
    Claims claims(folder, 1000), other(folder, 1000);
    other.take(5);
    claims.clear_lapsed([](std::size_t block) { return block != 1; });
    std::vector<std::string> left;
    for (auto const& e : fs::directory_iterator(folder)) left.push_back(e.path().filename());
    std::sort(left.begin(), left.end());
    EXPECT_EQ(left, (std::vector<std::string>{"000001.0", "000003.0", "000005.0"}));
}

TEST(Claims, AFolderThatIsNotThereIsNamed)
{
    fs::path const folder = scratch() / "none";
    Claims claims(folder);
    EXPECT_THROW(claims.take(0), WriteError);
    EXPECT_NE(test::refusal([&] { claims.take(0); }).find(folder.string()), std::string::npos);
}

// Whether a process ends: its first thread has, others may still be about to.
bool is_ending(pid_t pid)
{
    std::ifstream in(fmt::format("/proc/{}/stat", pid));
    std::string stat;
    std::getline(in, stat);
    return stat.empty() || stat.find(") Z ") != std::string::npos;
}

// A file that whoever holds the block locks. Throws where another living process holds it.
class LockedFile {
public:
    explicit LockedFile(fs::path const& path)
        : file_(open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666))
    {
        struct flock lock = {};
        lock.l_type = F_WRLCK;
        lock.l_whence = SEEK_SET;
        while (fcntl(file_, F_SETLK, &lock) != 0) {
            struct flock other = lock;
            fcntl(file_, F_GETLK, &other);
            if (other.l_type != F_UNLCK && !is_ending(other.l_pid))
                throw Error("two hold one block");
        }
    }
    ~LockedFile() { close(file_); }
    LockedFile(LockedFile const&) = delete;

private:
    int file_;
};

// Takes blocks and gives them back.
void take_and_give_back(fs::path const& folder, int blocks, int rounds)
{
    Claims claims(folder / "claims", kLong);
    for (int round = 0; round < rounds; ++round)
        for (int b = 0; b < blocks; ++b) {
            if (!claims.take(std::size_t(b))) continue;
            {
                LockedFile const lock(folder / std::to_string(b));
                test::append_byte(folder / (std::to_string(b) + ".taken"));
                std::this_thread::yield();
            }
            claims.give_back({std::size_t(b)});
        }
}

TEST(Claims, OfManyProcessesOneHoldsABlock)
{
    fs::path const folder = scratch();
    fs::create_directory(folder / "claims");
    std::vector<pid_t> processes;
    for (int i = 0; i < 6; ++i)
        processes.push_back(spawn([&] { take_and_give_back(folder, 20, 15); }));
    for (pid_t p : processes) EXPECT_EQ(wait_for(p), 0);
    for (int b = 0; b < 20; ++b)
        EXPECT_GE(fs::file_size(folder / (std::to_string(b) + ".taken")), 15u);
    EXPECT_EQ(test::files_in(folder / "claims"), 0u);
}

TEST(Claims, OneHoldsABlockWhileOthersDie)
{
    fs::path const folder = scratch();
    fs::create_directory(folder / "claims");
    std::mt19937 random(7);
    pid_t const survivor = spawn([&] { take_and_give_back(folder, 4, 1500); });
    for (int i = 0; i < 60; ++i) {
        pid_t const victim = spawn([&] { take_and_give_back(folder, 4, 1000000); });
        std::this_thread::sleep_for(std::chrono::microseconds(random() % 8000));
        kill(victim, SIGKILL);
        EXPECT_EQ(wait_for(victim), -1) << "two held one block";
    }
    EXPECT_EQ(wait_for(survivor), 0);
}

// Blocks that are never given back: each has one taker.
TEST(Claims, EachBlockIsTakenOnceWhileItIsHeld)
{
    fs::path const folder = scratch();
    fs::create_directory(folder / "claims");
    int gate[2];
    ASSERT_EQ(pipe(gate), 0);
    std::vector<pid_t> processes;
    for (int i = 0; i < 4; ++i)
        processes.push_back(spawn([&] {
            close(gate[1]);
            Claims claims(folder / "claims", kLong);
            for (std::size_t b = 0; b < 300; ++b)
                if (claims.take(b)) test::append_byte(folder / std::to_string(b));
            test::append_byte(folder / "through");
            char end = 0;
            if (read(gate[0], &end, 1) != 0) throw Error("no end of the pipe");
        }));
    while (!fs::exists(folder / "through") || fs::file_size(folder / "through") < 4)
        std::this_thread::sleep_for(milliseconds(1));
    close(gate[1]);
    close(gate[0]);
    for (pid_t p : processes) EXPECT_EQ(wait_for(p), 0);
    for (int b = 0; b < 300; ++b) EXPECT_EQ(fs::file_size(folder / std::to_string(b)), 1u) << b;
}

} // namespace
} // namespace tessemu
